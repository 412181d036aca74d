//! Linear estimation: factorised Kalman filters, smoothers, Riccati equation, moving horizon. No thermal words here.
//!
//! A problem is a [`StateSpace`]: how the state moves between samples and what each output reads. Every filter
//! here works on any of them.
pub mod bank;
pub(crate) mod dense;
mod factor;
pub mod failure;
pub mod form;
pub mod gate;
pub mod horizon;
pub mod kalman;
pub(crate) mod kernel;
pub mod lanes;
pub mod report;
pub mod riccati;
pub mod ring;
pub mod sequential;
pub mod smoother;
pub mod state_space;
pub mod stationary;
pub mod ud;
pub mod unscented;
pub mod van_loan;

pub use failure::StepError;
pub use form::{CovarianceForm, Joseph};
pub use gate::{GateCount, GateSettings, Outcome};
pub use kalman::{ExtendedKalman, KalmanSettings};
pub use report::{OutputReport, StepReport};
pub use riccati::{SteadyState, steady_prediction, steady_state};
pub use ring::{Placement, Refilter};
pub use sequential::{KalmanSnapshot, SequentialFilter};
pub(crate) use smoother::Backward;
pub use smoother::{PassStep, Smoothed, smooth_fixed_interval};
pub use state_space::{Linearisation, StateSpace};
pub use stationary::{Stationary, StationarySettings, StationarySnapshot};
pub use ud::UdFactors;
pub use unscented::{Unscented, UnscentedSettings, UnscentedSnapshot};
pub use van_loan::{Discrete, discretise};
