//! Thermal model of a gas cylinder: real-gas fluid, finite-volume wall, films inside and outside,
//! leaks and other flows, and the adaptive implicit simulation of all of them together.
//!
//! Data flow, one type per arrow:
//! [`vessel::VesselSpec`] and `scenario::ScenarioSpec` are what a file says; validated they become a
//! [`vessel::Vessel`] and a [`scenario::Scenario`]; [`simulate::simulate`] turns the pair into a
//! [`trajectory::Trajectory`]. All signatures are SI, with the unit in the name.
//!
//! | part | what |
//! |---|---|
//! | [`fluid`] | equations of state and transport properties; coefficients are data with their source |
//! | [`wall`], [`transfer`], [`flow`] | conduction in a mesh without temperatures; films, radiation, sun; orifices and leaks |
//! | [`vessel`], [`scenario`] | files, presets and what they become when they are valid; [`units`] reads the suffixes of their keys |
//! | [`reduced`] | the few nodes that an observer carries |
//! | [`model`], [`simulate`] | state, right-hand side, Jacobian and ledger; the solver |
//!
//! Without default features the crate is what runs beside a sensor: fluid, transfer, flow, reduced model and the validated types. `files` reads and writes TOML, `simulate` adds
//! scenarios, the full model and its solver.
//!
//! ```
//! use cylwatch_thermal::simulate::{SimulationSettings, simulate};
//! use cylwatch_thermal::{scenario, vessel};
//!
//! # fn main() -> Result<(), cylwatch_thermal::ThermalError> {
//! let vessel = vessel::presets::load("nitrogen-20l")?;
//! let scenario = scenario::presets::load("shock-cold")?;
//! let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_done| ())?;
//! let (first_pa, last_pa) = (run.pressure_pa[0], run.pressure_pa[run.pressure_pa.len() - 1]);
//! assert!(last_pa < 0.9 * first_pa, "a tight cylinder loses pressure in the cold");
//! # Ok(())
//! # }
//! ```
#![cfg_attr(not(any(feature = "files", test)), no_std)]
#[macro_use]
extern crate alloc;

mod bounds;
mod cache;
#[cfg(feature = "files")]
pub mod document;
mod error;
pub mod flow;
pub mod fluid;
#[cfg(feature = "simulate")]
pub mod model;
mod problem;
pub mod real;
pub mod reduced;
#[cfg(feature = "simulate")]
pub mod scenario;
pub mod sensor;
#[cfg(feature = "simulate")]
pub mod simulate;
#[cfg(feature = "simulate")]
pub mod trajectory;
pub mod transfer;
pub mod units;
pub mod vessel;
pub mod wall;

pub use error::{ThermalError, shown};

/// The code of the README, so that it is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
