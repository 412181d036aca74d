//! Viscosity and thermal conductivity of normal hydrogen.
//!
//! Viscosity, with `T* = T k/epsilon`, `Tr = T/Tc`, `rho_r = rho/rho_sc`:
//! `eta = eta_0 (1 + B_eta rho/M) + c_1 rho_r² exp[c_2 Tr + c_3/Tr + c_4 rho_r²/(c_5 + Tr) + c_6 rho_r⁶]`,
//! `eta_0 = 0.021357 sqrt(M T) / (sigma² S*)`, µPa s, `ln S* = sum_i a_i (ln T*)^i`,
//! `B_eta = N_A sigma³ sum_i b_i T*^(-i)`.
//!
//! Conductivity, with `delta = rho/rhoc`: `lambda_0 = sum_i A_i Tr^i / sum_i B_i Tr^i`,
//! `lambda_r = sum_i (B_1i + B_2i Tr) delta^i`, enhancement of Olchowy and Sengers.
//!
//! # Validity
//!
//! Viscosity: triple point to 1000 K, to 200 MPa; 4 % (0.1 % for 200 to 400 K up to 0.1 MPa). Conductivity:
//! triple point to 1000 K, to 100 MPa. The critical part of the viscosity is left out, as in the source.
//!
//! # References
//!
//! Muzny, Huber, Kazakov, J. Chem. Eng. Data 58 (2013) 969, doi 10.1021/je301273j; the reducing density is
//! 1/0.011 = 90.909 kg/m³ (NIST's and CoolProp's value), for which 90.5 is printed in places. Assael, Assael,
//! Huber, Perkins, Takata, J. Phys. Chem. Ref. Data 40 (2011) 033101, doi 10.1063/1.3606499.
use super::OlchowySengers;
use crate::fluid::Real;

/// Molar mass, g/mol.
const MOLAR_MASS_G_MOL: f64 = 2.015_88;
/// Lennard-Jones energy, K, and length, nm.
const EPSILON_OVER_K_K: f64 = 30.41;
const SIGMA_NM: f64 = 0.297;
/// Critical temperature, K, and density as the conductivity is reduced by it, kg/m³.
const TC_K: f64 = 33.145;
const RHOC_KG_M3: f64 = 31.262;
/// Chapman-Enskog constant with the cross section `S*`, µPa s nm² / sqrt(K kg/kmol).
const CHAPMAN_ENSKOG: f64 = 0.021_357;
/// Avogadro constant, 1/mol, times m³/nm³ (CODATA 2010).
const AVOGADRO_NM3: f64 = 6.022_141_29e23 * 1e-27;
/// Reducing density of the viscosity, kg/m³.
const RHO_SC_KG_M3: f64 = 1.0 / 0.011;

/// `a_i`: logarithm of the cross section.
const A: [f64; 5] = [0.209_63, -0.455_274, 0.143_602, -0.033_532_5, 0.002_769_81];
/// `b_i`: second viscosity virial coefficient.
const B: [f64; 7] = [-0.187, 2.4871, 3.7151, -11.0972, 9.0965, -3.8292, 0.5166];
/// `c_1` (µPa s) to `c_6`: higher densities.
const C: [f64; 6] =
    [6.434_496_73, 0.045_633_406_8, 0.232_797_868, 0.958_326_12, 0.127_941_189, 0.363_576_595];

/// Numerator (W/(m K)) and denominator of the dilute conductivity, powers of `Tr` ascending.
const DILUTE_NUMERATOR: [f64; 7] =
    [-0.340_976, 4.5882, -1.4508, 0.326_394, 0.003_169_39, 0.000_190_592, -1.139e-6];
const DILUTE_DENOMINATOR: [f64; 4] = [138.497, -22.1878, 4.57151, 1.0];
/// `[B_1i, B_2i]` of the residual conductivity, W/(m K), for `i` from 1.
const RESIDUAL: [[f64; 2]; 5] = [
    [0.036_308_1, 0.001_833_7],
    [-0.020_762_9, -0.008_867_16],
    [0.031_481, 0.015_826],
    [-0.014_309_7, -0.010_628_3],
    [0.001_749_8, 0.002_806_73],
];

/// Critical enhancement of the conductivity; the reference temperature is 1.5 critical ones.
pub(super) const CRITICAL: OlchowySengers = OlchowySengers {
    xi_0_m: 0.15e-9,
    amplitude: 0.052,
    strength: 1.01,
    gamma: 1.2415,
    cutoff_per_m: 1.0 / 0.4e-9,
    reference_temperature_k: 1.5 * TC_K,
    critical_pressure_pa: 1.2964e6,
    critical_density_kg_m3: 15_508.0 * 2.015_88e-3,
};

/// Viscosity, Pa s.
pub(super) fn viscosity_pa_s<D: Real>(rho: D, t: D) -> D {
    let reduced = t / EPSILON_OVER_K_K;
    let cross_section = polynomial(&A, reduced.ln()).exp();
    let dilute = (t * MOLAR_MASS_G_MOL).sqrt() / cross_section * (CHAPMAN_ENSKOG / (SIGMA_NM * SIGMA_NM));
    let virial = polynomial(&B, reduced.recip()) * (AVOGADRO_NM3 * SIGMA_NM * SIGMA_NM * SIGMA_NM);
    let molar = rho * (1e3 / MOLAR_MASS_G_MOL);
    (dilute * (virial * molar + 1.0) + dense_viscosity(rho, t)) * 1e-6
}

/// Part of the viscosity beyond the first order in density, µPa s.
fn dense_viscosity<D: Real>(rho: D, t: D) -> D {
    let tr = t / TC_K;
    let square = (rho / RHO_SC_KG_M3).powi(2);
    let exponent =
        tr * C[1] + tr.recip() * C[2] + square / (tr + C[4]) * C[3] + square * square * square * C[5];
    square * exponent.exp() * C[0]
}

/// Thermal conductivity without the critical enhancement, W/(m K).
pub(super) fn conductivity_w_m_k<D: Real>(rho: D, t: D) -> D {
    let tr = t / TC_K;
    let delta = rho / RHOC_KG_M3;
    let mut residual = D::from(0.0);
    for &[constant, slope] in RESIDUAL.iter().rev() {
        residual = (residual + tr * slope + constant) * delta;
    }
    polynomial(&DILUTE_NUMERATOR, tr) / polynomial(&DILUTE_DENOMINATOR, tr) + residual
}

/// Polynomial with coefficients ascending.
fn polynomial<D: Real>(coefficients: &[f64], x: D) -> D {
    coefficients.iter().rev().fold(D::from(0.0), |sum, &c| sum * x + c)
}
