//! Round trips of the solves over the whole domain of every fluid and equation, and the derivatives of the lifted ones.
//!
//! A state is drawn as temperature (logarithmic over the domain) and pressure (logarithmic from 10 Pa to 1000 bar). What
//! the domain refuses (too dense, on the saturation line, within 0.5 % below the critical temperature) is drawn again.
//! Solves stop when a Newton step is below 1e-9 of the root, so that roots are good to rounding, amplified by the
//! problem's condition; bars are 1e-9 of what the condition leaves.
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::fluid::{Fluid, State};
use cylwatch_thermal::real::Dual;
use proptest::prelude::*;

use crate::support::{EQUATIONS, all, condenses, liquefies};

fn fluids() -> impl Strategy<Value = Fluid> {
    (0..Fluid::names().len(), 0..EQUATIONS.len()).prop_map(|(name, equation)| {
        Fluid::named(Fluid::names().nth(name).unwrap()).unwrap().with_equation(EQUATIONS[equation])
    })
}

/// A temperature between the bounds of the domain and a pressure.
fn points() -> impl Strategy<Value = (Fluid, f64, f64)> {
    (fluids(), 0.0..1.0, 1.0..8.0).prop_map(|(fluid, t, log_p): (Fluid, f64, f64)| {
        let domain = fluid.domain();
        let (low, high) = (domain.lowest_temperature_k * 1.001, domain.highest_temperature_k * 0.999);
        let temperature_k = low * (high / low).powf(t);
        let pressure_pa = 10_f64.powf(log_p).min(domain.highest_pressure_pa);
        (fluid, pressure_pa, temperature_k)
    })
}

/// States that the domain holds.
fn states() -> impl Strategy<Value = (Fluid, State)> {
    points().prop_filter_map("outside the domain", |(fluid, p, t)| {
        let rho = fluid.density_from_pressure_temperature(p, t).ok()?;
        let state = fluid.checked_state(rho, t).ok()?;
        Some((fluid, state))
    })
}

fn case(fluid: &Fluid, s: &State) -> String {
    format!("{} {:?} at {} K, {} Pa", fluid.name(), fluid.equation(), s.temperature_k, s.pressure_pa)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, max_global_rejects: 30000, ..ProptestConfig::default() })]

    /// The pressure of the solved density, as the relative deviation of the density that would make it.
    #[test]
    fn density_has_the_pressure_it_was_solved_for((fluid, p, t) in points()) {
        match fluid.density_from_pressure_temperature(p, t) {
            Ok(rho) => {
                let s = fluid.state(rho, t);
                let deviation = (s.pressure_pa - p).abs() / (rho * s.dp_drho_pa_m3_kg);
                prop_assert!(s.dp_drho_pa_m3_kg > 0.0 && deviation <= 1e-9, "{}: {deviation:e}", case(&fluid, &s));
            }
            Err(ThermalError::NearCritical { critical_k, .. }) => {
                prop_assert!(t < critical_k && t > 0.99 * critical_k, "{} at {t} K, {p} Pa is not near critical", fluid.name());
            }
            Err(ThermalError::TooDense { .. }) => {
                let densest = fluid.domain().highest_density_kg_m3;
                prop_assert!(fluid.pressure_pa(densest, t) < p * (1.0 + 1e-6), "{} at {t} K, {p} Pa is not dense", fluid.name());
            }
            Err(ThermalError::Condensed { saturation_pa, .. }) => {
                prop_assert!(liquefies(&fluid) && p > saturation_pa * (1.0 - 1e-8), "{}", fluid.name());
            }
            Err(ThermalError::Solid { melting_pa, .. }) => prop_assert!(p > melting_pa),
            Err(error) => prop_assert!(false, "{error}"),
        }
    }

    #[test]
    fn temperature_comes_back_from_density_and_energy((fluid, s) in states(), guess in proptest::option::of(1.0..2000.0)) {
        let t = fluid.temperature_from_density_energy(s.density_kg_m3, s.internal_energy_j_kg, guess).unwrap();
        // The energy is known to 1e-15 of itself; its origin may be far away.
        let noise = 1e-14 * s.internal_energy_j_kg.abs() / s.cv_j_kg_k;
        prop_assert!((t - s.temperature_k).abs() <= 1e-9 * s.temperature_k + noise, "{}: {t}", case(&fluid, &s));
        let again = fluid.state_from_density_energy(s.density_kg_m3, s.internal_energy_j_kg, guess).unwrap();
        prop_assert!((again.temperature_k - t).abs() <= 1e-9 * t, "{}: {again:?}", case(&fluid, &s));
    }
}

proptest! {
    // Below the critical temperature each step of these solves may need the saturation line: fewer cases.
    #![proptest_config(ProptestConfig { cases: 300, max_global_rejects: 30000, ..ProptestConfig::default() })]

    #[test]
    fn state_comes_back_from_pressure_and_enthalpy((fluid, s) in states()) {
        let found = fluid.state_from_pressure_enthalpy(s.pressure_pa, s.enthalpy_j_kg);
        prop_assert!(found.is_ok(), "{}: {}", case(&fluid, &s), found.unwrap_err());
        let (t, noise) = (found.unwrap().temperature_k, 1e-14 * s.enthalpy_j_kg.abs() / s.cp_j_kg_k);
        prop_assert!((t - s.temperature_k).abs() <= 1e-8 * s.temperature_k + noise, "{}: {t}", case(&fluid, &s));
    }

    #[test]
    fn state_comes_back_from_pressure_and_entropy((fluid, s) in states()) {
        let found = fluid.state_from_pressure_entropy(s.pressure_pa, s.entropy_j_kg_k);
        prop_assert!(found.is_ok(), "{}: {}", case(&fluid, &s), found.unwrap_err());
        let t = found.unwrap().temperature_k;
        let noise = 1e-14 * s.entropy_j_kg_k.abs() * t / s.cp_j_kg_k;
        prop_assert!((t - s.temperature_k).abs() <= 1e-8 * s.temperature_k + noise, "{}: {t}", case(&fluid, &s));
    }
}

/// Room states of every fluid and equation, as far as it has them.
fn room() -> Vec<(Fluid, f64, f64)> {
    let mut found = Vec::new();
    for fluid in all() {
        let before = found.len();
        for t in [165.0, 230.0, 290.0, 330.0] {
            for p in [1e5, 5e6, 2e7, 4e7] {
                if fluid.density_from_pressure_temperature(p, t).is_ok() {
                    found.push((fluid.clone(), p, t));
                }
            }
        }
        assert!(found.len() >= before + 7, "{}", fluid.name());
    }
    found
}

/// Central difference over a relative step of 1e-5: good to about 1e-8 of a smooth function.
fn difference(f: impl Fn(f64) -> f64, x: f64) -> f64 {
    let h = 1e-5 * x;
    (f(x + h) - f(x - h)) / (2.0 * h)
}

#[test]
fn derivatives_of_the_state_from_density_and_energy_are_its_differences() {
    for (fluid, p, t) in room() {
        let rho = fluid.density_from_pressure_temperature(p, t).unwrap();
        let here = fluid.state(rho, t);
        let u = here.internal_energy_j_kg;
        // The step of the energy is 1e-5 of cv T: the energy itself may be near zero.
        let h = 1e-5 * here.cv_j_kg_k * t;
        let plain = |rho: f64, u: f64| fluid.state_from_density_energy(rho, u, Some(t)).unwrap();
        let lifted = |d_rho: f64, d_u: f64| {
            fluid
                .state_from_density_energy(
                    Dual { re: rho, eps: [d_rho] },
                    Dual { re: u, eps: [d_u] },
                    Some(t),
                )
                .unwrap()
        };
        let (in_density, in_energy) = (lifted(1.0, 0.0), lifted(0.0, 1.0));
        let (warm, cold) = (plain(rho, u + h), plain(rho, u - h));
        for (exact, numeric, size) in [
            (
                in_energy.temperature_k.eps[0],
                (warm.temperature_k - cold.temperature_k) / (2.0 * h),
                1.0 / here.cv_j_kg_k,
            ),
            (
                in_energy.pressure_pa.eps[0],
                (warm.pressure_pa - cold.pressure_pa) / (2.0 * h),
                here.dp_dt_pa_k / here.cv_j_kg_k,
            ),
            (in_density.temperature_k.eps[0], difference(|rho| plain(rho, u).temperature_k, rho), t / rho),
            (
                in_density.pressure_pa.eps[0],
                difference(|rho| plain(rho, u).pressure_pa, rho),
                here.dp_drho_pa_m3_kg,
            ),
        ] {
            assert!(
                (exact - numeric).abs() <= 1e-6 * size,
                "{} at {t} K, {p} Pa: {exact} {numeric}",
                fluid.name()
            );
        }
    }
}

/// Equal pressure, temperature and Gibbs energy, and the vapour pressure's slope by Clausius and Clapeyron.
#[test]
fn saturation_of_every_fluid_is_an_equilibrium() {
    for fluid in all().into_iter().filter(condenses) {
        let domain = fluid.domain();
        let (low, high) = (domain.lowest_temperature_k, 0.99 * domain.critical_temperature_k);
        for k in 1..=8 {
            let t = low + (high - low) * f64::from(k) / 8.0;
            let found = fluid.saturation(t).unwrap().unwrap();
            let (vapour, liquid) = (fluid.state(found.vapour_kg_m3, t), fluid.state(found.liquid_kg_m3, t));
            let what = format!("{} {:?} at {t} K", fluid.name(), fluid.equation());
            let rt = fluid.specific_gas_constant_j_kg_k() * t;
            let gibbs = |s: &State| s.enthalpy_j_kg - t * s.entropy_j_kg_k;
            assert!((vapour.pressure_pa / found.pressure_pa - 1.0).abs() <= 1e-9, "{what}");
            let dense = (liquid.pressure_pa - found.pressure_pa).abs()
                / (found.liquid_kg_m3 * liquid.dp_drho_pa_m3_kg);
            assert!(dense <= 1e-9, "{what}: {dense:e}");
            assert!((gibbs(&vapour) - gibbs(&liquid)).abs() <= 1e-8 * rt, "{what}");
            let slope = difference(|t| fluid.saturation(t).unwrap().unwrap().pressure_pa, t);
            let heat = vapour.enthalpy_j_kg - liquid.enthalpy_j_kg;
            let clapeyron = heat / t / (1.0 / found.vapour_kg_m3 - 1.0 / found.liquid_kg_m3);
            assert!((slope / clapeyron - 1.0).abs() <= 1e-5, "{what}: {slope} {clapeyron}");
        }
    }
}

/// No spinodal above the bound of their dew points: the density of a pressure is unique.
#[test]
fn pressure_of_a_mixture_rises_with_density_in_its_whole_domain() {
    for fluid in all().into_iter().filter(|fluid| ["argon-nitrogen", "ig-541"].contains(&fluid.name())) {
        let domain = fluid.domain();
        for k in 0..40 {
            let t = domain.lowest_temperature_k
                * (domain.highest_temperature_k / domain.lowest_temperature_k).powf(f64::from(k) / 39.0);
            for step in 1..=400 {
                let rho = domain.highest_density_kg_m3 * f64::from(step) / 400.0;
                let slope = fluid.state(rho, t).dp_drho_pa_m3_kg;
                assert!(slope > 0.0, "{} {:?}, {t} K, {rho} kg/m3: {slope}", fluid.name(), fluid.equation());
            }
        }
    }
}
