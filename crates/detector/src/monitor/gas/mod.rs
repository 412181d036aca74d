//! What pressure and mass say of the gas: whether it was put in or let out, is being lost, since when, how fast and for how long.
pub(super) mod bounds;
pub(super) mod contents;
pub(super) mod filling;
pub(super) mod gain;
pub mod jump;
pub(super) mod leak;
pub mod onset;
pub(super) mod outlook;
mod wander;
