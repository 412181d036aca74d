//! From the unconstrained optimum to the constrained, robust one: rows and readings join a small program as they are
//! found violated (outlying), until none is.
//!
//! This is exact. Rows that do not join are satisfied, so the optimum over those that did is the optimum over all;
//! and every round adds at least one.
use nalgebra::DVector;

use super::asked::Asked;
use super::constraint::{Constraint, Spot};
use super::interval::Interval;
use super::outcome::{FallbackReason, HorizonStatus};
use super::settings::Loss;
use super::sweep::Sweep;
use super::window::Path;

/// The linearised window with its factorisation.
pub(super) struct Question<'a> {
    pub sweep: &'a Sweep,
    pub intervals: &'a [Interval],
    /// The trajectory of linearisation.
    pub path: &'a Path,
    pub constraints: &'a [Constraint],
    pub loss: Loss,
    /// Posterior standard deviations of the newest state: the scale of what counts as fixed.
    pub spread: &'a [f64],
}

/// The step to the optimum.
#[derive(Clone, Debug)]
pub(super) struct Resolution {
    /// Changes of the states; noises absolute.
    pub step: Path,
    pub active: Vec<Active>,
    pub status: HorizonStatus,
    pub qp_solves: usize,
    pub qp_iterations: usize,
}

/// A row that holds with equality.
#[derive(Clone, Copy, Debug)]
pub(super) struct Active {
    pub spot: Spot,
    /// Decrease of the cost per unit of the bound.
    pub multiplier: f64,
}

impl Question<'_> {
    /// Solve; `likely` names rows that were active before.
    pub fn resolve(&self, likely: &[Spot]) -> Resolution {
        let base = self.sweep.run(None);
        match self.constrained(&base, likely) {
            Ok(resolution) => resolution,
            Err(reason) => self.without_constraints(&base, reason),
        }
    }

    /// What is left when the constraints cannot be met: the robust optimum, or at worst the weighted one.
    fn without_constraints(&self, base: &Path, reason: FallbackReason) -> Resolution {
        let free = Question { constraints: &[], ..*self };
        let robust = free.constrained(base, &[]);
        let resolution = robust.unwrap_or_else(|_| Resolution::unconstrained(base.clone()));
        Resolution { status: HorizonStatus::Fallback(reason), ..resolution }
    }

    fn constrained(&self, base: &Path, likely: &[Spot]) -> Result<Resolution, FallbackReason> {
        let mut asked = Asked::new(self, base);
        let mut resolution = Resolution::unconstrained(base.clone());
        while asked.extend(&resolution.step, likely)? {
            asked.solve(&mut resolution)?;
        }
        Ok(resolution)
    }

    /// State `i` after the change in `step`.
    pub fn state(&self, step: &Path, i: usize) -> DVector<f64> {
        &self.path.x[i] + &step.x[i]
    }
}

impl Resolution {
    fn unconstrained(step: Path) -> Self {
        Self {
            step,
            active: Vec::new(),
            status: HorizonStatus::Unconstrained,
            qp_solves: 0,
            qp_iterations: 0,
        }
    }
}
