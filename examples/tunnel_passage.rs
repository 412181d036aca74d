//! What does a 160 bar switch do when a train passes a warm tunnel in winter?
//!
//! `cargo run --release --example tunnel_passage`
//!
//! A tight cylinder and one that has lost 15 % of its gas stand in air of -30 °C, spend half an hour in a tunnel of
//! 35 °C and come out again. The scenario is written here as a file would be.
#![allow(clippy::print_stdout)]

use cylwatch::report::aligned;
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::{scenario, vessel};

const SCENARIO: &str = r#"
name = "half an hour in a tunnel"
duration_h = 4
sample_time_s = 10

[initial]
fill_pressure_bar = 200
fill_temperature_degc = 15
temperature_degc = -30

[ambient]
air_degc = -30
film_w_m2_k = 20

[[ambient.air_change]]
at_min = 30
to_degc = 35

[[ambient.air_change]]
at_min = 60
to_degc = -30
"#;

/// Pressure below which the switch alarms, Pa.
const SWITCH_PA: f64 = 160e5;

/// What the switch said.
pub(crate) struct Passage {
    /// Which cylinder.
    pub cylinder: &'static str,
    /// Lowest and highest pressure, bar.
    pub pressure_bar: [f64; 2],
    /// Whether the switch alarms at the start.
    pub alarm_at_start: bool,
    /// Times at which it changes its mind, min.
    pub changes_min: Vec<f64>,
}

/// Runs both cylinders.
pub(crate) fn run() -> anyhow::Result<[Passage; 2]> {
    let poor = SCENARIO.replace("fill_pressure_bar = 200", "fill_pressure_bar = 170");
    Ok([passage("tight, 200 bar at 15 degC", SCENARIO)?, passage("leaky, 170 bar at 15 degC", &poor)?])
}

// ANCHOR: passage
fn passage(cylinder: &'static str, text: &str) -> anyhow::Result<Passage> {
    let vessel = vessel::presets::load("nitrogen-20l")?;
    let scenario = scenario::read_scenario(text, "tunnel passage", &scenario::presets::table)?;
    let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
    let alarms: Vec<bool> = run.pressure_pa.iter().map(|&p| p < SWITCH_PA).collect();
    let changes = (1..alarms.len()).filter(|&k| alarms[k] != alarms[k - 1]);
    Ok(Passage {
        cylinder,
        pressure_bar: [
            run.pressure_pa.iter().copied().fold(f64::INFINITY, f64::min) / 1e5,
            run.pressure_pa.iter().copied().fold(0.0, f64::max) / 1e5,
        ],
        alarm_at_start: alarms[0],
        changes_min: changes.map(|k| run.time_s[k] / 60.0).collect(),
    })
}
// ANCHOR_END: passage

fn main() -> anyhow::Result<()> {
    let rows = run()?.map(|Passage { cylinder, pressure_bar: [low, high], alarm_at_start, changes_min }| {
        let start = if alarm_at_start { "alarm" } else { "silent" };
        let changes: Vec<String> = changes_min.iter().map(|minutes| format!("{minutes:.0}")).collect();
        vec![cylinder.into(), format!("{low:.1}"), format!("{high:.1}"), start.into(), changes.join(", ")]
    });
    let header = ["cylinder", "lowest / bar", "highest / bar", "at the start", "switches over at / min"];
    print!("{}", aligned(&header, &rows));
    println!("\nThe tunnel silences the switch for the leaky cylinder as it does for the tight one.");
    Ok(())
}
