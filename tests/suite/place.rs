//! `cylwatch place` on the 20 L cylinder, small enough for a test.
use crate::support::{Outcome, column, files, refusal, refused, rows, run, run_with_stdin};
use std::path::Path;
use tempfile::tempdir;

/// On a coarse wall, at rest only.
const SMALL: [&str; 6] = ["place", "nitrogen-20l", "--wall-nodes", "2", "--scenario", "none"];

/// With two sensors unless more are asked for.
fn small<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let sensors: &[&str] = if more.contains(&"--sensors") { &[] } else { &["--sensors", "2"] };
    [&SMALL, sensors, more].concat()
}

/// The program with a file of candidates, which it must refuse.
fn refuses(candidates: &str, more: &[&str], words: &[&str]) {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("places.toml"), candidates).unwrap();
    refused(
        folder.path(),
        &small(&[&["--candidates", "places.toml", "-o", "out.csv"], more].concat()),
        words,
    );
    assert_eq!(files(folder.path()), ["places.toml"]);
}

#[test]
fn tables_json_csv_figure_and_matrices_agree() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let files_asked = ["-o", "study.json", "--plot", "study.svg", "--matrices", "matrices.json"];
    let outcome = run(folder, &small(&files_asked));
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(0), ""), "{}", outcome.stderr);
    assert_eq!(files(folder), ["matrices.json", "study.json", "study.svg"]);
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let study: serde_json::Value = serde_json::from_str(&read("study.json")).unwrap();
    assert!(study["provenance"]["command"].as_str().unwrap().starts_with("cylwatch place nitrogen-20l"));
    assert_eq!(
        (study["partial"].as_bool(), study["criterion"]["name"].as_str()),
        (Some(false), Some("leak-rate"))
    );
    let best = &study["best"][0];
    let names: Vec<&str> =
        best["names"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    assert!(names.len() == 2 && names.contains(&"pressure"), "{names:?}");
    assert!(outcome.stderr.contains(names.iter().find(|name| **name != "pressure").unwrap()));
    square(&serde_json::from_str(&read("matrices.json")).unwrap());
    let svg = read("study.svg");
    for words in ["shoulder", "valve", "smallest leak in g/h"] {
        assert!(svg.contains(words), "{words} is missing in the figure");
    }
    // Two sensors of one price: nothing to show of what accuracy costs.
    assert!(!svg.contains("cost of a layout"));
}

/// Matrices of both members fit their states and the candidates.
fn square(matrices: &serde_json::Value) {
    for member in ["gas_temperature_and_leak_rate", "mass"] {
        let of = |key: &str| matrices[member][key].as_array().unwrap();
        let states = of("states").len();
        for matrix in ["transition", "process_noise"] {
            assert_eq!(of(matrix).len(), states);
            assert!(of(matrix).iter().all(|row| row.as_array().unwrap().len() == states));
        }
        assert_eq!((of("scales").len(), of("point").len()), (states, states));
        assert_eq!(of("outputs").len(), matrices["candidates"].as_array().unwrap().len());
    }
}

#[test]
fn words_go_to_stdout_and_csv_has_a_row_for_each_judged_layout() {
    let folder = tempdir().unwrap();
    let text = run(folder.path(), &small(&[]));
    assert_eq!(text.code, Some(0), "{}", text.stderr);
    assert!(text.stdout.starts_with("Where sensors should sit: nitrogen cylinder"), "{}", text.stdout);
    assert!(text.stdout.lines().all(|line| line.chars().count() <= 110), "{}", text.stdout);
    let csv = run(folder.path(), &small(&["--format", "csv", "--quiet"]));
    assert_eq!((csv.code, csv.stderr.as_str()), (Some(0), ""));
    assert!(csv.stdout.contains("# command: cylwatch place"));
    let (header, lines) = rows(&csv.stdout);
    assert!(header[0] == "sensors" && !lines.is_empty());
    assert!(column(&csv.stdout, "smallest_leak_g_h").iter().all(|leak| *leak > 0.0));
    // The best by the criterion is not worse than any other.
    let leak = column(&csv.stdout, "leak_sd_g_h");
    assert!(leak.iter().all(|other| leak[0] <= other * (1.0 + 1e-9)), "{leak:?}");
}

#[test]
fn a_search_that_is_ended_early_says_so_and_writes_what_it_has() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &small(&["--time-limit-s", "1e-9", "-o", "study.json"]));
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("PARTIAL") && outcome.stderr.contains("partial"), "{}", outcome.stderr);
    let study = std::fs::read_to_string(folder.path().join("study.json")).unwrap();
    assert_eq!(serde_json::from_str::<serde_json::Value>(&study).unwrap()["partial"], true);
    assert_eq!(files(folder.path()), ["study.json"]);
}

#[test]
fn what_a_file_of_candidates_has_wrong_is_named_with_its_line() {
    let rule = |rest: &str| format!("[[rule]]\n{rest}\n");
    refuses(&rule("sensor = \"sholder\""), &[], &["places.toml:2", "sholder", "shoulder"]);
    refuses(&rule("sensor = \"valve\"\ncost = -2"), &[], &["places.toml:3", "-2", "at least 0"]);
    refuses(&rule("sensor = \"valve\"\nstatus = \"perhaps\""), &[], &["places.toml:3", "perhaps"]);
    let twice = "[[rule]]\nsensor = \"valve\"\nstatus = \"required\"\n[[rule]]\nsensor = \"valve\"\nstatus = \"forbidden\"\n";
    refuses(twice, &[], &["places.toml:5", "valve"]);
    let group = |rest: &str| format!("[[group]]\nmembers = [\"valve\", \"shoulder\"]\n{rest}\n");
    refuses(&group("at_least = 3"), &[], &["places.toml:3", "at most 2"]);
    refuses(&group("at_least = 2\nat_most = 1"), &[], &["places.toml:3", "at most 1"]);
    let none_left =
        format!("{}{}", group("at_least = 2"), rule("sensor = \"valve\"\nstatus = \"forbidden\""));
    refuses(&none_left, &[], &["places.toml:3", "forbidden"]);
    refuses("minimum_distance_mm = -1\n", &[], &["places.toml:1", "-1"]);
    refuses("minimum_distance = 1\n", &[], &["places.toml:1", "minimum_distance"]);
    let near = "minimum_distance_mm = 5000\n[[rule]]\nsensor = \"shoulder\"\nstatus = \"required\"\n[[rule]]\nsensor = \"middle\"\nstatus = \"required\"\n";
    refuses(near, &[], &["places.toml:1", "middle", "shoulder"]);
}

#[test]
fn what_no_layout_can_be_is_said() {
    let no_pressure = "[[rule]]\nsensor = \"pressure\"\nstatus = \"forbidden\"\n";
    refuses(no_pressure, &[], &["mass_kg", "do not see"]);
    refuses("", &["--budget", "0.5"], &["cost at least 1", "budget is 0.5"]);
    refuses("", &["--budget", "1.5"], &["cost at least 2", "budget is 1.5"]);
    let all = "[[rule]]\nsensor = \"shoulder\"\nstatus = \"required\"\n[[rule]]\nsensor = \"middle\"\nstatus = \"required\"\n";
    refuses(all, &[], &["3 sensors are required", "2 asked for"]);
    // No two thermometers on the wall, but the group wants two.
    let apart = "minimum_distance_mm = 5000\n[[group]]\nmembers = [\"bottom\", \"middle\"]\nat_least = 2\n";
    refuses(apart, &["--sensors", "3"], &["no layout"]);
}

#[test]
fn options_that_are_wrong_are_refused_by_name_before_anything_runs() {
    let folder = tempdir().unwrap();
    let refuse = |more: &[&str], words: &[&str]| {
        refused(folder.path(), &[&["place", "nitrogen-20l"], more].concat(), words)
    };
    refuse(&["--criterion", "beauty"], &["beauty", "leak-rate", "robust-worst"]);
    refuse(&["--criterion", "robust-mean", "--scenario", "none"], &["robust-mean", "--scenario"]);
    refuse(
        &["--criterion", "smallest-leak", "--method", "branch-and-bound"],
        &["smallest-leak", "exhaustive"],
    );
    refuse(&["--sensors", "0"], &["--sensors 0"]);
    refuse(&["--confirm", "1"], &["--confirm 1", "at least 2"]);
    refuse(&["--sensors", "99", "--scenario", "none"], &["--sensors 99", "only"]);
    refuse(&["--budget", "-1"], &["--budget -1"]);
    refuse(&["--within-percent", "nan"], &["--within-percent"]);
    refuse(&["--within-s", "10"], &["--within", "every 1 min"]);
    refuse(&["--false-alarm-years", "0"], &["--false-alarm-years 0"]);
    refuse(&["--wall-nodes", "0"], &["--wall-nodes 0", "at least 1"]);
    refuse(&["--leak-g-h", "-3"], &["--leak-g-h"]);
    refuse(&["--sample-time-s", "60", "--sample-time-min", "1"], &["--sample-time-min", "keep one"]);
    refuse(&["--scenario", "no-such"], &["no-such", "scenario"]);
    refuse(&["--scenario", "tunnel-winter", "--scenario", "tunnel-winter"], &["twice"]);
    refuse(&["--plot", "a.pdf"], &[".svg or .png"]);
    refuse(&["-o", "no-such/study.json"], &["no-such"]);
    refuse(&["-o", "x.json", "--matrices", "x.json"], &["x.json"]);
    refuse(&["--json", "--matrices", "-"], &["--matrices"]);
    refuse(&["--candidates", "no-such.toml"], &["no-such.toml"]);
    assert!(files(folder.path()).is_empty());
}

#[test]
fn a_vessel_from_stdin_and_candidates_from_a_file_make_a_study() {
    let folder = tempdir().unwrap();
    let candidates = "[[sensor]]\nname = \"shoulder\"\n[[sensor]]\nname = \"wall_300mm\"\nheight_mm = 300\n\
                      [[sensor]]\nname = \"pressure\"\n[[rule]]\nsensor = \"shoulder\"\ncost = 2.5\n";
    std::fs::write(folder.path().join("places.toml"), candidates).unwrap();
    let vessel =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("vessels/nitrogen-20l.toml"))
            .unwrap();
    let mut arguments = small(&["--candidates", "places.toml", "--json", "--quiet"]);
    arguments[1] = "-";
    let outcome = run_with_stdin(folder.path(), &arguments, &vessel);
    let Outcome { code, stdout, stderr } = outcome;
    assert_eq!((code, stderr.as_str()), (Some(0), ""));
    let study: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(study["candidates"].as_array().unwrap().len(), 3);
    assert_eq!(study["provenance"]["inputs"].as_array().unwrap().len(), 2);
    // Both streams cannot be stdin.
    arguments.splice(8..9, ["--candidates"]);
    arguments[9] = "-";
    refusal(run_with_stdin(folder.path(), &arguments, &vessel), &["stdin"]);
}

#[test]
fn the_schema_knows_files_of_candidates() {
    let folder = tempdir().unwrap();
    let outcome = run(folder.path(), &["schema", "candidates"]);
    assert_eq!(outcome.code, Some(0));
    assert!(outcome.stdout.contains("minimum_distance") && outcome.stdout.contains("at_most"));
}
