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
fn a_table_that_ends_before_the_scenario_is_refused_with_its_last_row() {
    let folder = tempdir().unwrap();
    let path = folder.path();
    start(path);
    edited(path, "scenario.toml", "air_degc = 21", "air_csv = { file = \"air.csv\", column = \"air_degc\" }");
    for line in ["[[ambient.air_change]]", "at_min = 0", "to_degc = -25"] {
        edited(path, "scenario.toml", line, "");
    }
    let simulate = ["simulate", "vessel.toml", "scenario.toml", "-o", "run.csv"];
    for (rows, words) in [
        (
            "0,20\n3600,0\n",
            &["air.csv:3", "time_s = 3600", "the end of the scenario", "let the table go on"][..],
        ),
        ("0,20\n", &["air.csv:2", "the end of the scenario"]),
        ("0,20\n3600,0\n3500,0\n10800,0\n", &["air.csv:4", "sort the rows"]),
        ("0,20\n3600,warm\n10800,0\n", &["air.csv:3", "warm"]),
        ("0,20\n3600,9000\n10800,0\n", &["air.csv:3", "9000"]),
    ] {
        std::fs::write(path.join("air.csv"), format!("time_s,air_degc\n{rows}")).unwrap();
        refused(path, &simulate, words);
    }
    std::fs::write(path.join("air.csv"), "time_s,air_degc\n0,20\n5400,0\n10000,0\n").unwrap();
    assert_eq!(run(path, &simulate).code, Some(0));
}

#[test]
fn wrong_words_of_a_command_line_are_refused_with_the_right_ones() {
    let folder = tempdir().unwrap();
    let path = folder.path();
    start(path);
    let cases: [(&[&str], &str); 30] = [
        (&["simulate", "vessel.toml", "scenario.toml", "--seed", "-1"], "a whole number of at least 0"),
        (&["simulate", "vessel.toml", "scenario.toml", "--seed", "1.5"], "a whole number of at least 0"),
        (&["simulate", "vessel.toml", "scenario.toml", "--format", "xml"], "[possible values: csv"),
        (
            &["simulate", "vessel.toml", "scenario.toml", "-o", "no/run.csv"],
            "there is no folder no, make it first",
        ),
        (&["simulate", "vessel.toml", "scenario.toml", "-o", "vessel.toml"], "is an input of this run"),
        (&["estimate", "-", "-"], "stdin can be the vessel or the log, not both"),
        (
            &["properties", "nitrogen", "--temperature-degc", "15"],
            "a state takes two of temperature, pressure and density",
        ),
        (
            &["properties", "nitrogen", "--temperature-degc", "-300", "--pressure-bar", "1"],
            "must be above -273.15",
        ),
        (
            &["properties", "nitrogen", "--temperature-degc", "15", "--pressure-barg", "-2"],
            "must be above -1.01325",
        ),
        (
            &["properties", "co2", "--temperature-degc", "15", "--pressure-bar", "40"],
            "did you mean carbon-dioxide?",
        ),
        (
            &["properties", "ig541", "--temperature-degc", "15", "--pressure-bar", "40"],
            "did you mean ig-541?",
        ),
        (
            &["properties", "carbon-dioxide", "--temperature-degc", "15", "--pressure-bar", "60"],
            "in a cylinder at 15 degC from 50.9 bar on",
        ),
        (&["place", "vessel.toml", "--sensors", "0"], "a whole number of at least 1"),
        (&["place", "vessel.toml", "--sensors", "99"], "only 15 candidates may be taken"),
        (&["commission", "vessel.toml", "-o", "x.json", "--cylinders", "0"], "a whole number of at least 1"),
        (&["bench-detector", "nonsense"], "no built-in plan is called so, the nearest is"),
        (&["inspect", "."], "is a folder: name a file in it"),
        (
            &["identify", "log.csv", "--input", "shoulder", "--output", "shoulder"],
            "name the same column shoulder",
        ),
        (
            &["calibrate", "vessel.toml", "log.csv", "--fit", "nothing"],
            "there is no such parameter; known are",
        ),
        (&["schema", "vesel"], "[possible values: vessel, scenario"),
        (&["completions", "powershel"], "[possible values: bash"),
        (&["man", "--out", "log.csv"], "is a file where the output folder should be"),
        (&["reproduce", "--out", "log.csv"], "is a file where the output folder should be"),
        (&["monitor", "vessel.toml", "log.csv", "--zone", "Mars/Phobos"], "is no zone"),
        (&["monitor", "vessel.toml", "log.csv", "--map", "x"], "write OURS=THEIRS"),
        (&["monitor", "vessel.toml", "log.csv", "--map", "shoulder_degc="], "write OURS=THEIRS"),
        (&["monitor", "vessel.toml", "log.csv", "--state", "."], "is a folder: name a file in it"),
        (&["monitor", "vessel.toml", "log.csv", "--announced", "5"], "write FROM..UNTIL"),
        (&["inspection", "vessel.toml", "log.csv", "--fill-mass-kg", "0"], "must be above 0"),
        (&["simulte"], "similar subcommand"),
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
        for words in ["--limit-bar", "--coldest-degc", "liquid or two-phase"] {
            assert!(outcome.stderr.contains(words), "{words}: {}", outcome.stderr);
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

#[cfg(not(feature = "serve"))]
#[test]
fn a_program_without_the_gateway_says_how_to_build_one_that_has_it() {
    let folder = tempdir().unwrap();
    for arguments in [&["serve"][..], &["serve", "gateway.toml", "--check"]] {
        refused(folder.path(), arguments, &["--features serve"]);
    }
}
