//! Worlds that judge: cylinders, weather, sensors and faults drawn from seeds, and what an estimator or a monitor makes of them.
//!
//! The truth that judges differs from the model inside the product, and from the family that its tuning saw. Nothing of the
//! product depends on this crate. [`world`] draws and simulates, [`judge`] runs candidates and scores them.
pub mod judge;
#[allow(dead_code, reason = "taken over with the truths")]
mod random;
pub mod world;

pub use cylwatch_detector as detector;
pub use cylwatch_estimator as estimator;
pub use cylwatch_thermal as thermal;
