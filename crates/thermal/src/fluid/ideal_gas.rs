//! The ideal gas, `p = rho R T`: no residual part. The heat capacity stays that of the reference equation's ideal part.
use super::Real;
use super::derivatives::Reduced;
use super::helmholtz::HelmholtzEnergy;

/// The ideal gas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct IdealGas;

impl HelmholtzEnergy for IdealGas {
    fn residual<D: Real>(&self, _density_kg_m3: D, _temperature_k: D) -> Reduced<D> {
        Reduced::zero()
    }
}
