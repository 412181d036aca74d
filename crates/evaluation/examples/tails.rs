//! Tails of the evidence for a leak, fitted to leak-free worlds of the families that tune.
//!
//! `cargo run --release -p cylwatch-evaluation --example tails [-- PLAN]`
//!
//! Runs the monitor over all worlds of PLAN (`plans/tails.toml`; what is not tuning in it is left out), takes the largest statistics of each stretch of
//! operation and prints, for cylinders and for tanks, the tails as they stand in the library, the thresholds of one false alarm in ten years with their 95 % intervals,
//! and the rate of false alarms that such thresholds have in cylinders that they were not fitted to. Then those whose statistics come closest to them, or above.
use cylwatch_thermal::units::YEAR_S;
use std::io::Write as _;
use std::path::PathBuf;

use cylwatch_detector::evidence::{Scale, Tails};
use cylwatch_detector::monitor::MonitorSettings;
use cylwatch_evaluation::judge::candidate::Registry;
use cylwatch_evaluation::judge::plan::{Plan, Role, Unit};
use cylwatch_evaluation::tails::{CommissionedScale, FitSettings, MonitoredCylinder, commission, monitor};
use cylwatch_evaluation::world::{NominalVessel, Simulated};
use rayon::prelude::*;

const YEARS: f64 = 10.0;
/// Cylinders that are shown.
const SHOWN: usize = 12;

type Fault = Box<dyn std::error::Error + Send + Sync>;

fn main() -> Result<(), Fault> {
    let usual = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/plans/tails.toml"));
    let plan = Plan::read(&std::env::args().nth(1).map_or(usual, PathBuf::from), &Registry::default(), &[])?;
    // One after the other: what is found of cylinders is printed before tanks are simulated.
    let (tanks, cylinders): (Vec<Unit>, Vec<Unit>) = plan.units().into_iter().partition(is_tank);
    for (title, units) in [("Cylinders", cylinders), ("Tanks", tanks)] {
        let of = units.par_iter().with_max_len(1).map(|unit| of_simulation(&plan, unit));
        let monitored: Vec<Vec<MonitoredCylinder>> = of.collect::<Result<_, Fault>>()?;
        print(title, &monitored.into_iter().flatten().collect::<Vec<_>>())?;
    }
    Ok(())
}

/// Whether a vessel has the tails of tanks.
fn is_tank(unit: &Unit) -> bool {
    let of_tanks = |of: NominalVessel| Tails::usual(&of.vessel, of.fill_pa.1) == Tails::TANK;
    unit.simulated.family.vessel.nominal().is_ok_and(of_tanks)
}

fn of_simulation(plan: &Plan, unit: &Unit) -> Result<Vec<MonitoredCylinder>, Fault> {
    let (simulated, settings) = (Simulated::run(&unit.simulated)?, MonitorSettings::default());
    let tasks = unit.tasks.iter().map(|&task| &plan.tasks[task]).filter(|task| task.role == Role::Tune);
    tasks.map(|task| Ok(monitor(&simulated.world(&task.request)?, &settings)?)).collect()
}

fn print(title: &str, monitored: &[MonitoredCylinder]) -> Result<(), Fault> {
    if monitored.is_empty() {
        return Ok(());
    }
    let mut out = std::io::stdout();
    writeln!(out, "{title}\n")?;
    let found = commission(monitored, &FitSettings { mean_time_s: YEARS * YEAR_S, stretch: 1.0, seed: 1 })?;
    for CommissionedScale { tail, .. } in found.scales {
        let (level, interval_s, scale, shape) = (tail.level, tail.interval_s, tail.scale, tail.shape);
        writeln!(
            out,
            "    Tail {{ level: {level:.4}, interval_s: {interval_s:.4e}, scale: {scale:.4}, shape: {shape:.3} }},"
        )?;
    }
    let years = monitored.iter().map(|monitored| monitored.request.length_s).sum::<f64>() / YEAR_S;
    writeln!(
        out,
        "\nThresholds of one false alarm in {YEARS} years, from {years:.1} years of {} logs\n",
        monitored.len()
    )?;
    for of in found.scales {
        let (low, high) = of.threshold_interval;
        writeln!(out, "{:9} {:6.2} ({low:.2} to {high:.2})", of.scale.as_str(), of.threshold)?;
    }
    let rate = found.false_alarms;
    let (low, high) = rate.by_simulation;
    writeln!(
        out,
        "\nFalse alarms in ten years, out of sample: {:.2} ({low:.2} to {high:.2}), {} in {:.1} years",
        rate.per_ten_years, rate.count, rate.cylinder_years
    )?;
    let part = |monitored: &MonitoredCylinder| {
        let largest = monitored.record.largest();
        Scale::ALL
            .map(|scale| largest[scale as usize] / found.scales[scale as usize].threshold)
            .into_iter()
            .fold(0.0, f64::max)
    };
    let mut highest: Vec<(f64, &MonitoredCylinder)> =
        monitored.iter().map(|monitored| (part(monitored), monitored)).collect();
    highest.sort_by(|a, b| b.0.total_cmp(&a.0));
    writeln!(out, "\nClosest to a threshold\n")?;
    for (part, MonitoredCylinder { request, record }) in highest.iter().take(SHOWN) {
        writeln!(out, "{part:.2} {} {}: {:.2?}", request.family, request.seed, record.largest())?;
    }
    writeln!(out)?;
    Ok(())
}
