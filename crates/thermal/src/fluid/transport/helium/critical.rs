//! Critical enhancement of the thermal conductivity of helium-4, between 3.5 and 12 K.
//!
//! `lambda_c = m K^(1/2) T² (dp/dT)² / (rho eta) exp(-18.66 dT² - 4.25 drho⁴)`, `dT = |1 - T/Tc|`,
//! `drho = |1 - rho/rhoc|`, `(dp/dT)² = (cp - cv) rho² (dp/drho)_T / T`. The compressibility `K` is that of the
//! equation of state, `K_T = 1/(rho (dp/drho)_T)`, blended within `W = (dT/0.2)² + (drho/0.25)² < 1` with that of
//! the scaling law, `K = W K_T + (1 - W) K'`:
//! `1/K' = pc (rho/rhoc)² drho^(delta-1) (delta h - x/beta dh/dx)`, `x = (dT/drho)^(1/beta)`, `u = 1 + x/x0`,
//! `h = E1 u [1 + E2 u^(2/beta)]^((gamma-1)/(2 beta))`.
//!
//! The factor `m` is the one NIST's and CoolProp's programs use; the printed equation gives other values.
//! No state of a gas cylinder comes here; the part is kept so that the correlation is whole.
//!
//! Source: Hands and Arp, Cryogenics 21 (1981) 697, doi 10.1016/0011-2275(81)90211-3, section on the critical
//! region.
use crate::fluid::Real;
use crate::fluid::transport::TransportState;

/// Range of temperature, K.
const FROM_K: f64 = 3.5;
const TO_K: f64 = 12.0;
/// Critical point of the scaling law: K, kg/m³, Pa.
const TC_K: f64 = 5.189_92;
const RHOC_KG_M3: f64 = 69.158;
const PC_PA: f64 = 2.2746e5;
/// Constants of the scaling law.
const X0: f64 = 0.392;
const E1: f64 = 2.8461;
const E2: f64 = 0.271_56;
const BETA: f64 = 0.3554;
const GAMMA: f64 = 1.1743;
const DELTA: f64 = 4.304;
/// Exponent of the bracket of `h`.
const M: f64 = (GAMMA - 1.0) / (2.0 * BETA);
/// Factor `m`, of the dimension that makes the enhancement W/(m K).
const FACTOR: f64 = 3.468_523_3e-17 * 3.726_229_668;
/// Smallest distance from the critical temperature and density: powers of zero have no derivative.
const CRITICAL_DISTANCE_FLOOR: f64 = 1e-9;

/// Enhancement, W/(m K); `viscosity` in Pa s.
pub(crate) fn conductivity_w_m_k<R: Real>(state: &TransportState<R>, viscosity: R) -> R {
    let (rho, t, p_rho) = (state.density_kg_m3, state.temperature_k, state.dp_drho_pa_m3_kg);
    if t.re() <= FROM_K || t.re() >= TO_K || rho.re() <= 0.0 || p_rho.re() <= 0.0 {
        return R::from(0.0);
    }
    let d_t = distance(t / TC_K);
    let d_rho = distance(rho / RHOC_KG_M3);
    let compressibility = blended_compressibility(rho, p_rho, d_t, d_rho);
    let pressure_slope_squared = (state.cp_j_kg_k - state.cv_j_kg_k) * rho * rho * p_rho / t;
    let damping = (d_t * d_t * -18.66 - d_rho.powi(4) * 4.25).exp();
    compressibility.sqrt() * t * t / (rho * viscosity) * pressure_slope_squared * damping * FACTOR
}

/// `|1 - r|`, at least [`SMALLEST`].
fn distance<R: Real>(r: R) -> R {
    let distance = (-r + 1.0).abs();
    if distance.re() < CRITICAL_DISTANCE_FLOOR { R::from(CRITICAL_DISTANCE_FLOOR) } else { distance }
}

/// `K`, 1/Pa.
fn blended_compressibility<R: Real>(rho: R, p_rho: R, d_t: R, d_rho: R) -> R {
    let of_state = (rho * p_rho).recip();
    let w = (d_t / 0.2).powi(2) + (d_rho / 0.25).powi(2);
    if w.re() > 1.0 {
        return of_state;
    }
    let x = (d_t / d_rho).powf(1.0 / BETA);
    let u = x / X0 + 1.0;
    let power = u.powf(2.0 / BETA) * E2;
    let bracket = power + 1.0;
    let scale = bracket.powf(M) * E1;
    let h = scale * u;
    let dh_dx = scale * (power / bracket * (2.0 * M / BETA) + 1.0) / X0;
    let slope = d_rho.powf(DELTA - 1.0) * (h * DELTA - x * dh_dx / BETA);
    let of_scaling = (slope * (rho / RHOC_KG_M3).powi(2) * PC_PA).recip();
    w * of_state + (-w + 1.0) * of_scaling
}
