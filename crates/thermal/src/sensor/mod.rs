//! Sensors as a file states them: what they read, where they sit, how far they may be off. Plain data.
//!
//! A number of a sensor is [`Stated`]: the value, and how far the real one may be from it. A scenario draws the
//! real one; an estimator takes it as its prior. How a reading follows from these numbers is the business of whoever
//! simulates or predicts it.
#[cfg(feature = "files")]
mod build;
mod place;
#[cfg(feature = "files")]
mod pt100;
#[cfg(feature = "files")]
mod spec;

use crate::units::ATMOSPHERE_PA;
#[cfg(feature = "files")]
pub use build::mounted;
pub use place::{GasPlace, PLACES, SurfacePlace};
#[cfg(feature = "files")]
pub use pt100::Pt100Class;
#[cfg(feature = "files")]
pub use spec::{KindChoice, SensorSpec};

/// What a sensor reads, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SensorKind {
    /// Temperature of the outer surface, or of the valve body.
    Surface {
        /// Where it sits.
        place: SurfacePlace,
    },
    /// Gas pressure, by a transmitter at the valve.
    Pressure {
        /// What it counts from.
        reference: PressureReference,
        /// Upper end of its range, Pa, counted as it counts; `None`: it has no end.
        full_scale_pa: Option<f64>,
    },
    /// Gas temperature inside.
    Gas {
        /// Where it hangs.
        place: GasPlace,
    },
    /// Air temperature.
    Ambient,
}

/// What a pressure transmitter counts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PressureReference {
    /// Vacuum.
    Absolute,
    /// The air around it. Whoever records a gauge reading adds the standard atmosphere, as the unit `_barg` does,
    /// so that at another altitude the record is off by the difference.
    Gauge {
        /// Real pressure of the air, Pa.
        atmosphere_pa: f64,
    },
}

impl PressureReference {
    /// What a reading of zero is recorded as, Pa absolute: logs hold a gauge pressure with the standard atmosphere added.
    pub fn zero_pa(self) -> f64 {
        match self {
            Self::Absolute => 0.0,
            Self::Gauge { .. } => ATMOSPHERE_PA,
        }
    }
}

/// A number of a sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stated {
    /// Value: mean of what it may be.
    pub value: f64,
    /// Standard deviation around the value; 0: the value is known.
    pub sd: f64,
    /// Distribution around the value.
    pub law: Law,
}

/// Distribution of an uncertain number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Law {
    /// Normal.
    #[default]
    Normal,
    /// Uniform between limits, which lie `sqrt(3)` standard deviations from the middle.
    Uniform,
}

impl Stated {
    /// A known number.
    pub fn known(value: f64) -> Self {
        Self { value, ..Self::default() }
    }

    /// Normal around a value with a standard deviation.
    pub fn normal(value: f64, sd: f64) -> Self {
        Self { value, sd, law: Law::Normal }
    }

    /// Anywhere within `limit` of the value, as a tolerance or an accuracy class says; `sd = limit / sqrt(3)`.
    pub fn within(value: f64, limit: f64) -> Self {
        Self { value, sd: limit / 3.0_f64.sqrt(), law: Law::Uniform }
    }
}

/// Noise whose autocorrelation falls as `exp(-|dt| / time)`.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// Constant error, in the unit of the reading.
    pub offset: Stated,
    /// Coupling `kappa` of a surface sensor to the air, 0 to 1: it reads `T + kappa (T_air - T)`.
    pub air_coupling: Stated,
    /// Error of a pressure transmitter per kelvin of its electronics away from 15 °C, Pa/K.
    pub temperature_coefficient_pa_k: Stated,
    /// Relative error of a pressure transmitter's span.
    pub span: Stated,
    /// Random walk of the offset: its standard deviation after one second, in the unit of the reading per √s.
    pub walk_per_sqrt_s: f64,
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
