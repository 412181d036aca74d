//! Whether a Gauss-Newton step helps: the exact penalty function of the nonlinear problem.
//!
//! `phi = cost + sum pi |defect| + sum pi_a max(0, a^T x - b)` has the constrained optimum as its minimum once the
//! weights `pi` exceed the multipliers of the dynamics and of the constraints (Nocedal and Wright 2006, section 18.3).
//! The dynamics' multipliers follow from the step by the adjoint recursion
//! `p_i = F_i^T p_{i+1} - sum psi(r_ij) a_ij + sum lambda c`.
use nalgebra::{DMatrix, DVector};

use super::constraint::{Constraint, Span};
use super::interval::Interval;
use super::outcome::HorizonError;
use super::problem::{Active, Resolution, WindowProblem};
use super::settings::Loss;
use super::window::{Window, WindowTrajectory};
use crate::filter::StateSpace;

/// Weights of the penalties.
#[derive(Clone, Debug)]
pub(super) struct Merit {
    /// Of the dynamics' defects, one per state: (n).
    weights: DVector<f64>,
    /// Of the active constraints.
    active: Vec<Active>,
}

/// By how much the weights exceed the multipliers of the step.
const MARGIN: f64 = 2.0;

impl Merit {
    /// Weights for the step that answers `problem`.
    pub(super) fn of(problem: &WindowProblem, resolution: &Resolution) -> Self {
        let multipliers = adjoints(problem, resolution);
        let mut weights = DVector::zeros(problem.path.newest().len());
        for p in &multipliers {
            weights.zip_apply(p, |d: &mut f64, p: f64| *d = d.max(MARGIN * p.abs()));
        }
        let active = resolution.active.iter().map(|a| Active { multiplier: MARGIN * a.multiplier, ..*a });
        Self { weights, active: active.collect() }
    }

    /// `phi` of the trajectory of linearisation.
    pub(super) fn current(&self, window: &Window, problem: &WindowProblem) -> f64 {
        let path = &window.path;
        let mut phi = noise_cost(path) + self.outside(window, path, problem.constraints);
        for (i, interval) in window.intervals.iter().enumerate() {
            phi += self.defect(interval, interval.advanced.clone(), path, i);
            phi += interval.readings.iter().map(|r| problem.loss.value(r.residual)).sum::<f64>();
        }
        phi
    }

    /// `phi` of another trajectory, with noise variances and noise inputs as linearised.
    ///
    /// # Errors
    /// The process or an output has no value on it.
    pub(super) fn trial<M: StateSpace>(
        &self,
        model: &mut M,
        window: &Window,
        path: &WindowTrajectory,
        (constraints, loss): (&[Constraint], Loss),
    ) -> Result<f64, HorizonError<M::Error>> {
        let mut phi = noise_cost(path) + self.outside(window, path, constraints);
        for (i, interval) in window.intervals.iter().enumerate() {
            let mut next = path.x[i].clone();
            interval.advance(model, next.as_mut_slice())?;
            phi += self.defect(interval, next, path, i);
            phi += interval.reading_cost(model, &path.x[i + 1], loss)?;
        }
        if phi.is_finite() { Ok(phi) } else { Err(HorizonError::NotFinite) }
    }

    /// Penalty of the initial state's defect and of the active constraints.
    fn outside(&self, window: &Window, path: &WindowTrajectory, constraints: &[Constraint]) -> f64 {
        let start = &window.arrival.mean + &window.arrival.root * &path.xi - &path.x[0];
        let excess = |active: &Active| {
            let stage = active.spot.stage;
            let previous = path.x[stage.saturating_sub(1)].as_slice();
            constraints[active.spot.row].excess(previous, path.x[stage].as_slice())
        };
        let rows = self.active.iter().map(|a| a.multiplier * excess(a).max(0.0));
        self.penalty(&start) + rows.sum::<f64>()
    }

    /// Penalty of the defect at the end of interval `i`, over which the state alone moves to `advanced`.
    fn defect(
        &self,
        interval: &Interval,
        mut advanced: DVector<f64>,
        path: &WindowTrajectory,
        i: usize,
    ) -> f64 {
        interval.add_noise(&path.omega[i], &mut advanced);
        self.penalty(&(advanced - &path.x[i + 1]))
    }

    fn penalty(&self, defect: &DVector<f64>) -> f64 {
        defect.iter().zip(&self.weights).map(|(d, w)| d.abs() * w).sum()
    }
}

/// Cost of the step in the linearised problem, where it leaves no defect.
pub(super) fn linear_cost(problem: &WindowProblem, step: &WindowTrajectory) -> f64 {
    let mut cost = noise_cost(step);
    for (interval, delta) in problem.intervals.iter().zip(&step.x[1..]) {
        for reading in &interval.readings {
            cost += problem.loss.value(interval.residual_after(reading, delta));
        }
    }
    cost
}

fn noise_cost(path: &WindowTrajectory) -> f64 {
    0.5 * (path.xi.norm_squared() + path.omega.iter().map(|w| w.norm_squared()).sum::<f64>())
}

/// Multipliers `p_0 ... p_N` of the dynamics at the step: derivative of the cost from state `i` on with that state.
pub(super) fn adjoints(problem: &WindowProblem, resolution: &Resolution) -> Vec<DVector<f64>> {
    let n = problem.path.newest().len();
    let mut p = vec![DVector::zeros(n); problem.intervals.len() + 1];
    for active in &resolution.active {
        let constraint = &problem.constraints[active.spot.row];
        for &(k, a) in constraint.terms() {
            p[active.spot.stage][k] += active.multiplier * a;
            if constraint.span() == Span::Step {
                p[active.spot.stage - 1][k] -= active.multiplier * a;
            }
        }
    }
    for (i, interval) in problem.intervals.iter().enumerate().rev() {
        let (before, after) = p.split_at_mut(i + 1);
        for reading in &interval.readings {
            let r = interval.residual_after(reading, &resolution.step.x[i + 1]);
            after[0].axpy(-problem.loss.slope(r), &interval.gradient.column(reading.output), 1.0);
        }
        pull_back(&interval.linear.phi, &after[0], &mut before[i]);
    }
    p
}

/// `p <- p + F^T q` with `F = [phi; 0 I]`.
fn pull_back(phi: &DMatrix<f64>, q: &DVector<f64>, p: &mut DVector<f64>) {
    let (leading, n) = phi.shape();
    p.gemv_tr(1.0, phi, &q.rows(0, leading), 1.0);
    for k in leading..n {
        p[k] += q[k];
    }
}
