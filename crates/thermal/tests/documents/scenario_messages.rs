//! Every message about a scenario file, one broken input at a time.
use super::scenario_with;

#[test]
fn each_fault_of_a_scenario_names_line_key_and_remedy() {
    let cases = [
        ("duration_h = 2", "duration_h = 0"),
        ("duration_h = 2", ""),
        ("duration_h = 2", "duration_bar = 0"),
        ("duration_h = 2", "duration_h = 2\nsample_time_h = 3"),
        ("pressure_bar = 100", ""),
        ("pressure_bar = 100", "pressure_bar = 100\nmass_kg = 3"),
        ("pressure_bar = 100", "pressure_bar = 100\nfill_temperature_degc = 3"),
        ("air_degc = 21", ""),
        ("air_degc = 21", "air_k = 21"),
        ("air_degc = 21", "air_degc = 21\nair_table = {time_h = [0, 1], air_degc = [1, 2]}"),
        ("air_degc = 21", "air_table = {time_h = [0, 1, 0.5], air_degc = [1, 2, 3]}"),
        ("air_degc = 21", "air_table = {time_h = [0, 1, 1, 1], air_degc = [1, 2, 3, 4]}"),
        ("air_degc = 21", "air_table = {time_h = [0, 1], air_degc = [1]}"),
        ("air_degc = 21", "air_table = {time_h = [0, \n nan], air_degc = [1, 3]}"),
        ("air_degc = 21", "air_csv = {file = \"u.csv\", column = \"air_degc\"}"),
        ("air_degc = 21", "air_csv = {file = \"t.csv\", column = \"ar_degc\"}"),
        ("air_degc = 21", "air_csv = {file = \"t.csv\", column = \"air\"}"),
        ("air_degc = 21", "air_csv = {file = \"t.csv\", column = \"wind_m_s\"}"),
        ("film_w_m2_k = 8", "film_w_m2_k = 8\nwind_m_s = 3"),
        ("film_w_m2_k = 8", "film_w_m2_k = 0"),
        ("film_w_m2_k = 8", "wind_km_h = -3"),
        ("film_w_m2_k = 8", "[[ambient.air_change]]\nat_h = 1\nto_degc = 3\n[[ambient.air_change]]\nat_min = 10\nto_degc = 5"),
        ("film_w_m2_k = 8", "[[ambient.wind_change]]\nat_h = 1\nto_m_s = 3"),
        ("film_w_m2_k = 8", "[[leak]]\nflow_g_h = 0"),
        ("film_w_m2_k = 8", "[[leak]]\nname = \"a\""),
        ("film_w_m2_k = 8", "[[leak]]\nflow_g_h = 1\n[[leak]]\nname = \"leak\"\nflow_g_h = 2"),
        ("film_w_m2_k = 8", "[[leak]]\nflow_g_h = 1\ndiameter_mm = 1"),
        ("film_w_m2_k = 8", "[[leak]]\nflow_g_h = 1\nstart_h = 1\nstop_min = 10"),
        ("film_w_m2_k = 8", "[[sensor]]\nname = \"sholder\""),
        ("film_w_m2_k = 8", "[[sensor]]\nname = \"shoulder\"\nair_coupling = 2"),
        ("film_w_m2_k = 8", "[sun]\nvalve = true"),
        ("film_w_m2_k = 8", "[limits]\npressure_bar = [160, -1]"),
        ("film_w_m2_k = 8", "[limits]\npressure_bar = 160"),
    ];
    for (from, to) in cases {
        println!("{to:?}\n    {}", scenario_with(from, to).unwrap_err());
    }
}
