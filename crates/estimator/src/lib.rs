//! Estimation for gas cylinders on top of [`cylwatch_thermal`]: sensors, filters, the cylinder's observer,
//! identification of transfer functions, and the means to judge an estimator.
//!
//! A trajectory (simulated) becomes a [`log::Log`] through [`sensor`]; an observer turns a log, row by row,
//! into the mean gas temperature, the gas mass and the leak rate, each with its standard deviation.
pub mod bound;
pub mod calibrate;
mod cone;
pub mod consistency;
pub mod error;
pub mod filter;
pub mod identify;
mod least_squares;
pub mod log;
pub mod minimum;
pub mod observer;
pub mod placement;
pub mod sensor;
pub mod truth;

pub use cylwatch_thermal as thermal;
pub use error::EstimatorError;
