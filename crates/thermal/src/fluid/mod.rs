//! Equations of state and transport properties of gases.
/// A gas.
#[derive(Clone, Debug)]
pub struct Fluid {}
