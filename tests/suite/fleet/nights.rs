//! A fleet night after night: logs that have grown go on from the states, and what comes out is what one run over all would give.
use super::{
    COLUMNS, TIGHT, column, content, fleet, kill_again_and_again, log, row, table, vessels, with_logs,
};
use std::collections::BTreeMap;
use std::path::Path;
use tempfile::TempDir;

const NAMES: [&str; 7] = ["A", "B", "C1", "C2", "D", "E", "F"];

/// A row of every 20 s, of which three become one.
fn often(until: u32) -> String {
    let third = |k: u32| row(k, TIGHT).replacen(&(60 * k).to_string(), &(20 * k).to_string(), 1);
    COLUMNS.to_owned() + &(0..until).map(third).collect::<String>()
}

/// A log with dates of a zone, and a cell that is no number on each of two days.
fn dated(minutes: std::ops::Range<u32>) -> String {
    let row = |minute: u32| {
        let cells = row(minute, TIGHT);
        let cells = if minute % 700 == 650 { cells.replacen(",15.", ",bad", 1) } else { cells };
        let (_, cells) = cells.split_once(',').unwrap();
        let (day, hour, minute) = (1 + minute / 1440, minute / 60 % 24, minute % 60);
        format!("2026-10-{day:02}T{hour:02}:{minute:02}:00+02:00,{cells}")
    };
    COLUMNS.replacen("time_s", "time", 1) + &minutes.map(row).collect::<String>()
}

fn together(names: [&str; 2], minutes: std::ops::Range<u32>) -> String {
    let rows = |minute| names.map(|name| format!("{name},{}", row(minute, TIGHT))).concat();
    format!("cylinder,{COLUMNS}") + &minutes.map(rows).collect::<String>()
}

/// The logs of a night: rows at the end of a file, files in a folder, logs of several cylinders, dates, many rows a minute.
fn logs(night: u32) -> Vec<(&'static str, String)> {
    let until = [1100, 1800][night as usize - 1];
    let mut logs = vec![
        // It leaks in the first night, and more in the second.
        ("A.csv", log(0..until + 700, 1600)),
        ("cylinder=B/day=1/a.csv", log(0..1100, TIGHT)),
        ("site-1.csv", together(["C1", "C2"], 0..1100)),
        ("D.csv", dated(0..until)),
        // The night ends in the middle of a minute.
        ("E.csv", often(until - 1)),
        ("F.csv", log(0..1000, TIGHT)),
        ("G/site.csv", together(["G1", "G2"], 0..until)),
    ];
    if night == 2 {
        logs.push(("cylinder=B/day=2/a.csv", log(1100..1800, TIGHT)));
        logs.push(("site-2.csv", together(["C1", "C2"], 1100..1800)));
    }
    logs
}

fn names() -> Vec<&'static str> {
    [&NAMES[..], &["G1", "G2"]].concat()
}

fn lay(folder: &Path, logs: &[(&str, String)]) {
    for (name, text) in logs {
        let path = folder.join("logs").join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        // What has not changed keeps its time.
        if std::fs::read_to_string(&path).ok().as_ref() != Some(text) {
            std::fs::write(path, text).unwrap();
        }
    }
}

/// What the folder has, but for the heads of the rows, which name the logs of the first night.
fn found(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = content(&folder.join("out"));
    for (_, bytes) in found.iter_mut().filter(|(name, _)| name.starts_with("rows/")) {
        let text = String::from_utf8(std::mem::take(bytes)).unwrap();
        *bytes = text
            .lines()
            .filter(|line| !line.starts_with("# input"))
            .collect::<Vec<_>>()
            .join("\n")
            .into_bytes();
    }
    found
}

fn of_one_run(folder: &TempDir) -> BTreeMap<String, Vec<u8>> {
    std::fs::remove_dir_all(folder.path().join("out")).unwrap();
    let outcome = fleet(folder.path(), &["--rows"]);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    found(folder.path())
}

fn assert_same(nights: &BTreeMap<String, Vec<u8>>, whole: &BTreeMap<String, Vec<u8>>) {
    assert_eq!(nights.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>());
    let other: Vec<&String> =
        whole.iter().filter(|(name, bytes)| nights[*name] != **bytes).map(|(name, _)| name).collect();
    assert!(other.is_empty(), "{other:?}");
}

#[test]
fn two_nights_leave_the_bytes_of_one_run_over_both_with_one_thread_and_with_two() {
    for threads in ["1", "2"] {
        let folder = with_logs(&logs(1), &names());
        let options = ["--rows", "--threads", threads];
        assert_eq!(fleet(folder.path(), &options).code, Some(1));
        let first = table(folder.path(), "events.csv").len();
        lay(folder.path(), &logs(2));
        let outcome = fleet(folder.path(), &options);
        assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
        let nights = found(folder.path());
        let events = table(folder.path(), "events.csv").len();
        assert!(first > 0 && events > first, "{first} {events}");
        let whole = of_one_run(&folder);
        assert!(whole.len() > 30);
        assert_same(&nights, &whole);
    }
}

#[test]
fn a_second_night_that_is_killed_again_and_again_leaves_the_same_bytes() {
    let folder = with_logs(&logs(1), &names());
    assert_eq!(fleet(folder.path(), &["--rows"]).code, Some(1));
    lay(folder.path(), &logs(2));
    kill_again_and_again(folder.path(), (0..10).map(|k| 15 + 41 * (k * k % 11)));
    assert_eq!(fleet(folder.path(), &["--rows"]).code, Some(1));
    let nights = found(folder.path());
    assert_same(&nights, &of_one_run(&folder));
}

#[test]
fn a_second_night_reads_what_is_new_and_a_log_that_has_changed_before_is_done_anew() {
    let folder = with_logs(&[("A.csv", log(0..700, TIGHT)), ("B.csv", log(0..700, TIGHT))], &["A", "B"]);
    assert_eq!(fleet(folder.path(), &["--rows"]).code, Some(3));
    let beginning = |name: &str| {
        let text = std::fs::read_to_string(folder.path().join(format!("out/rows/{name}.csv"))).unwrap();
        text.lines().find(|line| line.starts_with("# input: logs")).unwrap().to_owned()
    };
    let before = [beginning("A"), beginning("B")];
    lay(folder.path(), &[("A.csv", log(0..900, TIGHT)), ("B.csv", log(0..900, 10))]);
    assert_eq!(fleet(folder.path(), &["--rows"]).code, Some(1));
    // The rows of A are added to those that are there, those of B are written again.
    assert_eq!(beginning("A"), before[0]);
    assert_ne!(beginning("B"), before[1]);
    assert_eq!(column(&table(folder.path(), "summary.csv"), "rows"), ["900", "900"]);
}

#[test]
fn a_folder_that_holds_what_is_new_alone_goes_on_when_it_is_told_to() {
    let days = |at: &[std::ops::Range<u32>]| -> Vec<(String, String)> {
        let day = |day: &std::ops::Range<u32>| {
            let text = log(day.clone(), 1600);
            (format!("cylinder=A/{:04}.csv", day.start), text)
        };
        at.iter().map(day).collect()
    };
    let folder = with_logs(&[("B.csv", log(0..400, TIGHT))], &["A", "B"]);
    for day in [0..1100, 1100..1800] {
        let logs = folder.path().join("logs");
        std::fs::remove_dir_all(&logs).unwrap();
        let logs = days(std::slice::from_ref(&day));
        lay(
            folder.path(),
            &logs.iter().map(|(name, text)| (name.as_str(), text.clone())).collect::<Vec<_>>(),
        );
        if day.start == 0 {
            lay(folder.path(), &[("B.csv", log(0..400, TIGHT))]);
        }
        let outcome = fleet(folder.path(), &["--go-on"]);
        assert!(outcome.code.is_some_and(|code| code == 3 || code == 1), "{}", outcome.stderr);
    }
    let nights = content(&folder.path().join("out"));
    let rows = table(folder.path(), "summary.csv");
    assert_eq!(
        (column(&rows, "cylinder"), column(&rows, "rows")),
        (vec!["A".into(), "B".into()], vec!["1800".into(), "400".into()])
    );
    assert_eq!(column(&rows, "outcome"), ["loss", "unknown"]);
    // A cylinder without a log tonight stays as it was, and that is told.
    assert!(table(folder.path(), "errors.csv")[0]["reason"].contains("B has no log"));
    // One run over both days has the same state and the same events.
    lay(
        folder.path(),
        &days(&[0..1100, 1100..1800])
            .iter()
            .map(|(name, text)| (name.as_str(), text.clone()))
            .collect::<Vec<_>>(),
    );
    let events = |folder: &Path| -> Vec<_> {
        table(folder, "events.csv").into_iter().filter(|event| event["cylinder"] == "A").collect()
    };
    let of_nights = events(folder.path());
    std::fs::remove_dir_all(folder.path().join("out")).unwrap();
    assert_eq!(fleet(folder.path(), &[]).code, Some(1));
    let whole = content(&folder.path().join("out"));
    assert!(nights["states/A.state"] == whole["states/A.state"]);
    assert!(!of_nights.is_empty() && of_nights == events(folder.path()));
    // Without the option all is done anew, from what is there.
    std::fs::remove_file(folder.path().join("logs/cylinder=A/0000.csv")).unwrap();
    assert_eq!(fleet(folder.path(), &["--go-on"]).code, Some(1));
    assert_eq!(column(&table(folder.path(), "summary.csv"), "rows")[0], "1800");
    assert!(fleet(folder.path(), &[]).code.is_some_and(|code| code != 2));
    assert_eq!(column(&table(folder.path(), "summary.csv"), "rows")[0], "700");
}

#[test]
fn a_bad_night_costs_nothing_of_the_nights_before() {
    let folder = with_logs(&[("A.csv", log(0..700, TIGHT)), ("B.csv", log(0..90, TIGHT))], &["A", "B"]);
    assert_eq!(fleet(folder.path(), &["--rows"]).code, Some(3));
    let state = || std::fs::read(folder.path().join("out/states/A.state")).unwrap();
    let before = (state(), table(folder.path(), "events.csv").len());
    lay(folder.path(), &[("A.csv", log(0..800, TIGHT) + "48000,15,15,200,7,7\n")]);
    assert_eq!(fleet(folder.path(), &["--rows"]).code, Some(3));
    let rows = table(folder.path(), "summary.csv");
    assert_eq!(column(&rows, "light"), ["unknown", "unknown"]);
    assert_eq!(column(&table(folder.path(), "errors.csv"), "line"), ["802"]);
    assert_eq!((state(), table(folder.path(), "events.csv").len()), before);
    lay(folder.path(), &[("A.csv", log(0..900, TIGHT))]);
    assert_eq!(fleet(folder.path(), &["--rows"]).code, Some(3));
    let nights = found(folder.path());
    std::fs::remove_dir_all(folder.path().join("out")).unwrap();
    assert_eq!(fleet(folder.path(), &["--rows"]).code, Some(3));
    assert_same(&nights, &found(folder.path()));
}

#[test]
fn a_state_that_is_not_the_one_of_the_record_is_not_gone_on_with() {
    let folder = with_logs(&[("A.csv", log(0..400, TIGHT))], &["A"]);
    assert_eq!(fleet(folder.path(), &[]).code, Some(3));
    std::fs::write(folder.path().join("out/states/A.state"), "another").unwrap();
    lay(folder.path(), &[("A.csv", log(0..500, TIGHT))]);
    assert_eq!(fleet(folder.path(), &["--go-on"]).code, Some(2));
    let errors = table(folder.path(), "errors.csv");
    assert!(
        errors[0]["file"].ends_with("A.state") && errors[0]["remedy"].contains("put that back"),
        "{errors:?}"
    );
    // Whose logs are all there needs no state.
    assert_eq!(fleet(folder.path(), &[]).code, Some(3));
    assert_eq!(column(&table(folder.path(), "summary.csv"), "rows"), ["500"]);
    // Another fill is another cylinder.
    std::fs::write(folder.path().join("fleet.csv"), vessels(&["A"]).replace(",200,", ",190,")).unwrap();
    lay(folder.path(), &[("A.csv", log(0..600, TIGHT))]);
    assert_eq!(fleet(folder.path(), &["--go-on"]).code, Some(2));
    assert!(table(folder.path(), "errors.csv")[0]["remedy"].contains("choose another output folder"));
}
