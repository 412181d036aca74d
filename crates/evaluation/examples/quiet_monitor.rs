//! What the monitor as a whole says of tight cylinders: leaks, exchanges of gas and faults of sensors that are none.
//!
//! `cargo run --release -p cylwatch-evaluation --example quiet_monitor -- [SEEDS [DAYS]]` (default 12 winters of 122 d, a row a minute, each
//! read by four sets of sensors: 16 cylinder-years, ten minutes on two cores). `SEEDS`: a count, or `first..end` of those that there are.
//!
//! The long run judges the evidence for a leak alone; here sensors are watched, jumps examined and rows taken in as well, and any of them
//! can go wrong. No seed is shared with the runs that thresholds were fitted to.
#![allow(clippy::print_stdout)]
#[path = "shared/seeds.rs"]
mod seeds;

use std::collections::BTreeMap;
use std::error::Error;

use cylwatch_detector::monitor::{EventKind, Health, Monitor, MonitorSettings};
use cylwatch_estimator::observer::Commissioning;
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::presets;
use cylwatch_evaluation::performance::{AlarmRate, YEAR_S};
use cylwatch_evaluation::truth::{Course, Truth, TruthSettings, generate_sets};
use rayon::prelude::*;

use seeds::seeds;

type Failure = Box<dyn Error + Send + Sync>;

const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];
const FIRST_SEED: u64 = 70_001;
/// Sets of sensors on each simulated cylinder.
const SETS: u64 = 4;
const INTERVAL_S: f64 = 60.0;
const DAY_S: f64 = 86_400.0;

/// How often each kind was said, and by how many cylinders.
type Said = BTreeMap<&'static str, u64>;

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1);
    let seeds = seeds(&arguments.next().unwrap_or_else(|| "12".into()), 0)?;
    let days: f64 = arguments.next().map_or(Ok(122.0), |text| text.parse())?;
    let all: Vec<Vec<Said>> =
        seeds.into_par_iter().map(|seed| simulation(FIRST_SEED + seed, days)).collect::<Result<_, _>>()?;
    let cylinders: Vec<&Said> = all.iter().flatten().collect();
    let years = cylinders.len() as f64 * days * DAY_S / YEAR_S;
    println!("{} cylinders, {years:.1} years\n", cylinders.len());
    println!(
        "| said of a tight cylinder | times | cylinders | first ones in 10 years (95 %) |\n|---|---|---|---|"
    );
    for kind in [
        "leak",
        "discharge",
        "refill",
        "restart",
        "thermometer shifted",
        "sensor detached",
        "transmitter shifted",
        "thermometers swapped",
        "channel late",
        "disturbed",
    ] {
        let times: u64 = cylinders.iter().filter_map(|said| said.get(kind)).sum();
        let with_one = cylinders.iter().filter(|said| said.contains_key(kind)).count() as u64;
        let first = AlarmRate { alarms: with_one, at_risk_s: years * YEAR_S };
        let (low, high) = first.per_year_interval(0.95);
        println!(
            "| {kind} | {times} | {with_one} of {} | {:.2} ({:.2} to {:.2}) |",
            cylinders.len(),
            10.0 * first.per_year(),
            10.0 * low,
            10.0 * high
        );
    }
    Ok(())
}

/// One cylinder in its weather, watched through each set of sensors.
fn simulation(seed: u64, days: f64) -> Result<Vec<Said>, Failure> {
    let course = Course::RailwayWeeks { days };
    let settings = TruthSettings::fast();
    let truths = generate_sets(&course, seed, INTERVAL_S, &settings, 0..SETS)?;
    truths.map(|truth| said(&truth?)).collect()
}

/// What the monitor says of a truth.
fn said(truth: &Truth) -> Result<Said, Failure> {
    let sensors = SENSORS.iter().map(|name| Sensor::typical(name)).collect::<Result<Vec<_>, _>>()?;
    let filled = Commissioning { settled: false, ..Commissioning::filled(200e5, 288.15) };
    let vessel = presets::load("nitrogen-20l")?;
    let mut monitor = Monitor::new(&vessel, &sensors, &filled, &MonitorSettings::default())?;
    let column = |name: &&str| truth.log.channels.iter().position(|channel| channel.name == **name);
    let columns =
        SENSORS.iter().map(|name| column(name).ok_or("it is read")).collect::<Result<Vec<_>, _>>()?;
    let mut said = Said::new();
    for (time_s, row) in truth.log.rows() {
        let readings: Vec<f64> = columns.iter().map(|&column| row[column]).collect();
        for output in monitor.step(time_s, &readings)? {
            for kind in output.events.iter().filter_map(|event| kind(&event.kind)) {
                *said.entry(kind).or_default() += 1;
            }
        }
    }
    Ok(said)
}

fn kind(event: &EventKind) -> Option<&'static str> {
    Some(match event {
        EventKind::LeakFound(_) => "leak",
        EventKind::Discharge(_) => "discharge",
        EventKind::Refill(_) => "refill",
        EventKind::Restarted => "restart",
        EventKind::Swapped(_) => "thermometers swapped",
        EventKind::Late { .. } => "channel late",
        EventKind::Disturbed { .. } => "disturbed",
        EventKind::Sensor { sensor, health: Health::Shifted(_) } if SENSORS[*sensor] == "pressure" => {
            "transmitter shifted"
        }
        EventKind::Sensor { health: Health::Shifted(_), .. } => "thermometer shifted",
        EventKind::Sensor { health: Health::Detached, .. } => "sensor detached",
        _ => return None,
    })
}
