//! `cylwatch monitor`.
mod bad_input;
mod live;
mod outputs;
mod session;
mod states;

use crate::support::{Outcome, rows, run_with_stdin};
use std::path::Path;

/// Readings of a cylinder at 15 °C, a row a minute from one minute to another; from `leak_from` on the pressure falls by 1 bar/h.
fn log(minutes: std::ops::Range<u32>, leak_from: u32) -> String {
    let mut text = String::from(HEADER);
    for minute in minutes {
        text.push_str(&row(minute, leak_from));
    }
    text
}

const HEADER: &str = "time_s,shoulder_degc,valve_degc,pressure_bar\n";

/// One row of such a log; the last digits of real readings move.
fn row(minute: u32, leak_from: u32) -> String {
    // Quadratic residues: no period of a few rows, no trend.
    let residue = |by: u32| f64::from(minute * minute * by % 101) / 50.0 - 1.0;
    let lost_bar = f64::from(minute.saturating_sub(leak_from)) / 60.0;
    let [shoulder, valve] = [15.0 + 0.03 * residue(3), 15.0 + 0.03 * residue(7)];
    let pressure = 200.0 + 0.02 * residue(11) - lost_bar;
    format!("{},{shoulder:.3},{valve:.3},{pressure:.4}\n", 60 * minute)
}

/// Minutes after which the monitor has learnt its sensors.
const LEARNT: u32 = 24 * 60;
/// Never.
const TIGHT: u32 = u32::MAX;

/// Monitors a text on stdin.
fn monitor(folder: &Path, log: &str, options: &[&str]) -> Outcome {
    run_with_stdin(folder, &[&["monitor", "nitrogen-20l", "-", "--settled"], options].concat(), log)
}

/// Cells of a column as they stand there.
fn cells(csv: &str, name: &str) -> Vec<String> {
    let (header, rows) = rows(csv);
    let index = header.iter().position(|found| *found == name).unwrap_or_else(|| panic!("no column {name}"));
    rows.iter().map(|row| row[index].to_owned()).collect()
}

/// Lines below the comments and the header.
fn data(csv: &str) -> Vec<&str> {
    csv.lines().filter(|line| !line.starts_with('#')).skip(1).collect()
}

/// Lines of stderr that are cautions, without the word.
fn cautions(outcome: &Outcome) -> Vec<&str> {
    outcome.stderr.lines().filter_map(|line| line.strip_prefix("caution: ")).collect()
}

/// The objects of a file of events.
fn events(folder: &Path, name: &str) -> Vec<serde_json::Value> {
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}
