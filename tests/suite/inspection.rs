//! `cylwatch inspection`: logs, folders of logs, single readings.
use crate::support::{Outcome, files, refused, run};
use std::path::Path;
use tempfile::{TempDir, tempdir};

const FILL: &[&str] = &["--fill-pressure-bar", "200", "--fill-temperature-degc", "15"];

fn inspection(folder: &Path, arguments: &[&str]) -> Outcome {
    run(folder, &[&["inspection", "nitrogen-20l"], arguments].concat())
}

/// A folder with the log of a cylinder of 200 bar at 15 °C that stands in tunnels.
fn with_log() -> TempDir {
    let folder = tempdir().unwrap();
    let simulated = run(folder.path(), &["simulate", "nitrogen-20l", "tunnel-winter", "-o", "log.csv", "-q"]);
    assert_eq!(simulated.code, Some(0), "{}", simulated.stderr);
    folder
}

fn cells(text: &str, name: &str) -> Vec<String> {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    let index = reader.headers().unwrap().iter().position(|found| found == name).unwrap();
    reader.records().map(|row| row.unwrap()[index].to_owned()).collect()
}

#[test]
fn a_log_passes_is_refilled_or_cannot_be_told_against_its_fill() {
    let folder = with_log();
    for (bar, code, judgement, words) in [
        ("200", 0, "pass", "pass, with a probability of"),
        ("218", 1, "refill", "refill, with a probability of"),
        ("210.5", 3, "cannot-be-told", "cannot be told: pass"),
    ] {
        let fill = ["log.csv", "--fill-pressure-bar", bar, "--fill-temperature-degc", "15"];
        let outcome = inspection(folder.path(), &[&fill[..], &["-o", "out.csv"]].concat());
        assert_eq!(outcome.code, Some(code), "{bar}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(words), "{}", outcome.stderr);
        let csv = std::fs::read_to_string(folder.path().join("out.csv")).unwrap();
        assert_eq!(cells(&csv, "judgement"), [judgement]);
        let adjusted: f64 = cells(&csv, "adjusted_bar")[0].parse().unwrap();
        assert!((adjusted - 200.0).abs() < 2.0, "{adjusted}");
    }
}

#[test]
fn a_page_says_judgement_uncertainties_dates_and_that_it_is_no_certificate() {
    let folder = with_log();
    let options =
        ["log.csv", "--date", "2026-08-31", "--gauge-compared", "2026-02-28", "--report", "page.html"];
    let outcome = inspection(folder.path(), &[&options[..], FILL].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
    // Six months after the last of August is the last of February.
    for words in ["pass, with", "2027-02-28", "gauge \u{b1}", "ISO 14520", "no certificate"] {
        assert!(page.contains(words), "{words} is missing");
        assert!(outcome.stdout.contains(words) || words.contains("ISO"), "{words}: {}", outcome.stdout);
    }
}

#[test]
fn in_a_folder_a_log_that_cannot_be_read_does_not_end_the_others() {
    let folder = with_log();
    let logs = folder.path().join("logs");
    std::fs::create_dir(&logs).unwrap();
    std::fs::rename(folder.path().join("log.csv"), logs.join("A-17.csv")).unwrap();
    std::fs::write(logs.join("B-2.csv"), "time_s,shoulder_degc,pressure_bar\n60,15,200\n0,15,200,9,9\n")
        .unwrap();
    std::fs::write(logs.join("notes.md"), "no log").unwrap();
    let outcome = inspection(folder.path(), &[&["logs", "-o", "out.csv"], FILL].concat());
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    let csv = std::fs::read_to_string(folder.path().join("out.csv")).unwrap();
    assert_eq!(cells(&csv, "cylinder"), ["A-17", "B-2"]);
    assert_eq!(cells(&csv, "judgement"), ["pass", "cannot-be-told"]);
    assert!(cells(&csv, "reason")[1].contains("B-2.csv:3"), "{csv}");
    std::fs::create_dir(folder.path().join("empty")).unwrap();
    refused(folder.path(), &[&["inspection", "nitrogen-20l", "empty"], FILL].concat(), &["empty has no log"]);
}

#[test]
fn a_single_reading_tells_more_the_longer_the_cylinder_has_rested() {
    let folder = tempdir().unwrap();
    let read = |bar: &str, more: &[&str]| {
        let reading = ["--pressure-barg", bar, "--temperature-degc", "15", "--format", "csv", "-q"];
        let outcome = inspection(folder.path(), &[&reading[..], FILL, more].concat());
        assert_eq!(outcome.stderr, "");
        let probability: f64 = cells(&outcome.stdout, "refill_probability")[0].parse().unwrap();
        (outcome.code, probability, cells(&outcome.stdout, "reason")[0].clone())
    };
    let (code, unknown, reason) = read("197", &["--thermometer", "air"]);
    assert_eq!(code, Some(3));
    assert!(reason.contains("of rest the same reading would tell"), "{reason}");
    let (code, rested, reason) = read("197", &["--rested-h", "6"]);
    assert_eq!((code, reason.as_str()), (Some(0), ""));
    assert!(rested < 0.05 && unknown > 0.1, "{rested} and {unknown}");
    let (code, low, _) = read("178", &["--rested-h", "6"]);
    assert_eq!(code, Some(1));
    assert!(low > 0.95, "{low}");
    // A better gauge tells where a worse one does not.
    let (worse, better) = (
        read("190", &["--rested-h", "6"]),
        read("190", &["--rested-h", "6", "--gauge-class-percent", "0.25", "--fill-sd-percent", "0.3"]),
    );
    assert_eq!(worse.0, Some(3));
    assert!(better.1 < worse.1, "{better:?} and {worse:?}");
    // In the air a thermometer says less of the gas than on the wall.
    let (_, in_air, _) = read("190", &["--rested-h", "1", "--thermometer", "air"]);
    let (_, on_wall, _) = read("190", &["--rested-h", "1"]);
    assert!(in_air > on_wall, "{in_air} and {on_wall}");
}

#[test]
fn a_round_of_readings_is_a_row_each_with_fills_of_their_own() {
    let folder = tempdir().unwrap();
    let round = "# gauge 7\ncylinder;date;pressure_barg;temperature_degc;rested_h;fill_pressure_bar;fill_temperature_degc\n\
        A1;2026-11-27;199,5;16;6;;\nA2;2026-11-27;175;12;6;;\nA3;;288;15,5;8;300;15\n";
    std::fs::write(folder.path().join("round.csv"), round).unwrap();
    let outcome = inspection(folder.path(), &[&["round.csv", "-o", "out.csv"], FILL].concat());
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    let csv = std::fs::read_to_string(folder.path().join("out.csv")).unwrap();
    assert_eq!(cells(&csv, "cylinder"), ["A1", "A2", "A3"]);
    assert_eq!(cells(&csv, "judgement"), ["pass", "refill", "cannot-be-told"]);
    assert_eq!(cells(&csv, "filled_bar"), ["200.00", "200.00", "300.00"]);
    assert_eq!(cells(&csv, "next_inspection"), ["2027-05-27", "2027-05-27", ""]);
    for (text, words) in [
        ("cylinder,pressure_bar\nA,190\n", &["round.csv:1", "no column of temperature"][..]),
        ("cylinder,pressure_k,temperature_degc\nA,190,15\n", &["round.csv:1", "no unit of pressure"]),
        ("cylinder,pressure_bar,temperature_degc\nA,many,15\n", &["round.csv:2", "pressure_bar = many"]),
        ("cylinder,pressure_bar,temperature_degc\nA,,15\n", &["round.csv:2", "pressure is empty"]),
        ("cylinder,pressure_bar,temperature_degc\nA,-190,15\n", &["round.csv:2", "-190 must be above 0"]),
        (
            "cylinder,date,pressure_bar,temperature_degc\nA,27.11.26,190,15\n",
            &["round.csv:2", "date = 27.11.26"],
        ),
        ("cylinder,pressure_bar,temperature_degc\n", &["round.csv", "no reading"]),
    ] {
        std::fs::write(folder.path().join("round.csv"), text).unwrap();
        refused(folder.path(), &[&["inspection", "nitrogen-20l", "round.csv"], FILL].concat(), words);
    }
}

#[test]
fn a_transmitter_that_stands_still_tells_nothing() {
    let folder = tempdir().unwrap();
    let mut text = String::from("time_s,shoulder_degc,valve_degc,pressure_bar\n");
    for minute in 0..1500 {
        let warm = 5.0 * (f64::from(minute) / 120.0).sin();
        text.push_str(&format!("{},{:.2},{:.2},200.00\n", 60 * minute, 15.0 + warm, 15.0 + warm));
    }
    std::fs::write(folder.path().join("stuck.csv"), text).unwrap();
    let outcome = inspection(folder.path(), &[&["stuck.csv"], FILL].concat());
    assert_eq!(outcome.code, Some(3), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("pressure stands still"), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("judgement  cannot be told\n"), "{}", outcome.stdout);
    assert_eq!(outcome.stdout.matches("stands still").count(), 1, "{}", outcome.stdout);
}

#[test]
fn what_is_missing_or_impossible_is_refused() {
    let folder = with_log();
    for (arguments, words) in [
        (&["log.csv"][..], &["what the cylinder was filled with", "--fill-mass-kg"][..]),
        (&["log.csv", "--fill-pressure-bar", "200"], &["a fill has a temperature"]),
        (&["--fill-mass-kg", "4.4"], &["give logs, or --pressure-bar"]),
        (&["--pressure-bar", "190", "--fill-mass-kg", "4.4"], &["--temperature-degc"]),
        (
            &["log.csv", "--pressure-bar", "190", "--temperature-degc", "5", "--fill-mass-kg", "4.4"],
            &["give logs, or"],
        ),
        (&["log.csv", "--fill-mass-kg", "4.4", "--date", "soon"], &["--date", "soon"]),
        (&["log.csv", "--fill-mass-kg", "4.4", "--certainty-percent", "40"], &["--certainty-percent", "40"]),
        (&["none.csv", "--fill-mass-kg", "4.4"], &["none.csv"]),
        (
            &["--pressure-bar", "1e6", "--temperature-degc", "5", "--fill-mass-kg", "4.4"],
            &["cannot be one of this vessel"],
        ),
    ] {
        refused(folder.path(), &[&["inspection", "nitrogen-20l"], arguments].concat(), words);
    }
    assert_eq!(files(folder.path()), ["log.csv"]);
}
