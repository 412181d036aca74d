//! Documents: units, messages, presets, schema, and that no text makes the reader panic.
// The lint's exception for tests covers test functions, not what they share.
#![allow(clippy::unwrap_used)]

mod forms;
mod presets;
mod property;
mod scenario_messages;
mod schema;
mod sensor_messages;
mod sensors;
mod units;
mod vessel_messages;

/// The built-in vessel with one piece of its text replaced.
fn vessel_with(from: &str, to: &str) -> String {
    let text = cylwatch_thermal::vessel::presets::FILES.text("nitrogen-20l").unwrap();
    assert_eq!(text.matches(from).count(), 1, "{from:?} has to stand once in the vessel");
    text.replace(from, to)
}

/// The message that reading the vessel gives.
fn vessel_message(text: &str) -> String {
    cylwatch_thermal::vessel::read_vessel(text, "vessels/x.toml").unwrap_err().to_string()
}

/// A CSV table that scenario tests name as `t.csv`.
const TABLE: &str = "# made up\ntime_min,air_degc,wind_m_s\n0,10,1\n30,,2\n60,20,\n";

fn files(name: &str) -> std::io::Result<String> {
    match name {
        "t.csv" => Ok(TABLE.to_owned()),
        "word.csv" => Ok("time_s,air_degc\n0,10\n60,warm\n".to_owned()),
        "hot.csv" => Ok("time_s,air_degc\n0,10\n60,9999\n".to_owned()),
        "back.csv" => Ok("time_min,air_degc\n0,10\n120,11\n60,12\n".to_owned()),
        "ragged.csv" => Ok("time_s,air_degc\n0,10\n60\n".to_owned()),
        "timeless.csv" => Ok("t,air_degc\n0,10\n".to_owned()),
        "flow.csv" => {
            Ok("# a flow meter\ntime_min,leak_g_s,back_g_s,source_barg\n0,0,0,200\n1,2.5,-1,190\n120,2.5,0,150\n".to_owned())
        }
        "empty.csv" => Ok("time_s,air_degc\n".to_owned()),
        _ => Err(std::io::Error::from(std::io::ErrorKind::NotFound)),
    }
}

/// Record of a calibration, to stand below a vessel.
const CALIBRATION: &str = r#"
[calibration]
date = "2026-03-01T12:00:00Z"
program = "cylwatch 0.1.0"
settings = "air of the log"
confidence = 0.95
[calibration.vessel]
name = "x.toml"
sha256 = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
[[calibration.log]]
name = "run.csv"
sha256 = "BA7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
[[calibration.fitted]]
parameter = "wall-capacity"
unit = "1"
value = 1.2
sd = 0.01
low = 1.18
high = 1.22
[[calibration.fitted]]
parameter = "initial-temperature"
of_log = "run.csv"
unit = "K"
value = 0.2
sd = 0.1
low = 0.0
high = 0.4
prior = { mean = 0.0, sd = 1.0 }
"#;

const SCENARIO: &str = r#"name = "x"
duration_h = 2
[initial]
pressure_bar = 100
[ambient]
air_degc = 21
film_w_m2_k = 8
"#;

/// Reads [`SCENARIO`] with one piece of its text replaced.
fn scenario_with(from: &str, to: &str) -> Result<cylwatch_thermal::scenario::Scenario, String> {
    assert_eq!(SCENARIO.matches(from).count(), 1, "{from:?} has to stand once in the scenario");
    let text = SCENARIO.replace(from, to);
    cylwatch_thermal::scenario::read_scenario(&text, "scenarios/x.toml", &files).map_err(|e| e.to_string())
}
