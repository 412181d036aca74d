//! Critical enhancement of the thermal conductivity: simplified crossover model of Olchowy and Sengers.
//!
//! `lambda_c = rho cp R0 k T / (6 pi eta xi) (Omega - Omega_0)` with `y = q_D xi`, `kappa = cv/cp`,
//! `Omega = 2/pi [(1 - kappa) atan y + kappa y]`, `Omega_0 = 2/pi [1 - exp(-1 / (1/y + y²/(3 delta²)))]`,
//! `xi = xi_0 (chi / Gamma)^(nu/gamma)`, `chi = pc rho / rhoc² [1/p_rho(rho, T) - Tref/T 1/p_rho(rho, Tref)]`,
//! `p_rho = (dp/drho)_T`.
//!
//! The enhancement is zero where `chi <= 0`, where the state is mechanically unstable, and from the reference
//! temperature on. There `chi` is negative anyway, except in dense gas far from the critical point, where it turns
//! positive again and CoolProp adds up to 0.06 % (nitrogen, argon, air, beyond 1000 bar) or 0.3 % (hydrogen,
//! at 500 bar and more, below 200 K).
//!
//! Towards the reference temperature it falls like `chi^(nu/gamma)`, almost a square root: the value is continuous
//! there, its derivative is not bounded. 1 K under the reference temperature it is at most 0.3 % of the
//! conductivity of nitrogen, argon and air up to 500 bar, 20 K under it 1.4 %.
//!
//! Source: Olchowy and Sengers, Int. J. Thermophys. 10 (1989) 417, doi 10.1007/BF01133538, as simplified by
//! Lemmon and Jacobsen, Int. J. Thermophys. 25 (2004) 21, doi 10.1023/B:IJOT.0000022327.04529.f3.
use core::f64::consts::PI;

use super::TransportState;
use crate::fluid::Real;

/// Boltzmann constant of the source's time, J/K (CODATA 2010; the SI of 2019 differs by 1e-7).
const BOLTZMANN_J_K: f64 = 1.380_648_8e-23;
/// Critical exponent `nu` of the correlation length.
const NU: f64 = 0.63;
/// `chi` below which the enhancement is taken as zero: rounding of the difference.
const CHI_ZERO: f64 = 10.0 * f64::EPSILON;

/// Fluid constants of the crossover model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OlchowySengers {
    /// Amplitude of the correlation length `xi_0`, m.
    pub xi_0_m: f64,
    /// Amplitude of the susceptibility `Gamma`.
    pub amplitude: f64,
    /// Universal amplitude `R0`.
    pub strength: f64,
    /// Critical exponent `gamma` of the susceptibility.
    pub gamma: f64,
    /// Cut-off wave number `q_D`, 1/m.
    pub cutoff_per_m: f64,
    /// Reference temperature `Tref`, K.
    pub reference_temperature_k: f64,
    /// Critical pressure, Pa.
    pub critical_pressure_pa: f64,
    /// Critical density, kg/m³.
    pub critical_density_kg_m3: f64,
}

impl OlchowySengers {
    /// Enhancement, W/(m K); `viscosity` in Pa s, `dp_drho_reference` in Pa m³/kg at the reference temperature.
    pub(crate) fn conductivity_w_m_k<D: Real>(
        &self,
        state: &TransportState<D>,
        viscosity: D,
        dp_drho_reference: D,
    ) -> D {
        let (rho, t, p_rho) = (state.density_kg_m3, state.temperature_k, state.dp_drho_pa_m3_kg);
        let rhoc = self.critical_density_kg_m3;
        if p_rho.re() <= 0.0 || t.re() >= self.reference_temperature_k {
            return D::from(0.0);
        }
        let reference = (t * dp_drho_reference).recip() * self.reference_temperature_k;
        let chi = rho * (p_rho.recip() - reference) * (self.critical_pressure_pa / (rhoc * rhoc));
        if chi.re() < CHI_ZERO {
            return D::from(0.0);
        }
        let xi = (chi / self.amplitude).powf(NU / self.gamma) * self.xi_0_m;
        let y = xi * self.cutoff_per_m;
        let delta = rho / rhoc;
        let kappa = state.cv_j_kg_k / state.cp_j_kg_k;
        let omega = (-kappa + 1.0) * y.atan() + kappa * y;
        let omega_0 = -(-(y.recip() + y * y / (delta * delta * 3.0)).recip()).exp_m1();
        rho * state.cp_j_kg_k * t * (omega - omega_0) / (viscosity * xi)
            * (self.strength * BOLTZMANN_J_K / (3.0 * PI * PI))
    }
}
