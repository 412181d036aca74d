//! Estimation: factorised Kalman filters, smoothers, Riccati equation, moving horizon. No thermal words here.
//!
//! A problem is a [`StateSpace`]: how the state moves between samples and what each output reads. Every filter
//! here works on any of them.
pub mod bank;
pub(crate) mod dense;
mod factor;
mod failure;
mod gate;
pub mod horizon;
mod kalman;
pub(crate) mod kernel;
pub(crate) mod lanes;
mod riccati;
pub mod smoother;
pub mod state_space;
mod ud;

pub use failure::StepError;
pub use gate::{Gate, Innovation, Outcome};
pub use kalman::ExtendedKalman;
pub use riccati::{SteadyState, steady_prediction, steady_state};
pub(crate) use smoother::Backward;
pub use smoother::{PassStep, Smoothed, smooth_fixed_interval};
pub use state_space::{Linearisation, StateSpace};
pub use ud::UdFactors;
