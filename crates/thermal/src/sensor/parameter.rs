//! The numbers of a sensor that may be uncertain.
use serde::{Deserialize, Serialize};

/// Most parameters of a sensor.
pub const MAX_PARAMETERS: usize = 3;

/// What a parameter is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ParameterKind {
    /// Constant error `b`, in the unit of the reading.
    Offset,
    /// Coupling `kappa` to what the sensor is mounted in, 0 to 1.
    Coupling,
    /// Error `c` of a pressure per kelvin of the transmitter, Pa/K.
    TemperatureCoefficient,
    /// Relative error `s` of the span.
    Span,
}

/// Distribution of an uncertain number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Law {
    /// Normal.
    #[default]
    Normal,
    /// Uniform between limits, which lie `sqrt(3)` standard deviations from the middle.
    Uniform,
}

/// A parameter with its prior. Units are those of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// What it is.
    pub kind: ParameterKind,
    /// Mean of the prior.
    pub mean: f64,
    /// Standard deviation of the prior; 0: the mean is the value.
    pub sd: f64,
    /// Intensity of its random walk: standard deviation after one second; 0: it is constant.
    pub walk_per_sqrt_s: f64,
    /// Distribution that a specimen is drawn from; a filter takes the standard deviation alone.
    pub law: Law,
}

impl Parameter {
    /// A constant, normal around a mean with a standard deviation.
    pub fn normal(kind: ParameterKind, mean: f64, sd: f64) -> Self {
        Self { kind, mean, sd, walk_per_sqrt_s: 0.0, law: Law::Normal }
    }

    /// A constant, anywhere within `limit` of the mean, as a tolerance or an accuracy class says; `sd = limit / sqrt(3)`.
    pub fn within(kind: ParameterKind, mean: f64, limit: f64) -> Self {
        Self { law: Law::Uniform, ..Self::normal(kind, mean, limit / libm::sqrt(3.0_f64)) }
    }

    /// Lowest and highest value that means something.
    pub fn domain(&self) -> (f64, f64) {
        match self.kind {
            ParameterKind::Coupling => (0.0, 1.0),
            ParameterKind::Offset | ParameterKind::TemperatureCoefficient | ParameterKind::Span => {
                (f64::NEG_INFINITY, f64::INFINITY)
            }
        }
    }
}
