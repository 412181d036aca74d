//! A monitor that is stopped goes on as if it had not been, or is refused, never silently.
use super::*;
use crate::support::{files, refusal, run};
use std::path::PathBuf;
use tempfile::{TempDir, tempdir};

const STATE: &[&str] = &["--state", "c.state"];

/// Rows, one run after the other, each going on from the last.
fn pieces(folder: &Path, cuts: &[u32], leak_from: u32, options: &[&str]) -> (Vec<String>, Outcome) {
    let mut lines = Vec::new();
    let mut last = None;
    for pair in cuts.windows(2) {
        let outcome = monitor(folder, &log(pair[0]..pair[1], leak_from), &[STATE, options].concat());
        assert_ne!(outcome.code, Some(2), "{}", outcome.stderr);
        lines.extend(data(&outcome.stdout).into_iter().map(str::to_owned));
        last = Some(outcome);
    }
    (lines, last.unwrap())
}

#[test]
fn runs_that_go_on_from_each_other_write_the_rows_of_one_run() {
    let folder = tempdir().unwrap();
    let (leak_from, end) = (30 * 60, 38 * 60);
    let whole = monitor(folder.path(), &log(0..end, leak_from), &["--events", "whole.jsonl"]);
    let cuts = [0, 1, 700, LEARNT + 3, leak_from + 90, end];
    let (lines, last) = pieces(folder.path(), &cuts, leak_from, &["--events", "pieces.jsonl"]);
    assert_eq!(lines, data(&whole.stdout));
    assert_eq!((whole.code, last.code), (Some(1), Some(1)), "{}", last.stderr);
    assert_eq!(events(folder.path(), "pieces.jsonl"), events(folder.path(), "whole.jsonl"));
    // The summaries differ in nothing but the rows that they count.
    let said = |outcome: &Outcome| {
        let lines = outcome.stderr.lines().filter(|line| !line.starts_with("log "));
        lines.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(said(&last), said(&whole));
}

#[test]
fn rows_that_wait_for_late_ones_wait_in_the_state() {
    let folder = tempdir().unwrap();
    let lateness = ["--lateness-min", "5"];
    let whole = monitor(folder.path(), &log(0..300, TIGHT), &lateness);
    let (lines, last) = pieces(folder.path(), &[0, 2, 100, 300], TIGHT, &lateness);
    assert_eq!(lines[..], data(&whole.stdout)[..lines.len()]);
    assert!(lines.len() >= 290 && lines.len() < 300);
    assert!(last.stderr.contains("wait for late ones"), "{}", last.stderr);
    // Nothing at all has come out: nothing can be told.
    let other = tempdir().unwrap();
    let (lines, last) = pieces(other.path(), &[0, 2], TIGHT, &lateness);
    assert_eq!((lines.len(), last.code), (0, Some(3)));
    assert!(last.stderr.contains("wait in the state"), "{}", last.stderr);
}

/// Monitors a file `log.csv` with a state.
fn monitor_file(folder: &Path, text: &str, options: &[&str]) -> Outcome {
    std::fs::write(folder.join("log.csv"), text).unwrap();
    run(folder, &[&["monitor", "nitrogen-20l", "log.csv", "--settled"], STATE, options].concat())
}

#[test]
fn a_log_that_grows_is_read_from_where_it_was_left() {
    let folder = tempdir().unwrap();
    let first = monitor_file(folder.path(), &log(0..200, TIGHT), &[]);
    let second = monitor_file(folder.path(), &log(0..320, TIGHT), &[]);
    assert_eq!((data(&first.stdout).len(), data(&second.stdout).len()), (200, 120));
    assert!(second.stderr.contains("200 known to the state"), "{}", second.stderr);
    // Nothing new: what was said last still stands.
    let third = monitor_file(folder.path(), &log(0..320, TIGHT), &["--next-service-d", "7"]);
    assert_eq!((data(&third.stdout).len(), third.code), (0, Some(3)), "{}", third.stderr);
    assert!(third.stderr.contains("unknown: still learning"), "{}", third.stderr);
    assert_eq!(cautions(&third), ["nothing new: the state has seen all rows up to t = 5.317 h"]);
}

#[test]
fn a_pipe_that_begins_again_is_known_and_one_whose_clock_is_set_back_is_not() {
    let folder = tempdir().unwrap();
    monitor(folder.path(), &log(0..200, TIGHT), STATE);
    let again = monitor(folder.path(), &log(0..230, TIGHT), STATE);
    assert_eq!(data(&again.stdout).len(), 30);
    assert!(again.stderr.contains("200 known to the state"), "{}", again.stderr);
    // The same cylinder goes on, by a clock that has fallen back by more than an hour.
    let mut text = String::from(HEADER);
    for minute in 230..260 {
        let line = row(minute, TIGHT);
        text.push_str(&format!("{},{}", 60 * (minute - 100), line.split_once(',').unwrap().1));
    }
    let back = monitor(folder.path(), &text, &[STATE, &["--events", "e.jsonl"]].concat());
    assert!(back.stderr.contains("the clock jumped once"), "{}", back.stderr);
    assert_eq!(data(&back.stdout).len(), 30);
}

#[test]
fn dates_go_on_from_the_first_log_and_dates_and_seconds_do_not_mix() {
    let folder = tempdir().unwrap();
    let dated = |from: u32, to: u32| {
        let mut text = String::from("time,shoulder_degc,pressure_bar\n");
        for minute in from..to {
            text.push_str(&format!(
                "2026-03-29T{:02}:{:02}:00.5Z,15.{},200.0{}\n",
                minute / 60,
                minute % 60,
                minute % 3,
                minute % 4
            ));
        }
        text
    };
    let whole = monitor(folder.path(), &dated(0, 200), &[]);
    let mut lines = Vec::new();
    for (from, to) in [(0, 90), (90, 200)] {
        let outcome = monitor(folder.path(), &dated(from, to), STATE);
        assert!(outcome.stdout.contains("# time_s = 0 is 2026-03-29T00:00:00.5Z"), "{}", outcome.stderr);
        lines.extend(data(&outcome.stdout).into_iter().map(str::to_owned));
    }
    assert_eq!(lines, data(&whole.stdout));
    let seconds = "time_s,shoulder_degc,pressure_bar\n99999,15,200\n";
    refusal(
        monitor(folder.path(), seconds, STATE),
        &["its log has dates", "times without dates", "--cold-start"],
    );
}

/// A folder with a state of two hours.
fn with_state() -> (TempDir, PathBuf) {
    let folder = tempdir().unwrap();
    let outcome = monitor(folder.path(), &log(0..120, TIGHT), STATE);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    let state = folder.path().join("c.state");
    (folder, state)
}

#[test]
fn a_state_that_is_cut_short_damaged_or_of_another_kind_is_refused_with_the_way_out() {
    let (folder, path) = with_state();
    let whole = std::fs::read(&path).unwrap();
    let refused = |bytes: &[u8], words: &[&str]| {
        std::fs::write(&path, bytes).unwrap();
        let outcome = monitor(folder.path(), &log(120..130, TIGHT), STATE);
        let words: Vec<&str> =
            words.iter().chain(&["cannot continue from ", "c.state: ", "--cold-start"]).copied().collect();
        refusal(outcome, &words);
        // What was there stays for whoever wants to look at it.
        assert_eq!(std::fs::read(&path).unwrap(), bytes);
    };
    refused(&whole[..whole.len() / 2], &["cut short"]);
    let mut damaged = whole.clone();
    damaged[whole.len() / 2] ^= 4;
    refused(&damaged, &["damaged"]);
    refused(log(0..3, TIGHT).as_bytes(), &["no state of a monitor"]);
    refused(b"", &["no state of a monitor"]);
    let line_end = whole.iter().position(|&byte| byte == b'\n').unwrap();
    let newer = String::from_utf8(whole[..line_end].to_vec()).unwrap().replacen(" 3 ", " 4 ", 1);
    refused(&[newer.as_bytes(), &whole[line_end..]].concat(), &["version 4, this program reads 3"]);
    // Declared, it begins anew, says so, and leaves a whole state.
    let cold = [STATE, &["--cold-start", "--events", "e.jsonl"]].concat();
    let outcome = monitor(folder.path(), &log(120..240, TIGHT), &cold);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    let [caution] = cautions(&outcome)[..] else { panic!("{}", outcome.stderr) };
    assert!(caution.starts_with("cold start instead of continuing from "), "{caution}");
    assert!(caution.ends_with("c.state: it has version 4, this program reads 3"), "{caution}");
    let events = events(folder.path(), "e.jsonl");
    assert_eq!(events[0]["event"], "cold-start");
    assert!(events[0]["reason"].as_str().unwrap().contains("version 4"));
    assert_eq!(monitor(folder.path(), &log(240..250, TIGHT), STATE).code, Some(3));
}

#[test]
fn a_state_of_another_vessel_other_sensors_or_settings_is_refused_by_what_differs() {
    let (folder, path) = with_state();
    let before = std::fs::read(&path).unwrap();
    let next = log(120..130, TIGHT);
    let refused = |options: &[&str], words: &[&str]| {
        refusal(monitor(folder.path(), &next, &[STATE, options].concat()), words);
    };
    refused(&["--lateness-s", "60"], &["a lateness of 0 s", "60 s"]);
    refused(&["--fill-mass-kg", "4"], &["the fill --settled", "--fill-mass-kg 4"]);
    let vessel = ["monitor", "nitrogen-20l-paper", "-", "--settled", "--state", "c.state"];
    refusal(run_with_stdin(folder.path(), &vessel, &next), &["made with vessel", "20 L, steel", "rigid"]);
    let fewer = "time_s,shoulder_degc,pressure_bar\n7200,15,200\n";
    refusal(monitor(folder.path(), fewer, STATE), &["made with sensors", "shoulder, valve"]);
    assert_eq!(std::fs::read(&path).unwrap(), before);
    // A fill that is not repeated is the one of the state.
    let silent = ["monitor", "nitrogen-20l", "-", "--state", "c.state"];
    assert_eq!(run_with_stdin(folder.path(), &silent, &next).code, Some(3));
    // When the next service is does not belong to it.
    let next = log(130..140, TIGHT);
    let outcome = monitor(folder.path(), &next, &[STATE, &["--next-service-d", "3"]].concat());
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
}

#[test]
fn a_state_outlives_other_limits_and_another_order_of_the_columns() {
    let (folder, _) = with_state();
    let others = ["--limit-bar", "150", "--coldest-degc", "-40", "--false-alarm-years", "100"];
    let turned = |line: &str| line.trim().split(',').rev().collect::<Vec<_>>().join(",") + "\n";
    let next: String = log(120..130, TIGHT).lines().map(turned).collect();
    let on = monitor(folder.path(), &next, &[STATE, &others].concat());
    assert_eq!(on.code, Some(3), "{}", on.stderr);
    // As if it had been so from the beginning.
    let whole = monitor(tempdir().unwrap().path(), &log(0..130, TIGHT), &others);
    let whole = data(&whole.stdout);
    assert_eq!(data(&on.stdout), whole[whole.len() - 10..]);
}

#[test]
fn what_was_done_before_a_bad_row_stays_with_a_state_and_goes_on_from_there() {
    let folder = tempdir().unwrap();
    let whole = monitor(folder.path(), &log(0..300, TIGHT), &[]);
    let bad = log(0..150, TIGHT) + "9000,15\n" + &row(151, TIGHT);
    let outcome = monitor(folder.path(), &bad, &[STATE, &["-o", "first.csv"]].concat());
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("stdin:152"), "{}", outcome.stderr);
    let first = std::fs::read_to_string(folder.path().join("first.csv")).unwrap();
    let known = data(&first).len();
    // The reader holds the last row back for another of its time.
    assert!((149..=150).contains(&known), "{known}");
    let second = monitor(folder.path(), &log(known as u32..300, TIGHT), STATE);
    let all: Vec<&str> = data(&first).into_iter().chain(data(&second.stdout)).collect();
    assert_eq!(all, data(&whole.stdout));
    // Without a state nothing is left behind.
    let other = tempdir().unwrap();
    assert_eq!(monitor(other.path(), &bad, &["-o", "first.csv"]).code, Some(2));
    assert!(files(other.path()).is_empty());
}

#[test]
fn a_state_is_saved_during_the_run_and_a_killed_run_goes_on_from_it() {
    use std::io::{Read, Write};
    use std::process::Stdio;
    let folder = tempdir().unwrap();
    let arguments =
        ["monitor", "nitrogen-20l", "-", "--settled", "--state", "c.state", "--save-every-s", "1e-9", "-q"];
    let mut command = crate::support::program(folder.path(), &arguments);
    command.stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    input.write_all(log(0..200, TIGHT).as_bytes()).unwrap();
    input.flush().unwrap();
    // All rows but the one that the reader holds back come out, each after the state of the one before was saved.
    let mut text = String::new();
    let mut output = child.stdout.take().unwrap();
    let mut piece = [0; 4096];
    while !text.contains("\n11880,") || !text.ends_with('\n') {
        let count = output.read(&mut piece).unwrap();
        text.push_str(std::str::from_utf8(&piece[..count]).unwrap());
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(files(folder.path()).iter().filter(|name| *name == "c.state").count(), 1);
    let whole = monitor(folder.path(), &log(0..260, TIGHT), &[]);
    // The last save may lie a row before the last row that came out: that row comes out once more.
    let rest = monitor_file(folder.path(), &log(0..260, TIGHT), &[]);
    let rest = data(&rest.stdout);
    assert!(rest.len() >= 60 && rest.len() <= 63, "{}", rest.len());
    assert_eq!(rest[..], data(&whole.stdout)[260 - rest.len()..]);
}

#[test]
fn alarms_are_acknowledged_with_a_comment_and_reset_once_they_are_over() {
    let folder = tempdir().unwrap();
    let (leak_from, end) = (30 * 60, 38 * 60);
    let (_, last) = pieces(folder.path(), &[0, end], leak_from, &[]);
    assert!(last.stderr.contains("leak: active since"), "{}", last.stderr);
    assert!(last.stderr.contains("not acknowledged"), "{}", last.stderr);
    // The next service is in an hour: 30 bar are lost in a day and more.
    let act = ["--acknowledge", "fitter is coming", "--events", "e.jsonl", "--next-service-h", "1"];
    let next = monitor(folder.path(), &log(end..end + 10, leak_from), &[STATE, &act].concat());
    assert_eq!(next.code, Some(1), "{}", next.stderr);
    assert_eq!(cells(&next.stdout, "reaction")[0], "next-interval");
    let standing = next.stderr.lines().find(|line| line.contains("leak: active")).unwrap();
    assert!(standing.ends_with(", acknowledged"), "{standing}");
    let changes: Vec<serde_json::Value> =
        events(folder.path(), "e.jsonl").into_iter().filter(|event| event["alarm"] == "leak").collect();
    let words: Vec<&str> = changes.iter().map(|event| event["change"].as_str().unwrap()).collect();
    assert_eq!(words, ["acknowledged", "confirmed"]);
    assert_eq!(changes[1]["Comment"], "fitter is coming");
    assert_eq!((&changes[1]["AckedState"], &changes[1]["LatchedState"]), (&true.into(), &true.into()));
    for (options, words) in [
        (&["--acknowledge", "x"][..], "--state"),
        (&["--state", "none.state", "--acknowledge", "x"], "none.state is not there"),
        (&["--state", "c.state", "--cold-start", "--acknowledge", "x"], "cannot be used with"),
    ] {
        refusal(monitor(folder.path(), &log(0..3, TIGHT), options), &[words]);
    }
}

#[test]
fn a_vessel_of_any_pressure_is_watched_without_a_word_about_its_transmitter_and_goes_on_from_its_state() {
    let folder = tempdir().unwrap();
    for (bar, fill) in [
        (310.0, &[][..]),
        (310.0, &["--fill-pressure-bar", "310"][..]),
        (7.0, &["--fill-pressure-bar", "7"][..]),
    ] {
        for (name, from) in [("first.csv", 0), ("second.csv", 120)] {
            let row = |minute: u32| {
                let k = f64::from(minute % 7);
                format!(
                    "{},{:.2},{:.2},{:.5}\n",
                    60 * minute,
                    15.0 + 0.01 * k,
                    15.02 - 0.01 * k,
                    bar * (1.0 + 1e-5 * k)
                )
            };
            let rows: String = (from..from + 120).map(row).collect();
            let text = format!("time_s,shoulder_degc,valve_degc,pressure_bar\n{rows}");
            std::fs::write(folder.path().join(name), text).unwrap();
            let common =
                ["monitor", "nitrogen-20l", name, "--state", "s.state", "-o", "rows.csv", "--limit-bar", "5"];
            let outcome = run(folder.path(), &[&common, fill].concat());
            assert_eq!(outcome.code, Some(3), "{bar} bar: {}", outcome.stderr);
            assert!(outcome.stderr.contains("sensors            all good"), "{bar} bar: {}", outcome.stderr);
            if from > 0 {
                assert!(!outcome.stderr.contains("cold start"), "{}", outcome.stderr);
            }
        }
        std::fs::remove_file(folder.path().join("s.state")).unwrap();
    }
}
