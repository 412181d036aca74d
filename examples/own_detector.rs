//! A detector of one's own: what has to be written, and how does it fare beside others on the same cylinders?
//!
//! `cargo run --release --example own_detector`
//!
//! The detector compares the pressure with that of a day before, at the slope of a tight cylinder and the difference of the
//! shoulder's temperatures. It needs no filling and no model. The bench sets its threshold on some cylinders and judges it on others.
#![allow(clippy::print_stdout)]

use cylwatch::thermal::units::DAY_S;
use std::collections::VecDeque;

use cylwatch::evaluation::EvaluationError;
use cylwatch::evaluation::baseline::Threshold;
use cylwatch::evaluation::performance::bench::{Candidate, Contender, Plan, Readings, bench};
use cylwatch::report::aligned;

const BAR_H: f64 = 1e5 / 3600.0;

// ANCHOR: detector
/// How much less pressure there is than a day before, temperature taken off, Pa.
#[derive(Clone, Debug, Default)]
pub struct DayBefore {
    /// Readings of the last day, oldest first.
    past: VecDeque<Readings>,
    missing_pa: f64,
}

/// Slope of a tight cylinder of 200 bar at 15 °C, Pa/K.
const SLOPE_PA_K: f64 = 0.992e5;

impl Contender for DayBefore {
    fn step(&mut self, now: &Readings) -> Result<f64, EvaluationError> {
        // A missing reading leaves the state as it is.
        if !(now.pressure_pa.is_finite() && now.shoulder_k.is_finite()) {
            return Ok(self.missing_pa);
        }
        self.past.push_back(*now);
        while let Some(&before) = self.past.front().filter(|before| now.time_s - before.time_s >= DAY_S) {
            let expected_pa = before.pressure_pa + SLOPE_PA_K * (now.shoulder_k - before.shoulder_k);
            self.missing_pa = expected_pa - now.pressure_pa;
            self.past.pop_front();
        }
        Ok(self.missing_pa)
    }
}
// ANCHOR_END: detector

/// What the bench says of a detector.
pub struct Judged {
    /// Name.
    pub detector: String,
    /// Threshold, bar.
    pub threshold_bar: f64,
    /// Found of all leaks, for each rate.
    pub found: Vec<(u64, u64)>,
}

/// Leak rates of the bench, bar/h.
pub const RATES_BAR_H: [f64; 2] = [1.0, 10.0];

// ANCHOR: bench
/// Benches it beside the paper's detector, on a few cylinders over a day and a half: enough to see how it is done, too few to rank.
pub fn run() -> anyhow::Result<Vec<Judged>> {
    let plan = Plan {
        rates_pa_s: RATES_BAR_H.map(|rate| rate * BAR_H).to_vec(),
        training: 5,
        tests: 3,
        learning_s: 1.1 * DAY_S,
        watched_s: 1.4 * DAY_S,
        ..Plan::default()
    };
    let candidates = [
        Candidate::new("day before", "Pa", || Ok(DayBefore::default())),
        Candidate::new("paper", "Pa", || Ok(Threshold::published(Plan::FILLING))),
    ];
    let outcome = bench(&plan, &candidates, &|_progress| ())?;
    let judged = outcome.judged.iter().map(|judged| Judged {
        detector: judged.performance.detector.clone(),
        threshold_bar: judged.level.threshold / 1e5,
        found: judged.performance.sensitivity.iter().map(|at| (at.delay.found, at.delay.leaks)).collect(),
    });
    Ok(judged.collect())
}
// ANCHOR_END: bench

fn main() -> anyhow::Result<()> {
    let rows: Vec<Vec<String>> = run()?
        .into_iter()
        .map(|judged| {
            let found = judged.found.iter().map(|(found, of)| format!("{found} of {of}"));
            [judged.detector, format!("{:.1}", judged.threshold_bar)].into_iter().chain(found).collect()
        })
        .collect();
    print!("{}", aligned(&["detector", "threshold / bar", "found of 1 bar/h", "of 10 bar/h"], &rows));
    Ok(())
}
