//! Gas through a control valve of a flow coefficient Kv, after IEC 60534-2-1:
//!
//! `m = (Kv / 36000) Y sqrt(rho_1 x p_1)`, SI but for Kv in m³/h, with the pressure drop ratio `x = (p_1 - p_2) / p_1`,
//! the expansion factor `Y = 1 - x / (3 F_gamma x_T)` and `F_gamma = gamma / 1.4`. From `x = F_gamma x_T` on the flow is choked
//! and `Y = 2/3`. There `Y sqrt(x)` has its maximum, so the flow is smooth where it chokes.
//!
//! `rho_1` is the density of the real gas, which is where its compressibility factor enters. `gamma` is the ratio of the heat
//! capacities of the ideal gas, for which the standard states its factor. Kv is defined by water: 1 m³/h of 1000 kg/m³ at 1 bar, so that the
//! standard's `N_6 = 31.6` is `sqrt(1000)`. No reducers (`F_P = 1`), turbulent.
//!
//! Range of the standard: `1.08 < gamma < 1.65`; helium and argon (1.667) lie 1 % outside. `x_T` is measured with air: 0.72 for a globe
//! valve with the flow to open, 0.25 to 0.4 for ball valves, 0.35 for butterfly valves.
//! As at an orifice the root becomes linear near equal pressures, and nothing flows back.
use super::OpeningFlow;
use crate::fluid::{Equation, Fluid, Real, State};

/// Pressure drop ratio below which the flow becomes linear in it.
const SMOOTH_BELOW: f64 = 1e-4;
/// Ratio of heat capacities that `x_T` is stated for: air.
const GAMMA_OF_AIR: f64 = 1.4;

/// Mass flow from a state at rest to a pressure.
pub(crate) fn flow<D: Real>(
    fluid: &Fluid,
    upstream: &State<D>,
    downstream_pa: D,
    kv_m3_h: f64,
    x_t: f64,
) -> OpeningFlow<D> {
    let ideal =
        fluid.clone().with_equation(Equation::IdealGas).state(upstream.density_kg_m3, upstream.temperature_k);
    let choking = ideal.cp_j_kg_k / ideal.cv_j_kg_k * (x_t / GAMMA_OF_AIR);
    let pressure = upstream.pressure_pa;
    let choking_pressure_pa = pressure.re() * (1.0 - choking.re());
    let x = (pressure - downstream_pa) / pressure;
    if x.re() <= 0.0 {
        return OpeningFlow { mass_flow_kg_s: D::from(0.0), choking_pressure_pa };
    }
    let x = if x.re() >= choking.re() { choking } else { x };
    let root = x * x * (x * x + SMOOTH_BELOW * SMOOTH_BELOW).powf(-0.75);
    let expansion = -(x / (choking * 3.0)) + 1.0;
    let mass_flow_kg_s = expansion * root * (upstream.density_kg_m3 * pressure).sqrt() * (kv_m3_h / 36_000.0);
    OpeningFlow { mass_flow_kg_s, choking_pressure_pa }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::Dual;
    use approx::assert_relative_eq;

    fn state(fluid: &Fluid, bar: f64, temperature_k: f64) -> State {
        let rho = fluid.density_from_pressure_temperature(bar * 1e5, temperature_k).unwrap();
        fluid.state(rho, temperature_k)
    }

    fn at(bar: (f64, f64), kv: f64, x_t: f64) -> f64 {
        let nitrogen = Fluid::named("nitrogen").unwrap();
        flow(&nitrogen, &state(&nitrogen, bar.0, 293.15), bar.1 * 1e5, kv, x_t).mass_flow_kg_s
    }

    /// The standard's own form in its own units, `W = 31.6 Kv Y sqrt(x p_1 rho_1)` with bar and kg/h, by hand for nitrogen at 10 bar and
    /// 20 °C (11.507 kg/m³, gamma 1.400): x = 0.2, Y = 1 - 0.2/(3 x 0.72) = 0.9074, so W = 137.6 kg/h for Kv = 1.
    #[test]
    fn a_valve_passes_what_the_standard_says() {
        assert_relative_eq!(at((10.0, 8.0), 1.0, 0.72) * 3_600.0, 137.6, max_relative = 2e-3);
        // Choked: x = 0.72, Y = 2/3: 31.6 x 2/3 x sqrt(0.72 x 10 x 11.507) = 191.8 kg/h.
        assert_relative_eq!(at((10.0, 1.0), 1.0, 0.72) * 3_600.0, 191.8, max_relative = 2e-3);
    }

    #[test]
    fn a_choked_valve_passes_the_most_and_joins_smoothly() {
        let choking = flow(
            &Fluid::named("nitrogen").unwrap(),
            &state(&Fluid::named("nitrogen").unwrap(), 100.0, 293.15),
            1e5,
            2.0,
            0.6,
        )
        .choking_pressure_pa
            / 1e5;
        assert_relative_eq!(choking, 40.0, max_relative = 2e-3);
        let most = at((100.0, 1.0), 2.0, 0.6);
        for above in [0.01, 1.0, 20.0, 59.0] {
            assert!(at((100.0, choking + above), 2.0, 0.6) < most);
        }
        assert_relative_eq!(at((100.0, choking + 1e-3), 2.0, 0.6), most, max_relative = 1e-8);
        assert_eq!(at((100.0, 100.0), 2.0, 0.6), 0.0);
        assert_eq!(at((100.0, 120.0), 2.0, 0.6), 0.0);
        assert_relative_eq!(
            at((100.0, 40.0), 4.0, 0.6),
            2.0 * at((100.0, 40.0), 2.0, 0.6),
            max_relative = 1e-14
        );
    }

    #[test]
    fn dual_derivative_is_the_difference_quotient() {
        let argon = Fluid::named("argon").unwrap();
        for back in [1e5, 9e6] {
            let at = |rho: f64| flow(&argon, &argon.state(rho, 288.0), back, 1.0, 0.7).mass_flow_kg_s;
            let state = argon.state(Dual::<1>::variable(200.0, 0), Dual::<1>::from(288.0));
            let dual = flow(&argon, &state, Dual::<1>::from(back), 1.0, 0.7).mass_flow_kg_s;
            assert_relative_eq!(dual.eps[0], (at(200.001) - at(199.999)) / 0.002, max_relative = 1e-6);
        }
    }
}
