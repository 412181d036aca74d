//! How good a leak detector is.
pub mod fault;
