//! Inputs outside the domain: the right error, with value, bound and remedy in its words; never a panic or a wild state.
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::fluid::{Equation, Fluid, State};
use proptest::prelude::*;

use crate::support::{EQUATIONS, all, condenses, liquefies};

fn nitrogen() -> Fluid {
    Fluid::named("nitrogen").unwrap()
}

/// The message holds all of these words.
fn says(error: &ThermalError, words: &[&str]) {
    let message = error.to_string();
    for word in words {
        assert!(message.contains(word), "{message:?} does not say {word:?}");
    }
}

#[test]
fn unknown_fluid_names_the_nearest() {
    for (wrong, nearest) in
        [("nitrogn", "nitrogen"), ("Heliun", "helium"), ("argone", "argon"), ("hidrogen", "hydrogen")]
    {
        let error = Fluid::named(wrong).unwrap_err();
        assert!(matches!(error, ThermalError::UnknownFluid { .. }), "{error:?}");
        says(&error, &[wrong, &format!("did you mean {nearest}?"), "nitrogen, argon, air, hydrogen, helium"]);
    }
}

#[test]
fn formulas_and_trade_names_are_answered_with_the_name() {
    for (wrong, name) in [
        ("co2", "carbon-dioxide"),
        ("CO2", "carbon-dioxide"),
        ("n2", "nitrogen"),
        ("IG-100", "nitrogen"),
        ("inergen", "ig-541"),
        ("ig-55", "argon-nitrogen"),
    ] {
        let error = Fluid::named(wrong).unwrap_err();
        says(&error, &[wrong, &format!("did you mean {name}?")]);
    }
}

#[test]
fn names_are_known_in_any_case() {
    for name in ["Nitrogen", "ARGON", "air", "Hydrogen", "helium"] {
        assert_eq!(Fluid::named(name).unwrap().name(), name.to_ascii_lowercase());
    }
}

#[test]
fn temperature_outside_names_the_range() {
    for fluid in all() {
        let domain = fluid.domain();
        for t in [
            (domain.lowest_temperature_k - 1.0).round(),
            1.5 * domain.highest_temperature_k,
            f64::NAN,
            f64::INFINITY,
            -1.0,
        ] {
            for error in [
                fluid.density_from_pressure_temperature(1e5, t).unwrap_err(),
                fluid.check(0.1, t).unwrap_err(),
                fluid.checked_state(0.1, t).unwrap_err(),
            ] {
                assert!(matches!(error, ThermalError::TemperatureOutside { .. }), "{error:?}");
                let (low, high) =
                    (domain.lowest_temperature_k.to_string(), domain.highest_temperature_k.to_string());
                says(&error, &[&t.to_string(), fluid.name(), &low, &high, "must lie between"]);
            }
        }
    }
}

#[test]
fn pressure_outside_names_the_bound() {
    for fluid in all() {
        let highest = fluid.domain().highest_pressure_pa;
        for p in [-1.0, 0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.5 * highest] {
            for error in [
                fluid.density_from_pressure_temperature(p, 300.0).unwrap_err(),
                fluid.state_from_pressure_enthalpy(p, 3e5).unwrap_err(),
                fluid.state_from_pressure_entropy(p, 3e3).unwrap_err(),
            ] {
                assert!(matches!(error, ThermalError::PressureOutside { .. }), "{error:?}");
                says(
                    &error,
                    &[&p.to_string(), fluid.name(), &highest.to_string(), "must be positive and at most"],
                );
            }
        }
    }
}

#[test]
fn density_outside_names_the_bound() {
    for fluid in all() {
        let highest = fluid.domain().highest_density_kg_m3;
        for rho in [0.0, -1.0, f64::NAN, f64::INFINITY, (highest + 1.0).round()] {
            for error in [
                fluid.check(rho, 300.0).unwrap_err(),
                fluid.temperature_from_density_energy(rho, 3e5, None).unwrap_err(),
            ] {
                assert!(matches!(error, ThermalError::DensityOutside { .. }), "{error:?}");
                says(&error, &[&rho.to_string(), &format!("{highest:.1}"), "must be positive and at most"]);
            }
        }
    }
}

#[test]
fn too_high_a_pressure_for_the_cold_says_what_to_do() {
    let error = nitrogen().density_from_pressure_temperature(2e9, 280.0).unwrap_err();
    assert!(matches!(error, ThermalError::TooDense { .. }), "{error:?}");
    says(&error, &["nitrogen", "2000000000 Pa", "lower the pressure or raise the temperature"]);
}

#[test]
fn two_phases_by_density_and_temperature_are_refused() {
    for fluid in all().into_iter().filter(condenses) {
        let t = 0.9 * fluid.domain().critical_temperature_k;
        let saturation = fluid.saturation(t).unwrap().unwrap();
        let rho = 0.5 * (saturation.vapour_kg_m3 + saturation.liquid_kg_m3);
        let error = fluid.checked_state(rho, t).unwrap_err();
        // Air condenses over a range of pressures, which the next test holds.
        let is_air = fluid.name() == "air" && fluid.equation() == Equation::Reference;
        assert_eq!(fluid.checked_state(0.999 * saturation.vapour_kg_m3, t).is_ok(), !is_air);
        if liquefies(&fluid) {
            assert!(matches!(error, ThermalError::Condensed { .. }), "{error:?}");
            let liquid = fluid.checked_state(1.001 * saturation.liquid_kg_m3, t).unwrap_err();
            assert_eq!(liquid.to_string(), error.to_string());
            continue;
        }
        assert!(matches!(error, ThermalError::TwoPhase { .. }), "{error:?}");
        let vapour = format!("vapour up to {:.3}", saturation.vapour_kg_m3);
        says(&error, &[fluid.name(), &vapour, "only single-phase gas is modelled"]);
        assert_eq!(fluid.checked_state(1.001 * saturation.liquid_kg_m3, t).is_ok(), !is_air);
    }
}

/// Dew and bubble pressures of Lemmon et al. (2000) at 100 K, as the library `chemicals` prints them: 567424.1338937 and 663128.5894402 Pa.
#[test]
fn air_between_its_dew_and_its_bubble_line_is_refused() {
    let air = Fluid::named("air").unwrap();
    let (dew, bubble) = (567_424.133_893_7, 663_128.589_440_2);
    let at = |p: f64| air.density_from_pressure_temperature(p, 100.0);
    let (vapour, liquid) = (at(dew - 1e-3).unwrap(), at(bubble + 1e-3).unwrap());
    assert!(vapour < 30.0 && liquid > 700.0, "{vapour} {liquid}");
    for p in [dew + 1e-3, 6e5, bubble - 1e-3] {
        let error = at(p).unwrap_err();
        assert!(matches!(error, ThermalError::BetweenDewAndBubble { .. }), "{error:?}");
        says(
            &error,
            &["air", "100 K", "dew line (567424 Pa)", "bubble line (663129 Pa)", "only single-phase"],
        );
    }
    for (rho, refused) in
        [(0.9999 * vapour, false), (1.0001 * vapour, true), (0.9999 * liquid, true), (liquid * 1.0001, false)]
    {
        assert_eq!(air.check(rho, 100.0).is_err(), refused, "{rho}");
    }
    // Along an isobar both sides are found again.
    for (p, t) in [(6e5, 102.0), (6e5, 97.0), (6e5, 300.0)] {
        let state = air.checked_state(air.density_from_pressure_temperature(p, t).unwrap(), t).unwrap();
        let again = air.state_from_pressure_enthalpy(p, state.enthalpy_j_kg).unwrap();
        assert!((again.temperature_k - t).abs() < 1e-6, "{} {t}", again.temperature_k);
    }
}

/// -146.958 °C is 126.192 K, whatever the sum leaves behind its last digit.
#[test]
fn numbers_of_messages_are_as_short_as_what_was_typed() {
    let typed = -146.958 + 273.15;
    assert_ne!(typed.to_string(), "126.192");
    let error = Fluid::named("argon").unwrap().density_from_pressure_temperature(1e10, typed).unwrap_err();
    says(&error, &["pressure 10000000000 Pa"]);
    let error = Fluid::named("helium").unwrap().check(1e6, typed).unwrap_err();
    says(&error, &["density 1000000 kg/m3"]);
    let error = Fluid::named("nitrogen").unwrap().check(1.0, typed - 100.0).unwrap_err();
    says(&error, &["temperature 26.192 K"]);
}

#[test]
fn two_phases_on_an_isobar_are_refused() {
    for fluid in all().into_iter().filter(condenses) {
        let t = 0.9 * fluid.domain().critical_temperature_k;
        let found = fluid.saturation(t).unwrap().unwrap();
        let (vapour, liquid) = (fluid.state(found.vapour_kg_m3, t), fluid.state(found.liquid_kg_m3, t));
        let p = found.pressure_pa;
        for error in [
            fluid
                .state_from_pressure_enthalpy(p, 0.5 * (vapour.enthalpy_j_kg + liquid.enthalpy_j_kg))
                .unwrap_err(),
            fluid
                .state_from_pressure_entropy(p, 0.5 * (vapour.entropy_j_kg_k + liquid.entropy_j_kg_k))
                .unwrap_err(),
        ] {
            if liquefies(&fluid) {
                assert!(matches!(error, ThermalError::Condensed { .. }), "{error:?}");
                continue;
            }
            assert!(matches!(error, ThermalError::TwoPhaseIsobar { .. }), "{error:?}");
            says(
                &error,
                &[fluid.name(), &p.to_string()[..8], "boiling temperature", "only single-phase states"],
            );
        }
    }
}

/// The saturation pressure is 50.871 bar at 15 °C and 19.696 bar at -20 °C (CoolProp 8.0.0).
#[test]
fn liquid_carbon_dioxide_in_a_cylinder_is_refused_with_the_pressure_that_condenses_it() {
    let fluid = Fluid::named("carbon-dioxide").unwrap();
    assert!(fluid.density_from_pressure_temperature(50.8e5, 288.15).is_ok());
    for p in [50.9e5, 60e5, 200e5] {
        let error = fluid.density_from_pressure_temperature(p, 288.15).unwrap_err();
        assert!(matches!(error, ThermalError::Condensed { .. }), "{error:?}");
        says(
            &error,
            &[
                "carbon-dioxide",
                "liquid or two-phase",
                "at 15 degC from 50.9 bar on",
                "cylwatch treats one phase only",
            ],
        );
    }
    let cold = fluid.check(70.0, 253.15).unwrap_err();
    says(&cold, &["253.15 K", "from 19.7 bar absolute on", "at 15 degC from 50.9 bar on"]);
    // From its critical temperature on it is one phase at any pressure, and thin gas is gas all the way to it.
    assert!(fluid.density_from_pressure_temperature(150e5, 305.0).is_ok());
    assert!(fluid.density_from_pressure_temperature(60e5, 303.5).is_ok());
}

/// Below their bound mixtures may condense or freeze: one refusal, whatever the pressure and the equation.
#[test]
fn mixtures_are_refused_below_the_bound_of_their_dew_points() {
    for (name, lowest) in [("argon-nitrogen", "150.687"), ("ig-541", "216.592")] {
        for equation in EQUATIONS {
            let fluid = Fluid::named(name).unwrap().with_equation(equation);
            for p in [1e5, 5e6, 3e7] {
                let error = fluid.density_from_pressure_temperature(p, 150.0).unwrap_err();
                says(&error, &["150 K", name, lowest, "must lie between"]);
                assert!(fluid.density_from_pressure_temperature(p, 220.0).is_ok(), "{name} {equation:?} {p}");
            }
        }
    }
}

#[test]
fn saturation_line_leaves_the_density_open() {
    let fluid = nitrogen();
    let p = fluid.saturation(100.0).unwrap().unwrap().pressure_pa;
    let error = fluid.density_from_pressure_temperature(p, 100.0).unwrap_err();
    assert!(matches!(error, ThermalError::OnSaturation { .. }), "{error:?}");
    says(&error, &["nitrogen", "100 K", "saturation line", "do not fix the density"]);
    // On either side there is a phase.
    let vapour = fluid.density_from_pressure_temperature(0.9999 * p, 100.0).unwrap();
    let liquid = fluid.density_from_pressure_temperature(1.0001 * p, 100.0).unwrap();
    assert!(vapour < 40.0 && liquid > 600.0, "{vapour} {liquid}");
}

#[test]
fn near_the_critical_point_phases_are_not_told_apart() {
    let fluid = nitrogen();
    let error = fluid.density_from_pressure_temperature(3.3e6, 125.9).unwrap_err();
    assert!(matches!(error, ThermalError::NearCritical { .. }), "{error:?}");
    says(&error, &["125.900 K", "within 0.5 %", "126.192", "stay outside"]);
    assert!(matches!(fluid.saturation(126.0), Err(ThermalError::NearCritical { .. })));
}

#[test]
fn energies_that_no_state_has_are_refused() {
    for fluid in all() {
        for energy in [1e12, -1e12, f64::NAN, f64::INFINITY] {
            let error = fluid.temperature_from_density_energy(10.0, energy, None).unwrap_err();
            assert!(matches!(error, ThermalError::NoTemperature { .. }), "{error:?}");
            says(&error, &[fluid.name(), "10 kg/m3", &energy.to_string()]);
            let error = fluid.state_from_pressure_enthalpy(1e6, energy).unwrap_err();
            if liquefies(&fluid) && energy < 0.0 {
                assert!(matches!(error, ThermalError::Condensed { .. }), "{error:?}");
                continue;
            }
            assert!(matches!(error, ThermalError::NoState { .. }), "{error:?}");
            says(&error, &[fluid.name(), "1000000 Pa", "enthalpy", &energy.to_string()]);
        }
    }
}

/// Any number at all, with the awkward ones and the usual magnitudes often.
fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => any::<f64>(),
        2 => prop::sample::select(vec![0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MIN_POSITIVE, 5e-324, f64::MAX, f64::MIN]),
        4 => (-3.0..10.0).prop_map(|exponent| 10_f64.powf(exponent)),
        6 => 2.0..1000.0,
    ]
}

fn stable(s: &State) -> bool {
    let finite = [
        s.temperature_k,
        s.density_kg_m3,
        s.pressure_pa,
        s.internal_energy_j_kg,
        s.enthalpy_j_kg,
        s.entropy_j_kg_k,
        s.cv_j_kg_k,
        s.cp_j_kg_k,
        s.sound_speed_m_s,
        s.dp_dt_pa_k,
        s.dp_drho_pa_m3_kg,
        s.compressibility,
        s.expansion_per_k,
    ];
    finite.iter().all(|value| value.is_finite()) && s.dp_drho_pa_m3_kg > 0.0
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, ..ProptestConfig::default() })]

    #[test]
    fn no_number_makes_a_panic_or_a_wild_state(name in 0..Fluid::names().len(), equation in 0_usize..3, a in any_number(), b in any_number(), guess in any_number()) {
        let fluid = Fluid::named(Fluid::names().nth(name).unwrap()).unwrap().with_equation(EQUATIONS[equation]);
        let what = format!("{} {:?} {a} {b}", fluid.name(), fluid.equation());
        // Unchecked functions promise no value, only an end.
        let (_, _, _) = (fluid.state(a, b), fluid.pressure_pa(a, b), fluid.pressure_with_derivatives(a, b));
        let (_, _) = (fluid.viscosity_pa_s(a, b), fluid.conductivity_w_m_k(a, b));
        prop_assert_eq!(fluid.check(a, b).is_ok(), fluid.checked_state(a, b).is_ok());
        if let Ok(s) = fluid.checked_state(a, b) {
            prop_assert!(stable(&s), "{what}: {s:?}");
        }
        if let Ok(rho) = fluid.density_from_pressure_temperature(a, b) {
            prop_assert!(stable(&fluid.state(rho, b)), "{what}: {rho}");
        }
        if let Ok(t) = fluid.temperature_from_density_energy(a, b, Some(guess)) {
            prop_assert!(t.is_finite() && t > 0.0, "{what}: {t}");
        }
        if let Ok(s) = fluid.state_from_density_energy(a, b, Some(guess)) {
            prop_assert!(s.temperature_k.is_finite() && s.pressure_pa.is_finite(), "{what}: {s:?}");
        }
        if let Ok(s) = fluid.state_from_pressure_enthalpy(a, b) {
            prop_assert!(stable(&s), "{what}: {s:?}");
        }
        if let Ok(s) = fluid.state_from_pressure_entropy(a, b) {
            prop_assert!(stable(&s), "{what}: {s:?}");
        }
        if let Ok(Some(s)) = fluid.saturation(a) {
            prop_assert!(s.pressure_pa > 0.0 && s.vapour_kg_m3 > 0.0 && s.vapour_kg_m3 < s.liquid_kg_m3, "{what}: {s:?}");
        }
    }
}

/// Melting pressures of CoolProp 8.0.0 (`melting_line`). Helium meets the bound of its density first.
#[test]
fn solid_states_are_refused_on_their_side_of_the_melting_line() {
    for (name, temperature_k, melting_mpa) in
        [("nitrogen", 70.0, 32.443), ("argon", 90.0, 25.326), ("hydrogen", 20.0, 44.920)]
    {
        let fluid = Fluid::named(name).unwrap();
        let at =
            |factor: f64| fluid.density_from_pressure_temperature(factor * melting_mpa * 1e6, temperature_k);
        assert!(at(0.999).is_ok(), "{name} below its melting line: {:?}", at(0.999));
        assert!(matches!(at(1.001), Err(ThermalError::Solid { .. })), "{name} above it: {:?}", at(1.001));
    }
}
