//! The numbers of a sensor that may be uncertain.
use cylwatch_thermal::sensor::{Law, Stated};

/// Most parameters of a sensor.
pub const MAX_PARAMETERS: usize = 3;

/// What a parameter is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// Constant error `b`, in the unit of the reading.
    Offset,
    /// Mounting coupling `kappa` to the air, 0 to 1.
    Coupling,
    /// Error `c` of a pressure per kelvin of the transmitter, Pa/K.
    TemperatureCoefficient,
    /// Relative error `s` of the span.
    Span,
}

/// A parameter with its prior. Units are those of its kind.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// A parameter that does not walk, as stated.
    pub(crate) fn new(kind: ParameterKind, stated: Stated) -> Self {
        Self { kind, mean: stated.value, sd: stated.sd, walk_per_sqrt_s: 0.0, law: stated.law }
    }

    /// The same with a random walk.
    pub(crate) fn walking(self, walk_per_sqrt_s: f64) -> Self {
        Self { walk_per_sqrt_s, ..self }
    }

    /// Lowest and highest value that means something.
    pub(crate) fn domain(&self) -> (f64, f64) {
        match self.kind {
            ParameterKind::Coupling => (0.0, 1.0),
            ParameterKind::Offset | ParameterKind::TemperatureCoefficient | ParameterKind::Span => {
                (f64::NEG_INFINITY, f64::INFINITY)
            }
        }
    }
}
