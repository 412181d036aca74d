//! `cylwatch init`, `schema`, `completions` and the program's help.
use crate::support::{files, refused, run};
use tempfile::tempdir;

#[test]
fn start_files_are_written_once_and_run_as_they_are() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &["init", "mine"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let mine = folder.path().join("mine");
    assert_eq!(files(&mine), ["scenario.toml", "vessel.toml"]);
    assert!(std::fs::read_to_string(mine.join("vessel.toml")).unwrap().starts_with('#'));
    let run = run(&mine, &["simulate", "vessel.toml", "scenario.toml", "-q"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    std::fs::write(mine.join("vessel.toml"), "edited").unwrap();
    std::fs::remove_file(mine.join("scenario.toml")).unwrap();
    refused(folder.path(), &["init", "mine"], &["vessel.toml", "is there already"]);
    assert_eq!(std::fs::read_to_string(mine.join("vessel.toml")).unwrap(), "edited");
    assert_eq!(files(&mine), ["vessel.toml"]);
}

#[test]
fn start_files_bring_the_tables_that_the_scenario_names() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &["init", "--scenario", "railway-week"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_eq!(files(folder.path()), ["railway-week.csv", "scenario.toml", "vessel.toml"]);
    let run = run(folder.path(), &["simulate", "vessel.toml", "scenario.toml", "-q"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn an_unknown_start_preset_writes_nothing() {
    let folder = tempdir().unwrap();
    refused(folder.path(), &["init", "--vessel", "nitrogen-20"], &["nitrogen-20", "nitrogen-20l"]);
    assert!(files(folder.path()).is_empty());
}

#[test]
fn schemas_are_json_and_know_the_keys() {
    let folder = tempdir().unwrap();
    for document in ["vessel", "scenario"] {
        let outcome = run(folder.path(), &["schema", document]);
        let schema: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
        assert!(schema["properties"]["name"].is_object(), "{document}");
    }
    let both: serde_json::Value = serde_json::from_str(&run(folder.path(), &["schema"]).stdout).unwrap();
    assert!(both["vessel"].is_object() && both["scenario"].is_object());
}

#[test]
fn every_command_has_help_and_the_shells_their_completions() {
    let folder = tempdir().unwrap();
    let help = run(folder.path(), &["--help"]);
    assert_eq!((help.code, help.stderr.as_str()), (Some(0), ""));
    for command in [
        "reproduce",
        "simulate",
        "estimate",
        "monitor",
        "identify",
        "calibrate",
        "properties",
        "init",
        "schema",
        "completions",
        "inspect",
        "man",
    ] {
        assert!(help.stdout.contains(command));
        assert_eq!(run(folder.path(), &[command, "--help"]).code, Some(0));
    }
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(run(folder.path(), &["completions", shell]).stdout.contains("cylwatch"));
    }
    refused(folder.path(), &["simulat"], &["simulate"]);
}

#[test]
fn a_short_help_fits_one_screen_and_the_long_one_has_the_expert_options() {
    let folder = tempdir().unwrap();
    for command in ["estimate", "monitor", "identify", "calibrate", "place"] {
        let [short, long] = ["-h", "--help"].map(|help| run(folder.path(), &[command, help]).stdout);
        assert!(short.lines().count() <= 40, "{command}: {} lines", short.lines().count());
        assert!(!short.contains("Expert options") && long.contains("Expert options"), "{command}");
    }
}

#[test]
fn a_negative_number_is_refused_by_its_bounds_whatever_the_option() {
    let folder = tempdir().unwrap();
    let cases: [&[&str]; 5] = [
        &["simulate", "nitrogen-20l", "shock-cold", "--seed"],
        &["reproduce", "--cylinders"],
        &["place", "nitrogen-20l", "--sensors"],
        &["calibrate", "nitrogen-20l", "log.csv", "--iterations"],
        &["bench-detector", "--most"],
    ];
    for arguments in cases {
        let outcome = run(folder.path(), &[arguments, &["-3"]].concat());
        assert_eq!(outcome.code, Some(2));
        let option = arguments.last().unwrap();
        assert!(
            outcome.stderr.starts_with(&format!("error: {option} -3: it must be a ")),
            "{}",
            outcome.stderr
        );
        assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
    }
}

#[test]
fn there_is_a_manual_page_for_every_command_and_the_main_one_goes_to_stdout() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &["man"]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
    assert!(outcome.stdout.contains(".TH cylwatch 1") && outcome.stdout.contains("NAME"));
    let outcome = run(folder.path(), &["man", "--out", "man1"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let pages = files(&folder.path().join("man1"));
    for page in ["cylwatch.1", "cylwatch-estimate.1", "cylwatch-inspect.1", "cylwatch-man.1"] {
        assert!(pages.iter().any(|found| found == page), "{page} is missing in {pages:?}");
    }
    let estimate = std::fs::read_to_string(folder.path().join("man1/cylwatch-estimate.1")).unwrap();
    assert!(estimate.contains("cylwatch estimate") && estimate.contains("\\-\\-zone"), "{estimate}");
    std::fs::write(folder.path().join("taken"), "").unwrap();
    refused(folder.path(), &["man", "--out", "taken"], &["taken is a file"]);
}
