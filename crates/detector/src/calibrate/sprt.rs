//! Errors and sample numbers of the sequential probability ratio test, exactly.
//!
//! From the sum `s` between the bounds, one more sample adds `N(m, delta^2)`, `m = delta (mu - delta/2)`. The probability of an
//! end above, `p(s) = P(s + llr >= a) + int p(y) f(y - s) dy`, and the mean number of samples, `n(s) = 1 + int n(y) f(y - s) dy`, are
//! solved like run lengths. The bounds for given errors start from Wald's, `ln((1 - beta)/alpha)` and
//! `ln((1 - alpha)/beta)`, less the mean overshoot `0.583 |delta|`, and are corrected by the logarithm of achieved over wished.
//!
//! Assumes independent normal samples of unit variance.
//!
//! Source: A. Wald, Ann. Math. Stat. 16 (1945) 117; D. Siegmund, Sequential Analysis, 1985; the integral
//! equations: K. W. Kemp, J. R. Stat. Soc. B 20 (1958) 379.
use serde::{Deserialize, Serialize};

use super::approximation::MEAN_OVERSHOOT;
use super::quadrature::{RunLength, enough_nodes, gauss_legendre, one_sample};
use super::{normal_density, normal_probability};
use crate::DetectorError;

/// Relative error of the error probabilities at the bounds found.
const TOLERANCE: f64 = 1e-9;

/// Bounds of the log-likelihood ratio.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SprtBounds {
    /// Step that is tested for, standard deviations.
    pub shift: f64,
    /// A step is claimed at `upper`.
    pub upper: f64,
    /// No step is claimed at `-lower`.
    pub lower: f64,
}

/// What a test does for a given mean.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SprtCharacteristics {
    /// Probability that a step is claimed.
    pub probability_of_change: f64,
    /// Mean number of samples.
    pub mean_samples: f64,
}

/// Bounds for the error probabilities `alpha` (step claimed without one) and `beta` (step missed).
///
/// # Errors
/// An error probability is not between 0 and 0.5, the shift zero, or so large that one sample has smaller errors.
pub fn sprt_bounds(shift: f64, alpha: f64, beta: f64) -> Result<SprtBounds, DetectorError> {
    for (setting, value) in [("alpha", alpha), ("beta", beta)] {
        if !(value > 0.0 && value < 0.5) {
            return Err(DetectorError::Setting { setting, value, bound: "between 0 and 0.5" });
        }
    }
    let bound = "not zero, and so small that one sample does not decide better than asked for";
    let wrong = || DetectorError::Setting { setting: "shift", value: shift, bound };
    if shift == 0.0 || !shift.is_finite() {
        return Err(wrong());
    }
    let overshoot = MEAN_OVERSHOOT * shift.abs();
    let upper = ((1.0 - beta) / alpha).ln() - overshoot;
    let mut bounds = SprtBounds { shift, upper, lower: ((1.0 - alpha) / beta).ln() - overshoot };
    for _ in 0..60 {
        if !(bounds.upper > 0.0 && bounds.lower > 0.0) {
            return Err(wrong());
        }
        let claimed = bounds.characteristics(0.0).probability_of_change;
        let missed = 1.0 - bounds.characteristics(shift).probability_of_change;
        let (off_upper, off_lower) = ((claimed / alpha).ln(), (missed / beta).ln());
        if off_upper.abs().max(off_lower.abs()) < TOLERANCE {
            return Ok(bounds);
        }
        bounds.upper += off_upper;
        bounds.lower += off_lower;
    }
    Err(wrong())
}

impl SprtBounds {
    /// What the test does when the samples have the mean `mean`, in standard deviations.
    pub fn characteristics(&self, mean: f64) -> SprtCharacteristics {
        let (sd, drift) = (self.shift.abs(), self.shift * (mean - 0.5 * self.shift));
        let nodes = gauss_legendre(enough_nodes(self.upper + self.lower, sd), -self.lower, self.upper);
        let kernel = |s: f64, y: f64| normal_density((y - s - drift) / sd) / sd;
        let above = |s: f64| normal_probability((s + drift - self.upper) / sd);
        let atom = (0.0, |_: f64| 0.0);
        SprtCharacteristics {
            probability_of_change: RunLength::solve(nodes.clone(), kernel, atom, above).starting_at(0.0),
            mean_samples: RunLength::solve(nodes, kernel, atom, one_sample).starting_at(0.0),
        }
    }
}
