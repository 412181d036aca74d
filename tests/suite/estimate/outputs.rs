//! Files that appear complete or not at all, formats, memory.
use super::{at_rest, estimate, simulate};
use crate::support::{column, files, program, refusal, refused, rows, run};
use std::io::{Read, Write};
use std::process::Stdio;
use tempfile::tempdir;

#[test]
fn json_holds_the_numbers_of_the_csv_with_summary_and_provenance() {
    let folder = tempdir().unwrap();
    simulate(folder.path(), "shock-cold", "run.csv");
    let csv = run(folder.path(), &["estimate", "nitrogen-20l", "run.csv"]).stdout;
    assert_eq!(
        run(folder.path(), &["estimate", "nitrogen-20l", "run.csv", "-o", "e.json", "-q"]).code,
        Some(0)
    );
    let text = std::fs::read_to_string(folder.path().join("e.json")).unwrap();
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    let (header, rows) = rows(&csv);
    assert_eq!(document["columns"], serde_json::json!(header));
    let data = document["data"].as_array().unwrap();
    assert_eq!(data.len(), rows.len());
    for (in_csv, in_json) in rows.iter().zip(data) {
        for (cell, value) in in_csv.iter().zip(in_json.as_array().unwrap()) {
            match value {
                serde_json::Value::Null => assert_eq!(*cell, ""),
                serde_json::Value::String(word) => assert_eq!(cell, word),
                number => assert_eq!(cell.parse().ok(), number.as_f64()),
            }
        }
    }
    assert_eq!(document["provenance"]["inputs"].as_array().unwrap().len(), 2);
    let summary = &document["summary"];
    assert_eq!(summary["rows"], rows.len());
    assert!(summary["against_truth"]["gas_mean_k"]["rms"].as_f64().unwrap() > 0.0);
    assert_eq!(summary["sensors"].as_array().unwrap().len(), 3);
}

#[test]
fn the_score_in_the_summary_is_that_of_the_written_numbers() {
    let folder = tempdir().unwrap();
    simulate(folder.path(), "shock-cold", "run.csv");
    let log = std::fs::read_to_string(folder.path().join("run.csv")).unwrap();
    let csv = run(folder.path(), &["estimate", "nitrogen-20l", "run.csv"]).stdout;
    let json = run(folder.path(), &["estimate", "nitrogen-20l", "run.csv", "--format", "json"]).stdout;
    let document: serde_json::Value = serde_json::from_str(&json).unwrap();
    let errors: Vec<f64> =
        column(&csv, "mass_kg").iter().zip(column(&log, "mass_kg")).map(|(a, b)| 1e3 * (a - b)).collect();
    let count = errors.len() as f64;
    let score = &document["summary"]["against_truth"]["mass_g"];
    // The file has the mass to a milligram.
    assert!((score["mean"].as_f64().unwrap() - errors.iter().sum::<f64>() / count).abs() < 1e-3);
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / count).sqrt();
    assert!((score["rms"].as_f64().unwrap() - rms).abs() < 1e-3);
}

#[test]
fn a_refused_log_leaves_older_outputs_as_they_were_and_nothing_beside_them() {
    let folder = tempdir().unwrap();
    let mut log = at_rest(500);
    log.push_str("10,15,15,200\n");
    std::fs::write(folder.path().join("log.csv"), log).unwrap();
    std::fs::write(folder.path().join("est.csv"), "older").unwrap();
    let arguments = [
        "estimate",
        "nitrogen-20l",
        "log.csv",
        "-o",
        "est.csv",
        "--plot",
        "est.svg",
        "--learned-out",
        "l.json",
    ];
    refused(folder.path(), &arguments, &["log.csv:502", "time 10 s"]);
    assert_eq!(std::fs::read_to_string(folder.path().join("est.csv")).unwrap(), "older");
    assert_eq!(files(folder.path()), ["est.csv", "log.csv"]);
}

#[test]
fn places_that_cannot_be_written_or_read_are_found_before_the_run() {
    let folder = tempdir().unwrap();
    std::fs::create_dir(folder.path().join("folder")).unwrap();
    std::fs::write(folder.path().join("log.csv"), at_rest(3)).unwrap();
    // The vessel does not exist: a complaint about the output shows that it was checked first.
    let with = |options: &[&str], words: &[&str]| {
        refused(folder.path(), &[&["estimate", "none.toml", "log.csv"], options].concat(), words);
    };
    with(&["-o", "missing/e.csv"], &["missing/e.csv", "no folder", "make it first"]);
    with(&["-o", "folder"], &["folder", "name a file in it"]);
    with(&["-o", "log.csv"], &["log.csv is an input"]);
    with(&["--plot", "e.pdf"], &["e.pdf", ".svg or .png"]);
    with(&["-o", "e.svg", "--plot", "e.svg"], &["same file"]);
    with(&["-o", "e.json", "--learned-out", "e.json"], &["same place"]);
    with(&["--learned-out", "-"], &["same place"]);
    refused(folder.path(), &["estimate", "-", "-"], &["stdin", "not both"]);
    refused(folder.path(), &["estimate", "nitrogen-20l", "none.csv"], &["none.csv cannot be read"]);
    refused(folder.path(), &["estimate", "nitrogen-20l", "folder"], &["folder is a folder"]);
    assert_eq!(files(folder.path()), ["folder", "log.csv"]);
}

#[test]
fn quiet_says_nothing_and_pictures_are_pictures() {
    let folder = tempdir().unwrap();
    let options = ["-q", "-o", "e.csv", "--plot", "e.png"];
    let outcome = estimate(folder.path(), &at_rest(100), &options);
    assert_eq!((outcome.code, outcome.stdout.as_str(), outcome.stderr.as_str()), (Some(0), "", ""));
    let picture = std::fs::File::open(folder.path().join("e.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(picture)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    assert!(pixels.iter().any(|&value| value < 50), "the picture is empty");
    refusal(estimate(folder.path(), "time_s\n", &["-q"]), &["error:"]);
}

/// Most memory that a process has used so far, KiB.
#[cfg(target_os = "linux")]
fn peak_kib(process: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_grow_with_the_length_of_the_log() {
    let folder = tempdir().unwrap();
    let mut command = program(folder.path(), &["estimate", "nitrogen-20l", "-", "--plot", "e.svg", "-q"]);
    command.stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let mut output = child.stdout.take().unwrap();
    let reader =
        std::thread::spawn(move || std::io::copy(&mut output.by_ref().take(1 << 30), &mut std::io::sink()));
    input.write_all(b"time_s,shoulder_degc,valve_degc,pressure_bar\n").unwrap();
    let mut write = |rows: std::ops::Range<u32>| {
        for row in rows {
            let last = f64::from(row * 7 % 5) - 2.0;
            writeln!(input, "{},{:.2},{:.2},{:.3}", 10 * row, 15.0 + 0.02 * last, 15.0, 200.0).unwrap();
        }
    };
    // The figure's buckets are full after 4096 rows; a pipe holds some thousand rows back.
    write(0..12_000);
    let early = peak_kib(child.id());
    write(12_000..60_000);
    let late = peak_kib(child.id());
    drop(input);
    assert!(child.wait().unwrap().success());
    reader.join().unwrap().unwrap();
    // 48 000 rows as they are written would be 1.2 MB, as estimates 5 MB.
    assert!(late - early < 512, "{early} KiB after 12 000 rows, {late} KiB after 60 000");
}
