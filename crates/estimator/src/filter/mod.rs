//! Linear estimation: factorised Kalman filters, smoothers, Riccati equation, moving horizon. No thermal words here.
//!
//! A problem is a [`StateSpace`]: how the state moves between samples and what each output reads. Every filter
//! here works on any of them.
mod factor;
mod kernel;
pub mod state_space;
pub mod ud;

pub use state_space::{Linearisation, StateSpace};
pub use ud::UdFactors;
