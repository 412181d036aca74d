//! Viscosity and thermal conductivity of helium-4.
//!
//! Viscosity, µg/(cm s), with `x = ln min(T, 300 K)` and `rho` in g/cm³:
//! `eta = exp(f + B rho + C rho² + D rho³)` up to 100 K; above 110 K
//! `eta = 196 T^0.71938 exp(12.451/T - 295.67/T² - 4.1249) + exp(f) [exp(B rho + C rho² + D rho³) - 1]`;
//! `f`, `B`, `C`, `D` are `p_0/x + p_1 + p_2 x + p_3 x² + p_4 x³`. Between 100 and 110 K the dilute part goes
//! linearly from one to the other, as NIST's programs do; CoolProp 8.0.0 switches at 100 K, a step of 2 %.
//! At 300 K the derivative along temperature steps, where `x` is held.
//!
//! Conductivity, W/(m K), with `rho` in kg/m³, `s = T^(1/3)`:
//! `lambda_0 = 2.7870034e-3 T^0.7034007057 exp(sum_i C_i T^(-i))`,
//! `lambda_r = (n_0 + n_1 T + n_2 s + n_3 s²) rho + (n_4 + n_5 s + n_6 s²) rho³`
//! `  + (n_7 + n_8 s + n_9 s² + n_10/T) rho² ln(rho/68)` (eqs. 3 and 17 there).
//!
//! # Validity
//!
//! Viscosity from 3.5 K on, up to 1500 K after the title of the source; the dense part knows temperature only up
//! to 300 K. Conductivity from 3.5 K on as given here. Tested from 5.3 to 400 K and to 500 bar.
//!
//! # References
//!
//! Arp, McCarty, Friend, NIST Technical Note 1334 (1998), doi 10.6028/NIST.TN.1334. Hands and Arp, Cryogenics 21
//! (1981) 697, doi 10.1016/0011-2275(81)90211-3. Coefficients as in NIST's and CoolProp's programs.
pub(super) mod critical;

use crate::fluid::Real;

/// µg/(cm s), the unit of the source, in Pa s.
const MICROPOISE_PA_S: f64 = 1e-7;
/// Temperatures between which the dilute viscosity goes from the cold to the warm correlation, K.
const COLD_K: f64 = 100.0;
const WARM_K: f64 = 110.0;
/// Temperature from which on the logarithm within the dense part is held, K.
const HELD_K: f64 = 300.0;
/// Cold dilute viscosity, its logarithm.
const F: [f64; 5] = [-0.135_311_743, 1.003_478_41, 1.206_546_49, -0.149_564_551, 0.012_520_841_6];
/// Dense part of the viscosity, first to third order in density.
const B: [f64; 5] = [-47.529_525_9, 87.679_930_9, -42.074_158_9, 8.331_282_89, -0.589_252_385];
const C: [f64; 5] = [547.309_267, -904.870_586, 431.404_928, -81.450_485_4, 5.370_084_33];
const D: [f64; 5] = [-1_684.393_24, 3_331.086_30, -1_632.191_72, 308.804_413, -20.293_636_7];

/// Dilute conductivity: factor, exponent of `T`, `C_i`.
const DILUTE_FACTOR: f64 = 2.787_003_4e-3;
const DILUTE_EXPONENT: f64 = 0.703_400_705_7;
const DILUTE: [f64; 4] = [3.739_232_544, -26.203_169_69, 59.822_522_46, -49.263_976_34];
/// `n_0` to `n_10` of the residual conductivity.
const N: [f64; 11] = [
    1.862_970_530e-4,
    -7.275_964_435e-7,
    -1.427_549_651e-4,
    3.290_833_592e-5,
    -5.213_335_363e-8,
    4.492_659_933e-8,
    -5.924_416_513e-9,
    7.087_321_137e-6,
    -6.013_335_678e-6,
    8.067_145_814e-7,
    3.995_125_013e-7,
];
/// Density within the logarithm, kg/m³.
const RHO_LOG_KG_M3: f64 = 68.0;

/// Viscosity, Pa s.
pub(super) fn viscosity_pa_s<R: Real>(rho: R, t: R) -> R {
    let ln_t = t.ln();
    let x = if t.re() < HELD_K { ln_t } else { R::from(libm::log(HELD_K)) };
    let inverse = x.recip();
    let series = |p: &[f64; 5]| inverse * p[0] + ((x * p[4] + p[3]) * x + p[2]) * x + p[1];
    let dense = rho * 1e-3;
    let exponent = ((dense * series(&D) + series(&C)) * dense + series(&B)) * dense;
    let cold = series(&F).exp();
    (dilute_viscosity(t, ln_t, cold) + cold * exponent.exp_m1()) * MICROPOISE_PA_S
}

/// Dilute viscosity, µg/(cm s), given the cold correlation.
fn dilute_viscosity<R: Real>(t: R, ln_t: R, cold: R) -> R {
    if t.re() <= COLD_K {
        return cold;
    }
    let inverse = t.recip();
    let warm = (ln_t * 0.719_38 + (inverse * -295.67 + 12.451) * inverse - 4.1249).exp() * 196.0;
    if t.re() >= WARM_K { warm } else { cold + (warm - cold) * (t - COLD_K) / (WARM_K - COLD_K) }
}

/// Thermal conductivity without the critical enhancement, W/(m K).
pub(super) fn conductivity_w_m_k<R: Real>(rho: R, t: R) -> R {
    let inverse = t.recip();
    let series = DILUTE.iter().rev().fold(R::from(0.0), |sum, &c| (sum + c) * inverse);
    let dilute = (t.ln() * DILUTE_EXPONENT + series).exp() * DILUTE_FACTOR;
    // rho² ln rho and its first derivative vanish with the density; the logarithm alone does not exist there.
    if rho.re() <= 0.0 {
        return dilute + first_order(t) * rho;
    }
    let s = t.cbrt();
    let cubic = (s * N[6] + N[5]) * s + N[4];
    let logarithmic = (s * N[9] + N[8]) * s + N[7] + inverse * N[10];
    let order = logarithmic * (rho / RHO_LOG_KG_M3).ln();
    dilute + ((cubic * rho + order) * rho + first_order(t)) * rho
}

/// Factor of the density in the residual conductivity, W m²/(K kg).
fn first_order<R: Real>(t: R) -> R {
    let s = t.cbrt();
    (s * N[3] + N[2]) * s + t * N[1] + N[0]
}
