//! Typical sensors, and files of sensors with their priors.
// Helpers outside of test functions fail a test by panicking, too.
#![allow(clippy::unwrap_used)]

use approx::assert_relative_eq;
use cylwatch_estimator::log::Quantity;
use cylwatch_estimator::sensor::{
    self, Law, ParameterKind, PressureReference, Sensor, SensorKind, SurfacePlace, read_sensors,
};

/// Mean, standard deviation and law of a parameter.
fn prior(sensor: &Sensor, kind: ParameterKind) -> (f64, f64, Law) {
    let found = sensor.parameters().iter().find(|parameter| parameter.kind == kind).unwrap();
    (found.mean, found.sd, found.law)
}

/// Standard deviation of a uniform distribution within `±limit`.
fn uniform_sd(limit: f64) -> f64 {
    (2.0 * limit) / 12.0_f64.sqrt()
}

#[test]
fn a_typical_surface_sensor_is_a_strapped_pt100_of_class_b() {
    for (name, place) in [
        ("shoulder", SurfacePlace::Shoulder),
        ("valve", SurfacePlace::Valve),
        ("wall_bottom", SurfacePlace::Bottom),
        ("wall_middle", SurfacePlace::Middle),
        ("wall_neck", SurfacePlace::Neck),
    ] {
        let typical = Sensor::typical(name).unwrap();
        assert_eq!((typical.name.as_str(), typical.kind), (name, SensorKind::Surface { place }));
        let (mean, sd, law) = prior(&typical, ParameterKind::Offset);
        assert_eq!((mean, law), (0.0, Law::Uniform));
        // 0.4 K at 20 degC.
        assert_relative_eq!(sd, uniform_sd(0.4), max_relative = 1e-12);
        assert_eq!(prior(&typical, ParameterKind::Coupling), (0.1, 0.04, Law::Normal));
        assert_relative_eq!(typical.noise_variance(), 0.0025, max_relative = 1e-12);
    }
}

#[test]
fn a_typical_transmitter_has_250_bar_and_a_quarter_percent() {
    let typical = Sensor::typical("pressure").unwrap();
    let expected =
        SensorKind::Pressure { reference: PressureReference::Absolute, full_scale_pa: Some(250e5) };
    assert_eq!((typical.kind, typical.quantity()), (expected, Quantity::Pressure));
    let (mean, sd, law) = prior(&typical, ParameterKind::Offset);
    assert_eq!((mean, law), (0.0, Law::Uniform));
    assert_relative_eq!(sd, uniform_sd(0.625e5), max_relative = 1e-12);
    let (mean, sd, _) = prior(&typical, ParameterKind::TemperatureCoefficient);
    assert_eq!(mean, 0.0);
    assert_relative_eq!(sd, 0.025e5, max_relative = 1e-12);
    assert_eq!(prior(&typical, ParameterKind::Span), (0.0, 0.0, Law::Normal));
    // 10 mbar.
    assert_relative_eq!(typical.noise_variance(), 1e6, max_relative = 1e-12);
}

#[test]
fn typical_air_and_gas_sensors_have_an_offset_of_their_own() {
    let air = Sensor::typical("ambient").unwrap();
    assert_eq!(prior(&air, ParameterKind::Offset), (0.0, 0.6, Law::Normal));
    let gas = Sensor::typical("gas_2").unwrap();
    assert_relative_eq!(prior(&gas, ParameterKind::Offset).1, uniform_sd(0.5), max_relative = 1e-12);
    assert_eq!((air.parameters().len(), gas.parameters().len()), (1, 1));
}

#[test]
fn every_typical_sensor_can_be_right_about_a_cylinder_outside() {
    for name in ["shoulder", "valve", "wall_bottom", "ambient", "gas_1"] {
        let (low, high) = Sensor::typical(name).unwrap().plausible();
        assert!(low < 233.0 && 343.0 < high, "{name}");
        // A broken wire of a Pt100 reads beyond 850 degC, a short circuit below -200 degC.
        assert!(low > 73.0 && high < 1123.0, "{name}");
    }
    let (low, high) = Sensor::typical("pressure").unwrap().plausible();
    assert!(low < 0.0 && 250e5 < high && high < 300e5);
}

#[test]
fn a_column_that_says_no_place_has_no_typical_sensor() {
    let message = |name: &str| Sensor::typical(name).unwrap_err().to_string();
    assert_eq!(
        message("sholder"),
        "sensor name = sholder is not known, did you mean shoulder?; choose one of bottom, middle, shoulder, neck, valve"
    );
    let places = "choose one of bottom, middle, shoulder, neck, valve";
    assert_eq!(message("wall_lid"), format!("sensor name = lid is not known; {places}"));
    assert_eq!(message("gas_"), format!("sensor name = gas_ is not known; {places}"));
}

#[test]
fn a_file_states_what_it_knows_and_the_rest_is_typical() {
    let text = "
[[sensor]]
name = \"shoulder\"
air_coupling = 0.15
offset_sd_k = 0.1
lag_s = 20

[[sensor]]
name = \"pressure\"
full_scale_bar = 400
gauge = true
temperature_coefficient_sd_mbar_k = 5
";
    let (specification, suite) = read_sensors(text, "sensors.toml").unwrap();
    let written = specification.to_toml().unwrap();
    assert_eq!(read_sensors(&written, "written.toml").unwrap().1.sensors(), suite.sensors(), "{written}");
    let shoulder = suite.find("shoulder").unwrap();
    assert_eq!(prior(shoulder, ParameterKind::Coupling), (0.15, 0.04, Law::Normal));
    assert_eq!(prior(shoulder, ParameterKind::Offset), (0.0, 0.1, Law::Normal));
    assert_eq!((shoulder.lag_s(), shoulder.noise_sd), (20.0, 0.05));
    let pressure = suite.find("pressure").unwrap();
    // A quarter percent of 400 bar, and the stated coefficient instead of 0.04 bar/K.
    assert_relative_eq!(prior(pressure, ParameterKind::Offset).1, uniform_sd(1e5), max_relative = 1e-12);
    let (_, sd, _) = prior(pressure, ParameterKind::TemperatureCoefficient);
    assert_relative_eq!(sd, 500.0, max_relative = 1e-12);
    assert_eq!(pressure.noise_sd, 1e3);
    assert_eq!(suite.sensors().len(), 2);
}

#[test]
fn a_fault_in_a_file_of_sensors_names_file_line_and_remedy() {
    let message = |text: &str| read_sensors(text, "sensors.toml").unwrap_err().to_string();
    let cases = [
        ("", "sensors.toml:1: sensor is missing: add it"),
        (
            "[[sensor]]\nname = \"valve\"\nnoise_mbar = 10",
            "sensors.toml:3: sensor noise_mbar cannot stand beside kind = surface: it belongs to pressure transmitters; a temperature takes _k",
        ),
        (
            "[[sensor]]\nname = \"valve\"\n[[sensor]]\nname = \"valve\"",
            "sensors.toml:4: sensor name = \"valve\" must be a name that no other sensor has: columns tell sensors apart by their names",
        ),
        (
            "[[sensor]]\nname = \"valve\"\nair_coupling = 2",
            "sensors.toml:3: sensor air_coupling = 2 must be between 0 and 1: 0 is a sensor in ideal contact, 0.15 to 0.2 a strapped one",
        ),
        (
            "[[sensor]]\nname = \"valve\"\nclass = \"B\"\noffset_sd_k = 0.1",
            "sensors.toml:4: sensor offset_sd_k cannot stand beside class: say in one way how far the offset may be off",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(message(text), expected);
    }
}

#[test]
fn the_schema_of_a_file_of_sensors_takes_every_unit_and_refuses_other_keys() {
    let schema = sensor::schema();
    let table = &schema["$defs"]["SensorSpec"];
    let patterns = table["patternProperties"].as_object().unwrap();
    for pattern in [
        "^offset_(k)$",
        "^offset_(bar|pa|kpa|mpa|mbar|psi)$",
        "^span_(percent|ratio|ppm)$",
        "^lag_(min|s|h|d)$",
    ] {
        assert!(patterns.contains_key(pattern), "{pattern} is not among {:?}", patterns.keys());
    }
    assert_eq!(table["additionalProperties"], false);
    assert_eq!(table["required"], serde_json::json!(["name"]));
}
