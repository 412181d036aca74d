//! Gate of each output: a reading too far from its prediction is not used.
//!
//! A reading passes if `nu^2/S` is below the quantile of chi-square with one degree of freedom. After so many
//! rejections in a row the filter is taken to be wrong, not the sensor: the next reading is accepted, and the
//! covariance grows along `P h` just so far that the reading passes (`S = nu^2 / quantile`).
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::EstimatorError;

/// When a reading is not used, and when it is used in spite of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GateSettings {
    /// Probability that a reading of a correct filter passes.
    pub probability: f64,
    /// Rejections in a row of one output, after which its next reading is accepted.
    pub reacquire_after: usize,
}

impl Default for GateSettings {
    fn default() -> Self {
        Self { probability: 0.9999, reacquire_after: 10 }
    }
}

impl GateSettings {
    /// Largest `nu^2/S` that passes.
    ///
    /// # Errors
    /// The probability is not between 0 and 1.
    pub fn limit(&self) -> Result<f64, EstimatorError> {
        if !(self.probability > 0.0 && self.probability < 1.0) {
            return Err(EstimatorError::GateProbability { probability: self.probability });
        }
        let chi_square = ChiSquared::new(1.0).expect("one degree of freedom is a valid number of them");
        Ok(chi_square.inverse_cdf(self.probability))
    }
}

/// What became of a reading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Outcome {
    /// There was none (NaN or infinite).
    #[default]
    Missing,
    /// Used.
    Accepted,
    /// Beyond the gate, not used.
    Rejected,
    /// Beyond the gate, used after too many rejections in a row; the covariance was inflated.
    Reacquired,
}

impl Outcome {
    /// Whether the reading has changed the estimate.
    pub fn is_used(self) -> bool {
        matches!(self, Self::Accepted | Self::Reacquired)
    }
}

/// History of one output at the gate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GateCount {
    /// Rejections in a row up to now; missing readings do not end a row.
    pub in_row: usize,
    /// Rejections so far.
    pub rejected: usize,
    /// Re-acquisitions so far.
    pub reacquired: usize,
}

/// The gate of a filter with its quantile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gate {
    /// Largest `nu^2/S` that passes.
    pub limit: f64,
    reacquire_after: usize,
}

impl Gate {
    /// A gate that everything passes, or that of the settings.
    pub fn try_new(settings: Option<GateSettings>) -> Result<Self, EstimatorError> {
        match settings {
            None => Ok(Self { limit: f64::INFINITY, reacquire_after: 0 }),
            Some(settings) => {
                Ok(Self { limit: settings.limit()?, reacquire_after: settings.reacquire_after })
            }
        }
    }

    /// Judge a reading by its normalised squared innovation and count the judgement.
    pub fn judge(&self, squared: f64, count: &mut GateCount) -> Outcome {
        if squared <= self.limit {
            count.in_row = 0;
            Outcome::Accepted
        } else if count.in_row >= self.reacquire_after {
            count.in_row = 0;
            count.reacquired += 1;
            Outcome::Reacquired
        } else {
            count.in_row += 1;
            count.rejected += 1;
            Outcome::Rejected
        }
    }

    /// Factor `c` of the inflation `P <- P + c (P h)(P h)^T` with which an innovation `nu` of variance `s`, of which `r` is
    /// noise, passes; zero if nothing is lacking or no state is seen.
    pub fn inflation(&self, nu: f64, s: f64, r: f64) -> f64 {
        let (known, lacking) = (s - r, nu * nu / self.limit - s);
        if known > 0.0 && lacking > 0.0 { lacking / (known * known) } else { 0.0 }
    }
}
