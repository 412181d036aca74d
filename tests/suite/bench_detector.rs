//! `cylwatch bench-detector` on a few cylinders over a day.
use crate::support::{TINY_BENCH, column, files, refused, rows, run};
use std::path::Path;
use tempfile::tempdir;

fn tiny<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&TINY_BENCH, more].concat()
}

#[test]
fn a_tiny_bench_writes_tables_figure_and_json_that_agree() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let outcome = run(folder, &tiny(&["--rates", "20", "-o", "bench.csv", "--plot", "delay.svg"]));
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(0), ""), "{}", outcome.stderr);
    assert_eq!(files(folder), ["bench.csv", "delay.svg"]);
    agree_on_the_false_alarms(folder, &outcome.stderr);
    let figure = std::fs::read_to_string(folder.join("delay.svg")).unwrap();
    for words in ["leak rate in bar/h", "median delay in h", "cylwatch", "pressure switch"] {
        assert!(figure.contains(words), "{words} is missing in the figure");
    }
}

/// CSV and the words beside it say the same.
fn agree_on_the_false_alarms(folder: &Path, words: &str) {
    let csv = std::fs::read_to_string(folder.join("bench.csv")).unwrap();
    assert!(csv.contains("# seed: 1\n") && csv.contains("# command: cylwatch bench-detector"));
    let (header, lines) = rows(&csv);
    assert_eq!((header[0], lines.len()), ("detector", 6));
    // Six times five tight cylinders of 1.1 d.
    for years in column(&csv, "at_risk_years") {
        assert!(years > 0.0 && years <= 5.0 * 1.1 / 365.25 + 1e-9, "{years}");
    }
    assert!(column(&csv, "leak_bar_h").iter().all(|rate| (rate - 20.0).abs() < 1e-6));
    for line in &lines {
        let said = words.lines().find(|said| said.starts_with(&format!("{} ", line[0])));
        let said: Vec<&str> = said.unwrap_or_else(|| panic!("{} is missing", line[0])).split("  ").collect();
        let cells: Vec<&str> = said.iter().map(|cell| cell.trim()).filter(|cell| !cell.is_empty()).collect();
        assert_eq!(cells[2], line[3], "false alarms of {}", line[0]);
    }
    assert!(words.contains("extrapolated by a factor of"), "{words}");
}

#[test]
fn tables_go_to_stdout_and_json_holds_every_run() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &tiny(&["--rates", "20", "--json", "--quiet"]));
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    let document: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    let detectors = document["detectors"].as_array().unwrap();
    assert_eq!(detectors[0]["performance"]["detector"], "cylwatch");
    assert!(detectors.iter().all(|detector| detector["runs"].as_array().unwrap().len() == 10));
    assert_eq!(document["provenance"]["seed"], 1);
    assert!(document["noise"]["sd_bar"].as_f64().unwrap() > 0.0);
}

#[test]
fn options_out_of_bounds_are_refused_by_name() {
    let folder = tempdir().unwrap();
    let refuse = |arguments: &[&str], words: &[&str]| refused(folder.path(), arguments, words);
    refuse(&["bench-detector", "--seeds", "4"], &["--seeds 4", "at least 5"]);
    refuse(&["bench-detector", "--days", "1"], &["--days 1", "above 1"]);
    refuse(&["bench-detector", "--rates", "0.1,-2"], &["--rates -2", "above 0"]);
    refuse(&["bench-detector", "--false-alarm-years", "0"], &["--false-alarm-years 0"]);
    refuse(&["bench-detector", "--plot", "a.pdf"], &[".svg or .png"]);
    refuse(&["bench-detector", "--json", "--format", "csv"], &["--format"]);
    refuse(&["bench-detector", "-o", "x.svg", "--plot", "x.svg"], &["x.svg"]);
}
