//! What the monitor says of the built-in winter week, tight, and of the same week in other surroundings.
//!
//! `cargo run --release -p cylwatch-evaluation --example weeks -- [SEEDS]` (default 5 sets of sensors; a quarter of a minute on two cores): rows of 10, 60 and 120 s; sun and wind
//! doubled, halved and off; tunnels of up to 55 °C; gas in layers.
//!
//! The simulation is that of `cylwatch simulate nitrogen-20l railway-week`, its sensors are drawn by seed; the monitor is that of `cylwatch monitor
//! nitrogen-20l`, told of the fill of 200 bar at 15 °C and nothing else.
#![allow(clippy::print_stdout)]
use cylwatch_thermal::units::DAY_S;
use std::error::Error;

use cylwatch_detector::monitor::{EventKind, Health, Monitor, MonitorSettings, Verdict};
use cylwatch_estimator::log::Log;
use cylwatch_estimator::observer::Commissioning;
use cylwatch_estimator::sensor::{Sensor, SensorSuite, sample_at};
use cylwatch_evaluation::thermal::scenario::{OutsideFilm, Scenario, presets as scenarios};
use cylwatch_evaluation::thermal::simulate::{SimulationSettings, simulate};
use cylwatch_evaluation::thermal::vessel::{GasResolution, Stratification, Vessel, presets};
use rayon::prelude::*;

type Failure = Box<dyn Error + Send + Sync>;

/// Air that is warmer than this is a tunnel's, K; what the warmest tunnel has, K.
const TUNNEL_K: f64 = 293.15;
const WARMEST_K: f64 = 328.15;

/// A week: its name, interval of the rows, s, and what is done to the preset.
struct Week {
    name: &'static str,
    interval_s: f64,
    sun: f64,
    wind: f64,
    warm_tunnels: bool,
    layers: bool,
}

const USUAL: Week =
    Week { name: "rows of 60 s", interval_s: 60.0, sun: 1.0, wind: 1.0, warm_tunnels: false, layers: false };

const WEEKS: [Week; 11] = [
    Week { name: "rows of 10 s", interval_s: 10.0, ..USUAL },
    USUAL,
    Week { name: "rows of 120 s", interval_s: 120.0, ..USUAL },
    Week { name: "sun doubled", sun: 2.0, ..USUAL },
    Week { name: "sun halved", sun: 0.5, ..USUAL },
    Week { name: "no sun", sun: 0.0, ..USUAL },
    Week { name: "wind doubled", wind: 2.0, ..USUAL },
    Week { name: "wind halved", wind: 0.5, ..USUAL },
    Week { name: "no wind", wind: 0.0, ..USUAL },
    Week { name: "tunnels to 55 °C", warm_tunnels: true, ..USUAL },
    Week { name: "gas in layers", layers: true, ..USUAL },
];

/// Counts: rows after the first day, and whatever was told in all of the log.
#[derive(Default)]
struct Counts {
    rows: usize,
    tight: usize,
    exchanges: usize,
    faults: usize,
    leaks: usize,
}

fn main() -> Result<(), Failure> {
    let seeds: u64 = std::env::args().nth(1).map_or(Ok(5), |text| text.parse())?;
    println!(
        "| week | tight after the first day, worst of {seeds} sets of sensors | exchanges | sensor faults | leaks |"
    );
    println!("|---|---:|---:|---:|---:|");
    let weeks: Vec<Vec<Counts>> =
        WEEKS.par_iter().map(|week| watched(week, seeds)).collect::<Result<_, _>>()?;
    for (week, sets) in WEEKS.iter().zip(weeks) {
        let worst = sets.iter().map(|of| of.tight as f64 / of.rows as f64).fold(1.0, f64::min);
        let sum = |of: fn(&Counts) -> usize| sets.iter().map(of).sum::<usize>();
        println!(
            "| {} | {:.1} % | {} | {} | {} |",
            week.name,
            100.0 * worst,
            sum(|of| of.exchanges),
            sum(|of| of.faults),
            sum(|of| of.leaks)
        );
    }
    Ok(())
}

/// One simulation, read by each set of sensors.
fn watched(week: &Week, seeds: u64) -> Result<Vec<Counts>, Failure> {
    let mut vessel = presets::load("nitrogen-20l")?;
    let told = vessel.clone();
    if week.layers {
        vessel.gas = GasResolution::Stratified(Stratification { cells: 8, ..Stratification::default() });
    }
    let scenario = changed(week)?;
    let suite = SensorSuite::try_new(scenario.sensors.iter().map(Sensor::from).collect())?;
    let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
    let rows = (scenario.duration_s / week.interval_s) as usize;
    let times_s: Vec<f64> = (0..=rows).map(|row| week.interval_s * row as f64).collect();
    (1..=seeds).map(|seed| counts(&told, &sample_at(&run, &suite.draw(seed), &times_s, seed)?)).collect()
}

/// The preset with this week's sun, wind and tunnels.
fn changed(week: &Week) -> Result<Scenario, Failure> {
    let mut scenario = scenarios::load("railway-week")?;
    let surroundings = &mut scenario.surroundings;
    if let Some(sun) = &mut surroundings.sun {
        sun.irradiance_w_m2 = sun.irradiance_w_m2.scaled(week.sun)?;
    }
    if let OutsideFilm::Convection { wind_m_s, .. } = &mut surroundings.film {
        *wind_m_s = wind_m_s.scaled(week.wind)?;
    }
    if week.warm_tunnels {
        let by_k = WARMEST_K - surroundings.air_k.range().1;
        surroundings.air_k =
            surroundings.air_k.mapped(|air_k| if air_k > TUNNEL_K { air_k + by_k } else { air_k })?;
    }
    Ok(scenario)
}

/// What the monitor says of a log, with typical sensors of the names in it.
fn counts(vessel: &Vessel, log: &Log) -> Result<Counts, Failure> {
    let sensors: Vec<Sensor> =
        log.channels.iter().map(|channel| Sensor::typical(&channel.name)).collect::<Result<_, _>>()?;
    let filled = Commissioning { settled: false, ..Commissioning::filled(200e5, 288.15) };
    let mut monitor = Monitor::new(vessel, &sensors, &filled, &MonitorSettings::default())?;
    let mut counts = Counts::default();
    for (time_s, readings) in log.rows() {
        for output in monitor.step(time_s, readings)? {
            let count =
                |is: fn(&EventKind) -> bool| output.events.iter().filter(|event| is(&event.kind)).count();
            counts.exchanges += count(|kind| matches!(kind, EventKind::Discharge(_) | EventKind::Refill(_)));
            counts.faults +=
                count(|kind| matches!(kind, EventKind::Sensor { health, .. } if *health != Health::Good));
            counts.leaks += count(|kind| matches!(kind, EventKind::LeakFound(_)));
            if time_s > DAY_S {
                counts.rows += 1;
                counts.tight += usize::from(output.decision.verdict == Verdict::Tight);
            }
        }
    }
    Ok(counts)
}
