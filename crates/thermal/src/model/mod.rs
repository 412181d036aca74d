//! State layout, right-hand side, Jacobian, outputs, mass and energy ledger.
pub mod stratified;
