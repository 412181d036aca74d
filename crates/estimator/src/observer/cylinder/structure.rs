//! Which states the equations of a step couple.
use super::super::states::{StateKind, States};
use alloc::vec::Vec;

/// Which states the equations have.
#[derive(Clone, Debug)]
pub(super) struct Structure {
    /// States of the block; the first `temperatures` are coupled both ways, the others are driven only.
    pub block: Vec<usize>,
    pub temperatures: usize,
    /// States outside the block.
    pub outer: Vec<usize>,
    pub mass: usize,
    pub leak: usize,
    /// Constants that act on the block.
    pub constants: Vec<usize>,
}

impl Structure {
    /// Temperatures are the states before the mass; lags are driven, and by what their sensors' parameters say.
    pub(super) fn of(states: &States) -> Self {
        let lags = states.lag.iter().flatten().copied();
        let block: Vec<usize> = (0..states.mass).chain(lags).collect();
        let acts = |state: &usize| match states.kinds[*state] {
            StateKind::Parameter { sensor, .. } => states.lag[sensor].is_some(),
            _ => true,
        };
        Self {
            temperatures: states.mass,
            outer: (0..states.leading).filter(|state| !block.contains(state)).collect(),
            mass: states.mass,
            leak: states.leak,
            constants: states.constants().filter(acts).collect(),
            block,
        }
    }
}
