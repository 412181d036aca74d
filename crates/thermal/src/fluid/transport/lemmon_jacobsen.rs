//! Viscosity and thermal conductivity in the form of Lemmon and Jacobsen (2004); the coefficients stand with those of the fluid's equation of state.
//!
//! With `tau = Tc/T`, `delta = rho/rhoc`, `T* = T k/epsilon`:
//!
//! - `eta_0 = 0.0266958 sqrt(M T) / (sigma² Omega)`, µPa s, `ln Omega = sum_i b_i (ln T*)^i`;
//! - `lambda_0 = N_1 eta_0 + sum_i N_i tau^(t_i)`, mW/(m K);
//! - both residuals `sum_i N_i tau^(t_i) delta^(d_i) exp(-gamma_i delta^(l_i))`, `gamma_i = 1` if `l_i > 0`
//!   else 0.
//!
//! # Validity
//!
//! All liquid and vapour states. The source states an uncertainty generally within 2 % for nitrogen and argon
//! and within 5 % for air, more in the critical region.
//!
//! # References
//!
//! Int. J. Thermophys. 25 (2004) 21, doi 10.1023/B:IJOT.0000022327.04529.f3.
use super::OlchowySengers;
use crate::fluid::Real;

/// Coefficients `b_i` of the collision integral, shared by all fluids.
const COLLISION: [f64; 5] = [0.431, -0.4623, 0.08406, 0.005341, -0.00331];
/// Chapman-Enskog constant, µPa s nm² / sqrt(K kg/kmol).
const CHAPMAN_ENSKOG: f64 = 0.026_695_8;

/// One residual term `n tau^t delta^d exp(-delta^l)`, the exponential only for `l > 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Term {
    /// Factor, µPa s or mW/(m K).
    pub n: f64,
    /// Exponent of `tau`.
    pub t: f64,
    /// Exponent of `delta`.
    pub d: u32,
    /// Exponent of `delta` within the exponential, at most 4; zero for none.
    pub l: usize,
}

impl Term {
    /// A term in the order of the source's tables.
    pub(crate) const fn new(n: f64, t: f64, d: u32, l: usize) -> Self {
        Self { n, t, d, l }
    }
}

/// Constants and coefficients of one fluid, in the units of the source.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LemmonJacobsenData {
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
    pub(crate) fn viscosity_pa_s<D: Real>(&self, rho: D, t: D) -> D {
        let delta = rho / self.reducing_density_kg_m3;
        (self.dilute_viscosity(t) + residual(self.viscosity, delta, self.ln_tau(t))) * 1e-6
    }

    /// Thermal conductivity without the critical enhancement, W/(m K).
    pub(crate) fn conductivity_w_m_k<D: Real>(&self, rho: D, t: D) -> D {
        let ln_tau = self.ln_tau(t);
        let delta = rho / self.reducing_density_kg_m3;
        let mut sum = self.dilute_viscosity(t) * self.dilute_from_viscosity;
        for &[n, exponent] in self.dilute {
            sum += (ln_tau * exponent).exp() * n;
        }
        (sum + residual(self.conductivity, delta, ln_tau)) * 1e-3
    }

    /// `eta_0`, µPa s.
    fn dilute_viscosity<D: Real>(&self, t: D) -> D {
        let x = (t / self.epsilon_over_k_k).ln();
        let [b0, b1, b2, b3, b4] = COLLISION;
        let ln_omega = (((x * b4 + b3) * x + b2) * x + b1) * x + b0;
        let amplitude = CHAPMAN_ENSKOG / (self.sigma_nm * self.sigma_nm);
        (t * self.molar_mass_g_mol).sqrt() * (-ln_omega).exp() * amplitude
    }

    fn ln_tau<D: Real>(&self, t: D) -> D {
        -(t / self.reducing_temperature_k).ln()
    }
}

/// Sum of the terms, with one exponential each.
fn residual<D: Real>(terms: &[Term], delta: D, ln_tau: D) -> D {
    let square = delta * delta;
    let powers = [delta, square, square * delta, square * square];
    let mut sum = D::from(0.0);
    for term in terms {
        let power = integer_power(delta, term.d);
        sum += match (term.l, term.t == 0.0) {
            (0, true) => power * term.n,
            (0, false) => (ln_tau * term.t).exp() * power * term.n,
            (l, _) => (ln_tau * term.t - powers[l - 1]).exp() * power * term.n,
        };
    }
    sum
}

/// `x^n` by squaring; the exponent of the library's `powi` is not known at compile time and costs a call.
fn integer_power<D: Real>(x: D, n: u32) -> D {
    let (mut power, mut square, mut n) = (D::from(1.0), x, n);
    while n > 0 {
        if n & 1 == 1 {
            power *= square;
        }
        square *= square;
        n >>= 1;
    }
    power
}
