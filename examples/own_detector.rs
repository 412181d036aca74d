//! A detector of one's own: what has to be written, and how does it fare beside others on the same cylinders?
//!
//! `cargo run --release --example own_detector`
//!
//! The detector compares the pressure with that of a day before, at the slope of a tight cylinder and the difference of the
//! shoulder's temperatures. It needs no filling and no model. The judge sets its threshold on some cylinders and judges it on others.
#![allow(clippy::print_stdout)]

use cylwatch::evaluation::judge::candidate::{Candidate, CandidateRun, Registry, Row};
use cylwatch::evaluation::judge::run::{RunSettings, Simulator, run as judge};
use cylwatch::evaluation::judge::{JudgeError, plan::Plan, statement::Statement, table::Table};
use cylwatch::evaluation::world::OperatorData;
use cylwatch::report::bench_detector::summary;
use cylwatch::thermal::units::DAY_S;
use std::collections::VecDeque;
use std::sync::Arc;

// ANCHOR: detector
/// How much less pressure there is than a day before, temperature taken off.
struct DayBefore;

/// The detector at work on one cylinder.
pub(crate) struct Watching {
    /// Indices of shoulder and pressure among the readings.
    pub columns: [usize; 2],
    /// Time, shoulder and pressure of the last day, oldest first.
    pub past: VecDeque<[f64; 3]>,
}

/// Slope of a tight cylinder of 200 bar at 15 °C, Pa/K.
const SLOPE_PA_K: f64 = 0.992e5;

impl Candidate for DayBefore {
    fn start(&self, data: &OperatorData) -> Result<Box<dyn CandidateRun>, JudgeError> {
        let column = |name: &str| data.sensors.iter().position(|sensor| sensor.name == name);
        let columns = ["shoulder", "pressure"].map(|name| column(name).expect("every world has both"));
        Ok(Box::new(Watching { columns, past: VecDeque::new() }))
    }

    /// It says a statistic: the judge finds the threshold.
    fn needs_threshold(&self) -> bool {
        true
    }
}

impl CandidateRun for Watching {
    fn step(&mut self, row: &Row<'_>, statements: &mut Vec<Statement>) -> Result<(), JudgeError> {
        let [shoulder_k, pressure_pa] = self.columns.map(|column| row.readings[column]);
        // A missing reading leaves the state as it is.
        if !(pressure_pa.is_finite() && shoulder_k.is_finite()) {
            return Ok(());
        }
        self.past.push_back([row.stamp_s, shoulder_k, pressure_pa]);
        while let Some(&[_, k, pa]) = self.past.front().filter(|past| row.stamp_s - past[0] >= DAY_S) {
            let missing_pa = pa + SLOPE_PA_K * (shoulder_k - k) - pressure_pa;
            statements.push(Statement {
                stamp_s: row.stamp_s,
                statistic: Some(missing_pa),
                ..Statement::default()
            });
            self.past.pop_front();
        }
        Ok(())
    }
}
// ANCHOR_END: detector

// ANCHOR: judge
/// A few cylinders, half of them for the thresholds: enough to see how it is done, too few to rank.
const PLAN: &str = r#"
title = "Own detector"
between_false_alarms_y = 10.0
tune = ["*/railway/full-mesh/*/*"]
judge = ["*/railway/mixed/*/*"]
candidate = [{ name = "day before", kind = "day-before" }, { name = "paper", kind = "paper" }]

[[group]]
name = "tight, and leaks of 1 and 10 bar/h"
families = ["nitrogen-20l/railway/full-mesh|mixed/class-b/120s"]
seeds = [1, 5]
length_d = 2.5
overlays = [{ kind = "nothing" }, { kind = "leak", part_per_h = [0.005, 0.05], onset_h = [48.0, 52.0] }]
"#;

/// Registers it and judges it beside the paper's detector.
pub(crate) fn run() -> anyhow::Result<Table> {
    let mut registry = Registry::default();
    registry.register("day-before", |_settings| Ok(Arc::new(DayBefore)));
    let plan = Plan::parse(PLAN, "the plan", &registry, &[])?;
    let out = tempfile::tempdir()?;
    let (folder, program) = (out.path().into(), String::new());
    let settings = RunSettings { folder, threads: 2, program, most_worlds: None };
    Ok(judge(&plan, &Simulator, &settings, &|_progress| ())?)
}
// ANCHOR_END: judge

fn main() -> anyhow::Result<()> {
    print!("{}", summary(&run()?).to_text());
    Ok(())
}
