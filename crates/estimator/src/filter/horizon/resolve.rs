//! From the unconstrained optimum to the constrained, robust one: rows and readings join a small program as they are
//! found violated (outlying), until none is.
//!
//! This is exact. Rows that do not join are satisfied, so the optimum over those that did is the optimum over all;
//! and every round adds at least one.
use nalgebra::DVector;

use super::active_set::ActiveSet;
use super::constraint::StageRow;
use super::outcome::{FallbackReason, HorizonStatus};
use super::problem::{Resolution, WindowProblem};
use super::window::WindowTrajectory;

impl WindowProblem<'_> {
    /// Solve; `likely` names rows that were active before.
    pub(super) fn resolve(&self, likely: &[StageRow]) -> Resolution {
        let base = self.sweep.run(None);
        match self.constrained(&base, likely) {
            Ok(resolution) => resolution,
            Err(reason) => self.without_constraints(&base, reason),
        }
    }

    /// What is left when the constraints cannot be met: the robust optimum, or at worst the weighted one.
    fn without_constraints(&self, base: &WindowTrajectory, reason: FallbackReason) -> Resolution {
        let free = WindowProblem { constraints: &[], ..*self };
        let robust = free.constrained(base, &[]);
        let resolution = robust.unwrap_or_else(|_| Resolution::unconstrained(base.clone()));
        Resolution { status: HorizonStatus::Fallback(reason), ..resolution }
    }

    fn constrained(
        &self,
        base: &WindowTrajectory,
        likely: &[StageRow],
    ) -> Result<Resolution, FallbackReason> {
        let mut active_set = ActiveSet::new(self, base);
        let mut resolution = Resolution::unconstrained(base.clone());
        while active_set.extend(&resolution.step, likely)? {
            active_set.solve(&mut resolution)?;
        }
        Ok(resolution)
    }

    /// State `i` after the change in `step`.
    pub(super) fn state(&self, step: &WindowTrajectory, i: usize) -> DVector<f64> {
        &self.path.x[i] + &step.x[i]
    }
}

impl Resolution {
    fn unconstrained(step: WindowTrajectory) -> Self {
        Self {
            step,
            active: Vec::new(),
            status: HorizonStatus::Unconstrained,
            qp_solves: 0,
            qp_iterations: 0,
        }
    }
}
