//! Maximum likelihood with noise on input and output, by the Kalman filter.
//!
//! Input samples that act after the last output sample have no part in it. The true input is a random walk at its samples (or an integrated one) and runs between them by the hold, as the model
//! assumes. A Wiener process *between* the samples would contradict the hold and bias coarse records. The state is
//! `[w, u now, u next, (slope)]` with `w = [1, s, ..] / a(s) u`; input and output are read with known variances. The innovations `nu`
//! and their variances `S` give the likelihood
//!
//! `-ln L = 1/2 sum (ln S + nu^2/S)`,
//!
//! minimised by the scoring method, `F step = -gradient` with Fisher's information
//! `F = sum (dnu dnu^T/S + dS dS^T/(2 S^2))`; the derivatives are central differences of `nu` and `ln S`.
//!
//! Source: Söderström 2007 (section 8); Ljung 1999 (section 10.1).
use nalgebra::{DMatrix, DVector};

use super::compensation::Variances;
use super::parametrisation::{Coefficients, Parametrisation};
use super::problem::Problem;
use super::response::respond;
use super::schedule::Schedule;
use super::solve::{Search, Solution, relative};
use super::{Hold, IdentifyError, InitialState, InputModel, Parameter};
use crate::EstimatorError;
use crate::filter::{ExtendedKalman, StateSpace, StepError, UdFactors};
use crate::least_squares::{invert, solve};
use process::Process;

mod process;

/// Step of the central differences.
const DIFFERENCE: f64 = 1e-5;
/// Variance of a state that nothing is known of, in the record's units.
const DIFFUSE: f64 = 1e7;
/// Halvings of a step that does not raise the likelihood.
const HALVINGS: usize = 12;
/// A relative step this small is the last: the differences do not resolve a smaller one.
const LAST_STEP: f64 = 1e-10;
/// Near the maximum a step that is not below this share of the one before it is rounding.
const CONTRACTION_RATIO: f64 = 0.5;
/// A gain of the logarithm of the likelihood this small is a ten-thousandth of a standard deviation.
const LOG_LIKELIHOOD_TOLERANCE: f64 = 1e-8;

/// Innovation and its variance of every reading.
type Innovations = Vec<(f64, f64)>;

/// A problem in which the likelihood is sought.
#[derive(Clone, Copy, Debug)]
pub(super) struct Likelihood<'a> {
    pub search: Search<'a>,
    pub variances: Variances,
    pub input_model: InputModel,
}

/// The maximum: parameters with the logarithm of the intensity last, their covariance.
#[derive(Clone, Debug)]
pub(super) struct Maximum {
    pub theta: Vec<f64>,
    pub covariance: DMatrix<f64>,
    pub iterations: usize,
}

impl Likelihood<'_> {
    /// The maximum from an estimate by another method. The initial response is integrated out.
    pub(super) fn maximise(&self, start: &Solution) -> Result<Maximum, IdentifyError> {
        let parametrisation = self.search.parametrisation;
        let mut theta = start.theta.clone();
        theta.push(self.first_intensity().ln());
        let free: Vec<usize> = (0..theta.len())
            .filter(|&i| !matches!(parametrisation.parameters.get(i), Some(Parameter::Initial(_))))
            .collect();
        let mut here = self.innovations(&theta).ok_or(IdentifyError::VarianceTooLarge)?;
        let mut size = f64::INFINITY;
        for iterations in 1..=self.search.settings.iterations {
            self.search.check_going()?;
            let (gradient, information) = self.derivatives(&theta, &free, &here)?;
            let step = solve(&information, &(-&gradient)).ok_or_else(|| self.undetermined(&theta))?;
            let mut full = DVector::zeros(theta.len());
            free.iter().zip(step.iter()).for_each(|(&i, &step)| full[i] = step);
            let last = std::mem::replace(&mut size, relative(&full, &theta));
            // Half the decrease that the step promises; too small a one drowns in the rounding of the cost.
            let close = -0.5 * gradient.dot(&step) <= LOG_LIKELIHOOD_TOLERANCE;
            if size <= LAST_STEP || (close && size > CONTRACTION_RATIO * last) {
                let covariance = invert(&information).ok_or_else(|| self.undetermined(&theta))?;
                let covariance = spread_out(&covariance, &free, theta.len());
                return Ok(Maximum { theta, covariance, iterations });
            }
            let bound = if close { f64::INFINITY } else { cost(&here) };
            (theta, here) = self.descend(&theta, &full, bound).ok_or_else(|| unsettled(iterations, size))?;
        }
        Err(unsettled(self.search.settings.iterations, size))
    }

    fn undetermined(&self, theta: &[f64]) -> IdentifyError {
        let parameter = Parameter::Denominator(0);
        let at = self.search.parametrisation.position(parameter).unwrap_or(0);
        IdentifyError::NotDetermined { parameter, value: theta[at], sd: f64::INFINITY }
    }

    /// Parameters along a step at which the cost is below a bound.
    fn descend(&self, theta: &[f64], step: &DVector<f64>, bound: f64) -> Option<(Vec<f64>, Innovations)> {
        (0..HALVINGS).find_map(|halvings| {
            let moved = self.search.moved(theta, step, 0.5_f64.powi(halvings as i32));
            let trial = self.innovations(&moved)?;
            (cost(&trial) < bound).then_some((moved, trial))
        })
    }

    /// Gradient of the cost, and Fisher's information.
    fn derivatives(
        &self,
        theta: &[f64],
        free: &[usize],
        here: &Innovations,
    ) -> Result<(DVector<f64>, DMatrix<f64>), IdentifyError> {
        let mut slopes = Vec::with_capacity(free.len());
        for &i in free {
            self.search.check_going()?;
            let difference = DIFFERENCE * theta[i].abs().max(0.1);
            let at = |shift: f64| {
                let mut shifted = theta.to_vec();
                shifted[i] += shift;
                self.innovations(&shifted).ok_or_else(|| self.undetermined(theta))
            };
            let (above, below) = (at(difference)?, at(-difference)?);
            let slope = |k: usize| {
                // Derivatives of nu/sqrt(S) at constant S, and of ln S.
                let (above, below): ((f64, f64), (f64, f64)) = (above[k], below[k]);
                let dnu = (above.0 - below.0) / (2.0 * difference * here[k].1.sqrt());
                (dnu, (above.1 / below.1).ln() / (2.0 * difference))
            };
            slopes.push((0..here.len()).map(slope).collect::<Vec<_>>());
        }
        let p = free.len();
        let (mut gradient, mut information) = (DVector::zeros(p), DMatrix::zeros(p, p));
        for (k, (nu, s)) in here.iter().enumerate() {
            let normal = nu / s.sqrt();
            for i in 0..p {
                let (dnu, dlns) = slopes[i][k];
                gradient[i] += normal * dnu + 0.5 * (1.0 - normal * normal) * dlns;
                for (j, slope) in slopes.iter().enumerate() {
                    information[(i, j)] += dnu * slope[k].0 + 0.5 * dlns * slope[k].1;
                }
            }
        }
        Ok((gradient, information))
    }

    /// Intensity of the input's course from its samples, less what their noise adds.
    fn first_intensity(&self) -> f64 {
        let Problem { input_time: t, u, .. } = self.search.problem;
        let noise = self.variances.input;
        let steps = u.windows(2).zip(t.windows(2)).map(|(u, t)| (u[1] - u[0], t[1] - t[0]));
        let (sum, noisy, count) = match self.input_model {
            InputModel::RandomWalk => steps.fold((0.0, 0.0, 0.0), |(sum, noisy, count), (du, dt)| {
                (sum + du * du / dt, noisy + 2.0 * noise / dt, count + 1.0)
            }),
            InputModel::IntegratedRandomWalk => {
                let slopes: Vec<(f64, f64)> = steps.map(|(du, dt)| (du / dt, dt)).collect();
                slopes.windows(2).fold((0.0, 0.0, 0.0), |(sum, noisy, count), pair| {
                    let (change, dt) = (pair[1].0 - pair[0].0, 0.5 * (pair[0].1 + pair[1].1));
                    (sum + change * change / dt, noisy + 6.0 * noise / dt.powi(3), count + 1.0)
                })
            }
        };
        ((sum - noisy).max(1e-3 * sum) / f64::max(count, 1.0)).max(f64::MIN_POSITIVE)
    }

    /// All innovations; `None` where the model is unstable or the filter fails.
    fn innovations(&self, theta: &[f64]) -> Option<Innovations> {
        let k = self.search.parametrisation.expand(theta);
        if !k.is_stable() {
            return None;
        }
        let intensity = theta.last()?.exp();
        let innovations = match k.order {
            1 => self.filter::<1>(&k, intensity),
            2 => self.filter::<2>(&k, intensity),
            _ => self.filter::<3>(&k, intensity),
        };
        innovations.ok().filter(|all| all.iter().all(|(nu, s)| nu.is_finite() && *s > 0.0))
    }

    fn filter<const N: usize>(
        &self,
        k: &Coefficients,
        intensity: f64,
    ) -> Result<Innovations, Box<dyn std::error::Error>> {
        let problem = self.search.problem;
        let schedule = Schedule::new(problem, k.dead_time);
        let y = self.unexplained(&schedule, k);
        let process = Process::<N>::new(k, self, intensity);
        let n = process.states();
        let covariance = self.start_covariance(k, n);
        let p = UdFactors::from_covariance(&covariance)?;
        let mut filter = ExtendedKalman::try_new(process, &vec![0.0; n], p)?;
        let mut innovations = Vec::with_capacity(problem.u.len() + problem.samples());
        let mut take = |filter: &mut ExtendedKalman<_>, dt: f64, z: [f64; 2]| {
            let read = filter.step(dt, &z)?.iter().zip(z).filter(|(_, z)| z.is_finite());
            innovations.extend(read.map(|(innovation, _)| (innovation.nu, innovation.s)));
            Ok::<(), StepError<EstimatorError>>(())
        };
        take(&mut filter, 0.0, [problem.u[0], schedule.initial.map_or(f64::NAN, |sample| y[sample])])?;
        for piece in &schedule.pieces {
            filter.model_mut().piece = *piece;
            let input = match problem.hold {
                Hold::First if piece.fresh => problem.u[piece.left + 1],
                Hold::Zero if piece.fresh && piece.left > 0 => problem.u[piece.left],
                _ => f64::NAN,
            };
            take(&mut filter, piece.duration, [input, piece.output.map_or(f64::NAN, |sample| y[sample])])?;
        }
        Ok(innovations)
    }

    /// Output less what does not depend on the input.
    fn unexplained(&self, schedule: &Schedule, k: &Coefficients) -> Vec<f64> {
        let problem = self.search.problem;
        if let InitialState::Given(_) = self.search.parametrisation.structure.initial {
            let free = respond(problem, schedule, &vec![0.0; problem.u.len()], k);
            problem.y.iter().zip(&free.y).map(|(y, free)| y - free).collect()
        } else {
            problem.y.iter().map(|y| y - k.offset).collect()
        }
    }

    /// Both input states are the first input, of which nothing is known; `w` as the structure says.
    fn start_covariance(&self, k: &Coefficients, states: usize) -> DMatrix<f64> {
        let n = k.order;
        let (u, y) = (&self.search.problem.u, &self.search.problem.y);
        let largest = u.iter().chain(y).fold(1.0, |largest: f64, value| largest.max(value.abs()));
        let diffuse = DIFFUSE * largest * largest;
        let mut covariance = DMatrix::zeros(states, states);
        let mut same = vec![n, n + 1];
        let mut factor = vec![1.0; states];
        match self.search.parametrisation.structure.initial {
            InitialState::Estimated => (0..n).for_each(|i| covariance[(i, i)] = diffuse),
            InitialState::Settled => {
                same.push(0);
                factor[0] = 1.0 / k.a[0];
            }
            InitialState::Zero | InitialState::Given(_) => {}
        }
        for &i in &same {
            for &j in &same {
                covariance[(i, j)] = diffuse * factor[i] * factor[j];
            }
        }
        if states > n + 2 {
            covariance[(n + 2, n + 2)] = diffuse / self.search.problem.interval().powi(2);
        }
        covariance
    }
}

/// `-ln L` but for a constant.
fn cost(innovations: &Innovations) -> f64 {
    0.5 * innovations.iter().map(|(nu, s)| s.ln() + nu * nu / s).sum::<f64>()
}

fn unsettled(iterations: usize, step: f64) -> IdentifyError {
    IdentifyError::NotConverged { method: "maximum likelihood", iterations, step }
}

/// A covariance of some parameters among all; the others have none.
fn spread_out(covariance: &DMatrix<f64>, free: &[usize], length: usize) -> DMatrix<f64> {
    let mut all = DMatrix::zeros(length, length);
    for (i, &row) in free.iter().enumerate() {
        for (j, &column) in free.iter().enumerate() {
            all[(row, column)] = covariance[(i, j)];
        }
    }
    all
}

/// Parameters of the structure alone, for the statistics of the simulation.
pub(super) fn without_intensity<'a>(parametrisation: &Parametrisation, maximum: &'a Maximum) -> &'a [f64] {
    &maximum.theta[..parametrisation.parameters.len()]
}

#[cfg(test)]
mod tests;
