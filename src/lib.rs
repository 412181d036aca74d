//! cylwatch tells a leaking gas cylinder from a cold one.
pub use cylwatch_detector as detector;
pub use cylwatch_estimator as estimator;
pub use cylwatch_thermal as thermal;
