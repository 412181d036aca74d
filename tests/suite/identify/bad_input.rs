//! Data that cannot be identified from: exit code 2, what failed, and what data would be needed.
use super::{identify, lagged, log};
use crate::support::{files, refusal};
use tempfile::tempdir;

/// Asserts that rows are refused with one message, and that no file is left.
fn refused(rows: &[[f64; 3]], options: &[&str], words: &[&str]) {
    let folder = tempdir().unwrap();
    let outcome =
        identify(folder.path(), &log(rows), &[options, &["-o", "m.json", "--plot", "m.svg"]].concat());
    assert_eq!(
        outcome.stderr.lines().filter(|line| line.starts_with("error:")).count(),
        1,
        "{}",
        outcome.stderr
    );
    refusal(outcome, words);
    assert!(files(folder.path()).is_empty());
}

#[test]
fn a_gap_is_refused_with_its_ends_unless_it_is_allowed() {
    let mut rows = lagged(400);
    rows[100..130].iter_mut().for_each(|row| row[1] = f64::NAN);
    refused(&rows, &[], &["missing from 5940 s to 7800 s", "longer than 1200.0 s", "before and after"]);
    let folder = tempdir().unwrap();
    let allowed = identify(folder.path(), &log(&rows), &["--longest-gap-h", "1"]);
    assert_eq!(allowed.code, Some(0), "{}", allowed.stderr);
}

#[test]
fn a_constant_column_is_named_with_its_value_and_what_would_be_needed() {
    let mut rows = lagged(100);
    rows.iter_mut().for_each(|row| row[1] = 21.0);
    refused(&rows, &[], &["shoulder", "the input is constant at 21", "without a step, a ramp"]);
    let mut rows = lagged(100);
    rows.iter_mut().for_each(|row| row[2] = 21.0);
    refused(&rows, &[], &["gas_top", "the output is constant at 21"]);
}

#[test]
fn too_few_samples_are_refused_with_how_many_would_do() {
    refused(&lagged(4), &[], &["4 usable output samples", "3 parameters", "at least 5"]);
    refused(&lagged(7), &["--order", "3"], &["9 parameters", "at least 11"]);
    // What is left after the held-out part counts.
    refused(&lagged(40), &["--validate", "0.95"], &["usable output samples"]);
    refused(&lagged(100), &["--validate", "0.015"], &["held-out data", "usable output samples"]);
}

#[test]
fn swapped_columns_are_found_and_said_so() {
    let rows: Vec<[f64; 3]> = lagged(400).iter().map(|&[time_s, u, y]| [time_s, y, u]).collect();
    refused(&rows, &[], &["the input follows from the output", "swap the columns"]);
}

#[test]
fn a_pole_or_a_dead_time_at_a_bound_is_refused_with_the_bound() {
    // The output is the input: no lag at all.
    let rows: Vec<[f64; 3]> =
        lagged(200).iter().map(|&[time_s, u, _]| [time_s, u, u + 1e-3 * (time_s / 60.0 % 7.0)]).collect();
    refused(&rows, &["--hold", "first"], &["1/s", "sample faster, or lower the order"]);
    // An integrator: the output rises as long as the input is above zero.
    let mut sum = 0.0;
    let rows: Vec<[f64; 3]> = lagged(200)
        .iter()
        .map(|&[time_s, u, _]| {
            let row = [time_s, u, sum];
            sum += 1e-3 * u;
            row
        })
        .collect();
    refused(&rows, &[], &["1/s", "record longer, or lower the order"]);
    refused(
        &lagged(400),
        &["--longest-dead-time-s", "90"],
        &["dead time ran to the end 0 s of its range 0 to 90 s"],
    );
}

#[test]
fn structures_settings_and_columns_that_cannot_be_are_refused_with_what_would_be_right() {
    let rows = lagged(50);
    refused(&rows, &["--order", "4"], &["--order 4: it must be a whole number of at least 1 and at most 3"]);
    refused(&rows, &["--zeros", "-1"], &["--zeros -1: it must be a whole number of at least 0"]);
    refused(&rows, &["--zeros", "1"], &["`zeros` = 1 must be below the order"]);
    refused(&rows, &["--gain", "0"], &["`gain` = 0 must be a number other than zero"]);
    refused(&rows, &["--initial", "1,2"], &["`initial` = 2 must be one value per order"]);
    refused(&rows, &["--lags", "0"], &["--lags 0: it must be a whole number of at least 1"]);
    refused(
        &rows,
        &["--method", "bias-compensated", "--input-sd-k", "0.1"],
        &["noise of gas_top", "give --output-sd-k"],
    );
    refused(
        &rows,
        &["--method", "compensated-instruments", "--input-sd-bar", "0.1"],
        &["--input-sd-bar", "shoulder is in °C"],
    );
    refused(
        &rows,
        &["--method", "second-sensor", "--second", "valve_degc"],
        &["no column valve", "shoulder, gas_top"],
    );
    refused(
        &lagged(200),
        &["--method", "compensated-instruments", "--input-sd-k", "100"],
        &["leave nothing of the data's own variation"],
    );
}
