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
            "film_w_m2_k = -1",
            "7: ambient film_w_m2_k = -1 must be between 0 and 10000 W/m2/K: 0 lets no heat through, still air has about 8, wind 20 to 100",
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
            "7: leak flow_g_h is missing: give a mass flow, e.g. flow_g_h = 20, the bore of a hole, e.g. diameter_mm = 0.1, or the Kv of a valve, e.g. kv_m3_h = 0.4",
        ),
        (
            "film_w_m2_k = 8",
            "[[leak]]\nflow_g_h = 1\n[[leak]]\nname = \"leak\"\nflow_g_h = 2",
            "10: leak name = \"leak\" must be a name that no other flow has: events tell flows apart by their names",
        ),
        (
            "film_w_m2_k = 8",
            "[[leak]]\nflow_g_h = 1\ndiameter_mm = 1",
            "9: leak diameter_mm cannot stand beside flow: give the mass flow, the bore of a hole, or the Kv of a valve",
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

/// A refill without its source, to be completed.
fn refill(rest: &str) -> String {
    format!("film_w_m2_k = 8\n[[refill]]\n{rest}")
}

#[test]
fn each_fault_of_a_refill_or_a_valve_names_line_key_and_remedy() {
    let source = "source_temperature_degc = 20\nsource_pressure_bar = 300\n";
    let cases = [
        (String::new(), "8: refill flow_g_h is missing: give a mass flow, e.g. flow_g_h = 20, the bore of a hole, e.g. diameter_mm = 0.1, or the Kv of a valve, e.g. kv_m3_h = 0.4"),
        (
            "diameter_mm = 2\nsource_pressure_bar = 300\n".to_owned(),
            "8: refill source_temperature_degc is missing: say how warm the gas of the source is",
        ),
        (
            "diameter_mm = 2\nsource_temperature_degc = 20\n".to_owned(),
            "8: refill source_pressure_bar is missing: say the pressure of the source",
        ),
        (
            format!("diameter_mm = 2\nkv_m3_h = 1\n{source}"),
            "10: refill kv_m3_h cannot stand beside diameter: give the mass flow, the bore of a hole, or the Kv of a valve",
        ),
        (
            format!("kv_l_min = 1\n{source}"),
            "9: refill kv_l_min is in _l_min, which is no unit of kv: use one of _m3_h",
        ),
        (
            format!("kv_m3_h = 1\ndischarge_coefficient = 0.8\n{source}"),
            "10: refill discharge_coefficient cannot stand beside kv: it belongs to an orifice of some diameter",
        ),
        (
            format!("diameter_mm = 1\nx_t = 0.7\n{source}"),
            "10: refill x_t cannot stand beside diameter: it belongs to a valve of some kv_m3_h",
        ),
        (
            format!("kv_m3_h = 1\nx_t = 1\n{source}"),
            "10: refill x_t = 1 must be between 0.1 and 0.8: 0.72 is a globe valve, 0.25 to 0.4 a ball or butterfly valve",
        ),
        (
            format!("kv_m3_h = 0\n{source}"),
            "9: refill kv_m3_h = 0 must be positive: give the flow coefficient of the data sheet, 0.01 to 100 are usual; Cv is 1.156 Kv",
        ),
        (
            format!("diameter_mm = 1\ndischarge_coefficient = 0.8\ndischarge_coefficient_ideal_gas = 0.8\n{source}"),
            "11: refill discharge_coefficient_ideal_gas cannot stand beside discharge_coefficient: keep the one that was measured",
        ),
        (
            format!("diameter_mm = 1\ndischarge_coefficient_ideal_gas = 1.1\n{source}"),
            "10: refill discharge_coefficient_ideal_gas = 1.1 must be between 0 and 1: 0.6 to 0.9 are usual",
        ),
        (
            format!("flow_g_s = 1\nsource_volume_l = 50\n{source}"),
            "10: refill source_volume_l cannot stand beside flow: a vessel gives what passes an orifice (diameter) or a valve (kv)",
        ),
        (
            format!("diameter_mm = 1\nsource_process = \"adiabatic\"\n{source}"),
            "10: refill source_process cannot stand beside a source without volume: it belongs to a source vessel: give source_volume_l, or leave it out",
        ),
        (
            format!("diameter_mm = 1\nsource_volume_l = 50\nsource_process = \"slow\"\n{source}"),
            "11: refill source_process = \"slow\" is not known; choose one of adiabatic, isothermal",
        ),
        (
            format!("diameter_mm = 1\nsource_volume_l = 0\n{source}"),
            "10: refill source_volume_l = 0 must be positive: give the inner volume of the vessel that the gas is taken from",
        ),
        (
            "diameter_mm = 1\nsource_volume_l = 50\nsource_temperature_degc = 20\nsource_pressure_table = {time_s = [0], pressure_bar = [3]}\n"
                .to_owned(),
            "12: refill source_pressure_table cannot stand beside source_volume: a vessel has its state at time 0 alone",
        ),
        (
            format!("diameter_mm = 1\n{source}source_pressure_table = {{time_s = [0], pressure_bar = [3]}}\n"),
            "11: refill source_pressure_bar cannot stand beside source_pressure_table: say the signal in one form",
        ),
        (
            format!("flow_table = {{time_s = [0, 10], flow_g_s = [1, -2]}}\n{source}"),
            "9: refill.flow_table flow_g_s = -2 must be between 0 and 100 kg/s: the direction is clear from [[leak]], [[discharge]] or [[refill]]; check the unit, _g_h or _kg_s",
        ),
        (
            format!("flow_csv = {{file = \"flow.csv\", column = \"air_degc\"}}\n{source}"),
            "9: refill.flow_csv column = \"air_degc\" must be a column in a unit of this signal, one of _g_h, _kg_s, _g_s, _kg_h: the end of a column's name is its unit",
        ),
    ];
    for (rest, expected) in cases {
        let message = scenario_with("film_w_m2_k = 8", &refill(&rest)).unwrap_err();
        assert_eq!(message, format!("scenarios/x.toml:{expected}"), "for {rest:?}");
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
    let flow = "film_w_m2_k = 8\n[[leak]]\nflow_csv = { file = 'flow.csv', column = 'back_g_s' }";
    let message = scenario_with("film_w_m2_k = 8", flow).unwrap_err();
    assert!(message.starts_with("flow.csv:4: back_g_s = -1 must be between 0 and 100 kg/s"), "{message}");
}
