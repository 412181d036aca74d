//! Leak detection for gas cylinders on top of [`cylwatch_estimator`]: change statistics, thresholds from
//! false-alarm rates, detectors to compare with, and the time that is left.
//!
//! [`statistic`] turns residuals, one by one, into a number that grows when their mean has changed;
//! [`calibrate`] turns a mean time between false alarms into the threshold of that number, and states the
//! shortest delay that any detector can have. [`baseline`] holds the paper's detector and others without an observer.
//! [`evidence`] turns what the observer says into statistics on time scales from an hour to a month, with thresholds.
//! [`prognosis`] turns mass and leak rate with their joint uncertainty into the time until a limit and the reaction that
//! is due.
pub mod baseline;
pub mod calibrate;
pub mod error;
pub mod evidence;
pub mod monitor;
pub mod performance;
pub mod prognosis;
pub mod statistic;

pub use cylwatch_estimator as estimator;
pub use error::DetectorError;
