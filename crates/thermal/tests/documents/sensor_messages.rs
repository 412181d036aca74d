//! Every message about a `[[sensor]]` table, one broken input at a time.
use super::scenario_with;

/// The message for a sensor of these lines; the first stands in line 8 of the file.
fn message(lines: &str) -> String {
    scenario_with("film_w_m2_k = 8", &format!("[[sensor]]\n{lines}")).unwrap_err()
}

#[test]
fn each_fault_of_a_sensor_names_line_key_and_remedy() {
    let cases = [
        (
            "name = \"Shoulder\"",
            "8: sensor name = \"Shoulder\" must be of the letters a-z, digits and _: it becomes part of a column's name, e.g. measured_shoulder_degc",
        ),
        ("place = \"valve\"", "7: sensor name is missing: add it"),
        (
            "name = \"valve\"\n[[sensor]]\nname = \"valve\"",
            "10: sensor name = \"valve\" must be a name that no other sensor has: columns tell sensors apart by their names",
        ),
        (
            "name = \"a\"\nplace = \"vlave\"",
            "9: sensor place = \"vlave\" is not known, did you mean valve?; choose one of bottom, middle, shoulder, neck, valve",
        ),
        (
            "name = \"a\"\nkind = \"presure\"",
            "9: sensor kind = \"presure\" is not known, did you mean pressure?; choose one of surface, pressure, gas, ambient, immersion",
        ),
        (
            "name = \"shoulder\"\nclass = \"D\"",
            "9: sensor class = \"D\" is not known; choose one of AA, A, B, C",
        ),
        (
            "name = \"a\"\nplace = \"valve\"\nheight_mm = 300",
            "10: sensor height_mm cannot stand beside place: say in one way where it sits",
        ),
        (
            "name = \"a\"\nheight_m = 300",
            "9: sensor height_m = 300 must be between 0 and 50 m: it counts from the outer bottom",
        ),
        (
            "name = \"gas_0\"",
            "8: sensor name = \"gas_0\" must be numbered from 1: gas_1 is the lowest cell of the gas",
        ),
        (
            "name = \"probe\"\nkind = \"gas\"\ncell = 0",
            "10: sensor cell = 0 must be at least 1: say where it hangs: cell = 1 is the lowest cell of the gas, or height_mm = 400",
        ),
        (
            "name = \"probe\"\nkind = \"gas\"",
            "7: sensor cell is missing: say where it hangs: cell = 1 is the lowest cell of the gas, or height_mm = 400",
        ),
        (
            "name = \"gas_1\"\ncell = 1\nheight_mm = 400",
            "10: sensor height_mm cannot stand beside cell: say in one way where it hangs",
        ),
        (
            "name = \"valve\"\nair_coupling_sd = -0.1",
            "9: sensor air_coupling_sd = -0.1 must be between 0 and 1: 0.04 is usual for strapped sensors",
        ),
        (
            "name = \"valve\"\nlag_s = -1",
            "9: sensor lag_s = -1 must be between 0 and 1 d: give the time constant, e.g. lag_s = 20, or leave it out",
        ),
        (
            "name = \"valve\"\nnoise_k = -0.1",
            "9: sensor noise_k = -0.1 must be at least 0: it is a size without a sign; leave it out for none",
        ),
        (
            "name = \"valve\"\nresolution_k = -1",
            "9: sensor resolution_k = -1 must be at least 0: it is a size without a sign; leave it out for none",
        ),
        (
            "name = \"valve\"\nclass = \"A\"\noffset_sd_k = 0.1",
            "10: sensor offset_sd_k cannot stand beside class: say in one way how far the offset may be off",
        ),
        (
            "name = \"valve\"\nclass = \"A\"\noffset_tolerance_k = 0.1",
            "10: sensor offset_tolerance_k cannot stand beside class: say in one way how far the offset may be off",
        ),
        (
            "name = \"pressure\"\noffset_tolerance_bar = 1\noffset_sd_bar = 0.1",
            "10: sensor offset_sd_bar cannot stand beside offset_tolerance: say in one way how far the offset may be off",
        ),
        (
            "name = \"valve\"\nwalk_sd_k = 0.1",
            "7: sensor walk_time_min is missing: say both, e.g. walk_sd_k = 0.05 in walk_time_d = 365",
        ),
        (
            "name = \"pressure\"\nwalk_time_d = 1",
            "7: sensor walk_sd_bar is missing: say both, e.g. walk_sd_k = 0.05 in walk_time_d = 365",
        ),
        (
            "name = \"valve\"\nwalk_sd_k = 0.1\nwalk_time_d = 0",
            "10: sensor walk_time_d = 0 must be positive: say both, e.g. walk_sd_k = 0.05 in walk_time_d = 365",
        ),
        (
            "name = \"valve\"\ncorrelated_noise_k = 0.1",
            "7: sensor correlation_time_min is missing: correlated noise takes its size and its correlation time",
        ),
        (
            "name = \"pressure\"\ncorrelation_time_min = 10",
            "7: sensor correlated_noise_bar is missing: correlated noise takes its size and its correlation time",
        ),
        (
            "name = \"valve\"\ndropout = 1.5",
            "9: sensor dropout = 1.5 must be between 0 and 1: 0.01 loses one reading of a hundred",
        ),
        (
            "name = \"valve\"\nlowest_degc = 20\nhighest_degc = 10",
            "10: sensor highest_degc = 10 must be above the lowest reading of 20.00 degC: a reading outside of these is taken for a fault",
        ),
        (
            "name = \"pressure\"\nspan_percent = 60",
            "9: sensor span_percent = 60 must be between -50 and 50 %: a reading of 0.1 % too much is span_percent = 0.1",
        ),
        (
            "name = \"pressure\"\nfull_scale_bar = 0",
            "9: sensor full_scale_bar = 0 must be between 1 Pa and 2000 bar: it is the upper end of the range, e.g. 250 bar",
        ),
        (
            "name = \"pressure\"\naltitude_m = 300",
            "9: sensor altitude_m cannot stand beside an absolute transmitter: an absolute transmitter reads the same at every altitude; for another one say gauge = true",
        ),
        (
            "name = \"pressure\"\ngauge = true\naltitude_m = 30000",
            "10: sensor altitude_m = 30000 must be between -500 m and 11 km: it gives the air's pressure after ISO 2533",
        ),
    ];
    for (lines, expected) in cases {
        assert_eq!(message(lines), format!("scenarios/x.toml:{expected}"), "for {lines:?}");
    }
}

#[test]
fn a_key_of_another_kind_is_refused_and_not_ignored() {
    let temperature =
        "a pressure takes bar or another unit of pressure, and no class or range of temperature";
    let pressure = "it belongs to pressure transmitters; a temperature takes _k";
    let cases = [
        ("pressure", "noise_k = 0.05", "noise_k", "pressure", temperature),
        ("pressure", "class = \"A\"", "class", "pressure", temperature),
        ("pressure", "air_coupling = 0.1", "air_coupling", "pressure", "it belongs to surface sensors"),
        ("pressure", "cell = 1", "cell", "pressure", "it belongs to sensors in the gas"),
        ("shoulder", "offset_bar = 0.1", "offset_bar", "surface", pressure),
        ("shoulder", "gauge = false", "gauge", "surface", pressure),
        ("shoulder", "cell = 1", "cell", "surface", "it belongs to sensors in the gas"),
        ("gas_1", "place = \"valve\"", "place", "gas", "it belongs to surface sensors"),
        (
            "ambient",
            "height_m = 1",
            "height_m",
            "ambient",
            "it belongs to sensors on the surface and in the gas",
        ),
        ("ambient", "air_coupling = 0.1", "air_coupling", "ambient", "it belongs to surface sensors"),
    ];
    for (name, line, key, kind, remedy) in cases {
        assert_eq!(
            message(&format!("name = \"{name}\"\n{line}")),
            format!("scenarios/x.toml:9: sensor {key} cannot stand beside kind = {kind}: {remedy}")
        );
    }
}

#[test]
fn a_number_without_or_with_a_wrong_unit_is_told_the_units_of_both_kinds() {
    assert_eq!(
        message("name = \"valve\"\noffset = 0.1"),
        "scenarios/x.toml:9: sensor offset has no unit: write offset_k, or another of _k, _bar, _pa, _kpa, _mpa, _mbar, _psi"
    );
    // An offset counts from nothing: neither Celsius nor gauge has a meaning.
    for unit in ["degc", "barg"] {
        assert_eq!(
            message(&format!("name = \"valve\"\noffset_{unit} = 0.1")),
            format!(
                "scenarios/x.toml:9: sensor offset_{unit} is in _{unit}, which is no unit of offset: use one of _k, _bar, _pa, _kpa, _mpa, _mbar, _psi"
            )
        );
    }
}
