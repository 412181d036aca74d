//! How long does the gas lag behind shoulder and valve?
//!
//! `cargo run --release --example scenario_2`
//!
//! The paper's second scenario: a cylinder at -25 °C comes into 40 °C air. For each place outside: how much later
//! the gas is half way, and by how much the place is warmer than the gas at most. The sensors read nearer to
//! the air than their surfaces are, so they run ahead still more.
#![allow(clippy::print_stdout)]

use anyhow::Context;
use cylwatch::estimator::sensor::SensorKind;
use cylwatch::report::{Readings, aligned};
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::{scenario, vessel};

/// How the gas follows a place on the outside.
pub(crate) struct Lag {
    /// The place or its sensor.
    pub place: String,
    /// How much later the gas is half way, s.
    pub lag_s: f64,
    /// Largest difference to the mean gas temperature, K.
    pub largest_k: f64,
}

/// Half way from -25 to 40 °C, K.
const HALF_WAY_K: f64 = 273.15 + 7.5;

/// Runs the scenario.
pub(crate) fn run() -> anyhow::Result<Vec<Lag>> {
    let vessel = vessel::presets::load("nitrogen-20l")?;
    let scenario = scenario::presets::load("tunnel-winter")?;
    let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
    let mut outside = Vec::new();
    for place in ["bottom", "middle", "shoulder", "valve"] {
        outside.push((place.to_owned(), run.surface_k(place).context("no such place")?));
    }
    for (sensor, k) in Readings::expected(&run)?.columns() {
        if let SensorKind::Surface { .. } = sensor.kind {
            outside.push((format!("{} sensor", sensor.name), k));
        }
    }
    let passes = |k: &[f64]| passing_s(&run.time_s, k).context("it never gets half way");
    let gas_s = passes(&run.gas_mean_k)?;
    outside
        .into_iter()
        .map(|(place, k)| {
            let largest_k =
                k.iter().zip(&run.gas_mean_k).map(|(outside, gas)| outside - gas).fold(0.0, f64::max);
            Ok(Lag { place, lag_s: gas_s - passes(&k)?, largest_k })
        })
        .collect()
}

/// When a rising temperature is half way, s.
fn passing_s(time_s: &[f64], temperature_k: &[f64]) -> Option<f64> {
    let k = temperature_k.iter().position(|&t| t >= HALF_WAY_K).filter(|&k| k > 0)?;
    let share = (HALF_WAY_K - temperature_k[k - 1]) / (temperature_k[k] - temperature_k[k - 1]);
    Some(time_s[k - 1] + share * (time_s[k] - time_s[k - 1]))
}

fn main() -> anyhow::Result<()> {
    let rows = run()?
        .into_iter()
        .map(|Lag { place, lag_s, largest_k }| vec![place, format!("{lag_s:.0}"), format!("{largest_k:.1}")]);
    print!("{}", aligned(&["place", "gas later / s", "warmer by up to / K"], &rows.collect::<Vec<_>>()));
    println!("\nThe gas is a good minute behind the wall, and minutes behind what the sensors read.");
    Ok(())
}
