//! Linear estimation: factorised Kalman filters, smoothers, Riccati equation, moving horizon. No thermal words here.
//!
//! A problem is a [`StateSpace`]: how the state moves between samples and what each output reads. Every filter
//! here works on any of them.
pub mod state_space;

pub use state_space::{Linearisation, StateSpace};
