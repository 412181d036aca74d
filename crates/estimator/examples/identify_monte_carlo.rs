//! Bias and coverage of every method of identification on six records with noise on input and output.
//!
//! `cargo run --release -p cylwatch-estimator --example identify_monte_carlo -- [runs] [case]`
//!
//! `runs`: 400 by default; `case`: 0 to 5, all by default. Errors of the pole and the gain in %: mean ± 95 % interval of the mean, standard
//! deviation of one run, and the share of 95 % intervals that hold the truth with Wilson's 95 % interval.
#![allow(clippy::unwrap_used, clippy::print_stdout)]
use cylwatch_estimator::consistency::Significance;
use cylwatch_estimator::identify::{InputModel, Method};

#[path = "../tests/suite/identify/noisy.rs"]
mod noisy;
#[allow(dead_code)]
#[path = "../tests/suite/identify/system.rs"]
mod system;

use noisy::{CASES, Case, Errors, study};

fn columns(errors: &Errors) -> String {
    let (mean, deviation, sd) = errors.bias();
    let covered = errors.coverage;
    let band = covered.interval(Significance::FIVE_PERCENT).unwrap();
    format!(
        "{:+7.3} ± {:.3} ({:.2})  {:.1} % [{:.1}, {:.1}]",
        100.0 * mean,
        196.0 * deviation,
        100.0 * sd,
        100.0 * covered.share(),
        100.0 * band.low,
        100.0 * band.high
    )
}

fn line(case: &Case, runs: u64, name: &str, method: impl Fn(&[f64]) -> Method + Sync) {
    let result = study(case, 0..runs, method);
    println!("  {name:22} pole {}   gain {}", columns(&result.pole), columns(&result.gain));
    if let Some(error) = result.failures.first() {
        println!("  {:22} {} failed: {error}", "", result.failures.len());
    }
}

fn main() {
    let mut arguments = std::env::args().skip(1).map(|argument| argument.parse::<u64>().unwrap());
    let runs = arguments.next().unwrap_or(400);
    let chosen = arguments.next();
    for (index, case) in CASES.iter().enumerate() {
        if chosen.is_some_and(|chosen| chosen != index as u64) {
            continue;
        }
        println!("{}", case.name);
        line(case, runs, "output error", |_| Method::OutputError);
        line(case, runs, "refined instruments", |_| Method::RefinedInstruments);
        line(case, runs, "bias-compensated", |_| case.compensated());
        let input_variance = case.variances().0;
        line(case, runs, "compensated instr.", |_| Method::CompensatedInstruments { input_variance });
        line(case, runs, "second sensor", |second| Method::SecondSensor { input: second.to_vec() });
        line(case, runs, "likelihood, walk", |_| case.likely(InputModel::RandomWalk));
        if matches!(case.course, noisy::Course::Day) {
            line(case, runs, "likelihood, smooth", |_| case.likely(InputModel::IntegratedRandomWalk));
        }
    }
}
