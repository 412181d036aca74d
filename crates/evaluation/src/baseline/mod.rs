//! What a detector without an observer can do: the paper's, and those that stand beside it in a comparison.
//!
//! All of them look at the error `e = p_expected(T) - p` of a [`Reading`] and differ in what they expect ([`Expectation`]) at
//! which gas temperature ([`GasTemperature`]), and in what they do with `e`:
//!
//! | detector | expected pressure | gas temperature | then |
//! |---|---|---|---|
//! | [`Threshold::published`] | published slope | published function of the shoulder | threshold, hold |
//! | `PressureError::refitted` in a [`Threshold`] | real gas | gain 1, refitted pole | zero, threshold, hold |
//! | [`Threshold::raw_switch`] | the limit, whatever the temperature | none | threshold 0 |
//! | [`Threshold::ideal_gas`] | `p_fill T/T_fill` | the shoulder | threshold, hold |
//! | [`ErrorCusum`] | any | any | cumulative sum as if `e` were white |
//!
//! A reading without a pressure, or without the temperature that the expectation needs, or not later than the one before, changes no
//! statistic; a shoulder without a pressure still moves the gas temperature.
//!
//! ```
//! use cylwatch_evaluation::baseline::{Filling, Reading, Threshold};
//!
//! let filling = Filling { pressure_pa: 200e5, temperature_k: 288.15 };
//! let mut detectors = [Threshold::published(filling), Threshold::ideal_gas(filling), Threshold::raw_switch(160e5)];
//! let reading = |time_s| Reading { time_s, shoulder_k: 288.15, pressure_pa: 198e5 };
//! detectors.iter_mut().for_each(|detector| {
//!     detector.update(reading(0.0));
//! });
//! // Ten minutes later an error has lasted.
//! let error_bar: Vec<f64> = detectors.iter_mut().map(|detector| detector.update(reading(600.0)) / 1e5).collect();
//! // The published gain of 1.033 adds 0.5 K, 0.42 bar.
//! assert!((error_bar[0] - 2.42).abs() < 0.01 && (error_bar[1] - 2.0).abs() < 1e-9 && error_bar[2] < 0.0);
//! ```
//!
//! Source: H. Bücking, R. Pfaff, R. Dirksmeier, Sensor positioning and thermal model for condition monitoring of pressure gas
//! reservoirs in vehicles, section 3.
mod error_cusum;
mod pressure_error;
mod sustained;
mod threshold;
mod trend;

pub use crate::estimator::identify::published::Filling;
pub use error_cusum::ErrorCusum;
pub use pressure_error::{Expectation, GasTemperature, PressureError};
pub use sustained::Sustained;
pub use threshold::{HOLD_S, Loss, Threshold};
pub use trend::Trend;

/// What the vehicle reads at one time; NaN: missing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Time, s.
    pub time_s: f64,
    /// Temperature of the shoulder, K.
    pub shoulder_k: f64,
    /// Pressure, Pa.
    pub pressure_pa: f64,
}
