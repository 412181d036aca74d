//! The search: Gauss-Newton with Levenberg's damping and geodesic acceleration, bounds by projection.
//!
//! A pressure sensor sees the gas a thousand times better than a contact of the valve is seen by any sensor. The sum of
//! squares is then a long, narrow, curved valley, in which a straight step is short. Along the step `v` the second
//! derivative of the readings comes from one more simulation, and `v + a/2` with `(A + lambda D) a = -J^T y_vv` follows the bend.
//!
//! Source: Levenberg 1944; Transtrum and Sethna 2012.
use nalgebra::{DMatrix, DVector};

use super::fit::{Evaluation, Fit};
use super::identifiability::{check_determined, identifiability, usual_width};
use super::sensitivity::sensitivities;
use super::solution::{Solution, cost};
use super::{CalibrateError, CalibrationSettings};
use crate::least_squares::{Damping, solve};

/// Longest step of a logarithm at once: beyond it the linearisation means nothing.
const LONGEST_STEP: f64 = 0.5;

/// A step of fewer standard deviations may be the last one where the solver's error keeps the sum from falling.
const SOLVER_ERROR_SD: f64 = 0.3;

/// Part of a step over which its bend is measured, and the largest ratio `2 |a| / |v|` at which the step is believed.
const BEND_STEP: f64 = 0.1;
const LARGEST_BEND: f64 = 0.75;

/// Steps shorter than this many standard deviations are straight.
const STRAIGHT_SD: f64 = 1.0;

/// Normal equations of the coordinates that are free.
struct Normal {
    matrix: DMatrix<f64>,
    rhs: DVector<f64>,
    /// Widths of the parameters to the power -2.
    scale: DVector<f64>,
    held: Vec<bool>,
}

/// A step of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchStep {
    /// Its number, from 1.
    pub number: usize,
    /// Distance to the minimum before it, in standard deviations of the estimate.
    pub distance_sd: f64,
}

/// Least squares from a start, with some coordinates held.
pub(super) fn search(fit: &Fit, start: Vec<f64>, held: &[bool]) -> Result<Solution, CalibrateError> {
    search_watched(fit, start, held, &mut |_| ())
}

/// [`search`], telling each step.
pub(super) fn search_watched(
    fit: &Fit,
    start: Vec<f64>,
    held: &[bool],
    watch: &mut dyn FnMut(SearchStep),
) -> Result<Solution, CalibrateError> {
    let mut here = Solution::at(fit, start, held)?;
    // What the model misses now is no information on the parameters: the first step trusts the widths as much.
    let mut damping = Damping::starting_at(here.cost / fit.samples() as f64);
    for iterations in 1..=fit.settings.iterations {
        here.iterations = iterations;
        here.jacobian = match sensitivities(fit, &here.z, &here.evaluation, held) {
            Ok(jacobian) => jacobian,
            // A valley without a bottom may lead to where nothing can be simulated: then that is what is wrong.
            Err(error) if iterations > 1 => {
                return Err(check_determined(fit, &identifiability(fit, &here)).err().unwrap_or(error));
            }
            Err(error) => return Err(error),
        };
        here.check_influence(fit)?;
        let normal = Normal::new(fit, &here);
        let distance = normal.distance();
        watch(SearchStep { number: iterations, distance_sd: distance });
        if distance <= fit.settings.tolerance_sd {
            return Ok(here);
        }
        match here.lower(fit, &normal, &mut damping, distance) {
            Some((z, evaluation, cost)) => (here.z, here.evaluation, here.cost) = (z, evaluation, cost),
            None if distance < SOLVER_ERROR_SD => return Ok(here),
            None => break,
        }
    }
    // It ends here too.
    check_determined(fit, &identifiability(fit, &here))?;
    let (iterations, step) = (here.iterations, Normal::new(fit, &here).distance());
    let relative_tolerance = fit.settings.simulation.relative_tolerance;
    let usual = CalibrationSettings::default().simulation.relative_tolerance;
    Err(if relative_tolerance > usual {
        CalibrateError::SolverTooCoarse { iterations, step, relative_tolerance, usual }
    } else {
        CalibrateError::NotConverged { iterations, step }
    })
}

impl Solution {
    /// A point of a lower sum; `None`: there is none however short the step.
    fn lower(
        &self,
        fit: &Fit,
        normal: &Normal,
        damping: &mut Damping,
        distance: f64,
    ) -> Option<(Vec<f64>, Evaluation, f64)> {
        while !damping.is_hopeless() {
            if let Some(step) = self.step(fit, normal, *damping, distance) {
                let moved = moved(fit, &self.z, &step);
                // A step to where nothing can be simulated is too long, no error.
                if let Ok(trial) = fit.evaluate(&moved) {
                    let sum = cost(fit, &moved, &trial);
                    if sum < self.cost {
                        damping.relax();
                        return Some((moved, trial, sum));
                    }
                }
                if distance < SOLVER_ERROR_SD {
                    return None;
                }
            }
            damping.tighten();
        }
        None
    }

    /// A damped step with its bend; `None`: it bends too much, or there is none.
    fn step(&self, fit: &Fit, normal: &Normal, damping: Damping, distance: f64) -> Option<DVector<f64>> {
        let straight = limited(fit, damping.scaled_step(&normal.matrix, &normal.rhs, &normal.scale)?);
        if distance < STRAIGHT_SD {
            return Some(straight);
        }
        let beside = fit.evaluate(&moved(fit, &self.z, &(&straight * BEND_STEP))).ok()?;
        let linear = &self.jacobian * &straight;
        let bend = DVector::from_iterator(
            linear.len(),
            self.evaluation
                .residuals
                .iter()
                .zip(&beside.residuals)
                .zip(linear.iter())
                .map(|((here, beside), linear)| 2.0 / BEND_STEP * ((here - beside) / BEND_STEP - linear)),
        );
        let rhs = normal.without_held(-self.jacobian.tr_mul(&bend));
        let acceleration = damping.scaled_step(&normal.matrix, &rhs, &normal.scale)?;
        let size = |d: &DVector<f64>| d.component_mul(&normal.scale).dot(d).sqrt();
        let believed = 2.0 * size(&acceleration) <= LARGEST_BEND * size(&straight);
        believed.then(|| straight + 0.5 * acceleration)
    }

    /// A parameter without prior must change some reading.
    fn check_influence(&self, fit: &Fit) -> Result<(), CalibrateError> {
        let idle = |&i: &usize| {
            !self.held[i] && fit.specs[i].prior.is_none() && self.jacobian.column(i).amax() == 0.0
        };
        match (0..self.held.len()).find(idle) {
            Some(i) => Err(CalibrateError::NoInfluence { parameter: fit.specs[i].kind.to_string() }),
            None => Ok(()),
        }
    }
}

/// The step, shortened so that no logarithm moves too far at once.
fn limited(fit: &Fit, step: DVector<f64>) -> DVector<f64> {
    let logarithms = fit.specs.iter().zip(step.iter()).filter(|(spec, _)| spec.kind.is_positive());
    let longest = logarithms.map(|(_, step)| step.abs()).fold(0.0, f64::max);
    step * (LONGEST_STEP / longest).min(1.0)
}

/// Coordinates after a step, within their bounds.
fn moved(fit: &Fit, z: &[f64], step: &DVector<f64>) -> Vec<f64> {
    let bounded = |((spec, z), step): ((&super::ParameterSpec, &f64), &f64)| {
        let (low, high) = spec.bounds_coordinate();
        (z + step).clamp(low, high)
    };
    fit.specs.iter().zip(z).zip(step.iter()).map(bounded).collect()
}

impl Normal {
    fn new(fit: &Fit, here: &Solution) -> Self {
        let (z, jacobian) = (&here.z, &here.jacobian);
        let mut matrix = jacobian.tr_mul(jacobian);
        let mut rhs = jacobian.tr_mul(&DVector::from_column_slice(&here.evaluation.residuals));
        for (i, spec) in fit.specs.iter().enumerate() {
            if let Some((mean, sd)) = spec.prior_coordinate() {
                matrix[(i, i)] += 1.0 / (sd * sd);
                rhs[i] -= (z[i] - mean) / (sd * sd);
            }
        }
        let scale = DVector::from_fn(z.len(), |i, _| usual_width(fit, i).powi(-2));
        let mut normal = Self { matrix, rhs, scale, held: here.held.clone() };
        for (i, (spec, &z)) in fit.specs.iter().zip(z).enumerate() {
            let (low, high) = spec.bounds_coordinate();
            let outward = (z <= low && normal.rhs[i] < 0.0) || (z >= high && normal.rhs[i] > 0.0);
            if normal.held[i] || outward {
                normal.hold(i);
            }
        }
        normal
    }

    /// Take a coordinate out of the equations.
    fn hold(&mut self, i: usize) {
        let diagonal = self.matrix[(i, i)];
        self.matrix.row_mut(i).fill(0.0);
        self.matrix.column_mut(i).fill(0.0);
        self.matrix[(i, i)] = if diagonal > 0.0 { diagonal } else { 1.0 };
        self.rhs[i] = 0.0;
        self.held[i] = true;
    }

    fn without_held(&self, mut rhs: DVector<f64>) -> DVector<f64> {
        for (value, _) in rhs.iter_mut().zip(&self.held).filter(|(_, held)| **held) {
            *value = 0.0;
        }
        rhs
    }

    /// Distance to the minimum in standard deviations, `sqrt(g^T A^-1 g)`; infinite if `A` is singular.
    fn distance(&self) -> f64 {
        solve(&self.matrix, &self.rhs).map_or(f64::INFINITY, |step| self.rhs.dot(&step).max(0.0).sqrt())
    }
}
