//! `cylwatch fleet`: each cylinder as by `monitor`, whatever the threads, through kills and bad files; tables and page.
mod called;
mod columns;
mod nights;
#[cfg(feature = "parquet")]
mod parquet;
mod vessels;

use crate::support::{Outcome, program, refused, run};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;
use tempfile::{TempDir, tempdir};

const FORMAT: &[&str] = &["--format", "csv", "-q"];

/// One row of a log of a cylinder at 15 °C; from minute `leak_from` on the pressure falls by 1 bar/h.
fn row(minute: u32, leak_from: u32) -> String {
    let residue = |by: u32| f64::from(minute * minute * by % 101) / 50.0 - 1.0;
    let lost_bar = f64::from(minute.saturating_sub(leak_from)) / 60.0;
    let [shoulder, valve] = [15.0 + 0.03 * residue(3), 15.0 + 0.03 * residue(7)];
    format!("{},{shoulder:.3},{valve:.3},{:.4}\n", 60 * minute, 200.0 + 0.02 * residue(11) - lost_bar)
}

const COLUMNS: &str = "time_s,shoulder_degc,valve_degc,pressure_bar\n";
const TIGHT: u32 = u32::MAX;

fn log(minutes: std::ops::Range<u32>, leak_from: u32) -> String {
    COLUMNS.to_owned() + &minutes.map(|minute| row(minute, leak_from)).collect::<String>()
}

/// A file of vessels for these cylinders, all settled at 200 bar and 15 °C.
fn vessels(names: &[&str]) -> String {
    let row = |name: &&str| format!("\"{name}\",nitrogen-20l,200,15,yes\n");
    "cylinder,vessel,fill_pressure_bar,fill_temperature_degc,settled\n".to_owned()
        + &names.iter().map(row).collect::<String>()
}

/// A folder with these files below `logs`, and the file of vessels of these cylinders.
fn with_logs(files: &[(&str, String)], names: &[&str]) -> TempDir {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("fleet.csv"), vessels(names)).unwrap();
    for (name, text) in files {
        let path = folder.path().join("logs").join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

/// A folder of tight cylinders alike, the prefix of their names before a number of two digits, and these names.
fn alike(prefix: &str, count: usize, minutes: u32) -> (TempDir, Vec<String>) {
    let names: Vec<String> = (0..count).map(|k| format!("{prefix}{k:02}")).collect();
    let files: Vec<String> = names.iter().map(|name| format!("{name}.csv")).collect();
    let files: Vec<_> = files.iter().map(|file| (file.as_str(), log(0..minutes, TIGHT))).collect();
    (with_logs(&files, &names.iter().map(String::as_str).collect::<Vec<_>>()), names)
}

/// Begins a run with rows so many times and kills it, each after so many milliseconds.
fn kill_again_and_again(folder: &Path, after_ms: impl Iterator<Item = u64>) {
    let arguments = [&["fleet", "logs", "--vessels", "fleet.csv", "-o", "out"], FORMAT, &["--rows"]].concat();
    let mut kills = 0;
    for after_ms in after_ms {
        let mut child = program(folder, &arguments).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(after_ms));
        // SIGKILL: nothing can be tidied up.
        kills += u32::from(child.try_wait().unwrap().is_none());
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert!(kills > 0, "no run was killed on its way");
}

fn fleet(folder: &Path, options: &[&str]) -> Outcome {
    run(folder, &[&["fleet", "logs", "--vessels", "fleet.csv", "-o", "out"], FORMAT, options].concat())
}

/// A table of the output folder, each row by its columns.
fn table(folder: &Path, name: &str) -> Vec<BTreeMap<String, String>> {
    let text = std::fs::read_to_string(folder.join("out").join(name)).unwrap();
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    reader.deserialize().map(|row| row.unwrap()).collect()
}

fn column(rows: &[BTreeMap<String, String>], name: &str) -> Vec<String> {
    rows.iter().map(|row| row[name].clone()).collect()
}

/// Everything in a folder that is not hidden.
fn content(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        match (name.starts_with('.'), path.is_dir()) {
            (true, _) => {}
            (false, true) => {
                found.extend(content(&path).into_iter().map(|(k, v)| (format!("{name}/{k}"), v)))
            }
            (false, false) => _ = found.insert(name, std::fs::read(&path).unwrap()),
        }
    }
    found
}

#[test]
fn a_row_says_what_the_monitor_says_of_the_same_log_number_for_number() {
    let files = [("A.csv", log(0..1800, 1600)), ("B.csv", log(0..1600, TIGHT)), ("C.csv", log(0..90, TIGHT))];
    let folder = with_logs(&files, &["A", "B", "C"]);
    let outcome = fleet(folder.path(), &["--rows"]);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert_eq!((outcome.stdout.as_str(), outcome.stderr.as_str()), ("", ""));
    let rows = table(folder.path(), "summary.csv");
    assert_eq!(column(&rows, "cylinder"), ["A", "C", "B"]);
    assert_eq!(column(&rows, "light"), ["act", "unknown", "fine"]);
    assert_eq!(column(&rows, "outcome"), ["loss", "unknown", "no-loss"]);
    for row in &rows {
        let name = &row["cylinder"];
        let monitor = run(
            folder.path(),
            &[
                &[
                    "monitor",
                    "nitrogen-20l",
                    &format!("logs/{name}.csv"),
                    "--settled",
                    "--format",
                    "json",
                    "-q",
                ][..],
                &[
                    "--fill-pressure-bar",
                    "200",
                    "--fill-temperature-degc",
                    "15",
                    "--state",
                    &format!("{name}.state"),
                ],
                &["--events", &format!("{name}.jsonl")],
            ]
            .concat(),
        );
        let document: serde_json::Value = serde_json::from_str(&monitor.stdout).unwrap();
        let said = &document["summary"];
        let is = |column: &str, expected: &serde_json::Value| {
            let found = row[column].parse::<f64>().ok();
            assert_eq!(found, expected.as_f64(), "{name}: {column}");
        };
        is("p15_bar", &said["p15_bar"]);
        is("limit_bar", &said["limit_bar"]);
        is("cold_pressure_bar", &said["cold_pressure_bar"]);
        is("leak_probability", &said["leak_probability"]);
        is("leak_high_g_h", &said["leak_rate_high_g_h"]);
        is("rows", &said["rows"]);
        for (k, column) in ["lost_g", "lost_low_g", "lost_high_g"].into_iter().enumerate() {
            is(column, &said["leak"]["lost_g"][k]);
        }
        for (quantile, column) in [("p5_d", "left_p5_d"), ("p50_d", "left_p50_d"), ("p95_d", "left_p95_d")] {
            is(column, &said["outlook"]["operational"][quantile]);
        }
        assert_eq!(row["verdict"], said["verdict"]["verdict"].as_str().unwrap());
        assert_eq!(row["reaction"], said["reaction"].as_str().unwrap_or_default());
        assert_eq!(row["outcome"], said["outcome"].as_str().unwrap());
        // The monitor's own run saves the same state and tells the same events.
        let own = std::fs::read(folder.path().join(format!("{name}.state"))).unwrap();
        let mut resumed = vec!["monitor", "nitrogen-20l", "more.csv", "-o", "more-rows.csv", "-q", "--state"];
        let state = format!("out/states/{name}.state");
        resumed.push(&state);
        std::fs::write(folder.path().join("more.csv"), log(1800..1900, TIGHT)).unwrap();
        assert!(run(folder.path(), &resumed).code.is_some_and(|code| code != 2), "{name}: the state goes on");
        assert!(!own.is_empty());
        let events = std::fs::read_to_string(folder.path().join(format!("{name}.jsonl"))).unwrap();
        let told: Vec<String> = table(folder.path(), "events.csv")
            .into_iter()
            .filter(|event| event["cylinder"] == *name)
            .map(|event| event["line"].clone())
            .collect();
        assert_eq!(told, events.lines().collect::<Vec<_>>(), "{name}");
    }
    let own = run(
        folder.path(),
        &[
            "monitor",
            "nitrogen-20l",
            "logs/B.csv",
            "--settled",
            "--fill-pressure-bar",
            "200",
            "--fill-temperature-degc",
            "15",
            "--state",
            "rows.state",
            "-o",
            "rows.csv",
            "-q",
        ],
    );
    assert_eq!(own.code, Some(0), "{}", own.stderr);
    let data = |path: &str| {
        let text = std::fs::read_to_string(folder.path().join(path)).unwrap();
        text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(data("rows.csv"), data("out/rows/B.csv"));
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let names: Vec<String> = (0..6).map(|k| format!("N{k}")).collect();
    let files: Vec<(String, String)> = names
        .iter()
        .enumerate()
        .map(|(k, name)| (format!("{name}.csv"), log(0..200 + 40 * k as u32, TIGHT)))
        .collect();
    let files: Vec<(&str, String)> = files.iter().map(|(name, text)| (name.as_str(), text.clone())).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let folder = with_logs(&files, &names);
    let mut found = Vec::new();
    for threads in ["1", "2", "3"] {
        let outcome = fleet(folder.path(), &["--rows", "--threads", threads]);
        assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
        let out = folder.path().join("out");
        found.push(content(&out));
        std::fs::remove_dir_all(&out).unwrap();
    }
    assert!(
        found[0].len() > 20 && found[0].contains_key("page.html") && found[0].contains_key("states/N3.state")
    );
    assert!(found[0] == found[1] && found[0] == found[2]);
}

#[test]
fn a_run_that_is_killed_again_and_again_ends_with_the_bytes_of_one_that_was_not() {
    let (folder, _) = alike("K", 8, 700);
    let whole = fleet(folder.path(), &["--rows"]);
    assert_eq!(whole.code, Some(3), "{}", whole.stderr);
    let out = folder.path().join("out");
    let expected = content(&out);
    std::fs::remove_dir_all(&out).unwrap();
    kill_again_and_again(folder.path(), (0..12).map(|k| 40 + 97 * (k * k % 11)));
    assert_eq!(fleet(folder.path(), &["--rows"]).code, Some(3));
    assert!(content(&out) == expected);
}

#[test]
fn a_second_run_does_only_what_has_changed() {
    let folder = with_logs(&[("A.csv", log(0..300, TIGHT)), ("B.csv", log(0..300, TIGHT))], &["A", "B"]);
    assert_eq!(fleet(folder.path(), &[]).code, Some(3));
    let record = |name: &str| {
        let path = folder.path().join(format!("out/records/{name}.record"));
        path.metadata().unwrap().modified().unwrap()
    };
    let before = [record("A"), record("B")];
    std::fs::write(folder.path().join("logs/B.csv"), log(0..400, TIGHT)).unwrap();
    assert_eq!(fleet(folder.path(), &[]).code, Some(3));
    assert_eq!(record("A"), before[0]);
    assert!(record("B") > before[1]);
    let rows = table(folder.path(), "summary.csv");
    let of_b = rows.iter().find(|row| row["cylinder"] == "B").unwrap();
    assert_eq!(of_b["rows"], "400");
    // A record that is damaged, and another limit, are done again.
    std::fs::write(folder.path().join("out/records/A.record"), "no record").unwrap();
    let damaged = record("A");
    assert_eq!(fleet(folder.path(), &["--limit-bar", "150"]).code, Some(3));
    assert!(record("A") > damaged);
    assert_eq!(column(&table(folder.path(), "summary.csv"), "limit_bar"), ["150", "150"]);
}

#[test]
fn a_bad_log_is_told_and_ends_nothing() {
    let files = [
        ("good.csv", log(0..100, TIGHT)),
        ("empty.csv", String::new()),
        ("columns.csv", "a,b\n1,2\n".to_owned()),
        ("cells.csv", format!("{COLUMNS}0,15,15,200\n60,15,15,200,7,7\n")),
        ("stranger.csv", log(0..10, TIGHT)),
        ("twice.csv", log(0..100, TIGHT)),
        ("site/twice.csv", log(0..100, TIGHT)),
        ("folder.csv/inside.txt", String::new()),
        ("notes.md", "no log".to_owned()),
        ("<script>alert(1).csv", log(0..100, TIGHT)),
    ];
    let names = ["good", "empty", "columns", "cells", "twice", "folder", "gone", "<script>alert(1)", "bytes"];
    let folder = with_logs(&files, &names);
    std::fs::write(folder.path().join("logs/bytes.csv"), [0x89, b'P', b'N', b'G', 0, 255]).unwrap();
    let outcome = fleet(folder.path(), &[]);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    let rows = table(folder.path(), "summary.csv");
    assert_eq!(rows.len(), names.len() + 1);
    let errors = table(folder.path(), "errors.csv");
    for (cylinder, file, line, reason) in [
        ("bytes", "logs/bytes.csv", "", "a picture"),
        ("cells", "logs/cells.csv", "3", "number of cells is 6"),
        ("columns", "logs/columns.csv", "1", "no column of time"),
        ("empty", "logs/empty.csv", "", "no header"),
        ("folder", "logs/folder.csv", "", "is a folder"),
        ("gone", "fleet.csv", "8", "has no log in logs"),
        ("stranger", "logs/stranger.csv", "", "is not in fleet.csv"),
        ("twice", "logs/twice.csv", "", "has another log"),
    ] {
        let found = errors.iter().find(|row| row["cylinder"] == cylinder && row["file"] == file);
        let found = found.unwrap_or_else(|| panic!("{cylinder} is missing in {errors:?}"));
        assert!(
            found["reason"].contains(reason) && found["line"] == line && !found["remedy"].is_empty(),
            "{found:?}"
        );
    }
    let page = std::fs::read_to_string(folder.path().join("out/page.html")).unwrap();
    assert!(
        !page.contains("<script>alert")
            && page.contains("&lt;script&gt;alert")
            && page.contains("\\u003cscript>alert")
    );
    for outside in ["src=", "@import", "url(", "<link", "href=\"http", "fetch(", "NaN"] {
        assert!(!page.contains(outside), "{outside}");
    }
    std::fs::remove_file(folder.path().join("logs/good.csv")).unwrap();
}

#[cfg(unix)]
#[test]
fn a_log_that_may_not_be_read_is_told() {
    use std::os::unix::fs::PermissionsExt;
    let folder = with_logs(&[("A.csv", log(0..100, TIGHT)), ("B.csv", log(0..100, TIGHT))], &["A", "B"]);
    let path = folder.path().join("logs/B.csv");
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o000)).unwrap();
    if std::fs::read(&path).is_ok() {
        eprintln!("skipped: this user may read everything");
        return;
    }
    assert_eq!(fleet(folder.path(), &[]).code, Some(3));
    assert!(table(folder.path(), "errors.csv")[0]["reason"].contains("cannot be read"));
}

#[test]
fn folders_named_after_cylinders_and_a_column_of_cylinders_are_the_logs_that_they_say() {
    let lines: Vec<String> = (0..300).map(|minute| row(minute, TIGHT)).collect();
    let mut column_log = format!("Cylinder,{COLUMNS}");
    for line in &lines {
        column_log.push_str(&format!("C 1,{line}C2,{line}"));
    }
    let files = [
        ("cylinder=A%2F1/day=1/a.csv", COLUMNS.to_owned() + &lines[..200].concat()),
        ("cylinder=A%2F1/day=2/a.csv", COLUMNS.to_owned() + &lines[200..].concat()),
        ("site.csv", column_log),
        ("P.csv", log(0..300, TIGHT)),
    ];
    let folder = with_logs(&files, &["A/1", "C 1", "C2", "P"]);
    let outcome = fleet(folder.path(), &[]);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    let rows = table(folder.path(), "summary.csv");
    assert_eq!(column(&rows, "rows"), ["300", "300", "300", "300"]);
    assert_eq!(column(&rows, "first_s"), ["0", "0", "0", "0"]);
    assert_eq!(column(&rows, "last_s"), ["17940", "17940", "17940", "17940"]);
    let p15 = column(&rows, "p15_bar");
    assert!(p15.iter().all(|one| *one == p15[0]), "{p15:?}");
    assert!(table(folder.path(), "errors.csv").is_empty());
    let cautions = column(&rows, "cautions");
    assert!(cautions.iter().all(|count| count == "0"), "{cautions:?}");
}

#[test]
fn one_vessel_for_all_and_the_exit_codes() {
    let folder = with_logs(&[("A.csv", log(0..1500, TIGHT))], &["A"]);
    let alike = |output: &str, more: &[&str]| {
        let options = ["fleet", "logs", "--vessel", "nitrogen-20l", "--settled", "-o", output];
        run(folder.path(), &[&options[..], FORMAT, more].concat())
    };
    let tight = alike("tight", &[]);
    assert_eq!(tight.code, Some(0), "{}", tight.stderr);
    std::fs::write(folder.path().join("logs/B.csv"), "").unwrap();
    assert_eq!(alike("one unread", &[]).code, Some(3));
    std::fs::remove_file(folder.path().join("logs/A.csv")).unwrap();
    let none = alike("none", &[]);
    assert_eq!(none.code, Some(2));
    assert!(none.stderr.contains("none of the 1 cylinders could be read"), "{}", none.stderr);
    for (arguments, words) in [
        (&["fleet", "logs", "-o", "out"][..], &["--vessels"][..]),
        (&["fleet", "nowhere", "--vessel", "nitrogen-20l", "-o", "out"], &["nowhere cannot be read"]),
        (
            &["fleet", "fleet.csv", "--vessel", "nitrogen-20l", "-o", "out"],
            &["fleet.csv is a file", "monitor"],
        ),
        (&["fleet", "logs", "--vessel", "nitrogen-21", "-o", "out"], &["nitrogen-21", "nearest"]),
        (&["fleet", "logs", "--vessel", "nitrogen-20l", "-o", "fleet.csv"], &["fleet.csv is a file"]),
        (
            &["fleet", "logs", "--vessel", "nitrogen-20l", "-o", "out", "--threads", "0"],
            &["--threads 0", "at least 1"],
        ),
        (&["fleet", "logs", "--vessel", "-", "-o", "out"], &["--vessel"]),
    ] {
        refused(folder.path(), arguments, words);
    }
}

#[cfg(unix)]
#[test]
fn a_signal_ends_a_run_cleanly_and_the_same_command_does_the_rest() {
    let (folder, names) = alike("S", 40, 400);
    let arguments = ["fleet", "logs", "--vessels", "fleet.csv", "-o", "out", "--format", "csv"];
    let mut command = program(folder.path(), &arguments);
    let child = command.stderr(std::process::Stdio::piped()).spawn().unwrap();
    let records = folder.path().join("out/records");
    let begun = || std::fs::read_dir(&records).is_ok_and(|entries| entries.count() > 0);
    while !begun() {
        std::thread::sleep(Duration::from_millis(5));
    }
    let interrupted = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(interrupted.is_ok_and(|status| status.success()));
    let outcome = Outcome::from(child.wait_with_output().unwrap());
    assert_eq!(outcome.code, Some(130), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("the same command does the rest"), "{}", outcome.stderr);
    assert!(!folder.path().join("out/summary.csv").exists());
    assert_eq!(fleet(folder.path(), &[]).code, Some(3));
    assert_eq!(table(folder.path(), "summary.csv").len(), names.len());
}
