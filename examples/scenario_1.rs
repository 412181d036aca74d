//! How far does the gauge fall when a tight cylinder goes from 21 °C into the cold, and when does it pass 160 bar?
//!
//! `cargo run --release --example scenario_1`
//!
//! The paper's first scenario, a step to -25 °C, and two colder ones. At -25 °C the gauge stays just above the
//! limit; five degrees colder it alarms, and no gas is lost.
#![allow(clippy::print_stdout)]

use anyhow::Context;
use cylwatch::report::aligned;
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::trajectory::EventKind;
use cylwatch::thermal::{scenario, vessel};

/// A step into cold air.
pub(crate) struct Fall {
    /// Air after the step, °C.
    pub air_degc: i32,
    /// Gauge before the step and after three hours, bar.
    pub pressure_bar: [f64; 2],
    /// Time at which it passes 160 bar, min; `None`: it does not.
    pub limit_min: Option<f64>,
}

/// Runs the three steps.
pub(crate) fn run() -> anyhow::Result<Vec<Fall>> {
    [-25, -30, -40].into_iter().map(fall).collect()
}

fn fall(air_degc: i32) -> anyhow::Result<Fall> {
    let preset = scenario::presets::FILES.text("shock-cold").context("no such scenario")?;
    let text = preset.replace("to_degc = -25", &format!("to_degc = {air_degc}"));
    let scenario = scenario::read_scenario(&text, "shock-cold, changed", &scenario::presets::table)?;
    let vessel = vessel::presets::load("nitrogen-20l")?;
    let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
    let limit =
        run.events.iter().find(|event| matches!(event.kind, EventKind::PressureLimit { falling: true, .. }));
    let end = run.pressure_pa.len() - 1;
    Ok(Fall {
        air_degc,
        pressure_bar: [run.pressure_pa[0] / 1e5, run.pressure_pa[end] / 1e5],
        limit_min: limit.map(|event| event.time_s / 60.0),
    })
}

fn main() -> anyhow::Result<()> {
    let rows = run()?.into_iter().map(|Fall { air_degc, pressure_bar: [before, after], limit_min }| {
        let limit = limit_min.map_or("never".into(), |minutes| format!("{minutes:.0}"));
        vec![
            air_degc.to_string(),
            format!("{before:.1}"),
            format!("{after:.1}"),
            format!("{:.1}", before - after),
            limit,
        ]
    });
    let header = ["air / degC", "before / bar", "after 3 h / bar", "fall / bar", "passes 160 bar / min"];
    print!("{}", aligned(&header, &rows.collect::<Vec<_>>()));
    println!("\nThe gauge of a tight cylinder falls by 45 bar at -25 degC; a few degrees colder it alarms.");
    Ok(())
}
