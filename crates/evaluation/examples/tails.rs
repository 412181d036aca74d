//! Tails of the evidence for a leak, fitted to leak-free worlds of the families that tune.
//!
//! `cargo run --release -p cylwatch-evaluation --example tails [-- PLAN]`
//!
//! Runs the monitor over all worlds of PLAN (`plans/tails.toml`; what is not tuning in it is left out), takes the largest statistics of each stretch of
//! operation and prints the tails as they stand in the library, and the thresholds of one false alarm in ten years with their 95 % intervals. Then the cylinders
//! whose statistics come closest to them, or above.
use std::io::Write as _;
use std::path::PathBuf;

use cylwatch_detector::evidence::{Scale, Statistics};
use cylwatch_detector::monitor::{Monitor, MonitorSettings};
use cylwatch_evaluation::judge::candidate::Registry;
use cylwatch_evaluation::judge::plan::{Plan, Role, Unit};
use cylwatch_evaluation::performance::YEAR_S;
use cylwatch_evaluation::tails::{Peaks, fit, interval};
use cylwatch_evaluation::world::{Simulated, World};
use rayon::prelude::*;

const YEARS: f64 = 10.0;
/// Cylinders that are shown.
const SHOWN: usize = 12;

type Fault = Box<dyn std::error::Error + Send + Sync>;

/// What the statistics of a cylinder did.
struct Run {
    family: String,
    seed: u64,
    length_s: f64,
    peaks: Peaks,
    largest: Statistics,
}

fn main() -> Result<(), Fault> {
    let usual = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/plans/tails.toml"));
    let plan = Plan::read(&std::env::args().nth(1).map_or(usual, PathBuf::from), &Registry::default(), &[])?;
    let runs: Vec<Vec<Run>> = plan
        .units()
        .par_iter()
        .with_max_len(1)
        .map(|unit| of_simulation(&plan, unit))
        .collect::<Result<_, Fault>>()?;
    print(&runs.into_iter().flatten().collect::<Vec<_>>())
}

fn of_simulation(plan: &Plan, unit: &Unit) -> Result<Vec<Run>, Fault> {
    let simulated = Simulated::run(&unit.simulated)?;
    let tasks = unit.tasks.iter().map(|&task| &plan.tasks[task]).filter(|task| task.role == Role::Tune);
    tasks.map(|task| watch(&simulated.world(&task.request)?)).collect()
}

fn watch(world: &World) -> Result<Run, Fault> {
    let told = &world.told;
    let mut monitor =
        Monitor::new(&told.vessel, &told.sensors, &told.commissioning, &MonitorSettings::default())?;
    let mut peaks = Peaks::default();
    let mut largest: Statistics = [0.0; Scale::ALL.len()];
    for (stamp_s, readings) in world.log.rows() {
        for output in monitor.step(stamp_s, readings)? {
            let statistics = monitor.evidence();
            peaks.update(output.estimate.time_s, &statistics);
            largest.iter_mut().zip(statistics).for_each(|(largest, value)| *largest = largest.max(value));
        }
    }
    let request = &world.request;
    Ok(Run {
        family: request.family.to_string(),
        seed: request.seed,
        length_s: request.length_s,
        peaks,
        largest,
    })
}

fn print(runs: &[Run]) -> Result<(), Fault> {
    let mut out = std::io::stdout();
    let peaks: Vec<&Peaks> = runs.iter().map(|run| &run.peaks).collect();
    let tails = fit(&peaks)?;
    for tail in tails.0 {
        let (level, interval_s, scale, shape) = (tail.level, tail.interval_s, tail.scale, tail.shape);
        writeln!(
            out,
            "    Tail {{ level: {level:.4}, interval_s: {interval_s:.4e}, scale: {scale:.4}, shape: {shape:.3} }},"
        )?;
    }
    let thresholds = tails.thresholds(YEARS * YEAR_S)?;
    let years = runs.iter().map(|run| run.length_s).sum::<f64>() / YEAR_S;
    writeln!(
        out,
        "\nThresholds of one false alarm in {YEARS} years, from {years:.1} years of {} cylinders\n",
        runs.len()
    )?;
    let intervals = interval(&peaks, YEARS * YEAR_S, 1)?;
    for (scale, (low, high)) in Scale::ALL.into_iter().zip(intervals) {
        writeln!(out, "{:9} {:6.2} ({low:.2} to {high:.2})", scale.as_str(), thresholds.of(scale))?;
    }
    let part = |run: &Run| {
        let parts = run.largest.iter().zip(thresholds.levels).map(|(value, level)| value / level);
        parts.fold(0.0, f64::max)
    };
    let mut highest: Vec<(f64, &Run)> = runs.iter().map(|run| (part(run), run)).collect();
    highest.sort_by(|a, b| b.0.total_cmp(&a.0));
    writeln!(out, "\nClosest to a threshold\n")?;
    for (part, run) in highest.iter().take(SHOWN) {
        writeln!(out, "{part:.2} {} {}: {:.2?}", run.family, run.seed, run.largest)?;
    }
    Ok(())
}
