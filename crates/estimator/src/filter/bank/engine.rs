//! Which filter the members of a bank run.
#[cfg(feature = "design")]
use crate::filter::horizon::{Constraint, HorizonSettings};

/// Filter that the members of a bank run.
#[derive(Clone, Debug, PartialEq)]
pub enum BankEngine {
    /// Extended Kalman filter, four members side by side.
    Extended,
    /// Unscented Kalman filter.
    Unscented,
    /// Gain of the steady state; constants are considered, not estimated.
    Stationary,
    /// Moving horizon on top of the extended filter, inside constraints.
    #[cfg(feature = "design")]
    MovingHorizon(HorizonSettings, Vec<Constraint>),
}
