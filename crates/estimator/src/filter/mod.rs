//! Estimation: factorised Kalman filters, smoothers, Riccati equation, moving horizon. No thermal words here.
//!
//! A problem is a [`StateSpace`]: how the state moves between samples and what each output reads. Every filter
//! here works on any of them.
mod bank;
mod belief;
// What is left of these is for engines and work that `design` brings.
#[cfg_attr(not(feature = "design"), expect(dead_code))]
pub(crate) mod dense;
mod factor;
mod failure;
mod gate;
#[cfg(feature = "design")]
pub mod horizon;
mod kalman;
#[cfg_attr(not(feature = "design"), expect(dead_code))]
pub(crate) mod kernel;
mod lanes;
#[cfg(feature = "design")]
mod linear;
mod plant;
mod record;
#[cfg(feature = "design")]
mod riccati;
pub(crate) mod simd;
mod smoother;
mod state_space;
#[cfg(feature = "design")]
mod stationary;
mod step;
#[cfg_attr(not(feature = "design"), expect(dead_code))]
mod ud;
pub(crate) mod ud_bank;
#[cfg(feature = "design")]
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
#[cfg(feature = "design")]
pub use riccati::{SteadyState, steady_prediction, steady_state};
pub(crate) use smoother::Backward;
pub use smoother::{Smoothed, smooth};
pub use state_space::{Dimensions, Linearisation, StateSpace};
pub use step::StepTransition;
pub(crate) use step::{StepMemory, Steps};
pub use ud::UdFactors;
pub use ud_bank::Pattern;
#[cfg(all(test, feature = "design"))]
pub(crate) use unscented::{SPREAD_SQUARED, SigmaPoints};
