//! Normalised innovations squared over time.
use super::{Band, Finding, Significance};
use crate::filter::{Innovation, Outcome};

/// Sum of `nu^2/S` over the readings of a run, before the gate: a gate cuts the tail and makes every filter look right.
///
/// The degrees of freedom are the scalar readings. Accepted readings are summed beside, for logs with faulty sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NisAccumulator {
    sum: f64,
    dof: u64,
    accepted_sum: f64,
    accepted_dof: u64,
}

impl NisAccumulator {
    /// Add an innovation `nu` with its variance `s`; one that is not finite was none.
    pub fn add(&mut self, nu: f64, s: f64, accepted: bool) {
        let squared = nu * nu / s;
        if !squared.is_finite() || s <= 0.0 {
            return;
        }
        self.sum += squared;
        self.dof += 1;
        if accepted {
            self.accepted_sum += squared;
            self.accepted_dof += 1;
        }
    }

    /// Add the innovations of a sample of a filter or of the observer.
    pub fn add_innovations(&mut self, innovations: &[Innovation]) {
        for innovation in innovations {
            self.add(innovation.nu, innovation.s, innovation.outcome == Outcome::Accepted);
        }
    }

    /// Add another run, or another part of the same.
    pub fn merge(&mut self, other: &Self) {
        self.sum += other.sum;
        self.dof += other.dof;
        self.accepted_sum += other.accepted_sum;
        self.accepted_dof += other.accepted_dof;
    }

    /// Degrees of freedom: number of readings.
    pub(crate) fn dof(&self) -> u64 {
        self.dof
    }

    /// Readings that the gate did not pass.
    pub(crate) fn refused(&self) -> u64 {
        self.dof - self.accepted_dof
    }

    /// Mean of `nu^2/S`, 1 for a correct filter; NaN without readings.
    pub fn mean(&self) -> f64 {
        self.sum / self.dof as f64
    }

    /// The same of the accepted readings alone, a little below 1 for a correct filter.
    pub(crate) fn mean_accepted(&self) -> f64 {
        self.accepted_sum / self.accepted_dof as f64
    }

    /// Band of the mean; `None` without readings.
    pub fn band(&self, significance: Significance) -> Option<Band> {
        Band::of_mean_square(self.dof, significance)
    }

    /// What the mean says of the stated covariances.
    pub fn finding(&self, significance: Significance) -> Finding {
        self.band(significance).map_or(Finding::TooFew, |band| Finding::of_mean_square(self.mean(), band))
    }
}
