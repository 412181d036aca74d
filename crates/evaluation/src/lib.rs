//! Worlds that judge: cylinders, weather, sensors and faults drawn from seeds, and what an estimator or a monitor makes of them.
//!
//! The truth that judges differs from the model inside the product, and from the family that its tuning saw. Nothing of the
//! product depends on this crate.
//!
//! | part | what |
//! |---|---|
//! | [`world`] | worlds that judge: vessel, climate, gas, sensors and rows, drawn by seed, with what really happened |
//! | [`matched`] | worlds that are the observer's own model, and the bound that no estimator goes below there |
//! | [`fault`] | faults put into good rows, and what a monitor must make of them |
//! | [`baseline`] | the paper's detector and others without an observer, to compare with |
//! | `noise` | noise of a series without a leak, and the shortest delay in it |
//! | [`judge`] | runs candidates on worlds and writes the table by family |
//! | [`placement`] | whether layouts of sensors achieve what is predicted of them |
pub mod baseline;
mod error;
pub mod fault;
pub mod judge;
pub mod matched;
mod noise;
pub mod placement;
mod random;
pub mod tails;
pub mod world;

pub use cylwatch_detector as detector;
pub use cylwatch_estimator as estimator;
pub use cylwatch_thermal as thermal;
pub use error::EvaluationError;
