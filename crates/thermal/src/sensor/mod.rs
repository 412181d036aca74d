//! Sensors: what they read, where they sit, how far they may be off.
//!
//! A sensor is of a [kind](SensorKind), which has its equation; a table of a file says which, and with which errors. A number
//! that may be uncertain is a [`Parameter`]. A scenario draws the real one; an estimator takes it as its prior.
#[cfg(feature = "files")]
mod build;
mod kind;
mod parameter;
mod place;
#[cfg(feature = "files")]
mod pt100;
mod reading;
#[cfg(feature = "files")]
mod spec;
#[cfg(feature = "files")]
mod table;
mod valid;

use alloc::string::String;
use alloc::vec::Vec;
#[cfg(feature = "files")]
pub use build::mounted;
#[cfg(feature = "files")]
pub use kind::KindChoice;
pub use kind::{ELECTRONICS_REFERENCE_K, PressureReference, SensorKind};
pub use parameter::{Law, MAX_PARAMETERS, Parameter, ParameterKind};
pub use place::{GasPlace, PLACES, SurfacePlace};
#[cfg(feature = "files")]
pub use pt100::Pt100Class;
pub use reading::{Exposure, Prediction, Quantity, Site};
use serde::{Deserialize, Serialize};
#[cfg(feature = "files")]
pub use spec::SensorSpec;

/// Noise whose autocorrelation falls as `exp(-|dt| / time)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CorrelatedNoise {
    /// Standard deviation, in the unit that the sensor reads.
    pub sd: f64,
    /// Correlation time, s.
    pub time_s: f64,
}

/// A validated sensor. Readings are in K or in Pa; so is everything here that has the unit of a reading.
#[derive(Clone, Debug, PartialEq)]
pub struct MountedSensor {
    /// Name, e.g. `shoulder`.
    pub name: String,
    /// What it reads, and where.
    pub kind: SensorKind,
    /// Time constant of its first-order lag, s; 0: none.
    pub lag_s: f64,
    /// Its uncertain numbers: the offset, then those of its kind.
    pub parameters: Vec<Parameter>,
    /// Steady drift, in the unit of the reading per second.
    pub drift_per_s: f64,
    /// Standard deviation of the white noise of a reading, in its unit.
    pub noise: f64,
    /// Correlated noise.
    pub correlated: Option<CorrelatedNoise>,
    /// Smallest step of a reading, in its unit; 0: none.
    pub resolution: f64,
    /// Probability that a reading is missing.
    pub dropout: f64,
    /// Lowest and highest reading that can be one, in its unit; a reading outside is a fault.
    pub plausible: (f64, f64),
}

impl MountedSensor {
    /// The parameter of a kind; `None` for one that this sensor does not have.
    pub fn parameter(&self, kind: ParameterKind) -> Option<&Parameter> {
        self.parameters.iter().find(|parameter| parameter.kind == kind)
    }
}
