//! cylwatch tells a leaking gas cylinder from a cold one.
//!
//! The crates of the workspace under one roof ([`thermal`], [`estimator`], [`detector`]), and what the program adds:
//! results as files and figures ([`report`]).
pub use cylwatch_detector as detector;
pub use cylwatch_estimator as estimator;
pub use cylwatch_thermal as thermal;

pub mod report;
