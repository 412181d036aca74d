//! Leak detection for gas cylinders: change statistics, thresholds from false-alarm rates,
//! the monitor and its prognosis, on top of [`cylwatch_estimator`].
//!
//! This crate so far holds only this page: the thermal solver and the observer come first.
pub use cylwatch_estimator as estimator;
