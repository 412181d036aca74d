//! Estimation for gas cylinders on top of [`cylwatch_thermal`]: sensors, filters, the cylinder's observer,
//! identification of transfer functions, and the means to judge an estimator.
//!
//! A trajectory (simulated) becomes a [`log::Log`] through [`sensor`]; an observer turns a log, row by row,
//! into the mean gas temperature, the gas mass and the leak rate, each with its standard deviation.
//!
//! | part | what |
//! |---|---|
//! | [`sensor`], [`log`] | what a sensor reads, with its errors; readings in rows |
//! | [`filter`], [`observer`] | linear algebra of filters and smoothers; the cylinder's states on top of it |
//! | [`identify`], [`calibrate`] | transfer functions and physical parameters from logs |
//! | [`placement`] | where sensors should sit, with a bound on what was missed |
//! | [`consistency`], [`bound`] | how an estimator is judged |
//!
//! Without default features the crate is what runs beside a sensor: what a sensor reads, filters and observer. `design` is everything offline, `simd` uses the vector registers of the
//! machine at hand.
//!
//! ```
//! use cylwatch_estimator::observer::{Commissioning, Observer, ObserverSettings};
//! use cylwatch_estimator::sensor::Sensor;
//! use cylwatch_estimator::thermal::vessel;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let vessel = vessel::presets::load("nitrogen-20l")?;
//! let sensors = [Sensor::typical("shoulder")?, Sensor::typical("pressure")?];
//! let filled = Commissioning::filled(200e5, 288.15);
//! let mut observer = Observer::new(&vessel, &sensors, &filled, &ObserverSettings::default())?;
//! // A reading that is missing is NaN.
//! let estimate = observer.step(60.0, &[288.1, f64::NAN])?;
//! assert!((estimate.mass_kg - 4.46).abs() < 0.1);
//! # Ok(())
//! # }
//! ```
#![cfg_attr(not(any(feature = "presets", feature = "simd", test)), no_std)]
#[macro_use]
extern crate alloc;

#[cfg(feature = "design")]
pub mod bound;
#[cfg(feature = "design")]
pub mod calibrate;
#[cfg(feature = "design")]
mod cone;
#[cfg(feature = "design")]
pub mod consistency;
mod error;
pub mod filter;
#[cfg(feature = "design")]
pub mod identify;
#[cfg(feature = "design")]
mod least_squares;
pub mod log;
#[cfg(feature = "design")]
pub mod minimum;
mod numbers;
pub mod observer;
#[cfg(feature = "design")]
pub mod placement;
pub mod sensor;

pub use cylwatch_thermal as thermal;
pub use error::EstimatorError;

/// The code of the README, so that it is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
