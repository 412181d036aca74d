//! Viscosity and thermal conductivity of carbon dioxide.
//!
//! Viscosity, with `T* = T k/epsilon`, `Tr = T/T_t`, `rho_r = rho/rho_tL`:
//! `eta = eta_0 (1 + B_eta rho/M) + eta_tL [c_1 Tr rho_r³ + (rho_r² + rho_r^gamma) / (Tr - c_2)]`,
//! `eta_0 = 1.0055 sqrt(T) / [a_0 + a_1 T^(1/6) + a_2 exp(a_3 T^(1/3)) + (a_4 + a_5 T^(1/3)) exp(-T^(1/3)) + a_6 sqrt(T)]`,
//! mPa s, `B_eta = N_A sigma³ sum_i b_i T*^(-t_i)`, `eta_tL = rho_tL^(2/3) sqrt(R T_t) / (M^(1/6) N_A^(1/3))`.
//!
//! Conductivity, with `Tr = T/Tc`, `delta = rho/rhoc`: `lambda_0 = sqrt(Tr) / sum_k L_k Tr^(-k)`, mW/(m K),
//! `lambda_r = sum_i (B_1i + B_2i Tr) delta^i`, enhancement of Olchowy and Sengers.
//!
//! # Validity
//!
//! Viscosity: 100 to 2000 K for the dilute gas (0.2 % from room temperature to 700 K), to 8000 MPa; up to 4 %
//! in the dense fluid. Conductivity: triple point to 1100 K, to 200 MPa; 3 % in the gas and supercritical, 5 % near the
//! critical temperature.
//!
//! # References
//!
//! Laesecke, Muzny, J. Phys. Chem. Ref. Data 46 (2017) 013107, doi 10.1063/1.4977429. Huber, Sykioti, Assael,
//! Perkins, J. Phys. Chem. Ref. Data 45 (2016) 013102, doi 10.1063/1.4940892.
use super::OlchowySengers;
use crate::fluid::Real;

/// Molar mass, kg/mol, gas constant, J/(mol K), and triple temperature, K, of the equation of state.
const MOLAR_MASS_KG_MOL: f64 = 0.044_009_8;
const GAS_CONSTANT_J_MOL_K: f64 = 8.31451;
const TRIPLE_K: f64 = 216.592;
/// Critical temperature, K, and density, kg/m³.
const TC_K: f64 = 304.1282;
const RHOC_KG_M3: f64 = 467.6;
/// Density of the liquid at the triple point, kg/m³.
const TRIPLE_LIQUID_KG_M3: f64 = 1178.53;
/// Energy, K, and length, m, of the second viscosity virial coefficient.
const EPSILON_OVER_K_K: f64 = 200.76;
const SIGMA_M: f64 = 0.378_421e-9;
/// Avogadro constant, 1/mol (CODATA 2010), and its cube root.
const AVOGADRO: f64 = 6.022_141_29e23;
const ROOT_AVOGADRO: f64 = 84_446_887.435_799_45;

/// `a_i`: dilute viscosity.
const A: [f64; 7] = [
    1_749.354_893_188_35,
    -369.069_300_007_128,
    5_423_856.348_876_91,
    -2.212_838_521_683_56,
    -269_503.247_933_569,
    73_145.021_531_826,
    5.343_686_495_092_78,
];
/// `(b_i, t_i)`: second viscosity virial coefficient.
const B: [(f64, f64); 9] = [
    (-19.572881, 0.0),
    (219.73999, 0.25),
    (-1015.3226, 0.5),
    (2471.0125, 0.75),
    (-3375.1717, 1.0),
    (2491.6597, 1.25),
    (-787.26086, 1.5),
    (14.085455, 2.5),
    (-0.34664158, 5.5),
];
/// `c_1`, `c_2` and `gamma`: higher densities.
const C: [f64; 2] = [0.360_603_235_428_487, 0.121_550_806_591_497];
const GAMMA: f64 = 8.062_827_374_812_77;

/// `L_k`: dilute conductivity, powers of `1/Tr` ascending.
const L: [f64; 4] = [0.015_187_430_7, 0.028_067_404_0, 0.022_856_419_0, -0.007_416_242_10];
/// `[B_1i, B_2i]` of the residual conductivity, W/(m K), for `i` from 1.
const RESIDUAL: [[f64; 2]; 6] = [
    [0.010_012_8, 0.004_308_29],
    [0.056_048_8, -0.035_856_3],
    [-0.081_162_0, 0.067_148_0],
    [0.062_433_7, -0.052_285_5],
    [-0.020_633_6, 0.017_457_1],
    [0.002_532_48, -0.001_964_14],
];

/// Critical enhancement of the conductivity; the reference temperature is 1.5 critical ones.
pub(super) const CRITICAL: OlchowySengers = OlchowySengers {
    xi_0_m: 1.5e-10,
    amplitude: 0.052,
    strength: 1.02,
    gamma: 1.239,
    cutoff_per_m: 1.0 / 4e-10,
    reference_temperature_k: 456.19,
    critical_pressure_pa: 7_377_300.0,
    critical_density_kg_m3: 10_624.906_3 * MOLAR_MASS_KG_MOL,
};

/// Viscosity, Pa s.
pub(super) fn viscosity_pa_s<D: Real>(rho: D, t: D) -> D {
    let ln_reduced = (t / EPSILON_OVER_K_K).ln();
    let mut virial = D::from(0.0);
    for (b, exponent) in B {
        virial += (ln_reduced * -exponent).exp() * b;
    }
    let first_order = virial * rho * (AVOGADRO * SIGMA_M * SIGMA_M * SIGMA_M / MOLAR_MASS_KG_MOL);
    dilute_viscosity(t) * (first_order + 1.0) + dense_viscosity(rho, t)
}

/// `eta_0`, Pa s.
fn dilute_viscosity<D: Real>(t: D) -> D {
    let root = t.cbrt();
    let sum = t.powf(1.0 / 6.0) * A[1]
        + (root * A[3]).exp() * A[2]
        + A[0]
        + (root * A[5] + A[4]) * (-root).exp()
        + t.sqrt() * A[6];
    t.sqrt() / sum * 1.0055e-3
}

/// Part of the viscosity beyond the first order in density, Pa s.
fn dense_viscosity<D: Real>(rho: D, t: D) -> D {
    let (tr, reduced) = (t / TRIPLE_K, rho / TRIPLE_LIQUID_KG_M3);
    let square = reduced * reduced;
    // In the dilute gas the logarithm of the power has no derivative.
    let high = if reduced.re() > 0.0 { reduced.powf(GAMMA) } else { D::from(0.0) };
    let scale = libm::pow(TRIPLE_LIQUID_KG_M3, 2.0 / 3.0) * libm::sqrt(GAS_CONSTANT_J_MOL_K * TRIPLE_K)
        / (libm::pow(MOLAR_MASS_KG_MOL, 1.0 / 6.0) * ROOT_AVOGADRO);
    (tr * square * reduced * C[0] + (square + high) / (tr - C[1])) * scale
}

/// Thermal conductivity without the critical enhancement, W/(m K).
pub(super) fn conductivity_w_m_k<D: Real>(rho: D, t: D) -> D {
    let (tr, delta) = (t / TC_K, rho / RHOC_KG_M3);
    let inverse = tr.recip();
    let sum = ((inverse * L[3] + L[2]) * inverse + L[1]) * inverse + L[0];
    let mut residual = D::from(0.0);
    for [constant, slope] in RESIDUAL.into_iter().rev() {
        residual = (residual + tr * slope + constant) * delta;
    }
    tr.sqrt() / sum * 1e-3 + residual
}
