//! The table of units.
use approx::assert_relative_eq;
use cylwatch_thermal::units::{self, Dimension, UNITS};
use proptest::prelude::*;

#[test]
fn suffixes_convert_to_known_values() {
    let cases = [
        ("p_barg", 0.0, 101_325.0),
        ("p_psi", 1.0, 6_894.757_293_168_361),
        ("p_psig", 0.0, 101_325.0),
        ("p_mpa", 20.0, 2e7),
        ("t_degc", -25.0, 248.15),
        ("t_min", 3.0, 180.0),
        ("t_d", 7.0, 604_800.0),
        ("v_l", 20.0, 0.02),
        ("x_mm", 6.0, 0.006),
        ("a_cm2", 250.0, 0.025),
        ("m_g_h", 3_600.0, 1e-3),
        ("u_km_h", 36.0, 10.0),
        ("b_per_bar", 1.5e-5, 1.5e-10),
        ("r_bar_h", 0.036, 1.0),
        ("drift_k_d", 86_400.0, 1.0),
        ("drift_bar_d", 0.864, 1.0),
        ("offset_psi", 1.0, 6_894.757_293_168_361),
        ("span_percent", 0.1, 1e-3),
        ("c_mbar_k", 12.0, 1_200.0),
    ];
    for (key, value, si) in cases {
        let (_, unit) = units::split(key).unwrap();
        assert_relative_eq!(unit.to_si(value), si, max_relative = 1e-14);
        assert_relative_eq!(unit.from_si(si), value, max_relative = 1e-14, epsilon = 1e-12);
    }
}

#[test]
fn the_longest_suffix_wins() {
    let cases = [
        ("film_w_m2_k", "film", Dimension::Film),
        ("conductivity_w_m_k", "conductivity", Dimension::Conductivity),
        ("contact_w_k", "contact", Dimension::Conductance),
        ("irradiance_w_m2", "irradiance", Dimension::HeatFlux),
        ("flow_g_h", "flow", Dimension::MassFlow),
        ("density_kg_m3", "density", Dimension::Density),
        ("heat_capacity_slope_per_k", "heat_capacity_slope", Dimension::PerTemperature),
        ("wind_m_s", "wind", Dimension::Speed),
        ("shoulder_k", "shoulder", Dimension::Temperature),
        ("gas_mean_sd_k", "gas_mean_sd", Dimension::TemperatureDifference),
        ("slope_pa_k", "slope", Dimension::PressurePerTemperature),
        ("pressure_sd_bar", "pressure_sd", Dimension::PressureDifference),
        ("noise_mbar", "noise", Dimension::PressureDifference),
        ("resolution_k", "resolution", Dimension::TemperatureDifference),
        ("offset_tolerance_pa", "offset_tolerance", Dimension::PressureDifference),
        ("drift_pa_s", "drift", Dimension::PressureRate),
        ("viscosity_pa_s", "viscosity", Dimension::Viscosity),
        ("drift_k_h", "drift", Dimension::TemperatureRate),
    ];
    for (key, base, dimension) in cases {
        let (found, unit) = units::split(key).unwrap();
        assert_eq!((found, unit.dimension), (base, dimension), "{key}");
    }
    for key in ["emissivity", "cells", "bar", "_bar", "", "x__", "air_csv"] {
        assert!(units::split(key).is_none(), "{key}");
    }
}

#[test]
fn a_unit_of_another_dimension_is_refused() {
    assert_eq!(units::to_si("x_bar", 2.0, Dimension::Pressure), Some(2e5));
    assert_eq!(units::to_si("x_bar", 2.0, Dimension::Temperature), None);
    assert_eq!(units::to_si("x_degc", 2.0, Dimension::TemperatureDifference), None);
    assert_eq!(units::to_si("x_barg", 2.0, Dimension::PressureDifference), None);
    assert_eq!(units::to_si("x", 2.0, Dimension::Pressure), None);
}

#[test]
fn every_dimension_has_one_si_unit_and_no_suffix_twice() {
    for unit in UNITS {
        let same = units::units_of(unit.dimension).filter(|other| other.suffix == unit.suffix).count();
        assert_eq!(same, 1, "{}", unit.suffix);
        let si = units::si_suffix(unit.dimension);
        assert_eq!(units::find(si, unit.dimension).unwrap().to_si(1.0), 1.0, "{si}");
    }
}

proptest! {
    #[test]
    fn every_unit_goes_there_and_back(value in -1e6..1e6_f64, i in 0..UNITS.len()) {
        let unit = &UNITS[i];
        let back = unit.from_si(unit.to_si(value));
        prop_assert!((back - value).abs() <= 1e-9 * value.abs().max(1.0), "{} {value} {back}", unit.suffix);
    }

    #[test]
    fn splitting_joins_to_the_key(key in "[a-z0-9_]{0,20}") {
        if let Some((base, unit)) = units::split(&key) {
            prop_assert_eq!(format!("{base}_{}", unit.suffix), key);
        }
    }
}
