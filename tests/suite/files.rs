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
