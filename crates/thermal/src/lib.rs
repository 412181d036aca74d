//! Thermal model of a gas cylinder: real-gas fluid, finite-volume wall, films inside and outside,
//! leaks and other flows, and the adaptive implicit simulation of all of them together.
//!
//! The way of the data is one type per arrow:
//! [`vessel::VesselSpec`] and [`scenario::ScenarioSpec`] are what a file says; validated they become a
//! [`vessel::Vessel`] and a [`scenario::Scenario`]; [`simulate::simulate`] turns the pair into a
//! [`trajectory::Trajectory`]. All signatures are SI, with the unit in the name.
pub mod document;
pub mod error;
pub mod flow;
pub mod fluid;
pub mod model;
pub mod scenario;
pub mod simulate;
pub mod trajectory;
pub mod transfer;
pub mod units;
pub mod vessel;
pub mod wall;

pub use error::ThermalError;
