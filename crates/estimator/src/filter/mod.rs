//! Linear estimation: factorised Kalman filters, smoothers, Riccati equation, moving horizon. No thermal words here.
//!
//! A problem is a [`StateSpace`]: how the state moves between samples and what each output reads. Every filter
//! here works on any of them.
mod dense;
mod factor;
pub mod failure;
pub mod form;
pub mod gate;
pub mod kalman;
mod kernel;
pub mod report;
pub mod sequential;
pub mod state_space;
pub mod ud;

pub use failure::StepError;
pub use form::{CovarianceForm, Information, Joseph, SquareRoot};
pub use gate::{GateCount, GateSettings, Outcome};
pub use kalman::{ExtendedKalman, KalmanSettings};
pub use report::{OutputReport, StepReport};
pub use sequential::{KalmanSnapshot, SequentialFilter};
pub use state_space::{Linearisation, StateSpace};
pub use ud::UdFactors;
