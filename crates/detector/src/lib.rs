//! Leak detection for gas cylinders on top of [`cylwatch_estimator`]: change statistics and thresholds from
//! false-alarm rates.
//!
//! [`statistic`] turns residuals, one by one, into a number that grows when their mean has changed;
//! [`calibrate`] turns a mean time between false alarms into the threshold of that number, and states the
//! shortest delay that any detector can have.
pub mod calibrate;
pub mod error;
pub mod statistic;

pub use cylwatch_estimator as estimator;
pub use error::DetectorError;
