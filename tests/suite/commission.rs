//! `cylwatch commission` and what `cylwatch monitor` makes of it, with stretches of an hour so that a test can afford it.
use crate::support::{Outcome, files, program, refused, run};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::OnceLock;
use tempfile::{TempDir, tempdir};

/// Six cylinders of twenty days in a workshop: shorter ones have no onset that is as old as those of the slowest statistic.
const SMALL: [&str; 14] = [
    "--rehearsal",
    "--days",
    "20",
    "--cylinders",
    "6",
    "--climate",
    "workshop",
    "--gas",
    "mixed",
    "--sensor-class",
    "class-b",
    "--row-interval",
    "300s",
    "--quiet",
];

fn small<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["commission", "nitrogen-20l"], &SMALL[..], more].concat()
}

/// `thresholds.json` of the small run, and what the program said; `log.csv` beside it.
fn commissioned() -> &'static (TempDir, Outcome) {
    static COMMISSIONED: OnceLock<(TempDir, Outcome)> = OnceLock::new();
    COMMISSIONED.get_or_init(|| {
        let folder = tempdir().unwrap();
        let loud: Vec<&str> =
            small(&["-o", "thresholds.json"]).into_iter().filter(|word| *word != "--quiet").collect();
        let outcome = run(folder.path(), &loud);
        run(folder.path(), &["simulate", "nitrogen-20l", "ramp-warm", "-o", "log.csv", "--quiet"]);
        (folder, outcome)
    })
}

fn read(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// A monitor with a file of thresholds.
fn monitor(folder: &Path, vessel: &str, thresholds: &str, more: &[&str]) -> Outcome {
    let log = commissioned().0.path().join("log.csv");
    let words = ["monitor", vessel, log.to_str().unwrap(), "--commissioned", thresholds, "-o", "rows.csv"];
    run(folder, &[&words, more].concat())
}

#[test]
fn thresholds_come_with_their_worlds_their_intervals_and_the_rate_of_false_alarms() {
    let (folder, outcome) = commissioned();
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(0), ""), "{}", outcome.stderr);
    for words in ["6 tight cylinders of 20 d", "180 to 200 bar", "workshop", "half-day", "out of sample"] {
        assert!(outcome.stderr.contains(words), "{words}: {}", outcome.stderr);
    }
    let usage = "cylwatch monitor nitrogen-20l LOG --commissioned thresholds.json";
    assert!(outcome.stderr.contains(usage), "{}", outcome.stderr);
    let file = read(&folder.path().join("thresholds.json"));
    assert!(file["provenance"]["command"].as_str().unwrap().starts_with("cylwatch commission nitrogen-20l"));
    assert_eq!(file["provenance"]["inputs"][0]["name"], "preset nitrogen-20l");
    assert_eq!(
        (file["fill_pressure_bar"].as_f64(), file["full_scale_bar"].as_f64()),
        (Some(200.0), Some(250.0))
    );
    assert_eq!(file["worlds"]["climates"], json!(["workshop"]));
    assert_eq!((&file["rehearsal"], &file["worlds"]["cylinders"]), (&json!(true), &json!(6)));
    for of in file["scales"].as_array().unwrap() {
        let [low, threshold, high] =
            [&of["threshold_interval"][0], &of["threshold"], &of["threshold_interval"][1]]
                .map(|v| v.as_f64().unwrap());
        assert!(0.0 < low && low <= threshold && threshold <= high, "{of}");
    }
    let years = file["false_alarms"]["cylinder_years"].as_f64().unwrap();
    assert!(years > 0.2 && years < 6.1 * 20.0 / 365.25, "{years}");
}

#[test]
fn one_thread_finds_what_several_find() {
    let folder = tempdir().unwrap();
    let output = program(folder.path(), &small(&["-o", "-"])).env("RAYON_NUM_THREADS", "1").output().unwrap();
    assert!(output.status.success());
    let one: Value = serde_json::from_slice(&output.stdout).unwrap();
    let (first, _) = commissioned();
    let file = read(&first.path().join("thresholds.json"));
    assert_eq!((&one["scales"], &one["false_alarms"]), (&file["scales"], &file["false_alarms"]));
}

#[test]
fn a_monitor_takes_the_thresholds_of_its_vessel_and_no_others() {
    let (first, _) = commissioned();
    let folder = tempdir().unwrap();
    let thresholds = first.path().join("thresholds.json");
    let path = thresholds.to_str().unwrap();
    let taken = monitor(
        folder.path(),
        "nitrogen-20l",
        path,
        &["--fill-pressure-bar", "200", "--fill-temperature-degc", "15"],
    );
    assert!(taken.code != Some(2) && taken.stderr.contains("rehearsal"), "{}", taken.stderr);
    assert!(!taken.stderr.contains("found for a fill"), "{}", taken.stderr);
    let rows = std::fs::read_to_string(folder.path().join("rows.csv")).unwrap();
    assert!(rows.lines().any(|line| line.starts_with("# input: ") && line.contains("thresholds.json")));
    std::fs::remove_file(folder.path().join("rows.csv")).unwrap();

    let refuses = |vessel: &str, text: Option<String>, words: &[&str]| {
        let file = folder.path().join("other.json");
        std::fs::write(&file, text.unwrap_or_else(|| std::fs::read_to_string(path).unwrap())).unwrap();
        crate::support::refusal(monitor(folder.path(), vessel, "other.json", &[]), words);
        assert_eq!(files(folder.path()), ["other.json"]);
    };
    refuses(
        "nitrogen-20l-paper",
        None,
        &["--commissioned other.json", "its thresholds are for", "cylwatch commission"],
    );
    refuses("nitrogen-20l", Some("{}".into()), &["other.json", "no file of `cylwatch commission`"]);
    refuses("nitrogen-20l", Some("x".into()), &["other.json", "no JSON"]);
    let mut newer = read(&thresholds);
    newer["version"] = json!(2);
    refuses("nitrogen-20l", Some(newer.to_string()), &["version 2", "anew"]);
}

#[test]
fn a_state_that_was_made_with_the_usual_thresholds_goes_on_with_those_of_the_vessel() {
    let (first, _) = commissioned();
    let folder = tempdir().unwrap();
    let log = first.path().join("log.csv");
    let usual =
        ["monitor", "nitrogen-20l", log.to_str().unwrap(), "--state", "cylinder.state", "-o", "rows.csv"];
    assert_ne!(run(folder.path(), &usual).code, Some(2));
    let thresholds = first.path().join("thresholds.json");
    let own =
        monitor(folder.path(), "nitrogen-20l", thresholds.to_str().unwrap(), &["--state", "cylinder.state"]);
    assert!(own.code != Some(2) && own.stderr.contains("the state has seen all rows"), "{}", own.stderr);
}

#[test]
fn another_fill_than_that_of_the_thresholds_is_a_caution() {
    let (first, _) = commissioned();
    let folder = tempdir().unwrap();
    let mut file = read(&first.path().join("thresholds.json"));
    file["fill_pressure_bar"] = json!(100.0);
    std::fs::write(folder.path().join("low.json"), file.to_string()).unwrap();
    let outcome = monitor(folder.path(), "nitrogen-20l", "low.json", &[]);
    assert!(
        outcome.code != Some(2) && outcome.stderr.contains("for a fill of 100 bar"),
        "{}",
        outcome.stderr
    );
}

#[test]
fn what_cannot_be_commissioned_is_refused_before_anything_is_simulated() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let refuses = |more: &[&str], words: &[&str]| {
        refused(folder, &[&["commission", "nitrogen-20l", "-o", "out.json"], more].concat(), words);
        assert!(files(folder).is_empty());
    };
    refuses(&["--cylinders", "100"], &["--cylinders 100", "102 are needed", "62 d"]);
    refuses(&["--days", "30"], &["--days 30", "30.04 d and longer"]);
    refuses(&["--days", "nan"], &["--days nan: it must be a number above 0"]);
    refuses(&["--days", "500"], &["--days", "between"]);
    refuses(&["--row-interval", "1s"], &["--row-interval", "samples"]);
    refuses(&["--climate", "winter"], &["winter", "railway"]);
    refuses(&["--false-alarm-years", "0"], &["--false-alarm-years 0", "above 0"]);
    refuses(&["--full-scale-bar", "150"], &["--full-scale-bar 150", "above the fill of 200 bar"]);
    refuses(&["--fill-pressure-bar", "-5"], &["--fill-pressure-bar", "above"]);
    refuses(&["--fill-pressure-bar", "1e9"], &["--fill-pressure-bar", "no such state"]);
    refused(folder, &["commission", "nitrogen-20l"], &["--output"]);
    refused(
        folder,
        &["commission", "nitrogen-20l", "-o", "not/there.json"],
        &["not/there.json", "no folder"],
    );
    refused(folder, &["commission", "nitrogen-30l", "-o", "out.json"], &["nitrogen-30l", "the nearest is"]);
}

#[cfg(unix)]
#[test]
fn a_run_that_is_ended_leaves_nothing() {
    let folder = tempdir().unwrap();
    let mut child =
        program(folder.path(), &["commission", "nitrogen-20l", "-o", "out.json", "--quiet"]).spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(300));
    let ended = std::process::Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
    assert!(ended.unwrap().success());
    assert!(!child.wait().unwrap().success());
    assert!(files(folder.path()).is_empty());
}
