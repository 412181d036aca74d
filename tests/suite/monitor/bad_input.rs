//! Bad logs and options.
use super::*;
use crate::support::{refusal, run};
use tempfile::tempdir;

fn refused(log: &str, options: &[&str], words: &[&str]) {
    let folder = tempdir().unwrap();
    refusal(monitor(folder.path(), log, &[options, &["-o", "r.csv"]].concat()), words);
    assert!(!folder.path().join("r.csv").exists());
}

#[test]
fn numbers_out_of_their_bounds_are_refused_with_the_bound() {
    let text = log(0..3, TIGHT);
    refused(&text, &["--false-alarm-years", "0"], &["--false-alarm-years 0: it must be a number above 0"]);
    refused(&text, &["--false-alarm-years", "nan"], &["--false-alarm-years nan"]);
    let bounds =
        "error: --false-alarm-years -3: it must be a number above 0 and at most 100000; the default is 10\n";
    refused(&text, &["--false-alarm-years", "-3"], &[bounds]);
    refused(&text, &["--fill-sd-percent", "-1"], &["--fill-sd-percent -1", "above 0 and at most 100"]);
    refused(&text, &["--limit-bar", "-1"], &["--limit-bar = -1 must be above 0"]);
    refused(&text, &["--coldest-degc", "-300"], &["--coldest-degc = -300 must be above -273.15"]);
    refused(&text, &["--lateness-s", "inf"], &["--lateness-s", "finite"]);
    refused(&text, &["--limit-bar", "160", "--limit-mpa", "16"], &["keep one"]);
    refused(&text, &["--cold-start"], &["--state"]);
}

#[test]
fn logs_are_refused_as_by_estimate() {
    refused("time_s,shoulder,pressure_bar\n0,15,200\n", &[], &["stdin:1", "shoulder", "_degc"]);
    refused("time_s,flow_kg_s\n0,1\n", &[], &["no column to estimate from"]);
    refused("time_s,shoulder_degc\n0,15\n60,15\n", &[], &["no pressure", "--fill-mass-kg"]);
    refused("time_s,shoulder_degc,pressure_bar\n0,15,200\n60,15\n60,15,200\n", &[], &["stdin:3", "cells"]);
    let short = log(0..10, TIGHT);
    refused(&short, &["--fill-mass-kg", "15"], &["the fill of 15.000 kg makes", "begins with 200.0 bar"]);
    refused(&short, &["--fill-mass-kg", "40"], &["stdin:2: the fill of 40.000 kg does not fit the vessel"]);
    let folder = tempdir().unwrap();
    refusal(run(folder.path(), &["monitor", "-", "-"]), &["stdin", "not both"]);
    refusal(run(folder.path(), &["monitor", "nitrogen-20l", "none.csv"]), &["none.csv cannot be read"]);
}

#[test]
fn rows_of_one_time_that_contradict_each_other_cost_a_caution_and_do_not_end_a_live_run() {
    let folder = tempdir().unwrap();
    let text = log(0..30, TIGHT) + "1800,15,15,200\n1800,15,15,201\n" + &row(31, TIGHT);
    let outcome = monitor(folder.path(), &text, &[]);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    let [caution] = cautions(&outcome)[..] else { panic!("{}", outcome.stderr) };
    assert_eq!(
        caution,
        "stdin:33: the row has the time of the one above and says something else; 1 row left out"
    );
    assert_eq!(cells(&outcome.stdout, "pressure_bar")[30], "200.00000");
}

#[test]
fn a_clock_that_is_set_back_is_an_event_and_no_error() {
    let folder = tempdir().unwrap();
    // An hour back, as at the end of summer time.
    let mut text = log(0..200, TIGHT);
    for minute in 200..400 {
        let line = row(minute, TIGHT);
        let (_, readings) = line.split_once(',').unwrap();
        text.push_str(&format!("{},{readings}", 60 * (minute - 60)));
    }
    let outcome = monitor(folder.path(), &text, &["--events", "e.jsonl"]);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    let jumps: Vec<f64> = events(folder.path(), "e.jsonl")
        .iter()
        .filter(|event| event["event"] == "clock-jump")
        .map(|event| event["jump_s"].as_f64().unwrap())
        .collect();
    assert_eq!(jumps.len(), 1);
    assert!((jumps[0] + 3600.0).abs() <= 120.0, "{jumps:?}");
    assert!(outcome.stderr.contains("the clock jumped once"), "{}", outcome.stderr);
    // The rows carry the times that they came with.
    assert_eq!(cells(&outcome.stdout, "time_s").last().unwrap(), "20340");
}
