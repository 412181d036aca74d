//! What cannot be calibrated: exit code 2, one message with a remedy, and no file left behind.
use super::{Log, log};
use crate::support::{Outcome, files, refusal, run};
use std::path::Path;
use tempfile::tempdir;

/// Asserts that a run is refused with one message that has these words, and leaves nothing.
fn assert_refused(folder: &Path, outcome: Outcome, words: &[&str]) {
    let errors = outcome.stderr.lines().filter(|line| line.starts_with("error:")).count();
    assert_eq!(errors, 1, "{}", outcome.stderr);
    refusal(outcome, words);
    for name in ["new.toml", "fit.svg"] {
        assert!(!files(folder).contains(&name.to_owned()), "{name}");
    }
}

/// Refuses a log for what is in it.
fn refused(change: impl Fn(Log) -> Log, options: &[&str], words: &[&str]) {
    let folder = tempdir().unwrap();
    change(log(folder.path())).write(folder.path(), "bad.csv");
    let outputs = ["-o", "new.toml", "--plot", "fit.svg"];
    let arguments = [&["calibrate", "nitrogen-20l", "bad.csv"], options, &outputs[..]].concat();
    let outcome = run(folder.path(), &arguments);
    assert_refused(folder.path(), outcome, words);
}

/// Refuses options, each with its words.
fn refused_options(cases: &[(&[&str], &[&str])]) {
    let folder = tempdir().unwrap();
    log(folder.path());
    for (options, words) in cases {
        let outcome = run(folder.path(), &[&["calibrate", "nitrogen-20l", "log.csv"], *options].concat());
        assert_refused(folder.path(), outcome, words);
    }
}

#[test]
fn a_log_without_excitation_says_what_to_record() {
    let level = |value: f64, step: f64| {
        move |number: usize, _: &str| format!("{}", value + step * (number % 3) as f64)
    };
    let still = |log: Log| {
        log.with("ambient_degc", level(20.0, 0.0))
            .with("shoulder_degc", level(20.0, 0.02))
            .with("valve_degc", level(20.0, 0.01))
            .with("pressure_bar", level(204.8, 0.001))
    };
    refused(still, &[], &["no channel moves", "record a change of the ambient by tens of kelvin"]);
}

#[test]
fn a_gap_of_the_air_is_refused_with_its_ends_unless_it_is_allowed() {
    let gap = |log: Log| {
        log.with(
            "ambient_degc",
            |number, cell| {
                if (61..90).contains(&number) { String::new() } else { cell.to_owned() }
            },
        )
    };
    refused(
        gap,
        &[],
        &["the air is missing from 3600 s to 5400 s", "longer than 1200.0 s", "--longest-gap-min"],
    );
    let folder = tempdir().unwrap();
    gap(log(folder.path())).write(folder.path(), "gap.csv");
    let arguments = ["gap.csv", "--longest-gap-h", "1", "--fit", "outside-film"];
    super::calibrate(folder.path(), &arguments);
}

#[test]
fn gaps_of_readings_are_no_fault() {
    let folder = tempdir().unwrap();
    let gappy = log(folder.path()).with("shoulder_degc", |number, cell| {
        if (30..70).contains(&number) { "NaN".to_owned() } else { cell.to_owned() }
    });
    gappy.write(folder.path(), "gap.csv");
    let outcome = super::calibrate(folder.path(), &["gap.csv", "--fit", "outside-film,inside-film"]);
    let [_, value, low, high] = super::shown(&outcome.stdout, "outside-film");
    assert!((value - super::OUTSIDE).abs() < 2.0 * (high - low), "{value} {low} {high}");
}

#[test]
fn a_constant_column_and_a_log_of_another_vessel_are_named() {
    let constant = |log: Log| log.with("shoulder_degc", |_, _| "21.5".to_owned());
    refused(constant, &[], &["`shoulder`", "reads 294.65 (K or Pa) throughout", "leave it out"]);
    let mirrored =
        |log: Log| log.with("shoulder_degc", |_, cell| format!("{}", 40.0 - cell.parse::<f64>().unwrap()));
    refused(
        mirrored,
        &["--fit", "outside-film"],
        &["`shoulder`", "not of this vessel and scenario", "mapped wrongly"],
    );
}

#[test]
fn too_few_rows_are_refused_with_both_numbers() {
    let short = |mut log: Log| {
        log.0.truncate(3);
        log
    };
    refused(short, &[], &["6 usable readings cannot determine 12 parameters", "record more"]);
}

#[test]
fn a_solver_that_is_too_coarse_for_the_search_is_named_as_the_cause() {
    let words =
        ["no minimum after", "with a relative tolerance of 1e-2 the solver's error hides it", "take 1e-9"];
    refused(|log| log, &["--relative-tolerance", "1e-2"], &words);
}

#[test]
fn what_nobody_says_is_asked_for() {
    let words = ["no reading ambient", "--map ambient_degc=THEIRS", "--scenario"];
    refused(|log| log.without("ambient_degc"), &[], &words);
    let words = ["no pressure", "how much gas", "--fill-mass-kg"];
    refused(|log| log.without("pressure_bar"), &[], &words);
    let only_air = |log: Log| log.without("pressure_bar").without("shoulder_degc").without("valve_degc");
    refused(only_air, &["--fill-mass-kg", "4"], &["no column can be used as a reading of the cylinder"]);
}

#[test]
fn a_parameter_at_its_bound_or_outside_of_it_is_named() {
    refused_options(&[
        (&["--bounds", "outside-film=0.9,1.1"], &["`outside film` runs to its bound 1.1", "move the bound"]),
        (&["--start", "outside-film=30"], &["start of `outside film` is 30", "0.05 and 20"]),
        (&["--prior", "outside-film=1,0"], &["prior standard deviation", "positive"]),
    ]);
}

#[test]
fn wrong_names_are_refused_with_the_nearest_one() {
    refused_options(&[
        (&["--fit", "outside-flim"], &["outside-flim", "did you mean outside-film?", "wall-capacity"]),
        (&["--fit", "ofset:shoulder"], &["did you mean offset?"]),
        (&["--fit", "offset"], &["offset:NAME with the name of the sensor"]),
        (&["--fit", "offset:sholder"], &["no sensor sholder", "did you mean shoulder?", "pressure"]),
        (&["--fit", "discharge-coefficient:vent"], &["orifice flow of this name"]),
        (&["--prior", "volume=1,0.1"], &["--prior", "volume is not fitted", "add it to --fit"]),
        (&["--profile", "volume"], &["--profile", "volume is not fitted"]),
        (&["--prior", "outside-film=1"], &["write NAME=MEAN,SD"]),
        (&["--bounds", "outside-film=a,b"], &["write NAME=LOW,HIGH"]),
        (&["--start", "outside-film"], &["write NAME=VALUE"]),
        (&["--fit", "outside-film", "--hold", "outside-film"], &["both name outside-film"]),
        (&["--scenario", "shock-clod"], &["the nearest is shock-cold"]),
        (&["--scenario", "other.csv=shock-cold"], &["other.csv is none of the logs"]),
        (&["--vessel-of", "nitrogen-20l"], &["write LOG=VESSEL"]),
    ]);
}

#[test]
fn options_that_contradict_each_other_are_refused() {
    refused_options(&[
        (&["--scenario", "shock-cold", "--wind-m-s", "3"], &["--film and --wind", "without a scenario"]),
        (&["--film-w-m2-k", "8", "--wind-m-s", "3"], &["both say the outside film"]),
        (&["--validate", "1.5"], &["between 0 and 1"]),
        (&["log.csv"], &["log.csv is given twice"]),
        (&["--validate", "log.csv"], &["log.csv is given twice"]),
        (&["-o", "-", "--format", "json"], &["both want stdout"]),
        (&["--date", "yesterday"], &["2026-03-01T12:00:00Z"]),
        (&["--fill-mass-kg", "1"], &["the fill of 1.000 kg makes", "the log begins with"]),
        (&["--iterations", "0"], &["iterations"]),
    ]);
}

#[test]
fn an_output_that_cannot_be_written_is_refused_before_the_run() {
    let folder = tempdir().unwrap();
    log(folder.path());
    let cases: [(&[&str], &[&str]); 4] = [
        (&["-o", "none/new.toml"], &["none/new.toml cannot be written", "make it first"]),
        (&["-o", "new.csv"], &["ends in .toml", "--format json"]),
        (&["-o", "log.csv"], &["ends in .toml"]),
        (&["--plot", "fit.pdf"], &[".svg or .png"]),
    ];
    for (options, words) in cases {
        let outcome = run(folder.path(), &[&["calibrate", "nitrogen-20l", "log.csv"], options].concat());
        assert_refused(folder.path(), outcome, words);
    }
    let before = "name = 'x'\n";
    std::fs::write(folder.path().join("own.toml"), before).unwrap();
    let outcome = run(folder.path(), &["calibrate", "own.toml", "log.csv", "-o", "own.toml"]);
    assert_refused(folder.path(), outcome, &["own.toml is an input", "choose another output"]);
    let arguments = ["calibrate", "nitrogen-20l", "log.csv", "--scenario", "own.toml", "-o", "own.toml"];
    let outcome = run(folder.path(), &arguments);
    assert_refused(folder.path(), outcome, &["own.toml is an input"]);
    assert_eq!(std::fs::read_to_string(folder.path().join("own.toml")).unwrap(), before);
}
