//! Thermodynamic properties of a state, all from one Helmholtz energy.
//!
//! With `alpha = alpha0 + alphar` and the scaled derivatives of [`super::helmholtz::Reduced`] (Span, Multiparameter
//! Equations of State, 2000, table 3.10): `p = rho R T (1 + alphar_d)`, `u = R T (alpha_t)`, `s = R (alpha_t - alpha)`,
//! `cv = -R alpha_tt`, `(dp/drho)_T = R T (1 + 2 alphar_d + alphar_dd)`, `(dp/dT)_rho = rho R (1 + alphar_d - alphar_dt)`,
//! `cp = cv + T (dp/dT)^2 / (rho^2 dp/drho)`, `w^2 = cp/cv dp/drho`, `beta = (dp/dT) / (rho dp/drho)`.
use super::Real;
use super::derivatives::Reduced;

/// A state; `D` is `f64` or a dual number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<D = f64> {
    /// Temperature, K.
    pub temperature_k: D,
    /// Density, kg/m³.
    pub density_kg_m3: D,
    /// Pressure, Pa.
    pub pressure_pa: D,
    /// Specific internal energy, J/kg (reference state of the equation's source).
    pub internal_energy_j_kg: D,
    /// Specific enthalpy, J/kg.
    pub enthalpy_j_kg: D,
    /// Specific entropy, J/(kg K).
    pub entropy_j_kg_k: D,
    /// Isochoric heat capacity, J/(kg K).
    pub cv_j_kg_k: D,
    /// Isobaric heat capacity, J/(kg K).
    pub cp_j_kg_k: D,
    /// Speed of sound, m/s.
    pub sound_speed_m_s: D,
    /// `(dp/dT)_rho`, Pa/K.
    pub dp_dt_pa_k: D,
    /// `(dp/drho)_T`, Pa m³/kg.
    pub dp_drho_pa_m3_kg: D,
    /// Compressibility factor `p / (rho R T)`.
    pub compressibility: D,
    /// Isobaric expansion coefficient, 1/K.
    pub expansion_per_k: D,
}

impl<D: Real> State<D> {
    /// From the ideal and the residual part.
    pub(super) fn from_reduced(
        gas_constant_j_kg_k: f64,
        density_kg_m3: D,
        temperature_k: D,
        ideal: &Reduced<D>,
        residual: &Reduced<D>,
    ) -> Self {
        let r = gas_constant_j_kg_k;
        let (rho, t) = (density_kg_m3, temperature_k);
        let rt = t * r;
        let compressibility = residual.d + 1.0;
        let pressure_pa = rho * rt * compressibility;
        let dp_drho = rt * (residual.d * 2.0 + residual.dd + 1.0);
        let dp_dt = rho * r * (residual.d - residual.dt + 1.0);
        let energy = ideal.t + residual.t;
        let internal_energy_j_kg = rt * energy;
        let cv = (ideal.tt + residual.tt) * (-r);
        let expansion_per_k = dp_dt / (rho * dp_drho);
        let cp = cv + t * dp_dt * expansion_per_k / rho;
        Self {
            temperature_k: t,
            density_kg_m3: rho,
            pressure_pa,
            internal_energy_j_kg,
            enthalpy_j_kg: internal_energy_j_kg + rt * compressibility,
            entropy_j_kg_k: (energy - ideal.a - residual.a) * r,
            cv_j_kg_k: cv,
            cp_j_kg_k: cp,
            sound_speed_m_s: (dp_drho * cp / cv).sqrt(),
            dp_dt_pa_k: dp_dt,
            dp_drho_pa_m3_kg: dp_drho,
            compressibility,
            expansion_per_k,
        }
    }
}
