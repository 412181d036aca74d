//! What can be unknown, and what is known of it beforehand.
use std::fmt;

use super::CalibrateError;
use crate::sensor::{ParameterKind as SensorParameterKind, Sensor};

/// What a parameter is. *Factor*: relative to what the vessel or the scenario says, so that it transfers to others.
#[derive(Clone, Debug, PartialEq)]
pub enum ParameterKind {
    /// Factor on the outside film, be it a coefficient or the law for wind and natural convection; a number of the vessel.
    OutsideFilm,
    /// Factor on the inside film.
    InsideFilm,
    /// Factor on the film of gas that the jet of a refill stirs.
    JetFilm,
    /// Factor on the heat capacity of the wall.
    WallCapacity,
    /// Factor on the heat capacity of the valve.
    ValveCapacity,
    /// Factor on the thermal contact between valve and neck.
    ValveContact,
    /// Factor on the inner volume.
    Volume,
    /// Discharge coefficient of the orifice flow of this name.
    DischargeCoefficient {
        /// Name of the flow.
        flow: String,
    },
    /// Factor on the gas mass at the start.
    FillMass,
    /// Wall and gas at the start are this much warmer than the scenario says, K.
    InitialTemperature,
    /// What the thermometer of the air reads too much, K: air and radiation are this much colder than the scenario says. All
    /// other thermometers are compared with the air, so that their offsets are known no better than this one.
    AirOffset,
    /// Mounting coupling of a surface sensor to the air, 0 to 1.
    SensorCoupling {
        /// Name of the sensor.
        sensor: String,
    },
    /// Time constant of a sensor's lag, s.
    SensorLag {
        /// Name of the sensor.
        sensor: String,
    },
    /// Offset of a sensor, K or Pa.
    SensorOffset {
        /// Name of the sensor.
        sensor: String,
    },
    /// Relative error of a pressure sensor's span.
    SensorSpan {
        /// Name of the sensor.
        sensor: String,
    },
    /// Temperature coefficient of a pressure sensor, Pa/K.
    SensorTemperatureCoefficient {
        /// Name of the sensor.
        sensor: String,
    },
}

/// What a parameter acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    /// The simulation.
    Simulation,
    /// The sensors' readings.
    Reading,
}

impl ParameterKind {
    pub(super) fn stage(&self) -> Stage {
        match self {
            Self::SensorOffset { .. }
            | Self::SensorCoupling { .. }
            | Self::SensorSpan { .. }
            | Self::SensorLag { .. }
            | Self::SensorTemperatureCoefficient { .. } => Stage::Reading,
            _ => Stage::Simulation,
        }
    }

    /// Whether it is sought as its logarithm. What acts on the simulation and is not is the shift of a temperature, K.
    pub fn is_positive(&self) -> bool {
        match self {
            Self::InitialTemperature | Self::AirOffset => false,
            Self::SensorLag { .. } => true,
            other => other.stage() == Stage::Simulation,
        }
    }

    /// Whether it is a number of one experiment: what it began with, and what its air was read by.
    pub fn is_of_experiment(&self) -> bool {
        matches!(self, Self::InitialTemperature | Self::FillMass | Self::AirOffset)
    }

    /// Bounds where none are given: beyond them nothing means anything.
    pub(crate) fn usual_bounds(&self) -> (f64, f64) {
        match self {
            Self::DischargeCoefficient { .. } => (0.05, 1.0),
            Self::Volume | Self::FillMass => (0.5, 2.0),
            Self::InitialTemperature | Self::AirOffset => (-50.0, 50.0),
            Self::SensorCoupling { .. } => (0.0, 0.95),
            Self::SensorLag { .. } => (0.1, 1e5),
            Self::SensorOffset { .. } | Self::SensorTemperatureCoefficient { .. } => (-1e7, 1e7),
            Self::SensorSpan { .. } => (-0.5, 0.5),
            _ => (0.05, 20.0),
        }
    }

    /// How far such a parameter is usually off: 30 % (as a logarithm) of a positive one, a sensor's in its own unit.
    pub fn usual_width(&self, is_pressure: bool) -> f64 {
        match self {
            Self::Volume | Self::FillMass => 0.05,
            Self::InitialTemperature => 3.0,
            Self::AirOffset => 1.0,
            Self::SensorCoupling { .. } => 0.1,
            Self::SensorOffset { .. } if is_pressure => 1e5,
            Self::SensorOffset { .. } => 1.0,
            Self::SensorSpan { .. } => 0.01,
            Self::SensorTemperatureCoefficient { .. } => 5e3,
            _ => 0.3,
        }
    }

    /// Name of the sensor that it belongs to.
    pub fn sensor(&self) -> Option<&str> {
        match self {
            Self::SensorCoupling { sensor }
            | Self::SensorLag { sensor }
            | Self::SensorOffset { sensor }
            | Self::SensorSpan { sensor }
            | Self::SensorTemperatureCoefficient { sensor } => Some(sensor),
            _ => None,
        }
    }

    /// The number of the sensor's reading, if it is one.
    pub(super) fn sensor_parameter(&self) -> Option<SensorParameterKind> {
        match self {
            Self::SensorCoupling { .. } => Some(SensorParameterKind::Coupling),
            Self::SensorOffset { .. } => Some(SensorParameterKind::Offset),
            Self::SensorSpan { .. } => Some(SensorParameterKind::Span),
            Self::SensorTemperatureCoefficient { .. } => Some(SensorParameterKind::TemperatureCoefficient),
            _ => None,
        }
    }
}

impl fmt::Display for ParameterKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutsideFilm => f.write_str("outside film"),
            Self::InsideFilm => f.write_str("inside film"),
            Self::JetFilm => f.write_str("jet film"),
            Self::WallCapacity => f.write_str("wall capacity"),
            Self::ValveCapacity => f.write_str("valve capacity"),
            Self::ValveContact => f.write_str("valve contact"),
            Self::Volume => f.write_str("volume"),
            Self::DischargeCoefficient { flow } => write!(f, "discharge coefficient of {flow}"),
            Self::FillMass => f.write_str("fill mass"),
            Self::InitialTemperature => f.write_str("initial temperature"),
            Self::AirOffset => f.write_str("offset of the air's thermometer"),
            Self::SensorCoupling { sensor } => write!(f, "coupling of {sensor}"),
            Self::SensorLag { sensor } => write!(f, "lag of {sensor}"),
            Self::SensorOffset { sensor } => write!(f, "offset of {sensor}"),
            Self::SensorSpan { sensor } => write!(f, "span error of {sensor}"),
            Self::SensorTemperatureCoefficient { sensor } => {
                write!(f, "temperature coefficient of {sensor}")
            }
        }
    }
}

/// What is known of a parameter beforehand, in its unit. A positive parameter is taken as lognormal with the relative
/// standard deviation `sd / mean`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
}

/// Experiments that share one value.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Scope {
    /// All.
    #[default]
    All,
    /// These, by their place in the list, from 0.
    Only(Vec<usize>),
}

impl Scope {
    /// Whether an experiment is one of them.
    pub fn contains(&self, experiment: usize) -> bool {
        match self {
            Self::All => true,
            Self::Only(these) => these.contains(&experiment),
        }
    }
}

/// An unknown parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterSpec {
    /// What it is.
    pub kind: ParameterKind,
    /// Where the search begins, in its unit.
    pub start: f64,
    /// What is known of it; `None`: nothing.
    pub prior: Option<Prior>,
    /// Lowest and highest value; `None`: `ParameterKind::usual_bounds`.
    pub bounds: Option<(f64, f64)>,
    /// Experiments that share it.
    pub scope: Scope,
}

impl ParameterSpec {
    /// A parameter of all experiments without a prior.
    pub fn new(kind: ParameterKind, start: f64) -> Self {
        Self { kind, start, prior: None, bounds: None, scope: Scope::All }
    }

    /// The same with a prior.
    pub fn with_prior(self, mean: f64, sd: f64) -> Self {
        Self { prior: Some(Prior { mean, sd }), ..self }
    }

    /// The same for some experiments only.
    pub fn only(self, experiments: Vec<usize>) -> Self {
        Self { scope: Scope::Only(experiments), ..self }
    }

    /// The uncertain numbers of a sensor, started at and with the priors of the sensor itself.
    pub fn of_sensor(sensor: &Sensor) -> Vec<Self> {
        let name = || sensor.name.clone();
        let uncertain = sensor.parameters().iter().filter(|parameter| parameter.sd > 0.0);
        uncertain
            .map(|parameter| {
                let kind = match parameter.kind {
                    SensorParameterKind::Offset => ParameterKind::SensorOffset { sensor: name() },
                    SensorParameterKind::Coupling => ParameterKind::SensorCoupling { sensor: name() },
                    SensorParameterKind::Span => ParameterKind::SensorSpan { sensor: name() },
                    SensorParameterKind::TemperatureCoefficient => {
                        ParameterKind::SensorTemperatureCoefficient { sensor: name() }
                    }
                };
                Self::new(kind, parameter.mean).with_prior(parameter.mean, parameter.sd)
            })
            .collect()
    }

    /// Lowest and highest value.
    pub fn bounds(&self) -> (f64, f64) {
        self.bounds.unwrap_or_else(|| self.kind.usual_bounds())
    }

    /// Value of the search's coordinate.
    pub(super) fn coordinate(&self, value: f64) -> f64 {
        if self.kind.is_positive() { value.ln() } else { value }
    }

    /// Value of a coordinate of the search.
    pub(super) fn value(&self, z: f64) -> f64 {
        if self.kind.is_positive() { z.exp() } else { z }
    }

    /// Mean and standard deviation of the prior in the search's coordinate.
    pub(super) fn prior_coordinate(&self) -> Option<(f64, f64)> {
        let Prior { mean, sd } = self.prior?;
        Some(if self.kind.is_positive() { (mean.ln(), sd / mean) } else { (mean, sd) })
    }

    /// Bounds in the search's coordinate.
    pub(super) fn bounds_coordinate(&self) -> (f64, f64) {
        let (low, high) = self.bounds();
        (self.coordinate(low), self.coordinate(high))
    }

    pub(super) fn check(&self) -> Result<(), CalibrateError> {
        let fail = |field: &'static str, value: f64, bound: String| {
            Err(CalibrateError::ParameterValue { parameter: self.kind.to_string(), field, value, bound })
        };
        let (low, high) = self.bounds();
        let lowest = if self.kind.is_positive() { f64::MIN_POSITIVE } else { f64::NEG_INFINITY };
        if low.is_nan() || low < lowest {
            return fail("lower bound", low, "positive".into());
        }
        if high.is_nan() || high <= low {
            return fail("upper bound", high, format!("above {low}"));
        }
        if self.start.is_nan() || self.start <= low || self.start >= high {
            return fail("start", self.start, format!("between its bounds {low} and {high}"));
        }
        if let Some(Prior { mean, sd }) = self.prior {
            if !(low..=high).contains(&mean) {
                return fail("prior mean", mean, format!("between its bounds {low} and {high}"));
            }
            if !sd.is_finite() || sd <= 0.0 {
                return fail("prior standard deviation", sd, "positive".into());
            }
        }
        Ok(())
    }
}
