//! `cylwatch bench-detector` on a few cylinders over a day.
use crate::support::{Outcome, TINY_PLAN, files, refused, run, run_with_stdin};
use serde_json::Value;
use std::path::Path;
use tempfile::{TempDir, tempdir};

/// A folder with the tiny plan in it.
fn folder() -> TempDir {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("tiny.toml"), TINY_PLAN).unwrap();
    folder
}

fn bench(folder: &Path, more: &[&str]) -> Outcome {
    run(folder, &[&["bench-detector", "tiny.toml"], more].concat())
}

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap()
}

const RESULTS: [&str; 6] = ["cost.json", "cost.md", "journal.jsonl", "table.json", "table.md", "times.jsonl"];

#[test]
fn stdout_tables_figure_and_report_agree() {
    let folder = folder();
    let folder = folder.path();
    let Outcome { code, stdout, stderr } =
        bench(folder, &["--out", "made/here", "--plot", "delay.svg", "--report", "report.html"]);
    assert_eq!(code, Some(0), "{stderr}");
    assert!(stderr.starts_with("A tiny plan: 11 worlds, 0.0301 cylinder-years"), "{stderr}");
    assert_eq!(files(&folder.join("made/here")), RESULTS);
    assert_eq!(stdout, read(folder, "made/here/table.md"));
    assert!(stdout.contains("11 of 11 worlds") && stdout.contains("## pressure, switch"), "{stdout}");
    let table: Value = serde_json::from_str(&read(folder, "made/here/table.json")).unwrap();
    assert_eq!(table["provenance"]["finished"], 11);
    let [ours, switch] = [0, 1].map(|n| &table["candidates"][n]);
    assert!(ours["threshold"].is_null() && switch["threshold"]["worlds"] == 5);
    let all = ours["groups"].as_array().unwrap().iter().find(|of| of["group"] == "all").unwrap();
    let delay = &all["leaks"]["by_rate"][1]["delay"];
    assert_eq!((&delay["leaks"], &delay["found"]), (&2.into(), &2.into()), "10 % an hour is found");
    assert!(all["tight"]["losses"]["cylinder_years"].as_f64().unwrap() <= 2.0 / 365.25 + 1e-9);
    let hours = delay["median_s"].as_f64().unwrap() / 3600.0;
    let [figure, report] = ["delay.svg", "report.html"].map(|name| read(folder, name));
    for words in ["leak rate in % of the gas per hour", "median delay in h", "cylwatch", "pressure, switch"] {
        assert!(figure.contains(words), "{words} is missing in the figure");
    }
    // The plan is an input, with its hash.
    assert!(
        figure.contains("command: cylwatch bench-detector tiny.toml") && figure.contains("input: tiny.toml")
    );
    assert!(
        report.contains(&format!("{} h", cylwatch::report::number(hours, 2))),
        "{hours} h is not in the report"
    );
    assert!(report.contains("one false alarm in 0.1 years"));
}

#[test]
fn without_a_folder_the_table_alone_is_left_as_markdown_or_json_and_it_is_the_same() {
    let folder = folder();
    let folder = folder.path();
    let kept = bench(folder, &["--out", "out", "--json", "--quiet", "--threads", "1"]);
    assert_eq!((kept.code, kept.stderr.as_str()), (Some(0), ""));
    assert_eq!(kept.stdout, read(folder, "out/table.json"));
    let piped = run_with_stdin(folder, &["bench-detector", "-", "--json", "--quiet"], TINY_PLAN);
    assert_eq!((piped.code, piped.stdout), (Some(0), kept.stdout));
    assert_eq!(files(folder), ["out", "tiny.toml"]);
}

#[test]
fn a_run_that_was_stopped_says_so_and_goes_on_to_the_same_table() {
    let folder = folder();
    let folder = folder.path();
    let partial = bench(folder, &["--out", "parts", "--most", "4"]);
    assert_eq!(partial.code, Some(3), "{}", partial.stderr);
    assert!(partial.stdout.contains("(partial)") && partial.stderr.contains("4 of 11 worlds are finished"));
    let rest = bench(folder, &["--out", "parts"]);
    assert_eq!(rest.code, Some(0), "{}", rest.stderr);
    assert!(rest.stderr.contains("goes on: 4 of 11 worlds"), "{}", rest.stderr);
    assert_eq!(rest.stdout, bench(folder, &[]).stdout);
    // The folder is that of its plan.
    refused(folder, &["bench-detector", "smoke", "--out", "parts"], &["another plan", "give another folder"]);
}

#[test]
fn a_plan_is_checked_and_its_size_told_without_running_it() {
    let folder = folder();
    let folder = folder.path();
    let check = |arguments: &[&str]| {
        let outcome = run(folder, &[&["bench-detector", "--check"], arguments].concat());
        assert_eq!((outcome.code, outcome.stderr.as_str()), (Some(0), ""));
        outcome.stdout
    };
    assert!(check(&["tiny.toml"]).contains("less than a minute"));
    assert!(check(&[]).starts_with("Leak detectors side by side in railway winters: 624 worlds"));
    assert!(check(&["quick", "--leave-out", "climate=desert"]).contains("1556 worlds"));
    let list = run(folder, &["bench-detector", "--list"]);
    for name in ["railway", "reference", "fault", "years", "smoke"] {
        assert!(list.stdout.lines().any(|line| line.starts_with(name)), "{}", list.stdout);
    }
    assert_eq!(files(folder), ["tiny.toml"]);
}

#[test]
fn mistakes_in_plan_and_command_are_refused_by_name_before_anything_runs() {
    let folder = folder();
    let folder = folder.path();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write("line.toml", &TINY_PLAN.replace("seeds = [1, 2]", "seeds = 1"));
    write("kind.toml", &TINY_PLAN.replace("pressure-switch", "pressure-swich"));
    write(
        "tight.toml",
        &TINY_PLAN.replace(r#", { kind = "leak", part_per_h = [0.05, 0.1], onset_h = [14.0, 15.0] }"#, ""),
    );
    let refuse = |arguments: &[&str], words: &[&str]| {
        refused(folder, &[&["bench-detector"], arguments].concat(), words);
    };
    refuse(&["refrence"], &["refrence", "the nearest is reference", "bench-detector --list"]);
    refuse(&["line.toml"], &["line.toml, line 19"]);
    refuse(&["kind.toml"], &["kind.toml", "pressure-swich", "pressure-switch"]);
    refuse(&["tiny.toml", "--leave-out", "climate=autumn"], &["--leave-out", "autumn", "railway"]);
    refuse(&["tight.toml", "--plot", "delay.svg"], &["--plot", "tight.toml has no leaks"]);
    refuse(&["--threads", "0"], &["--threads 0", "at least 1"]);
    refuse(&["--plot", "a.pdf"], &[".svg or .png"]);
    refuse(&["tiny.toml", "--plot", "not/there.svg"], &["not/there.svg", "no folder"]);
    refuse(&["tiny.toml", "--report", "tiny.toml"], &["--report"]);
    refuse(&["tiny.toml", "--out", "line.toml"], &["line.toml", "is a file"]);
    assert_eq!(files(folder), ["kind.toml", "line.toml", "tight.toml", "tiny.toml"]);
}

#[cfg(unix)]
#[test]
fn a_run_without_out_that_is_ended_leaves_no_folder() {
    let folder = tempdir().unwrap();
    let mut command = crate::support::program(folder.path(), &["bench-detector", "fault", "-q"]);
    let mut child = command.env("TMPDIR", folder.path()).spawn().unwrap();
    let begin = std::time::Instant::now();
    while crate::support::files(folder.path()).is_empty() {
        assert!(begin.elapsed() < std::time::Duration::from_secs(60));
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    // The folder is there before anybody listens for a signal.
    std::thread::sleep(std::time::Duration::from_millis(300));
    let ended = std::process::Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
    assert!(ended.unwrap().success());
    assert!(!child.wait().unwrap().success());
    assert!(crate::support::files(folder.path()).is_empty());
}
