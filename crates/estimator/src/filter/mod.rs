//! Estimation: factorised Kalman filters, smoothers, Riccati equation, moving horizon. No thermal words here.
//!
//! A problem is a [`StateSpace`]: how the state moves between samples and what each output reads. Every filter
//! here works on any of them.
mod bank;
mod belief;
pub(crate) mod dense;
mod factor;
mod failure;
mod gate;
#[cfg(feature = "design")]
pub mod horizon;
mod kalman;
pub(crate) mod kernel;
mod lanes;
mod linear;
mod plant;
mod record;
mod riccati;
pub(crate) mod simd;
mod smoother;
mod state_space;
mod stationary;
mod step;
mod ud;
pub(crate) mod ud_bank;
mod unscented;

pub(crate) use bank::Outline;
pub use bank::{Bank, BankEngine, Workspace};
pub use belief::Belief;
pub(crate) use belief::{Moments, mixture};
pub use failure::StepError;
pub use gate::{Gate, Innovation, Outcome};
pub use kalman::ExtendedKalman;
#[cfg(feature = "design")]
pub(crate) use linear::LinearSystem;
pub use plant::{Plant, SlowProcess};
pub use record::StepRecord;
pub use riccati::{SteadyState, steady_prediction, steady_state};
pub(crate) use smoother::Backward;
pub use smoother::{Smoothed, smooth};
pub use state_space::{Linearisation, StateSpace};
pub use step::StepTransition;
pub(crate) use step::parts;
pub use ud::UdFactors;
pub use ud_bank::Pattern;
#[cfg(test)]
pub(crate) use unscented::{SPREAD_SQUARED, SigmaPoints};
