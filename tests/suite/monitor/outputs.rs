//! Formats, files that appear complete or not at all, places.
use super::*;
use crate::support::{column, files, refused, run};
use tempfile::tempdir;

#[test]
fn json_holds_the_cells_of_the_csv_with_summary_and_provenance() {
    let folder = tempdir().unwrap();
    let text = log(0..120, TIGHT);
    let csv = monitor(folder.path(), &text, &[]).stdout;
    let json = monitor(folder.path(), &text, &["--format", "json"]);
    let document: serde_json::Value = serde_json::from_str(&json.stdout).unwrap();
    let (header, rows) = rows(&csv);
    assert_eq!(document["columns"], serde_json::json!(header));
    let values = document["data"].as_array().unwrap();
    assert_eq!(values.len(), rows.len());
    for (in_csv, in_json) in rows.iter().zip(values) {
        for (cell, value) in in_csv.iter().zip(in_json.as_array().unwrap()) {
            match value {
                serde_json::Value::Null => assert_eq!(*cell, ""),
                serde_json::Value::String(word) => assert_eq!(cell, word),
                number => assert_eq!(cell.parse().ok(), number.as_f64()),
            }
        }
    }
    let summary = &document["summary"];
    assert_eq!((&summary["rows"], &summary["verdict"]["verdict"]), (&120.into(), &"unknown".into()));
    assert_eq!(summary["sensors"].as_array().unwrap().len(), 3);
    assert!(summary["p15_bar"].as_f64().is_some_and(|p15| (p15 - 200.0).abs() < 1.0));
    assert!(document["error"].is_null());
    assert_eq!(document["provenance"]["inputs"].as_array().unwrap().len(), 2);
}

#[test]
fn the_first_columns_are_those_of_an_estimate() {
    let folder = tempdir().unwrap();
    let text = log(0..120, TIGHT);
    let csv = monitor(folder.path(), &text, &[]).stdout;
    let estimates =
        run_with_stdin(folder.path(), &["estimate", "nitrogen-20l", "-", "--settled", "-q"], &text).stdout;
    let (ours, theirs) = (rows(&csv).0, rows(&estimates).0);
    assert_eq!(ours[..theirs.len()], theirs);
    assert_eq!(cells(&csv, "quality"), cells(&estimates, "quality"));
    // The monitor's observer gives the pressure another weight; at rest that is hardly seen.
    for (name, sd, unit) in [("mass_kg", "mass_sd_g", 1e-3), ("gas_mean_degc", "gas_mean_sd_k", 1.0)] {
        let [ours, theirs] = [&csv, &estimates].map(|text| column(text, name));
        for ((a, b), sd) in ours.iter().zip(theirs).zip(column(&csv, sd)) {
            assert!((a - b).abs() < 0.1 * unit * sd, "{name}: {a} and {b}");
        }
    }
}

#[test]
fn events_begin_anew_without_a_state_and_go_on_with_one() {
    let folder = tempdir().unwrap();
    let count = |options: &[&str], minutes: std::ops::Range<u32>| {
        let options = [&["--events", "e.jsonl", "-q"], options].concat();
        assert_eq!(monitor(folder.path(), &log(minutes, TIGHT), &options).stderr, "");
        events(folder.path(), "e.jsonl").len()
    };
    let first = count(&[], 0..LEARNT + 10);
    assert!(first > 0);
    assert_eq!(count(&[], 0..LEARNT + 10), first);
    assert_eq!(count(&["--state", "c.state"], 0..1), 0);
    assert_eq!(count(&["--state", "c.state"], 1..LEARNT + 10), first);
    let all = events(folder.path(), "e.jsonl");
    let mut ids: Vec<&str> = all.iter().map(|event| event["id"].as_str().unwrap()).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), all.len());
}

#[test]
fn places_that_cannot_be_written_are_found_before_the_run() {
    let folder = tempdir().unwrap();
    std::fs::create_dir(folder.path().join("folder")).unwrap();
    std::fs::write(folder.path().join("log.csv"), log(0..3, TIGHT)).unwrap();
    // The vessel does not exist: a complaint about the output shows that it was checked first.
    let with = |options: &[&str], words: &[&str]| {
        refused(folder.path(), &[&["monitor", "none.toml", "log.csv"], options].concat(), words);
    };
    with(&["-o", "log.csv"], &["log.csv is an input"]);
    with(&["--events", "missing/e.jsonl"], &["missing/e.jsonl", "make it first"]);
    with(&["--state", "folder"], &["folder", "name a file"]);
    with(&["--state", "-"], &["--output and --state name the same place"]);
    with(&["-o", "r.csv", "--state", "-"], &["--state must be a file"]);
    with(&["--events", "-"], &["--output and --events name the same place"]);
    with(&["-o", "x", "--events", "x"], &["same place"]);
    with(&["--events", "x", "--state", "x"], &["same place"]);
    with(&["--plot", "m.pdf"], &[".svg or .png"]);
    with(&["--plot", "m.svg", "--events", "m.svg"], &["same file"]);
    assert_eq!(files(folder.path()), ["folder", "log.csv"]);
}

#[test]
fn pictures_are_pictures_and_quiet_says_nothing() {
    let folder = tempdir().unwrap();
    let options = ["-q", "-o", "r.csv", "--events", "e.jsonl", "--plot", "m.png"];
    let outcome = monitor(folder.path(), &log(0..100, TIGHT), &options);
    assert_eq!((outcome.code, outcome.stdout.as_str(), outcome.stderr.as_str()), (Some(3), "", ""));
    let picture = std::fs::File::open(folder.path().join("m.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(picture)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    assert!(pixels.iter().any(|&value| value < 50), "the picture is empty");
}

#[test]
fn the_help_says_columns_and_exit_codes() {
    let folder = tempdir().unwrap();
    let help = run(folder.path(), &["monitor", "--help"]).stdout;
    for words in
        ["leak_low_g_h", "cold_pressure_bar", "3 inconclusive", "--coldest-degc", "[default: 160 bar]"]
    {
        assert!(help.contains(words), "{words}");
    }
}

#[test]
fn a_fill_below_the_usual_limit_asks_for_the_limit_of_the_vessel() {
    let text = log(0..3, TIGHT);
    let fill = ["--fill-pressure-bar", "155", "--fill-temperature-degc", "15"];
    for (limit, asks) in [(&[][..], true), (&["--limit-bar", "120"], false)] {
        let folder = tempdir().unwrap();
        let outcome = monitor(folder.path(), &text, &[&fill, limit].concat());
        let asked = outcome.stderr.contains("below the usual limit of 160 bar");
        assert_eq!(asked, asks, "{}", outcome.stderr);
    }
}

#[test]
fn a_step_of_none_tells_each_row_by_itself() {
    let rows: String = (0..7).map(|k| format!("{},15.0{k},15.0{k},200.0{k}\n", 10 * k)).collect();
    let text = format!("{HEADER}{rows}");
    let told = |options: &[&str]| data(&monitor(tempdir().unwrap().path(), &text, options).stdout).len();
    assert_eq!(told(&["--step-s", "0", "--lateness-s", "0"]), 7);
    assert_eq!(told(&[]), 2);
}

#[test]
fn a_log_that_begins_in_a_tunnel_shows_no_refill() {
    let folder = tempdir().unwrap();
    for vessel in ["nitrogen-20l", "closed-bottle", "haque-i1"] {
        let simulated = run(folder.path(), &["simulate", vessel, "tunnel-winter", "-o", "run.csv"]);
        assert_eq!(simulated.code, Some(0), "{}", simulated.stderr);
        let watched = run(folder.path(), &["monitor", vessel, "run.csv", "-o", "rows.csv"]);
        // Too short to be told.
        assert_eq!(watched.code, Some(3), "{vessel}: {}", watched.stderr);
        assert!(!watched.stderr.contains("refill of"), "{vessel}: {}", watched.stderr);
    }
}
