//! Settings of the stated uncertainty of the mean gas temperature.
use serde::{Deserialize, Serialize};

use crate::EstimatorError;

/// What the stated uncertainty of the mean gas temperature leaves out of the filter's, and what it never does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BandSettings {
    /// What the filter's variance is too large by before the cylinder is learnt, as a standard deviation, K.
    pub overstated_k: f64,
    /// Error of the model that is always there, K.
    pub model_k: f64,
}

impl BandSettings {
    /// The filter's own variance: for a truth that is the observer's own model.
    pub const NONE: Self = Self { overstated_k: 0.0, model_k: 0.0 };

    pub(super) fn validate(&self) -> Result<(), EstimatorError> {
        for (setting, value) in [("band.overstated_k", self.overstated_k), ("band.model_k", self.model_k)] {
            if !(value >= 0.0 && value.is_finite()) {
                let bound = "finite and at least 0";
                return Err(EstimatorError::ObserverSetting { setting, value, bound });
            }
        }
        Ok(())
    }
}

impl Default for BandSettings {
    fn default() -> Self {
        Self { overstated_k: 0.4, model_k: 0.1 }
    }
}
