//! A monitor that runs beside a logger: rows as they come, one table over all runs, signals.
use super::*;
use crate::support::{files, program, refused, run};
use std::fs::File;
use std::io::Write;
use std::process::{Child, ChildStdin, Stdio};
use std::time::{Duration, Instant, SystemTime};
use tempfile::tempdir;

const ARGUMENTS: &[&str] =
    &["monitor", "nitrogen-20l", "-", "--settled", "--state", "c.state", "-o", "rows.csv"];

/// A monitor that waits for rows.
fn started(folder: &Path, options: &[&str]) -> (Child, ChildStdin) {
    let mut command = program(folder, &[ARGUMENTS, options].concat());
    let mut child = command.stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let input = child.stdin.take().unwrap();
    (child, input)
}

fn table(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("rows.csv")).unwrap_or_default()
}

/// Waits for a row of the table.
fn wait_for(folder: &Path, time_s: u32) {
    let begin = Instant::now();
    while !table(folder).contains(&format!("\n{time_s},")) {
        assert!(begin.elapsed() < Duration::from_secs(60), "no row of {time_s} s:\n{}", table(folder));
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// The rows that one run over all minutes writes.
fn whole(minutes: std::ops::Range<u32>) -> Vec<String> {
    let outcome = monitor(tempdir().unwrap().path(), &log(minutes, TIGHT), &[]);
    data(&outcome.stdout).into_iter().map(str::to_owned).collect()
}

#[cfg(unix)]
fn signal(child: &Child, name: &str) {
    let sent = std::process::Command::new("kill").args([name, &child.id().to_string()]).status();
    assert!(sent.unwrap().success());
}

#[test]
fn a_row_is_in_the_table_when_it_has_come_not_with_the_next_one() {
    let folder = tempdir().unwrap();
    let (mut child, mut input) = started(folder.path(), &[]);
    input.write_all(log(0..5, TIGHT).as_bytes()).unwrap();
    wait_for(folder.path(), 240);
    input.write_all(row(5, TIGHT).as_bytes()).unwrap();
    wait_for(folder.path(), 300);
    drop(input);
    child.wait().unwrap();
    assert_eq!(data(&table(folder.path())), whole(0..6));
}

#[cfg(unix)]
#[test]
fn a_signal_saves_the_state_gives_the_summary_and_the_next_run_goes_on_in_one_table() {
    let folder = tempdir().unwrap();
    for (name, from, until) in [("-INT", 0, 70), ("-TERM", 70, 200), ("-HUP", 200, 210)] {
        let (child, mut input) = started(folder.path(), &["--save-every-d", "1"]);
        let mut text = log(from..until, TIGHT);
        // A line that the logger is still writing.
        let last = row(until, TIGHT);
        text.push_str(&last[..last.len() - 3]);
        input.write_all(text.as_bytes()).unwrap();
        wait_for(folder.path(), 60 * (until - 1));
        signal(&child, name);
        let outcome: Outcome = child.wait_with_output().unwrap().into();
        assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
        for words in ["stopped by a signal; the state is saved", "unknown"] {
            assert!(outcome.stderr.contains(words), "{words}: {}", outcome.stderr);
        }
        assert_eq!(files(folder.path()), ["c.state", "rows.csv"]);
        drop(input);
    }
    let text = table(folder.path());
    assert_eq!(data(&text), whole(0..210));
    assert_eq!(text.matches("time_s,").count(), 1);
}

#[cfg(unix)]
#[test]
fn a_signal_before_the_first_row_of_a_run_leaves_all_as_it_was() {
    let folder = tempdir().unwrap();
    let (mut child, mut input) = started(folder.path(), &[]);
    input.write_all(log(0..20, TIGHT).as_bytes()).unwrap();
    drop(input);
    child.wait().unwrap();
    let before = table(folder.path());
    let (child, mut input) = started(folder.path(), &[]);
    input.write_all(HEADER.as_bytes()).unwrap();
    std::thread::sleep(Duration::from_millis(500));
    signal(&child, "-TERM");
    let outcome: Outcome = child.wait_with_output().unwrap().into();
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    assert_eq!(table(folder.path()), before);
}

#[test]
fn rows_after_the_last_save_of_a_killed_run_stand_once_whether_the_log_comes_again_or_goes_on() {
    let folder = tempdir().unwrap();
    let (mut child, mut input) = started(folder.path(), &["--save-every-s", "1e-9"]);
    input.write_all(log(0..60, TIGHT).as_bytes()).unwrap();
    wait_for(folder.path(), 60 * 59);
    child.kill().unwrap();
    child.wait().unwrap();
    drop(input);
    let saved = std::fs::read(folder.path().join("c.state")).unwrap();
    // Killed again, long after its last save and in the middle of a row.
    let (mut child, mut input) = started(folder.path(), &["--save-every-d", "1"]);
    input.write_all(log(60..90, TIGHT).as_bytes()).unwrap();
    wait_for(folder.path(), 60 * 89);
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(std::fs::read(folder.path().join("c.state")).unwrap(), saved);
    let mut rows = File::options().append(true).open(folder.path().join("rows.csv")).unwrap();
    rows.write_all(b"5400,15.0").unwrap();
    std::fs::copy(folder.path().join("c.state"), folder.path().join("kept.state")).unwrap();
    std::fs::copy(folder.path().join("rows.csv"), folder.path().join("kept.csv")).unwrap();

    // The log as a file once more: what is known to the state is skipped, what came after it comes once.
    std::fs::write(folder.path().join("log.csv"), log(0..100, TIGHT)).unwrap();
    let mut arguments = ARGUMENTS.to_vec();
    arguments[2] = "log.csv";
    let outcome = run(folder.path(), &arguments);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
    assert_eq!(data(&table(folder.path())), whole(0..100));

    // Through a pipe the logger goes on with later rows: those of before stay, though the state has not seen them.
    std::fs::rename(folder.path().join("kept.state"), folder.path().join("c.state")).unwrap();
    std::fs::rename(folder.path().join("kept.csv"), folder.path().join("rows.csv")).unwrap();
    let (mut child, mut input) = started(folder.path(), &[]);
    input.write_all(log(90..100, TIGHT).as_bytes()).unwrap();
    drop(input);
    child.wait().unwrap();
    let times: Vec<f64> = cells(&table(folder.path()), "time_s").iter().map(|s| s.parse().unwrap()).collect();
    assert_eq!(times, (0..100).map(|minute| 60.0 * f64::from(minute)).collect::<Vec<_>>());
}

#[test]
fn a_table_with_other_columns_is_not_gone_on_with() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("log.csv"), log(0..20, TIGHT)).unwrap();
    let mut arguments = ARGUMENTS.to_vec();
    arguments[2] = "log.csv";
    run(folder.path(), &arguments);
    std::fs::write(folder.path().join("rows.csv"), "time_s,leak_g_h\n0,1\n").unwrap();
    refused(folder.path(), &arguments, &["rows.csv", "other columns", "choose another output"]);
    assert_eq!(table(folder.path()), "time_s,leak_g_h\n0,1\n");
}

#[test]
fn what_a_killed_run_left_half_written_goes_and_what_another_run_writes_stays() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("log.csv"), log(0..20, TIGHT)).unwrap();
    let made = |name: &str, age_s: u64| {
        let file = File::create(folder.path().join(name)).unwrap();
        file.set_modified(SystemTime::now() - Duration::from_secs(age_s)).unwrap();
        file
    };
    made(".cylwatch-old.part", 3600);
    made(".cylwatch-young.part", 0);
    made("mine.part", 3600);
    let locked = made(".cylwatch-busy.part", 3600);
    locked.lock().unwrap();
    run(folder.path(), &["monitor", "nitrogen-20l", "log.csv", "--settled", "-o", "rows.csv"]);
    let left = [".cylwatch-busy.part", ".cylwatch-young.part", "log.csv", "mine.part", "rows.csv"];
    assert_eq!(files(folder.path()), left);
}
