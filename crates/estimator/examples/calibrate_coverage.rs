//! How often the intervals of six numbers that are 30 % off hold the truth, and how much better the calibrated vessel predicts
//! a scenario that was not recorded.
//!
//! `cargo run --release -p cylwatch-estimator --example calibrate_coverage -- [seeds]`
//!
//! `seeds`: how many, 50 by default, from 101 on; the study was set up on seeds below. Class B sensors on shoulder and valve, a
//! pressure transmitter of 0.25 %; unknown too are their offsets, the transmitter's temperature coefficient, and the valve's contact,
//! with a prior of a factor of two. Recorded: `tunnel-step`, predicted: `shock-cold`.
#![allow(clippy::unwrap_used, clippy::print_stdout)]
use cylwatch_estimator::consistency::{Coverage, Significance};
use rayon::prelude::*;

#[allow(dead_code)]
#[path = "../tests/suite/calibrate/study.rs"]
mod study;

use study::{Case, kinds, preset};

/// First seed that was not looked at before.
const FIRST_SEED: u64 = 101;

/// What one seed gives.
struct Outcome {
    covered: [bool; 6],
    sd: [f64; 6],
    gain: f64,
}

fn outcome(seed: u64) -> Result<Outcome, String> {
    let case = Case::new(seed);
    let calibrated =
        case.calibration(&preset("tunnel-step")).run().map_err(|error| format!("seed {seed}: {error}"))?;
    let (before, after) = case.prediction(&calibrated, &preset("shock-cold"));
    let sd = std::array::from_fn(|i| calibrated.estimates[i].sd / calibrated.estimates[i].value);
    Ok(Outcome { covered: case.covered(&calibrated), sd, gain: before / after })
}

fn coverage(seeds: u64) {
    let (outcomes, failures): (Vec<Outcome>, Vec<String>) = (FIRST_SEED..FIRST_SEED + seeds)
        .into_par_iter()
        .map(outcome)
        .partition_map(|outcome| match outcome {
            Ok(outcome) => rayon::iter::Either::Left(outcome),
            Err(error) => rayon::iter::Either::Right(error),
        });
    // A calibration without intervals holds nothing: it counts as a miss.
    failures.iter().for_each(|failure| println!("{failure}"));
    for (i, kind) in kinds().iter().enumerate() {
        let inside = outcomes.iter().filter(|outcome| outcome.covered[i]).count() as u64;
        let band = Coverage { inside, samples: seeds }.interval(Significance::FIVE_PERCENT).unwrap();
        let sd = outcomes.iter().map(|outcome| outcome.sd[i]).sum::<f64>() / outcomes.len() as f64;
        println!(
            "{kind}: inside {inside} of {seeds} [{:.1} %, {:.1} %], mean standard deviation {:.2} %",
            100.0 * band.low,
            100.0 * band.high,
            100.0 * sd
        );
    }
    let mut gains: Vec<f64> = outcomes.iter().map(|outcome| outcome.gain).collect();
    gains.sort_by(f64::total_cmp);
    println!(
        "gas temperature of the next scenario: {:.0} times better, at least {:.1}",
        gains[gains.len() / 2],
        gains[0]
    );
}

fn main() {
    let seeds = std::env::args().nth(1).map_or(50, |text| text.parse().unwrap());
    coverage(seeds);
}
