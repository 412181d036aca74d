//! What is known of mass and leak rate, and how the loss goes on.
use serde::{Deserialize, Serialize};

use super::lambert_w;
use crate::DetectorError;

/// How the mass goes on from now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum LossLaw {
    /// The leak is choked, proportional to what is left: `m(t) = m exp(-r t/m)`.
    #[default]
    Choked,
    /// The leak rate stays: `m(t) = m - r t`. Always the shorter time.
    Linear,
}

impl LossLaw {
    /// Mass now that is at the limit, kg, after a time, s, at the present leak rate, kg/s.
    pub(super) fn mass_that_reaches_kg(self, limit_kg: f64, leak_kg_s: f64, time_s: f64) -> f64 {
        let lost_kg = leak_kg_s * time_s;
        match self {
            Self::Linear => limit_kg + lost_kg,
            // m ln(m/limit) = r t.
            Self::Choked => limit_kg * libm::exp(lambert_w(lost_kg / limit_kg)),
        }
    }

    /// Time until the limit, s, of a mass and leak rate without uncertainty; infinite without a leak, 0 at the limit.
    pub(crate) fn time_s(self, mass_kg: f64, leak_kg_s: f64, limit_kg: f64) -> f64 {
        if mass_kg <= limit_kg {
            return 0.0;
        }
        if leak_kg_s <= 0.0 {
            return f64::INFINITY;
        }
        match self {
            Self::Linear => (mass_kg - limit_kg) / leak_kg_s,
            Self::Choked => mass_kg / leak_kg_s * libm::log(mass_kg / limit_kg),
        }
    }
}

/// Mass and leak rate now, jointly normal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MassAndLeak {
    /// Mean of the mass, kg.
    pub mass_kg: f64,
    /// Mean of the leak rate, kg/s; may be negative where none is seen.
    pub leak_kg_s: f64,
    /// Standard deviation of the mass, kg.
    pub mass_sd_kg: f64,
    /// Standard deviation of the leak rate, kg/s.
    pub leak_sd_kg_s: f64,
    /// Their correlation.
    pub correlation: f64,
}

impl MassAndLeak {
    /// From the mean and the covariance of (mass, kg; leak rate, kg/s).
    ///
    /// # Shapes
    /// `covariance`: (2, 2), symmetric; a variance may be zero.
    ///
    /// # Errors
    /// A mean is not finite or the mass not positive; the covariance is not symmetric and positive semidefinite.
    pub fn try_new(mass_kg: f64, leak_kg_s: f64, covariance: [[f64; 2]; 2]) -> Result<Self, DetectorError> {
        crate::error::positive("mass_kg", mass_kg)?;
        let refused = |setting, value, bound| Err(DetectorError::Setting { setting, value, bound });
        if !leak_kg_s.is_finite() {
            return refused("leak_kg_s", leak_kg_s, "finite");
        }
        let [[mass, across], [mirrored, leak]] = covariance;
        for (setting, value) in [("covariance[0][0]", mass), ("covariance[1][1]", leak)] {
            if !(value >= 0.0 && value.is_finite()) {
                return refused(setting, value, "finite and not negative");
            }
        }
        let (mass_sd_kg, leak_sd_kg_s) = (libm::sqrt(mass), libm::sqrt(leak));
        let scale = mass_sd_kg * leak_sd_kg_s;
        if !across.is_finite() || across.abs() > (1.0 + 1e-9) * scale {
            return refused("covariance[0][1]", across, "at most the product of the standard deviations");
        }
        if !mirrored.is_finite() || (across - mirrored).abs() > 1e-9 * scale {
            return refused("covariance[1][0]", mirrored, "covariance[0][1]");
        }
        let correlation = if scale > 0.0 { across / scale } else { 0.0 };
        let correlation = correlation.clamp(-1.0, 1.0);
        Ok(Self { mass_kg, leak_kg_s, mass_sd_kg, leak_sd_kg_s, correlation })
    }
}
