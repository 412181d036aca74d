//! Leak or cold: two cylinders show the same pressure, how much gas is in them?
//!
//! `cargo run --release --example leak`
//!
//! One cylinder is tight and cools from 15 to -15 °C. The other stays at 15 °C and leaks 60 g/h until its gauge
//! shows what the cold one's does. Pressure and gas temperature together give the mass, and that differs.
#![allow(clippy::print_stdout)]

use anyhow::Context;
use cylwatch::report::aligned;
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::trajectory::Trajectory;
use cylwatch::thermal::{scenario, vessel};

const SCENARIO: &str = r#"
name = "leak or cold"
duration_h = 16
sample_time_min = 1

[initial]
fill_pressure_bar = 200
temperature_degc = 15

[ambient]
air_degc = 15
film_w_m2_k = 20
"#;

const COLD: &str = "
[[ambient.air_change]]
at_min = 0
over_h = 6
to_degc = -15
";

const LEAK: &str = "
[[leak]]
flow_g_h = 60
";

/// What is known of a cylinder at one time.
pub(crate) struct Reading {
    /// Which cylinder.
    pub cylinder: &'static str,
    /// Time, h.
    pub time_h: f64,
    /// Gauge, bar.
    pub pressure_bar: f64,
    /// Mean gas temperature, °C.
    pub gas_degc: f64,
    /// Mass from pressure and temperature, kg.
    pub mass_kg: f64,
    /// Mass that is gone since the start, g.
    pub lost_g: f64,
}

// ANCHOR: run
/// Runs both; the second is read when its gauge shows what the first one's shows at the end.
pub(crate) fn run() -> anyhow::Result<[Reading; 2]> {
    let cold = simulated(COLD)?;
    let leaky = simulated(LEAK)?;
    let end = cold.time_s.len() - 1;
    let same = leaky.pressure_pa.iter().position(|&p| p <= cold.pressure_pa[end]);
    let same = same.context("the leak is too small to reach this pressure")?;
    Ok([reading("cold", &cold, end)?, reading("leaking", &leaky, same)?])
}

fn simulated(what_happens: &str) -> anyhow::Result<Trajectory> {
    let vessel = vessel::presets::load("nitrogen-20l")?;
    let text = format!("{SCENARIO}{what_happens}");
    let scenario = scenario::read_scenario(&text, "leak or cold", &scenario::presets::table)?;
    Ok(simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?)
}

/// The mass comes from what can be known outside: pressure, temperatures, and the vessel.
fn reading(cylinder: &'static str, run: &Trajectory, k: usize) -> anyhow::Result<Reading> {
    let mass_kg = |k: usize| -> anyhow::Result<f64> {
        let (pressure_pa, gas_k) = (run.pressure_pa[k], run.gas_mean_k[k]);
        let density_kg_m3 = run.vessel.fluid.density_from_pressure_temperature(pressure_pa, gas_k)?;
        Ok(density_kg_m3 * run.vessel.volume.volume_m3(run.wall_mean_k[k], pressure_pa))
    };
    Ok(Reading {
        cylinder,
        time_h: run.time_s[k] / 3600.0,
        pressure_bar: run.pressure_pa[k] / 1e5,
        gas_degc: run.gas_mean_k[k] - 273.15,
        mass_kg: mass_kg(k)?,
        lost_g: 1e3 * (mass_kg(0)? - mass_kg(k)?),
    })
}
// ANCHOR_END: run

fn main() -> anyhow::Result<()> {
    let rows = run()?.map(|Reading { cylinder, time_h, pressure_bar, gas_degc, mass_kg, lost_g }| {
        vec![
            cylinder.into(),
            format!("{time_h:.1}"),
            format!("{pressure_bar:.1}"),
            format!("{gas_degc:.1}"),
            format!("{mass_kg:.3}"),
            // Adding zero turns a rounded -0 into 0.
            format!("{:.0}", lost_g.round() + 0.0),
        ]
    });
    let header = ["cylinder", "time / h", "gauge / bar", "gas / degC", "gas / kg", "lost / g"];
    print!("{}", aligned(&header, &rows));
    println!("\nThe gauge cannot tell them apart; the gas temperature can.");
    Ok(())
}
