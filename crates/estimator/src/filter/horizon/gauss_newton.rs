//! The Gauss-Newton iteration of one sample: linearise, solve, shorten the step where it does not help.
//!
//! States and noises are unknowns together, so a trajectory need not obey the dynamics before the iteration has
//! converged, and linear constraints hold after every full step.
use nalgebra::DMatrix;

use super::constraint::{Constraint, StageRow};
use super::merit::{Merit, linear_cost};
use super::outcome::{HorizonError, HorizonStatus};
use super::problem::{Resolution, WindowProblem};
use super::settings::{HorizonSettings, Loss};
use super::sweep::Sweep;
use super::window::{Window, WindowTrajectory};
use crate::filter::StateSpace;

/// Least share of a full step that is tried.
const SHORTEST: f64 = 1.0 / 64.0;
/// Share of the predicted decrease that a step must reach.
const SUFFICIENT_DECREASE: f64 = 1e-4;
/// Relative rounding error of a cost.
const ROUNDING: f64 = 1e-12;

/// What the iterations of one sample end with; the trajectory is in the window.
#[derive(Clone, Debug)]
pub(super) struct Iterated {
    /// Of the last iteration.
    pub resolution: Resolution,
    /// Cost of the last step.
    pub cost: f64,
    pub converged: bool,
    pub iterations: usize,
    /// Over all iterations.
    pub qp_solves: usize,
    /// Over all iterations.
    pub qp_iterations: usize,
}

/// The iteration's fixed parts.
pub(super) struct GaussNewton<'a> {
    pub constraints: &'a [Constraint],
    pub settings: &'a HorizonSettings,
}

/// A step in the linearised problem, with what judges it.
struct Proposed {
    resolution: Resolution,
    merit: Merit,
    /// Merit before the step.
    current: f64,
    /// Merit after the full step if the problem were linear.
    predicted: f64,
}

/// Where a line search ends.
struct Searched {
    path: WindowTrajectory,
    full: bool,
    /// Merit there, if it is sufficiently lower.
    merit: Option<f64>,
}

impl GaussNewton<'_> {
    /// Iterate until steps no longer matter; `likely` names rows that were active before.
    pub(super) fn iterate<M: StateSpace>(
        &self,
        model: &mut M,
        window: &mut Window,
        sweep: &mut Sweep,
        likely: &[StageRow],
    ) -> Result<Iterated, HorizonError<M::Error>> {
        let mut likely = likely.to_vec();
        let (mut qp_solves, mut qp_iterations) = (0, 0);
        for iterations in 1.. {
            window.linearise(model, self.settings.loss)?;
            let proposed = self.propose(window, sweep, &likely);
            qp_solves += proposed.resolution.qp_solves;
            qp_iterations += proposed.resolution.qp_iterations;
            let searched = self.search(model, window, &proposed);
            let converged = self.has_converged(&proposed, &searched);
            let last = converged || searched.merit.is_none() || iterations == self.settings.iterations_max;
            window.path = searched.path;
            let Proposed { resolution, predicted: cost, .. } = proposed;
            if last {
                return Ok(Iterated { resolution, cost, converged, iterations, qp_solves, qp_iterations });
            }
            likely = resolution.active.iter().map(|a| a.spot).collect();
        }
        unreachable!("the loop ends at the last iteration")
    }

    fn propose(&self, window: &Window, sweep: &mut Sweep, likely: &[StageRow]) -> Proposed {
        let Window { arrival, intervals, path } = window;
        sweep.factorise(intervals, path, &arrival.mean, &arrival.root);
        let spread = spread(&sweep.newest_covariance());
        let (constraints, loss) = (self.constraints, self.settings.loss);
        let problem = WindowProblem { sweep, intervals, path, constraints, loss, spread: &spread };
        let resolution = problem.resolve(likely);
        let merit = Merit::of(&problem, &resolution);
        let current = merit.current(window, &problem);
        let predicted = linear_cost(&problem, &resolution.step);
        Proposed { resolution, merit, current, predicted }
    }

    /// The longest tried share of the step that lowers the merit. If none does, the full step: a filter's estimate is
    /// no more than that; and if the process refuses it, the longest share that it takes.
    fn search<M: StateSpace>(&self, model: &mut M, window: &Window, proposed: &Proposed) -> Searched {
        let mut possible = None;
        let mut alpha = 1.0;
        while alpha >= SHORTEST {
            let path = window.path.towards(&proposed.resolution.step, alpha);
            let against = (self.constraints, self.settings.loss);
            if let Ok(merit) = proposed.merit.trial(model, window, &path, against) {
                let decrease = SUFFICIENT_DECREASE * alpha * (proposed.current - proposed.predicted);
                if merit <= proposed.current - decrease + ROUNDING * proposed.current {
                    return self.keep_inside(window, proposed, path, alpha, merit);
                }
                possible.get_or_insert(path);
            }
            alpha *= 0.5;
        }
        let path = possible.unwrap_or_else(|| window.path.clone());
        Searched { path, full: false, merit: None }
    }

    /// A shortened step may end outside the constraints; the full one ends inside and is then preferred.
    fn keep_inside(
        &self,
        window: &Window,
        proposed: &Proposed,
        path: WindowTrajectory,
        alpha: f64,
        merit: f64,
    ) -> Searched {
        let full = alpha == 1.0;
        let met = !matches!(proposed.resolution.status, HorizonStatus::Fallback(_));
        if !full && met && window.ends_outside(self.constraints, &path) {
            let path = window.path.towards(&proposed.resolution.step, 1.0);
            return Searched { path, full, merit: Some(merit) };
        }
        Searched { path, full, merit: Some(merit) }
    }

    /// Whether the step was small, or the problem proved linear over it. The decrease of a step of `d` posterior
    /// standard deviations is `d^2 / 2`.
    fn has_converged(&self, proposed: &Proposed, searched: &Searched) -> bool {
        let negligible = 0.5 * self.settings.tolerance.powi(2) + ROUNDING * proposed.current;
        let small = proposed.current - proposed.predicted <= negligible;
        let error = searched.merit.map(|merit| (merit - proposed.predicted).abs());
        small || (searched.full && error.is_some_and(|error| error <= negligible))
    }
}

/// Posterior covariance weighs readings as the loss does at the final trajectory.
pub(super) fn weigh_readings(window: &mut Window, resolution: &Resolution, loss: Loss) -> bool {
    if loss == Loss::Quadratic {
        return false;
    }
    for (i, interval) in window.intervals.iter_mut().enumerate() {
        for j in 0..interval.readings.len() {
            let residual = interval.residual_after(&interval.readings[j], &resolution.step.x[i + 1]);
            interval.readings[j].weight = loss.weight(residual);
        }
    }
    true
}

fn spread(covariance: &DMatrix<f64>) -> Vec<f64> {
    covariance.diagonal().iter().map(|v| v.sqrt()).collect()
}
