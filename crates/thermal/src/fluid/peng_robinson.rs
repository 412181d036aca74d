//! Peng-Robinson (1976), the cubic equation that an engineer would otherwise take, as a reduced Helmholtz energy.
//!
//! `p = R T / (v - b) - a(T) / (v^2 + 2 b v - b^2)` integrates to `alphar = -ln(1 - b rho) - A F(b rho)` with `A = a(T) / (b R T)`,
//! `F(B) = ln[(1 + (1+sqrt 2) B) / (1 + (1-sqrt 2) B)] / (2 sqrt 2)`; `a(T) = a_c [1 + kappa (1 - sqrt(T/T_c))]^2`.
//! Its ideal part is the reference equation's. Source: Peng and Robinson, Ind. Eng. Chem. Fundam. 15 (1976) 59.
use core::f64::consts::SQRT_2;

use super::Real;
use super::data::terms::FluidData;
use super::derivatives::Reduced;
use super::helmholtz::HelmholtzEnergy;

/// The Peng-Robinson equation of one fluid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PengRobinson {
    critical_temperature_k: f64,
    kappa: f64,
    /// Covolume, m³/kg.
    covolume_m3_kg: f64,
    /// `a_c / (b R)`, K.
    strength_k: f64,
}

/// `b p_c / (R T_c)` and `a_c p_c / (R T_c)^2` of the equation.
const COVOLUME: f64 = 0.077_796_073_903_888_46;
const STRENGTH: f64 = 0.457_235_528_921_382_2;
/// `kappa = K[0] + K[1] omega + K[2] omega^2`.
const K: [f64; 3] = [0.374_64, 1.542_26, -0.269_92];

fn kappa(acentric_factor: f64) -> f64 {
    K[0] + (K[1] + K[2] * acentric_factor) * acentric_factor
}

/// Critical point and acentric factor of the fluid that has the equation of a mixture.
pub(super) struct Equivalent {
    /// Critical temperature, K.
    pub temperature_k: f64,
    /// Critical pressure, Pa.
    pub pressure_pa: f64,
    /// Acentric factor.
    pub acentric_factor: f64,
}

/// Of a mixture by the van der Waals rules `b = sum x_i b_i`, `sqrt a = sum x_i sqrt a_i` (`k_ij = 0`): `sqrt a` is linear in `sqrt T` for each
/// component and so for the mixture, which is the form of a pure fluid.
pub(super) fn equivalent(components: &[(&FluidData, f64)], gas_constant_j_mol_k: f64) -> Equivalent {
    let r = gas_constant_j_mol_k;
    // sqrt a = constant - slope sqrt T
    let (mut covolume, mut constant, mut slope) = (0.0, 0.0, 0.0);
    for (data, x) in components {
        let (t, p) = (data.critical_temperature_k, data.critical_pressure_pa);
        let (root, kappa) = (libm::sqrt(STRENGTH) * r * t / libm::sqrt(p), kappa(data.acentric_factor));
        covolume += x * COVOLUME * r * t / p;
        constant += x * root * (1.0 + kappa);
        slope += x * root * kappa / libm::sqrt(t);
    }
    // At the critical temperature a_c = STRENGTH / COVOLUME b R T_c.
    let root_t = constant / (slope + libm::sqrt(STRENGTH / COVOLUME * covolume * r));
    let kappa = slope * root_t / (constant - slope * root_t);
    Equivalent {
        temperature_k: root_t * root_t,
        pressure_pa: COVOLUME * r * root_t * root_t / covolume,
        acentric_factor: (-K[1] + libm::sqrt(K[1] * K[1] - 4.0 * K[2] * (K[0] - kappa))) / (2.0 * K[2]),
    }
}

impl PengRobinson {
    /// From critical point and acentric factor.
    pub(super) fn new(data: &FluidData) -> Self {
        let b =
            COVOLUME * data.gas_constant_j_mol_k * data.critical_temperature_k / data.critical_pressure_pa;
        Self {
            critical_temperature_k: data.critical_temperature_k,
            kappa: kappa(data.acentric_factor),
            covolume_m3_kg: b / data.molar_mass_kg_mol,
            strength_k: STRENGTH / COVOLUME * data.critical_temperature_k,
        }
    }

    /// Density that the equation cannot exceed, kg/m³.
    pub(super) fn densest_kg_m3(&self) -> f64 {
        1.0 / self.covolume_m3_kg
    }
}

impl HelmholtzEnergy for PengRobinson {
    fn residual<D: Real>(&self, density_kg_m3: D, temperature_k: D) -> Reduced<D> {
        let b = density_kg_m3 * self.covolume_m3_kg;
        let free = -b + 1.0;
        let quadratic = -(b * b) + b * 2.0 + 1.0;
        let f = ((b * (1.0 + SQRT_2) + 1.0) / (b * (1.0 - SQRT_2) + 1.0)).ln() / (2.0 * SQRT_2);
        let (f1, f2) = (b / quadratic, -(b * b) * (-b * 2.0 + 2.0) / (quadratic * quadratic));
        // alpha(T) and T d/dT, (T d/dT)^2 of it; then the same of A = strength alpha / T.
        let s = (temperature_k / self.critical_temperature_k).sqrt();
        let k = self.kappa;
        let root = s * (-k) + (1.0 + k);
        let alpha = root * root;
        let alpha1 = s * root * (-k);
        let alpha2 = s * (s * (2.0 * k * k) - k * (1.0 + k)) * 0.5;
        let strength = temperature_k.recip() * self.strength_k;
        let a0 = strength * alpha;
        let a1 = strength * (alpha1 - alpha);
        let a2 = strength * (alpha2 - alpha1 * 2.0 + alpha);
        let ratio = b / free;
        Reduced {
            a: -(free.ln()) - a0 * f,
            d: ratio - a0 * f1,
            t: a1 * f,
            dd: ratio * ratio - a0 * f2,
            dt: a1 * f1,
            tt: -(a2 + a1) * f,
        }
    }
}
