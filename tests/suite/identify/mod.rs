//! `cylwatch identify`.
mod bad_input;
mod outputs;
mod session;

use crate::support::{Outcome, run_with_stdin};
use std::path::Path;

/// Time constant of the logs below, s.
const LAG_S: f64 = 300.0;

/// Input of the logs below, °C: levels of many samples.
fn level(row: u32) -> f64 {
    [21.0, -25.0, 40.0, 5.0, 30.0][(row / 40 % 5) as usize]
}

/// Noise of the gas readings below, K.
const NOISE_K: f64 = 0.02;

/// Numbers of variance one that look random: sums of twelve uniform ones (SplitMix64).
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let mut uniform = || {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            (z ^ (z >> 31)) as f64 / u64::MAX as f64
        };
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }
}

/// Rows of a log whose gas follows a shoulder that is held between samples through a lag of 300 s, read with noise.
fn lagged(rows: u32) -> Vec<[f64; 3]> {
    let mut gas = 10.0;
    let decay = (-60.0 / LAG_S).exp();
    let mut noise = Noise(1);
    let row = |row: u32| {
        let line = [60.0 * f64::from(row), level(row), gas + NOISE_K * noise.next()];
        gas = level(row) + decay * (gas - level(row));
        line
    };
    (0..rows).map(row).collect()
}

/// A log of rows.
fn log(rows: &[[f64; 3]]) -> String {
    let cell = |value: f64| if value.is_nan() { String::new() } else { format!("{value:.4}") };
    let lines = rows.iter().map(|row| row.map(cell).join(",") + "\n");
    String::from("time_s,shoulder_degc,gas_top_degc\n") + &lines.collect::<String>()
}

/// Identifies the gas of a text on stdin from its shoulder.
fn identify(folder: &Path, log: &str, options: &[&str]) -> Outcome {
    let arguments = ["identify", "-", "--input", "shoulder", "--output", "gas_top"];
    let held: &[&str] = if options.contains(&"--hold") { &[] } else { &["--hold", "zero"] };
    run_with_stdin(folder, &[&arguments[..], held, options].concat(), log)
}

/// The result as JSON.
fn document(folder: &Path, log: &str, options: &[&str]) -> serde_json::Value {
    let outcome = identify(folder, log, &[options, &["--format", "json", "-q"]].concat());
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    serde_json::from_str(&outcome.stdout).unwrap()
}

/// Value, low and high of a row of the table for people.
fn shown(table: &str, name: &str) -> [f64; 3] {
    let line =
        table.lines().find(|line| line.starts_with(name)).unwrap_or_else(|| panic!("no {name} in {table}"));
    let cells: Vec<&str> = line[name.len()..].split_whitespace().collect();
    [0, 1, 2].map(|k| cells[k].parse().unwrap())
}
