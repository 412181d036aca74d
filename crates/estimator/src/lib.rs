//! Estimation for gas cylinders: sensors, filters, the cylinder's observer, identification,
//! calibration and sensor placement, on top of [`cylwatch_thermal`].
//!
//! This crate so far holds only this page: the thermal solver comes first.
pub use cylwatch_thermal as thermal;
