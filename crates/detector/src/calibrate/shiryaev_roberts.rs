//! Run length of the Shiryaev-Roberts procedure, exactly.
//!
//! In `l = ln R`, from `u = ln(1 + R)`: `a(u) = 1 + int_{l < ln A} a(ln(1 + e^l)) f(l - u) dl`, `f` the normal density of the
//! log-likelihood ratio, mean `delta (mu - delta/2)`, standard deviation `delta`.
//!
//! Assumes independent normal samples of unit variance. From `E R_T = E T` without a change the run length is at
//! least `A`.
//!
//! Source: G. V. Moustakides, A. S. Polunchenko and A. G. Tartakovsky, Statistica Sinica 21 (2011) 571.
use serde::{Deserialize, Serialize};

use super::normal_density;
use super::quadrature::{RunLength, enough_nodes, gauss_legendre, one_sample};
use super::solve::threshold_for;
use crate::DetectorError;
use crate::statistic::softplus;

/// How many standard deviations of a log-likelihood ratio below its mean are followed.
const DEEPEST: f64 = 9.0;

/// A Shiryaev-Roberts procedure with its threshold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShiryaevRobertsChart {
    /// Step it looks for, standard deviations.
    pub shift: f64,
    /// Threshold of the statistic, `ln A`.
    pub log_threshold: f64,
}

impl ShiryaevRobertsChart {
    /// The chart with so many samples between false alarms on average.
    ///
    /// # Errors
    /// The shift is zero or not finite, or the run length out of reach.
    pub fn for_arl(shift: f64, arl: f64) -> Result<Self, DetectorError> {
        if shift == 0.0 || !shift.is_finite() {
            let bound = "finite, not zero";
            return Err(DetectorError::Setting { setting: "shift", value: shift, bound });
        }
        let chart = |log_threshold: f64| Self { shift, log_threshold };
        // ARL >= A: the logarithm of the wished run length is a threshold high enough.
        let highest = arl.max(1.0).ln() + 0.1;
        let lowest = (-6.0 * shift.abs()).min(highest - 1.0);
        let log_threshold = threshold_for(arl, lowest, highest, |level| chart(level).arl(0.0))?;
        Ok(chart(log_threshold))
    }

    /// Mean number of samples to an alarm when all have the mean `mean`, in standard deviations.
    pub fn arl(&self, mean: f64) -> f64 {
        let (sd, drift) = (self.shift.abs(), self.shift * (mean - 0.5 * self.shift));
        let lowest = drift - DEEPEST * sd;
        if self.log_threshold <= lowest {
            return 1.0;
        }
        let nodes = gauss_legendre(enough_nodes(self.log_threshold - lowest, sd), lowest, self.log_threshold);
        // Both arguments are values of ln R; the start is the value that has ln(1 + R) = 0.
        let kernel = |l: f64, y: f64| normal_density((y - softplus(l) - drift) / sd) / sd;
        RunLength::solve(nodes, kernel, (f64::NEG_INFINITY, |_| 0.0), one_sample)
            .starting_at(f64::NEG_INFINITY)
    }
}
