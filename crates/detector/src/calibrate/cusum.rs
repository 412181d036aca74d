//! Run length of the cumulative sum, exactly.
//!
//! From the sum `s`: `a(s) = 1 + a(0) Phi(k - mu - s) + int_0^h a(y) phi(y - s + k - mu) dy` for samples `N(mu, 1)`.
//! Two-sided with a head start `u` on both sides, sums of which only one can be positive for long:
//! `a = [a+(u) a-(0) + a+(0) a-(u) - a+(0) a-(0)]/[a+(0) + a-(0)]`, which without a head start is
//! `1/a = 1/a+(0) + 1/a-(0)`.
//!
//! Assumes independent normal samples of unit variance.
//!
//! Source: E. S. Page, Biometrika 41 (1954) 100; J. M. Lucas and R. B. Crosier, Technometrics 24 (1982) 199, the
//! two-sided formula in their appendix.
use serde::{Deserialize, Serialize};

use super::quadrature::{RunLength, enough_nodes, gauss_legendre, one_sample};
use super::solve::threshold_for;
use super::{normal_density, normal_probability};
use crate::DetectorError;

/// Against an increase only, or against either change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sides {
    /// One sum.
    One,
    /// Two sums.
    Two,
}

/// A cumulative sum with its threshold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CusumChart {
    /// Reference value `k`, standard deviations.
    pub reference: f64,
    /// Threshold `h`, standard deviations.
    pub threshold: f64,
    /// Head start as a share of the threshold: 0, or 0.5 for fast initial response.
    pub head_start: f64,
    /// One or two sums.
    pub sides: Sides,
}

impl CusumChart {
    /// The chart with so many samples between false alarms on average, the first one from the head start.
    ///
    /// # Errors
    /// `arl` is not above that of a zero threshold, or too large to be solved for (some 1e13).
    ///
    /// # Validity
    /// `reference` above 0.05: below, the domain of the integral equation becomes long.
    pub fn for_arl(reference: f64, head_start: f64, sides: Sides, arl: f64) -> Result<Self, DetectorError> {
        if !(reference > 0.0 && reference.is_finite()) {
            let bound = "positive and finite";
            return Err(DetectorError::Setting { setting: "reference", value: reference, bound });
        }
        if !(0.0..1.0).contains(&head_start) {
            let bound = "at least 0, below 1";
            return Err(DetectorError::Setting { setting: "head_start", value: head_start, bound });
        }
        let chart = |threshold: f64| Self { reference, threshold, head_start, sides };
        let highest = 16.0 / reference.min(1.0) + 4.0;
        let threshold = threshold_for(arl, 1e-9, highest, |threshold| chart(threshold).arl(0.0))?;
        Ok(chart(threshold))
    }

    /// Mean number of samples to an alarm when all have the mean `mean`, in standard deviations.
    pub fn arl(&self, mean: f64) -> f64 {
        match self.sides {
            Sides::One => self.one_sided(mean).1,
            Sides::Two => {
                let ((zero_up, up), (zero_down, down)) = (self.one_sided(mean), self.one_sided(-mean));
                // Divided through by the product of both, which may overflow.
                (up / zero_up + down / zero_down - 1.0) / (1.0 / zero_up + 1.0 / zero_down)
            }
        }
    }

    /// Mean run length of one sum from zero and from the head start.
    fn one_sided(&self, mean: f64) -> (f64, f64) {
        let drift = mean - self.reference;
        let nodes = gauss_legendre(enough_nodes(self.threshold, 1.0), 0.0, self.threshold);
        let kernel = |s: f64, y: f64| normal_density(y - s - drift);
        let run = RunLength::solve(nodes, kernel, (0.0, |s| normal_probability(-s - drift)), one_sample);
        (run.starting_at(0.0), run.starting_at(self.head_start * self.threshold))
    }
}
