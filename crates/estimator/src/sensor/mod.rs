//! What a sensor reads and how a filter predicts it: one object for both.
//!
//! [`Sensor::predict`] is the static reading with its derivatives, for a filter; the equation is that of the sensor's
//! [kind](SensorKind). [`sample`] turns a trajectory into a [`crate::log::Log`] with everything that follows: the reading
//! passes a first-order lag ([`lag`]), drifts, gets noise ([`noise`]), is rounded to its resolution, and may get lost.
//! The [`Parameter`]s of the equation are known, or have a prior from which `Sensor::draw` takes one specimen
//! ([`SensorTruth`]).
#[cfg(feature = "design")]
mod exposure;
#[cfg(feature = "design")]
mod file;
#[cfg(feature = "design")]
pub mod lag;
mod model;
#[cfg(feature = "design")]
pub mod noise;
#[cfg(feature = "design")]
mod sample;
#[cfg(feature = "design")]
mod stream;
#[cfg(feature = "design")]
mod suite;
#[cfg(feature = "design")]
mod typical;

pub use cylwatch_thermal::sensor::{
    CorrelatedNoise, ELECTRONICS_REFERENCE_K, Exposure, GasPlace, Law, MAX_PARAMETERS, Parameter,
    ParameterKind, Prediction, PressureReference, SensorKind, Site, SurfacePlace,
};
#[cfg(feature = "design")]
pub use cylwatch_thermal::sensor::{KindChoice, Pt100Class, SensorSpec};
#[cfg(feature = "design")]
pub use file::{SensorsSpec, read_sensors, schema};
pub use model::Sensor;
#[cfg(feature = "design")]
pub use sample::{sample, sample_at};
#[cfg(feature = "design")]
pub use suite::{SensorSuite, SensorTruth, Specimen, SuiteTruth};
