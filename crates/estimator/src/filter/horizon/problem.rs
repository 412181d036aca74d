//! The problem of a linearised window, and the step that solves it.
use super::constraint::{Constraint, StageRow};
use super::interval::Interval;
use super::outcome::HorizonStatus;
use super::settings::Loss;
use super::sweep::Sweep;
use super::window::WindowTrajectory;

/// The linearised window with its factorisation.
pub(super) struct WindowProblem<'a> {
    pub sweep: &'a Sweep,
    pub intervals: &'a [Interval],
    /// The trajectory of linearisation.
    pub path: &'a WindowTrajectory,
    pub constraints: &'a [Constraint],
    pub loss: Loss,
    /// Posterior standard deviations of the newest state: the scale of what counts as fixed.
    pub spread: &'a [f64],
}

/// The step to the optimum.
#[derive(Clone, Debug)]
pub(super) struct Resolution {
    /// Changes of the states; noises absolute.
    pub step: WindowTrajectory,
    pub active: Vec<Active>,
    pub status: HorizonStatus,
    pub qp_solves: usize,
    pub qp_iterations: usize,
}

/// A row that holds with equality.
#[derive(Clone, Copy, Debug)]
pub(super) struct Active {
    pub spot: StageRow,
    /// Decrease of the cost per unit of the bound.
    pub multiplier: f64,
}
