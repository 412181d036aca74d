//! What a sensor reads and how a filter predicts it: one object for both.
//!
//! ```text
//! surface   y = T + kappa (T_air - T) + b
//! gas       y = T_gas + b
//! ambient   y = T_air + b
//! pressure  y = (1 + s) (p - p_0) + b + c (T_el - 15 degC) + p_r
//! ```
//!
//! with mounting coupling `kappa`, offset `b`, span error `s` and temperature coefficient `c`; `T_el` is the temperature
//! of the transmitter's electronics, which is that of the valve. An absolute transmitter has `p_0 = p_r = 0`. A gauge
//! one counts from the air's pressure `p_0`, and whoever records its reading as absolute adds the standard atmosphere
//! `p_r`. The reading then passes a first-order lag ([`lag`]), drifts, gets noise ([`noise`]), is rounded to its
//! resolution, and may get lost.
//!
//! [`Sensor::predict`] is the static reading with its derivatives, for a filter; [`sample`] turns a trajectory into a
//! [`crate::log::Log`] with everything that follows. The numbers `b, kappa, c, s` are [`Parameter`]s: known, or with a
//! prior from which `Sensor::draw` takes one specimen ([`SensorTruth`]).
#[cfg(feature = "design")]
mod exposure;
#[cfg(feature = "design")]
mod file;
#[cfg(feature = "design")]
pub mod lag;
mod model;
#[cfg(feature = "design")]
pub mod noise;
mod parameter;
#[cfg(feature = "design")]
mod sample;
#[cfg(feature = "design")]
mod stream;
#[cfg(feature = "design")]
mod suite;
#[cfg(feature = "design")]
mod typical;

pub use cylwatch_thermal::sensor::{
    CorrelatedNoise, GasPlace, Law, PressureReference, SensorKind, SurfacePlace,
};
#[cfg(feature = "design")]
pub use cylwatch_thermal::sensor::{KindChoice, Pt100Class, SensorSpec};
#[cfg(feature = "design")]
pub use file::{SensorsSpec, read_sensors, schema};
pub use model::{ELECTRONICS_REFERENCE_K, Exposure, Prediction, Sensor};
pub use parameter::{MAX_PARAMETERS, Parameter, ParameterKind};
#[cfg(feature = "design")]
pub use sample::{sample, sample_at};
#[cfg(feature = "design")]
pub use suite::{SensorSuite, SensorTruth, Specimen, SuiteTruth};
