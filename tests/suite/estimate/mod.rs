//! `cylwatch estimate`.
mod bad_input;
mod filters;
mod outputs;
mod session;

use crate::support::{Outcome, run, run_with_stdin};
use std::path::Path;

/// Readings of a cylinder at rest, 200 bar and 15 °C, a row a minute.
fn at_rest(rows: u32) -> String {
    let mut text = String::from("time_s,shoulder_degc,valve_degc,pressure_bar\n");
    for row in 0..rows {
        // The last digits of real readings move.
        let last = f64::from(row * 7 % 5) - 2.0;
        text.push_str(&format!(
            "{},{:.2},{:.2},{:.3}\n",
            60 * row,
            15.0 + 0.02 * last,
            15.0 - 0.01 * last,
            200.0 + 0.005 * last
        ));
    }
    text
}

/// Estimates a text on stdin.
fn estimate(folder: &Path, log: &str, options: &[&str]) -> Outcome {
    run_with_stdin(folder, &[&["estimate", "nitrogen-20l", "-"], options].concat(), log)
}

/// Writes the log of a scenario.
fn simulate(folder: &Path, scenario: &str, log: &str) {
    let outcome = run(folder, &["simulate", "nitrogen-20l", scenario, "-o", log, "-q"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
}

/// Lines of stderr that are cautions, without the word.
fn cautions(outcome: &Outcome) -> Vec<&str> {
    outcome.stderr.lines().filter_map(|line| line.strip_prefix("caution: ")).collect()
}
