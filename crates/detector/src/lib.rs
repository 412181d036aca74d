//! Leak detection for gas cylinders on top of [`cylwatch_estimator`]: the evidence for a leak, the verdict, and the time that is left.
//!
//! [`evidence`] turns what the observer says into statistics on time scales from an hour to a month, with thresholds.
//! [`prognosis`] turns mass and leak rate with their joint uncertainty into the time until a limit and the reaction that
//! is due. [`monitor`] puts all of it behind one call a row: readings in, [`Verdict`](monitor::Verdict), events and
//! alarms out.
//!
//! ```
//! use cylwatch_detector::monitor::{Monitor, MonitorSettings};
//! use cylwatch_detector::estimator::observer::Commissioning;
//! use cylwatch_detector::estimator::sensor::Sensor;
//! use cylwatch_detector::estimator::thermal::vessel;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let vessel = vessel::presets::load("nitrogen-20l")?;
//! let sensors = [Sensor::typical("shoulder")?, Sensor::typical("pressure")?];
//! let filled = Commissioning::filled(200e5, 288.15);
//! let mut monitor = Monitor::new(&vessel, &sensors, &filled, &MonitorSettings::default())?;
//! for minute in 0..10 {
//!     for output in monitor.step(60.0 * f64::from(minute), &[288.15, 200e5])? {
//!         println!("{:?}", output.decision.verdict);
//!     }
//! }
//! # Ok(())
//! # }
//! ```
#![cfg_attr(not(any(feature = "presets", feature = "simd", test)), no_std)]
#[macro_use]
extern crate alloc;

pub mod compiled;
pub mod error;
pub mod evidence;
pub mod inspection;
pub mod monitor;
pub mod prognosis;
pub mod sealed;
mod units;

pub use cylwatch_estimator as estimator;
pub use error::DetectorError;

/// The code of the README, so that it is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
