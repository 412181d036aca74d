//! What is said of a cylinder, and with which exit code.
use super::*;
use crate::support::{column, program, run};
use std::io::{BufRead, BufReader, Write};
use std::process::Stdio;
use tempfile::tempdir;

/// Eight hours of 1 bar/h after a day and a half.
fn leaking() -> String {
    log(0..44 * 60, 36 * 60)
}

#[test]
fn a_leak_is_exit_code_1_with_its_rate_onset_loss_and_what_to_do() {
    let folder = tempdir().unwrap();
    let outcome = monitor(folder.path(), &leaking(), &["--events", "e.jsonl"]);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    let last = |name: &str| cells(&outcome.stdout, name).last().unwrap().parse::<f64>().unwrap();
    assert_eq!(cells(&outcome.stdout, "verdict").last().unwrap(), "leak");
    // 1 bar/h of a cylinder that holds 4.477 kg at 200 bar, both from CoolProp 8.0: 19.4 g/h.
    let (low, high) = (last("leak_low_g_h"), last("leak_high_g_h"));
    assert!(low < 19.4 && 19.4 < high && high - low < 8.0, "{low} to {high} g/h");
    assert!((last("leak_bar_h") - 1.0).abs() < 0.2, "{}", last("leak_bar_h"));
    assert!((last("onset_s") - 36.0 * 3600.0).abs() < 5400.0, "{}", last("onset_s"));
    assert!((last("lost_g") - 155.0).abs() < 40.0, "{}", last("lost_g"));
    assert!(last("leak_probability") > 0.95);
    assert_eq!(cells(&outcome.stdout, "reaction").last().unwrap(), "as-soon-as-possible");
    for words in [
        "verdict",
        "leak rate",
        "since",
        "lost since",
        "time to the limit",
        "maintenance as soon as possible",
    ] {
        assert!(outcome.stderr.contains(words), "`{words}` is missing in {}", outcome.stderr);
    }
    let events = events(folder.path(), "e.jsonl");
    let found = events.iter().find(|event| event["event"] == "leak-found").unwrap();
    let rate: Vec<f64> = serde_json::from_value(found["rate_g_h"].clone()).unwrap();
    assert!(rate[1] < rate[0] && rate[0] < rate[2]);
    let alarm = events.iter().find(|event| event["alarm"] == "leak").unwrap();
    assert_eq!((&alarm["change"], &alarm["ActiveState"]), (&"active".into(), &true.into()));
}

#[test]
fn a_tight_cylinder_is_exit_code_0_and_one_that_is_not_known_yet_3() {
    let folder = tempdir().unwrap();
    let tight = monitor(folder.path(), &log(0..LEARNT + 120, TIGHT), &["-o", "rows.csv"]);
    assert_eq!(tight.code, Some(0), "{}", tight.stderr);
    assert!(tight.stderr.contains("verdict            tight"), "{}", tight.stderr);
    assert!(tight.stderr.contains("none found"), "{}", tight.stderr);
    let early = monitor(folder.path(), &log(0..120, TIGHT), &[]);
    assert_eq!(early.code, Some(3), "{}", early.stderr);
    assert!(early.stderr.contains("unknown: still learning the sensors"), "{}", early.stderr);
    assert!(cells(&early.stdout, "reason").iter().all(|reason| reason == "still learning the sensors"));
}

#[test]
fn a_cylinder_without_a_pressure_is_never_called_tight() {
    let folder = tempdir().unwrap();
    let mut text = log(0..LEARNT + 60, TIGHT);
    for minute in LEARNT + 60..LEARNT + 240 {
        text.push_str(&format!("{},15.{},15.{},\n", 60 * minute, minute % 7, minute % 5));
    }
    let outcome = monitor(folder.path(), &text, &["--events", "e.jsonl"]);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("unknown: no usable pressure"), "{}", outcome.stderr);
    let raised = |event: &serde_json::Value| event["alarm"] == "unknown" && event["change"] == "active";
    assert!(events(folder.path(), "e.jsonl").iter().any(raised));
}

#[test]
fn the_verdict_stands_on_stderr_event_by_event_with_the_dates_of_the_log() {
    let folder = tempdir().unwrap();
    let dated = leaking().replacen("time_s", "time", 1);
    let mut lines = dated.lines();
    let mut text = format!("{}\n", lines.next().unwrap());
    for line in lines {
        let (seconds, rest) = line.split_once(',').unwrap();
        let minutes: u32 = seconds.parse::<u32>().unwrap() / 60;
        let (day, hour, minute) = (1 + minutes / 1440, minutes / 60 % 24, minutes % 60);
        text.push_str(&format!("2026-01-{day:02}T{hour:02}:{minute:02}:00+01:00,{rest}\n"));
    }
    let outcome = monitor(folder.path(), &text, &["-o", "rows.csv"]);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    let found = outcome.stderr.lines().find(|line| line.contains("leak found")).unwrap();
    // The leak begins at noon of the second day.
    assert!(found.starts_with("2026-01-02T1") && found.contains("since 2026-01-02T1"), "{found}");
    let rows = std::fs::read_to_string(folder.path().join("rows.csv")).unwrap();
    assert!(rows.contains("# time_s = 0 is 2025-12-31T23:00:00Z"), "{rows:.300}");
    let seconds = monitor(folder.path(), &leaking(), &["-q"]).stdout;
    let without = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        [&cells[..1], &cells[2..]].concat().join(",")
    };
    assert_eq!(data(&rows).into_iter().map(without).collect::<Vec<_>>(), data(&seconds)[..]);
    assert!(data(&rows)[60].starts_with("3600,2026-01-01T01:00:00+01:00,"), "{}", data(&rows)[60]);
}

#[test]
fn after_a_jump_of_the_clock_rows_events_and_summary_have_one_time() {
    let folder = tempdir().unwrap();
    let (jump_at, back_s, leak_from, end) = (600, 7200, 30 * 60, 36 * 60);
    let shifted = |minute: u32| {
        let row = row(minute, leak_from);
        let (time_s, cells) = row.split_once(',').unwrap();
        let jump_s = if minute >= jump_at { back_s } else { 0 };
        format!("{},{cells}", time_s.parse::<u32>().unwrap() - jump_s)
    };
    let text: String = std::iter::once(HEADER.to_owned()).chain((0..end).map(shifted)).collect();
    let outcome = monitor(folder.path(), &text, &["--format", "json", "--events", "e.jsonl", "-q"]);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    let document: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    let times: Vec<f64> =
        document["data"].as_array().unwrap().iter().map(|row| row[0].as_f64().unwrap()).collect();
    assert_eq!(document["summary"]["time_s"].as_f64(), times.last().copied());
    let events = events(folder.path(), "e.jsonl");
    let leak = events.iter().find(|event| event["event"] == "leak-found").unwrap();
    let onset_s = leak["onset_s"].as_f64().unwrap();
    let truth_s = f64::from(60 * leak_from - back_s);
    assert!((onset_s - truth_s).abs() < 3600.0, "{onset_s} for {truth_s}");
    let jump = events.iter().position(|event| event["event"] == "clock-jump").unwrap();
    assert!(events[..jump].iter().all(|event| event["time_s"].as_f64().unwrap() < 36_000.0), "{events:?}");
    let after = events[jump..].iter().filter(|event| event["event"] == "verdict");
    for event in after {
        assert!(times.contains(&event["time_s"].as_f64().unwrap()), "{event}");
    }
}

#[test]
fn limits_and_times_come_from_options_in_any_unit() {
    let folder = tempdir().unwrap();
    let text = log(0..LEARNT + 60, TIGHT);
    let cold = |options: &[&str]| {
        let outcome = monitor(folder.path(), &text, &[options, &["-q"]].concat());
        *column(&outcome.stdout, "cold_pressure_bar").last().unwrap()
    };
    assert_eq!(cold(&["--coldest-degc", "-40"]), cold(&["--coldest-k", "233.15"]));
    // Of 200 bar at 15 °C, CoolProp 8.0: 160.1 bar at -25 °C, 145.0 at -40 °C; the wall gives way by 0.1 to 0.2 bar.
    assert!((cold(&[]) - 160.1).abs() < 0.7, "{}", cold(&[]));
    assert!((cold(&["--coldest-degc", "-40"]) - 145.0).abs() < 0.7);
    let low =
        monitor(folder.path(), &text, &["--limit-mpa", "19.8", "-o", "rows.csv", "--events", "e.jsonl"]);
    assert!(low.stderr.contains("limit of 198 bar"), "{}", low.stderr);
    let alarm = events(folder.path(), "e.jsonl");
    let alarm = alarm.iter().find(|event| event["alarm"] == "operational-limit").unwrap();
    // 200 bar are above 198 and within the warning of 5 bar.
    assert_eq!(alarm["LimitState"], "Low");
}

#[test]
fn late_rows_are_sorted_in_and_rows_that_come_twice_change_nothing() {
    let folder = tempdir().unwrap();
    let minutes: Vec<u32> = (0..LEARNT + 60).collect();
    let text = |order: &[u32]| {
        let rows: String = order.iter().map(|&minute| row(minute, TIGHT)).collect();
        HEADER.to_owned() + &rows
    };
    let mut shuffled = minutes.clone();
    for k in (5..shuffled.len() - 5).step_by(7) {
        shuffled.swap(k, k + 2);
    }
    shuffled.insert(400, 398);
    let lateness = ["--lateness-min", "5"];
    let whole = monitor(folder.path(), &text(&minutes), &lateness);
    let sorted = monitor(folder.path(), &text(&shuffled), &lateness);
    assert_eq!((whole.code, sorted.code), (Some(0), Some(0)), "{}", sorted.stderr);
    assert_eq!(data(&sorted.stdout), data(&whole.stdout));
    assert!(sorted.stderr.contains("1 came twice"), "{}", sorted.stderr);
    // Without it a late row is left out, and that is said.
    let strict = monitor(folder.path(), &text(&shuffled), &[]);
    assert!(strict.stderr.contains("came too late"), "{}", strict.stderr);
}

#[test]
fn rows_come_out_while_the_log_goes_on() {
    let folder = tempdir().unwrap();
    let mut command = program(folder.path(), &["monitor", "nitrogen-20l", "-", "-q"]);
    command.stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let mut output = BufReader::new(child.stdout.take().unwrap()).lines();
    input.write_all(HEADER.as_bytes()).unwrap();
    // The reader waits for the next row of a time, nothing else holds a row back.
    for minute in 0..4 {
        input.write_all(row(minute, TIGHT).as_bytes()).unwrap();
    }
    input.flush().unwrap();
    let mut next =
        || output.by_ref().map(Result::unwrap).find(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    assert!(next().unwrap().starts_with("0,") && next().unwrap().starts_with("60,"));
    assert!(next().unwrap().starts_with("120,"));
    drop(input);
    assert!(next().unwrap().starts_with("180,"));
    assert_eq!(child.wait().unwrap().code(), Some(3));
}

#[test]
fn a_simulated_log_of_a_leak_is_monitored_from_a_file_with_its_truth_in_the_figure() {
    let folder = tempdir().unwrap();
    let simulated =
        run(folder.path(), &["simulate", "nitrogen-20l", "leak-after-tunnel", "-o", "run.csv", "-q"]);
    assert_eq!(simulated.code, Some(0), "{}", simulated.stderr);
    let outcome =
        run(folder.path(), &["monitor", "nitrogen-20l", "run.csv", "-o", "rows.csv", "--plot", "m.svg"]);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    let figure = std::fs::read_to_string(folder.path().join("m.svg")).unwrap();
    for words in [
        "pressure in bar",
        "gas mass in kg",
        "leak rate in g/h",
        "truth",
        "limit 160 bar",
        "leak found",
        "verdict",
    ] {
        assert!(figure.contains(words), "`{words}` is missing");
    }
}
