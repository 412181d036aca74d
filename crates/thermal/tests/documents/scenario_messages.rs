//! Every message about a scenario file, one broken input at a time.
use super::scenario_with;

#[test]
fn each_fault_of_a_scenario_names_line_key_and_remedy() {
    let cases = [
        (
            "duration_h = 2",
            "duration_h = 0",
            "2: duration_h = 0 must be positive: say how long the scenario lasts",
        ),
        ("duration_h = 2", "", "1: duration_min is missing: add it"),
        (
            "duration_h = 2",
            "duration_bar = 0",
            "2: duration_bar is in _bar, which is no unit of duration: use one of _min, _s, _h, _d",
        ),
        (
            "duration_h = 2",
            "duration_h = 2\nsample_time_h = 3",
            "3: sample_time_h = 3 must be between 0.00036 s and the duration of 2 h: give the interval of the output samples, e.g. sample_time_min = 1",
        ),
        (
            "pressure_bar = 100",
            "",
            "3: initial fill_pressure_bar is missing: say how full the cylinder is: fill_pressure_bar at fill_temperature_degc, pressure_bar or mass_kg",
        ),
        (
            "pressure_bar = 100",
            "pressure_bar = 100\nmass_kg = 3",
            "5: initial mass_kg cannot stand beside pressure_pa: say the fill in one way",
        ),
        (
            "pressure_bar = 100",
            "pressure_bar = 100\nfill_temperature_degc = 3",
            "5: initial fill_temperature_degc cannot stand beside a fill without fill_pressure: it belongs to fill_pressure; for other fills give temperature",
        ),
        (
            "air_degc = 21",
            "",
            "5: ambient air_degc is missing: say the temperature of the air around the cylinder",
        ),
        (
            "air_degc = 21",
            "air_k = 21",
            "6: ambient air_k = 21 must be between 60 K and 1500 K (-213 degC and 1227 degC): check the unit, _degc or _k",
        ),
        (
            "air_degc = 21",
            "air_degc = 21\nair_table = {time_h = [0, 1], air_degc = [1, 2]}",
            "6: ambient air_degc cannot stand beside air_table: say the signal in one form",
        ),
        (
            "air_degc = 21",
            "air_table = {time_h = [0, 1, 0.5], air_degc = [1, 2, 3]}",
            "6: ambient.air_table time_h = 0.5 must be at least 1 h, the time before: sort the rows; the same time twice is a jump",
        ),
        (
            "air_degc = 21",
            "air_table = {time_h = [0, 1, 1, 1], air_degc = [1, 2, 3, 4]}",
            "6: ambient.air_table time_h = 1 must be later than 1 h, the time of the two rows before: sort the rows; the same time twice is a jump",
        ),
        (
            "air_degc = 21",
            "air_table = {time_h = [0, 1], air_degc = [1]}",
            "6: ambient.air_table air_degc = [1] must be a list of 2 values, one for each time: give as many values as times",
        ),
        (
            "air_degc = 21",
            "air_table = {time_h = [0, \n nan], air_degc = [1, 3]}",
            "7: ambient.air_table time_h = nan must be a finite number: write a number or leave it out",
        ),
        (
            "air_degc = 21",
            "air_csv = {file = \"u.csv\", column = \"air_degc\"}",
            "6: ambient.air_csv file = \"u.csv\" must be a file that can be read: the name counts from the scenario's folder (entity not found)",
        ),
        (
            "air_degc = 21",
            "air_csv = {file = \"t.csv\", column = \"ar_degc\"}",
            "6: ambient.air_csv column = \"ar_degc\" is not known, did you mean air_degc?; choose one of time_min, air_degc, wind_m_s",
        ),
        (
            "air_degc = 21",
            "air_csv = {file = \"t.csv\", column = \"air\"}",
            "6: ambient.air_csv column = \"air\" must be a column in a unit of this signal, one of _degc, _k, _degf: the end of a column's name is its unit",
        ),
        (
            "air_degc = 21",
            "air_csv = {file = \"t.csv\", column = \"wind_m_s\"}",
            "6: ambient.air_csv column = \"wind_m_s\" must be a column in a unit of this signal, one of _degc, _k, _degf: the end of a column's name is its unit",
        ),
        (
            "film_w_m2_k = 8",
            "film_w_m2_k = 8\nwind_m_s = 3",
            "7: ambient film_w_m2_k cannot stand beside the wind: give the film coefficient, or the wind that it is computed from",
        ),
        (
            "film_w_m2_k = 8",
            "film_w_m2_k = 0",
            "7: ambient film_w_m2_k = 0 must be positive and at most 10000 W/m2/K: still air has about 8, wind 20 to 100",
        ),
        (
            "film_w_m2_k = 8",
            "wind_km_h = -3",
            "7: ambient wind_km_h = -3 must be between 0 and 200 m/s: 0 is still air",
        ),
        (
            "film_w_m2_k = 8",
            "[[ambient.air_change]]\nat_h = 1\nto_degc = 3\n[[ambient.air_change]]\nat_min = 10\nto_degc = 5",
            "11: ambient.air_change at_min = 10 must be at least 1 h, the end of the change before: sort the changes by time",
        ),
        (
            "film_w_m2_k = 8",
            "[[ambient.wind_change]]\nat_h = 1\nto_m_s = 3",
            "5: ambient wind_m_s is missing: say the value before the first change",
        ),
        (
            "film_w_m2_k = 8",
            "[[leak]]\nflow_g_h = 0",
            "8: leak flow_g_h = 0 must be positive: the direction is clear from [[leak]], [[discharge]] or [[refill]]",
        ),
        (
            "film_w_m2_k = 8",
            "[[leak]]\nname = \"a\"",
            "7: leak flow_g_h is missing: give a mass flow, e.g. flow_g_h = 20, or the bore of a hole, e.g. diameter_mm = 0.1",
        ),
        (
            "film_w_m2_k = 8",
            "[[leak]]\nflow_g_h = 1\n[[leak]]\nname = \"leak\"\nflow_g_h = 2",
            "10: leak name = \"leak\" must be a name that no other flow has: events tell flows apart by their names",
        ),
        (
            "film_w_m2_k = 8",
            "[[leak]]\nflow_g_h = 1\ndiameter_mm = 1",
            "9: leak diameter_mm cannot stand beside flow: give the mass flow or the bore of a hole",
        ),
        (
            "film_w_m2_k = 8",
            "[[leak]]\nflow_g_h = 1\nstart_h = 1\nstop_min = 10",
            "10: leak stop_min = 10 must be later than the start at 1 h: leave it out for a flow to the end",
        ),
        (
            "film_w_m2_k = 8",
            "[[sensor]]\nname = \"sholder\"",
            "8: sensor name = \"sholder\" is not known, did you mean shoulder?; choose one of bottom, middle, shoulder, neck, valve",
        ),
        (
            "film_w_m2_k = 8",
            "[[sensor]]\nname = \"shoulder\"\nair_coupling = 2",
            "9: sensor air_coupling = 2 must be between 0 and 1: 0 is a sensor in ideal contact, 0.15 to 0.2 a strapped one",
        ),
        (
            "film_w_m2_k = 8",
            "[sun]\nvalve = true",
            "5: ambient irradiance_w_m2 is missing: say how strong the sun of [sun] is",
        ),
        (
            "film_w_m2_k = 8",
            "[limits]\npressure_bar = [160, -1]",
            "8: limits pressure_bar = -1 must be between 1 Pa and 2000 bar absolute: check the unit, _bar is absolute and _barg above the atmosphere",
        ),
        ("film_w_m2_k = 8", "[limits]\npressure_bar = 160", "8: limits pressure_bar = 160 must be a list"),
    ];
    for (from, to, expected) in cases {
        let message = scenario_with(from, to).unwrap_err();
        assert_eq!(message, format!("scenarios/x.toml:{expected}"), "for {to:?}");
    }
}

#[test]
fn each_fault_of_a_table_names_its_file_and_line() {
    let cases = [
        ("word", "3: air_degc = warm must be a finite number: write a number or leave it out"),
        (
            "hot",
            "3: air_degc = 9999 must be between 60 K and 1500 K (-213 degC and 1227 degC): check the unit, _degc or _k",
        ),
        (
            "back",
            "4: time_min = 60 must be at least 2 h, the time before: sort the rows; the same time twice is a jump",
        ),
        ("ragged", "3: the text cannot be read: CSV error: "),
        (
            "timeless",
            "1: the time column is missing: name one of the columns time_s, time_min, time_h or time_d",
        ),
        ("empty", "1: a value of air_degc is missing: give at least one row with a time and a value"),
    ];
    for (file, expected) in cases {
        let column = format!("air_csv = {{ file = '{file}.csv', column = 'air_degc' }}");
        let message = scenario_with("air_degc = 21", &column).unwrap_err();
        assert!(message.starts_with(&format!("{file}.csv:{expected}")), "{message}");
    }
}
