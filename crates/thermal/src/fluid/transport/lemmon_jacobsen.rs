//! Viscosity and thermal conductivity of nitrogen, argon and air after Lemmon and Jacobsen (2004).
//!
//! With `tau = Tc/T`, `delta = rho/rhoc`, `T* = T k/epsilon`:
//!
//! - `eta_0 = 0.0266958 sqrt(M T) / (sigma² Omega)`, µPa s, `ln Omega = sum_i b_i (ln T*)^i` (eqs. 2, 3);
//! - `lambda_0 = N_1 eta_0 + sum_i N_i tau^(t_i)`, mW/(m K) (eq. 5);
//! - both residuals `sum_i N_i tau^(t_i) delta^(d_i) exp(-gamma_i delta^(l_i))`, `gamma_i = 1` if `l_i > 0`
//!   else 0 (eqs. 4, 6).
//!
//! # Validity
//!
//! Triple point to 2000 K and 2200 MPa for nitrogen, similar for argon and air; the source states 0.5 to 2 % in
//! the viscosity and 1 to 2 % in the conductivity of the gas up to about 100 MPa, 5 % outside.
//!
//! # References
//!
//! Int. J. Thermophys. 25 (2004) 21, doi 10.1023/B:IJOT.0000022327.04529.f3, tables I to V.
use super::OlchowySengers;
use crate::fluid::Real;

/// Coefficients `b_i` of the collision integral, shared by the three fluids (table II).
const COLLISION: [f64; 5] = [0.431, -0.4623, 0.08406, 0.005341, -0.00331];
/// Chapman-Enskog constant, µPa s nm² / sqrt(K kg/kmol).
const CHAPMAN_ENSKOG: f64 = 0.026_695_8;

/// One residual term `n tau^t delta^d exp(-delta^l)`, the exponential only for `l > 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Factor, µPa s or mW/(m K).
    pub n: f64,
    /// Exponent of `tau`.
    pub t: f64,
    /// Exponent of `delta`.
    pub d: i32,
    /// Exponent of `delta` within the exponential; zero for none.
    pub l: i32,
}

/// Constants and coefficients of one fluid, in the units of the source.
#[derive(Clone, Copy, Debug)]
pub struct LemmonJacobsenData {
    /// Molar mass within `eta_0`, g/mol.
    pub molar_mass_g_mol: f64,
    /// Lennard-Jones energy `epsilon/k`, K.
    pub epsilon_over_k_k: f64,
    /// Lennard-Jones length `sigma`, nm.
    pub sigma_nm: f64,
    /// Reducing temperature, K.
    pub reducing_temperature_k: f64,
    /// Reducing density, kg/m³.
    pub reducing_density_kg_m3: f64,
    /// Residual viscosity, µPa s.
    pub viscosity: &'static [Term],
    /// Factor `N_1` of `eta_0` in the dilute conductivity, (mW/(m K)) / (µPa s).
    pub dilute_from_viscosity: f64,
    /// `[N_i, t_i]` of the further terms of the dilute conductivity, mW/(m K).
    pub dilute: &'static [[f64; 2]],
    /// Residual conductivity, mW/(m K).
    pub conductivity: &'static [Term],
    /// Critical enhancement of the conductivity.
    pub critical: OlchowySengers,
}

impl LemmonJacobsenData {
    /// Viscosity, Pa s.
    pub fn viscosity_pa_s<D: Real>(&self, rho: D, t: D) -> D {
        let ln_t = t.ln();
        let delta = rho / self.reducing_density_kg_m3;
        (self.dilute_viscosity(t, ln_t) + residual(self.viscosity, delta, self.ln_tau(ln_t))) * 1e-6
    }

    /// Thermal conductivity without the critical enhancement, W/(m K).
    pub fn conductivity_w_m_k<D: Real>(&self, rho: D, t: D) -> D {
        let ln_t = t.ln();
        let ln_tau = self.ln_tau(ln_t);
        let delta = rho / self.reducing_density_kg_m3;
        let mut sum = self.dilute_viscosity(t, ln_t) * self.dilute_from_viscosity;
        for &[n, exponent] in self.dilute {
            sum += (ln_tau * exponent).exp() * n;
        }
        (sum + residual(self.conductivity, delta, ln_tau)) * 1e-3
    }

    /// `eta_0`, µPa s.
    fn dilute_viscosity<D: Real>(&self, t: D, ln_t: D) -> D {
        let x = ln_t - self.epsilon_over_k_k.ln();
        let mut ln_omega = D::from(0.0);
        for &b in COLLISION.iter().rev() {
            ln_omega = ln_omega * x + b;
        }
        let amplitude = CHAPMAN_ENSKOG / (self.sigma_nm * self.sigma_nm);
        (t * self.molar_mass_g_mol).sqrt() * (-ln_omega).exp() * amplitude
    }

    fn ln_tau<D: Real>(&self, ln_t: D) -> D {
        -ln_t + self.reducing_temperature_k.ln()
    }
}

/// Sum of the terms, with one exponential each.
fn residual<D: Real>(terms: &[Term], delta: D, ln_tau: D) -> D {
    let mut sum = D::from(0.0);
    for term in terms {
        let exponent = if term.l > 0 { ln_tau * term.t - delta.powi(term.l) } else { ln_tau * term.t };
        sum += exponent.exp() * delta.powi(term.d) * term.n;
    }
    sum
}
