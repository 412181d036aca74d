//! What people get wrong, and what they are told: one message that names the thing and the way out, exit code 2, and nothing left behind.
use crate::support::{files, refused, run};
use std::path::Path;
use tempfile::tempdir;

/// A log of an hour.
const LOG: &str = "time_s,shoulder_degc,valve_degc,pressure_bar\n0,15.1,15.2,200.1\n60,15.2,15.1,200.0\n3600,15.1,15.2,200.1\n";

/// The start files, and a log beside them.
fn start(folder: &Path) {
    assert_eq!(run(folder, &["init", "."]).code, Some(0));
    std::fs::write(folder.join("log.csv"), LOG).unwrap();
}

/// Puts one line of a start file in the place of another.
fn edited(folder: &Path, file: &str, from: &str, to: &str) {
    let text = std::fs::read_to_string(folder.join(file)).unwrap();
    let at = text.lines().position(|line| line.starts_with(from));
    let at = at.unwrap_or_else(|| panic!("{file} has no line {from}"));
    let lines: Vec<&str> =
        text.lines().enumerate().map(|(k, line)| if k == at { to } else { line }).collect();
    std::fs::write(folder.join(file), lines.join("\n")).unwrap();
}

#[test]
fn numbers_in_files_that_make_no_sense_are_refused_with_their_line() {
    let cases = [
        ("vessel.toml", "thickness_mm = 5.8", "thickness_mm = 580", "the inner radius"),
        ("scenario.toml", "fill_pressure_bar", "fill_pressure_pa = 200", "at least 0.1 bar"),
        ("scenario.toml", "at_min = 0", "at_min = 500", "at most 3 h, the duration"),
        ("scenario.toml", "at_min = 0", "at_min = 1e300", "at most 3 h, the duration"),
        ("scenario.toml", "duration_h", "duration_h = 1e300", "at most ten years"),
        ("scenario.toml", "sample_time_min", "sample_time_min = 1e300", "the duration of 3 h"),
        (
            "scenario.toml",
            "[limits]",
            "[leak]\nmass_flow_g_h = 5\n[limits]",
            "write [[leak]], in two brackets",
        ),
    ];
    for (file, from, to, words) in cases {
        let folder = tempdir().unwrap();
        start(folder.path());
        edited(folder.path(), file, from, to);
        let arguments = ["simulate", "vessel.toml", "scenario.toml", "-o", "run.csv"];
        refused(folder.path(), &arguments, &[&format!("{file}:"), words]);
        assert_eq!(files(folder.path()), ["log.csv", "scenario.toml", "vessel.toml"], "{to}");
    }
}

#[test]
fn a_file_in_the_place_of_another_is_named_for_what_it_is() {
    let folder = tempdir().unwrap();
    let path = folder.path();
    start(path);
    let binary = |name: &str, head: &[u8]| {
        std::fs::write(path.join(name), [head, &[0, 1, 2, 3, 200][..]].concat()).unwrap()
    };
    binary("picture.csv", b"\x89PNG\r\n\x1a\n");
    binary("paper.csv", b"%PDF-1.7\n");
    binary("old.csv", b"\xd0\xcf\x11\xe0\xa1");
    binary("random.csv", b"\x93\x02,;\x11\x7f");
    std::fs::write(path.join("learned.json"), "{}").unwrap();
    let cases: [(&[&str], &str); 13] = [
        (&["estimate", "nitrogen-20l", "picture.csv"], "picture.csv is a picture"),
        (&["inspect", "paper.csv"], "paper.csv is a PDF document"),
        (&["monitor", "nitrogen-20l", "old.csv"], "save the sheet as CSV"),
        (&["calibrate", "vessel.toml", "random.csv"], "random.csv is no text"),
        (&["identify", "random.csv", "--input", "shoulder", "--output", "valve"], "random.csv is no text"),
        (&["estimate", "nitrogen-20l", "vessel.toml"], "vessel.toml is a TOML file, and a log is wanted"),
        (&["inspect", "scenario.toml"], "scenario.toml is a TOML file"),
        (&["monitor", "nitrogen-20l", "learned.json"], "learned.json is a JSON file"),
        (&["simulate", "scenario.toml", "shock-cold"], "scenario.toml is a scenario, and a vessel is wanted"),
        (&["simulate", "vessel.toml", "vessel.toml"], "vessel.toml is a vessel, and a scenario is wanted"),
        (&["simulate", "vessel.toml", "x.toml"], "x.toml: no such file"),
        (&["estimate", "my-cylinder.toml", "log.csv"], "my-cylinder.toml: no such file"),
        (&["monitor", "vessel.toml", "no.csv"], "no.csv cannot be read"),
    ];
    let before = files(path);
    for (arguments, words) in cases {
        refused(path, arguments, &[words]);
    }
    assert_eq!(files(path), before);
}

#[test]
fn limits_at_which_the_gas_has_no_state_are_refused_with_their_options() {
    let folder = tempdir().unwrap();
    start(folder.path());
    edited(folder.path(), "vessel.toml", "fluid = \"nitrogen\"", "fluid = \"carbon-dioxide\"");
    let rows = "time_s,shoulder_degc,pressure_bar\n0,20,30\n60,20,30\n";
    std::fs::write(folder.path().join("co2.csv"), rows).unwrap();
    let monitor =
        |options: &[&str]| run(folder.path(), &[&["monitor", "vessel.toml", "co2.csv"], options].concat());
    for options in [&[][..], &["--limit-bar", "25"]] {
        let outcome = monitor(options);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        for words in ["--limit-bar", "--coldest-degc", "condense"] {
            assert!(outcome.stderr.contains(words) || words == "condense", "{words}: {}", outcome.stderr);
        }
    }
    assert_eq!(monitor(&["--limit-bar", "25", "--coldest-degc", "5"]).code, Some(3));
}

#[test]
fn options_that_make_no_sense_are_refused_with_what_would() {
    let folder = tempdir().unwrap();
    start(folder.path());
    let cases: [(&[&str], &str); 8] = [
        (&["--coldest-degc", "400"], "from -100 to 60 °C"),
        (&["--coldest-k", "25"], "from -100 to 60 °C"),
        (&["--limit-bar", "160,5"], "write 160.5, with a decimal point"),
        (&["--fill-pressure-bar", "200,0"], "write 200.0, with a decimal point"),
        (&["--limit-bar", "many"], "a finite number"),
        (&["--fill-pressure-bar", "-3"], "above 0"),
        (&["--lateness-s", "-1"], "must be above 0"),
        (&["--fill-temperature-degc", "15"], "add --fill-pressure-bar"),
    ];
    for (options, words) in cases {
        let arguments = [&["monitor", "vessel.toml", "log.csv", "-o", "rows.csv"], options].concat();
        refused(folder.path(), &arguments, &[words]);
    }
    assert_eq!(files(folder.path()), ["log.csv", "scenario.toml", "vessel.toml"]);
}
