//! Mass flux of a real gas through an orifice, choked or not.
//!
//! Isentropic nozzle from stagnation to throat: `G = rho sqrt(2 (h_0 - h))` along `s = s_0`.
//! Choked: the throat speed is the speed of sound, `2 (h_0 - h) = w^2`, which maximises `G`.
//! Subsonic: the throat has the back pressure. Near equal pressures `sqrt` is replaced by a smooth root that
//! stays differentiable, so that the flow ends without a singular derivative. Nothing flows back. The direction does not matter: a refill has its source for stagnation
//! and the cylinder for back pressure.
//! Assumptions: the throat stays single-phase (a metastable state is accepted: condensation is slower than
//! the passage), one discharge coefficient for both regimes.
//! Real-gas critical flow is 4-6 % above the ideal gas at 65-150 bar nitrogen.
use crate::real::Dual;
use alloc::borrow::ToOwned;

use crate::ThermalError;
use crate::fluid::{Fluid, Real, State};

/// Relative enthalpy drop, as a fraction of `p_0 / rho_0`, below which the velocity becomes linear in it.
const SMOOTH_BELOW: f64 = 1e-4;
const MAX_ITERATIONS: usize = 60;

/// Mass flux and regime of an orifice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrificeFlux<D = f64> {
    /// Mass flux through the vena contracta, kg/(m² s).
    pub mass_flux_kg_m2_s: D,
    /// Throat pressure at critical flow, Pa.
    pub critical_pressure_pa: f64,
    /// Whether the flow is choked.
    pub choked: bool,
}

/// Density and temperature of a throat.
type Throat = [f64; 2];

/// Mass flux from a stagnation state to a back pressure.
///
/// # Errors
/// No throat state was found (stagnation state outside the fluid's domain).
pub fn mass_flux<D: Real>(
    fluid: &Fluid,
    stagnation: &State<D>,
    back_pressure_pa: f64,
) -> Result<OrificeFlux<D>, ThermalError> {
    mass_flux_into(fluid, stagnation, D::from(back_pressure_pa))
}

/// The same to a back pressure that has derivatives, as a cylinder's has that is filled.
///
/// # Errors
/// As [`mass_flux`].
pub(crate) fn mass_flux_into<D: Real>(
    fluid: &Fluid,
    stagnation: &State<D>,
    back_pressure_pa: D,
) -> Result<OrificeFlux<D>, ThermalError> {
    let real = Stagnation::of(stagnation);
    let back_pa = back_pressure_pa.re();
    let critical = throat(fluid, &real, Condition::Sonic)?;
    let critical_pressure_pa = fluid.pressure_pa(critical[0], critical[1]);
    let choked = critical_pressure_pa >= back_pa;
    if real.pressure_pa <= back_pa {
        return Ok(OrificeFlux { mass_flux_kg_m2_s: D::from(0.0), critical_pressure_pa, choked: false });
    }
    let at = if choked { critical } else { throat(fluid, &real, Condition::Pressure(back_pa))? };
    let condition = if choked { Condition::Sonic } else { Condition::Pressure(back_pressure_pa) };
    let state = lifted_throat(fluid, stagnation, condition, at);
    let drop = stagnation.enthalpy_j_kg - state.enthalpy_j_kg;
    let floor = SMOOTH_BELOW * real.pressure_pa / real.density_kg_m3;
    // sqrt(x) for x >> floor, x^2 / floor^1.5 for x << floor: the slope ends at 0, as it is where nothing flows.
    let square = drop * drop;
    let smooth_root = square * (square + floor * floor).powf(-0.75);
    Ok(OrificeFlux {
        mass_flux_kg_m2_s: state.density_kg_m3 * smooth_root * core::f64::consts::SQRT_2,
        critical_pressure_pa,
        choked,
    })
}

/// What fixes the throat beside its entropy.
#[derive(Clone, Copy, Debug)]
enum Condition<D = f64> {
    Sonic,
    Pressure(D),
}

impl Condition {
    fn lifted<D: Real>(self) -> Condition<D> {
        match self {
            Self::Sonic => Condition::Sonic,
            Self::Pressure(p) => Condition::Pressure(D::from(p)),
        }
    }
}

impl<D: Real> Condition<D> {
    fn re(&self) -> Condition {
        match self {
            Self::Sonic => Condition::Sonic,
            Self::Pressure(p) => Condition::Pressure(p.re()),
        }
    }
}

/// Real parts of the stagnation state.
struct Stagnation {
    pressure_pa: f64,
    temperature_k: f64,
    density_kg_m3: f64,
    enthalpy_j_kg: f64,
    entropy_j_kg_k: f64,
    gamma: f64,
}

impl Stagnation {
    fn of<D: Real>(state: &State<D>) -> Self {
        Self {
            pressure_pa: state.pressure_pa.re(),
            temperature_k: state.temperature_k.re(),
            density_kg_m3: state.density_kg_m3.re(),
            enthalpy_j_kg: state.enthalpy_j_kg.re(),
            entropy_j_kg_k: state.entropy_j_kg_k.re(),
            gamma: (state.cp_j_kg_k.re() / state.cv_j_kg_k.re()).clamp(1.05, 1.7),
        }
    }
}

/// The two throat equations, scaled by the gas constant and by `R T`.
fn residual<D: Real>(
    condition: Condition<D>,
    throat: &State<D>,
    enthalpy_0: D,
    entropy_0: D,
    scale: (f64, f64),
) -> [D; 2] {
    let second = match condition {
        Condition::Sonic => {
            (enthalpy_0 - throat.enthalpy_j_kg - throat.sound_speed_m_s * throat.sound_speed_m_s * 0.5)
                / scale.1
        }
        Condition::Pressure(p) => (throat.pressure_pa - p) / p,
    };
    [(throat.entropy_j_kg_k - entropy_0) / scale.0, second]
}

type Dual2 = Dual<2>;

/// Residual and its Jacobian over (ln rho, ln T) at a throat.
fn linearised(
    fluid: &Fluid,
    at: Throat,
    condition: Condition,
    enthalpy_0: f64,
    entropy_0: f64,
    scale: (f64, f64),
) -> ([f64; 2], [[f64; 2]; 2]) {
    let rho: Dual2 = Dual2::variable(libm::log(at[0]), 0).exp();
    let t: Dual2 = Dual2::variable(libm::log(at[1]), 1).exp();
    let f = residual(condition.lifted(), &fluid.state(rho, t), enthalpy_0.into(), entropy_0.into(), scale);
    let gradient = |x: Dual2| {
        let g = x.eps;
        [g[0], g[1]]
    };
    ([f[0].re, f[1].re], [gradient(f[0]), gradient(f[1])])
}

fn solve_2x2<D: Real>(j: [[f64; 2]; 2], f: [D; 2]) -> [D; 2] {
    let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
    [(f[0] * j[1][1] - f[1] * j[0][1]) / det, (f[1] * j[0][0] - f[0] * j[1][0]) / det]
}

fn scales(fluid: &Fluid, temperature_k: f64) -> (f64, f64) {
    let r = fluid.specific_gas_constant_j_kg_k();
    (r, r * temperature_k)
}

/// Newton's method in the logarithms of density and temperature, started at the ideal gas.
fn throat(fluid: &Fluid, stagnation: &Stagnation, condition: Condition) -> Result<Throat, ThermalError> {
    let g = stagnation.gamma;
    let temperature_ratio = match condition {
        Condition::Sonic => 2.0 / (g + 1.0),
        Condition::Pressure(p) => libm::pow(p / stagnation.pressure_pa, (g - 1.0) / g),
    };
    let mut at = [
        stagnation.density_kg_m3 * libm::pow(temperature_ratio, 1.0 / (g - 1.0)),
        stagnation.temperature_k * temperature_ratio,
    ];
    let scale = scales(fluid, stagnation.temperature_k);
    for _ in 0..MAX_ITERATIONS {
        let (f, j) =
            linearised(fluid, at, condition, stagnation.enthalpy_j_kg, stagnation.entropy_j_kg_k, scale);
        let step = solve_2x2(j, f);
        if !(step[0].is_finite() && step[1].is_finite()) {
            break;
        }
        let longest = step[0].abs().max(step[1].abs());
        let damping = (0.2 / longest).min(1.0);
        at = [at[0] * libm::exp(-damping * step[0]), at[1] * libm::exp(-damping * step[1])];
        if longest < 1e-12 {
            return Ok(at);
        }
    }
    Err(ThermalError::NoThroat {
        pressure_pa: stagnation.pressure_pa,
        temperature_k: stagnation.temperature_k,
        fluid: fluid.name().to_owned(),
    })
}

/// Throat state with the derivatives of the stagnation state: one more Newton step, in dual numbers.
fn lifted_throat<D: Real>(
    fluid: &Fluid,
    stagnation: &State<D>,
    condition: Condition<D>,
    at: Throat,
) -> State<D> {
    let (h0, s0) = (stagnation.enthalpy_j_kg, stagnation.entropy_j_kg_k);
    let scale = scales(fluid, stagnation.temperature_k.re());
    let (_, j) = linearised(fluid, at, condition.re(), h0.re(), s0.re(), scale);
    let fixed = fluid.state(D::from(at[0]), D::from(at[1]));
    let step = solve_2x2(j, residual(condition, &fixed, h0, s0, scale));
    fluid.state((-step[0]).exp() * at[0], (-step[1]).exp() * at[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fluid::Equation;
    use crate::real::Dual;

    fn flux(fluid: &Fluid, bar: f64, temperature_k: f64, back_pa: f64) -> OrificeFlux {
        let rho = fluid.density_from_pressure_temperature(bar * 1e5, temperature_k).unwrap();
        mass_flux(fluid, &fluid.state(rho, temperature_k), back_pa).unwrap()
    }

    /// Ratio of the real-gas critical flux of nitrogen to the ideal gas's (k = 1.4) along run I1, found by maximising
    /// over the throat pressure with CoolProp (project study of the stratified gas, section 2).
    #[test]
    fn real_gas_passes_four_to_six_percent_more() {
        let nitrogen = Fluid::named("nitrogen").unwrap();
        let r = nitrogen.specific_gas_constant_j_kg_k();
        for (bar, t, ratio) in [
            (150.0, 289.0, 1.05),
            (66.0, 234.0, 1.06),
            (39.0, 209.0, 1.05),
            (26.0, 199.0, 1.04),
            (5.0, 190.0, 1.01),
        ] {
            let ideal = bar * 1e5 * (1.4 / (r * t)).sqrt() * (2.0_f64 / 2.4).powf(3.0);
            let here = flux(&nitrogen, bar, t, 1e5).mass_flux_kg_m2_s / ideal;
            assert!((here - ratio).abs() < 0.008, "{bar} bar {t} K: {here}");
        }
    }

    #[test]
    fn ideal_monatomic_gas_has_the_textbook_critical_flux_and_pressure() {
        let argon = Fluid::named("argon").unwrap().with_equation(Equation::IdealGas);
        let g: f64 = 5.0 / 3.0;
        let r = argon.specific_gas_constant_j_kg_k();
        let here = flux(&argon, 100.0, 300.0, 1e5);
        let factor = (2.0 / (g + 1.0)).powf((g + 1.0) / (2.0 * (g - 1.0)));
        approx::assert_relative_eq!(
            here.mass_flux_kg_m2_s,
            1e7 * (g / (r * 300.0)).sqrt() * factor,
            max_relative = 1e-7
        );
        approx::assert_relative_eq!(
            here.critical_pressure_pa,
            1e7 * (2.0 / (g + 1.0)).powf(g / (g - 1.0)),
            max_relative = 1e-9
        );
        assert!(here.choked);
    }

    #[test]
    fn flux_is_continuous_where_it_unchokes_and_ends_at_equal_pressures() {
        let nitrogen = Fluid::named("nitrogen").unwrap();
        let critical = flux(&nitrogen, 10.0, 288.0, 1e5).critical_pressure_pa;
        let (below, above) =
            (flux(&nitrogen, 10.0, 288.0, critical * 0.999), flux(&nitrogen, 10.0, 288.0, critical * 1.001));
        assert!(below.choked && !above.choked);
        approx::assert_relative_eq!(below.mass_flux_kg_m2_s, above.mass_flux_kg_m2_s, max_relative = 1e-5);
        assert!(flux(&nitrogen, 10.0, 288.0, 9.999_999e5).mass_flux_kg_m2_s < 0.1 * above.mass_flux_kg_m2_s);
        assert_eq!(flux(&nitrogen, 10.0, 288.0, 2e6).mass_flux_kg_m2_s, 0.0);
    }

    /// The critical flux is the largest along the isentrope: throats at nearby pressures pass less.
    #[test]
    fn critical_flux_is_the_maximum_over_throat_pressures() {
        let nitrogen = Fluid::named("nitrogen").unwrap();
        let choked = flux(&nitrogen, 150.0, 288.0, 1e5);
        for factor in [1.02, 1.1, 1.3] {
            let subsonic = flux(&nitrogen, 150.0, 288.0, choked.critical_pressure_pa * factor);
            assert!(subsonic.mass_flux_kg_m2_s < choked.mass_flux_kg_m2_s);
        }
    }

    #[test]
    fn dual_derivative_is_the_difference_quotient() {
        let nitrogen = Fluid::named("nitrogen").unwrap();
        for back in [1e5, 1.2e7] {
            let at =
                |rho: f64| mass_flux(&nitrogen, &nitrogen.state(rho, 288.0), back).unwrap().mass_flux_kg_m2_s;
            let dual = mass_flux(
                &nitrogen,
                &nitrogen.state(Dual::<1>::variable(170.0, 0), Dual::<1>::from(288.0)),
                back,
            )
            .unwrap();
            let difference = (at(170.001) - at(169.999)) / 0.002;
            approx::assert_relative_eq!(dual.mass_flux_kg_m2_s.eps[0], difference, max_relative = 1e-6);
        }
    }
}
