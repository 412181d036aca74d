//! cylwatch tells a leaking gas cylinder from a cold one.
//!
//! The crates of the workspace under one roof ([`thermal`], [`estimator`], [`detector`]), and what the program adds:
//! logs as files ([`log`]), results as files and figures ([`report`]), gas properties ([`properties`]),
//! the reproduction of the paper ([`reproduce`]).
pub use cylwatch_detector as detector;
pub use cylwatch_estimator as estimator;
pub use cylwatch_thermal as thermal;

pub mod log;
pub mod properties;
pub mod report;
pub mod reproduce;

/// The code of the README, so that it is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
