//! Running the program.
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;
use tempfile::TempDir;

/// The program with arguments, in a folder.
pub(crate) fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cylwatch"));
    command.current_dir(folder).args(arguments).stdin(Stdio::null()).env_remove("NO_COLOR");
    command
}

/// What the program did.
pub(crate) struct Outcome {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl From<Output> for Outcome {
    fn from(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Self { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }
}

/// Runs the program in a folder.
pub(crate) fn run(folder: &Path, arguments: &[&str]) -> Outcome {
    program(folder, arguments).output().unwrap().into()
}

/// The paper rebuilt by the program with one cylinder of each case and seed 3, once for all tests: the folder, with `made/here` and
/// `reproduce.html` in it, and what the program said.
pub(crate) fn reproduced() -> &'static (TempDir, Outcome) {
    static REPRODUCED: OnceLock<(TempDir, Outcome)> = OnceLock::new();
    REPRODUCED.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let few = ["--cylinders", "1", "--report", "reproduce.html"];
        let outcome = run(folder.path(), &[&["reproduce", "--out", "made/here"], &few[..]].concat());
        (folder, outcome)
    })
}

/// Runs the program with a text on stdin.
pub(crate) fn run_with_stdin(folder: &Path, arguments: &[&str], text: &str) -> Outcome {
    let mut command = program(folder, arguments);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    // A program that refuses its arguments does not wait for its input.
    if let Err(error) = child.stdin.take().unwrap().write_all(text.as_bytes()) {
        assert_eq!(error.kind(), std::io::ErrorKind::BrokenPipe);
    }
    child.wait_with_output().unwrap().into()
}

/// Runs the program, which must refuse with exit code 2, one message that names all of `words`, and no data.
pub(crate) fn refused(folder: &Path, arguments: &[&str], words: &[&str]) {
    refusal(run(folder, arguments), words);
}

/// Asserts a refusal.
pub(crate) fn refusal(outcome: Outcome, words: &[&str]) {
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert_eq!(outcome.stdout, "");
    assert!(!outcome.stderr.contains("panicked"), "{}", outcome.stderr);
    for word in words {
        assert!(outcome.stderr.contains(word), "`{word}` is missing in: {}", outcome.stderr);
    }
}

/// Names of the files in a folder.
pub(crate) fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// Lines of a CSV text below its comments: header and rows.
pub(crate) fn rows(csv: &str) -> (Vec<&str>, Vec<Vec<&str>>) {
    let mut lines = csv.lines().filter(|line| !line.starts_with('#'));
    let header = lines.next().unwrap().split(',').collect();
    (header, lines.map(|line| line.split(',').collect()).collect())
}

/// A column of a CSV text as numbers.
pub(crate) fn column(csv: &str, name: &str) -> Vec<f64> {
    let (header, rows) = rows(csv);
    let index = header.iter().position(|found| *found == name).unwrap_or_else(|| panic!("no column {name}"));
    rows.iter().map(|row| row[index].parse().unwrap()).collect()
}

/// A plan of the judge that a test can afford: two detectors, five cylinders for the threshold and two that judge, a day each.
pub(crate) const TINY_PLAN: &str = r#"
title = "A tiny plan"
between_false_alarms_y = 0.1
tune = ["*/workshop/*/*/*"]
judge = ["*/railway/*/*/*"]
candidate = [{ name = "cylwatch", kind = "monitor" }, { name = "pressure, switch", kind = "pressure-switch" }]

[[group]]
name = "for the threshold"
families = ["nitrogen-20l/workshop/mixed/class-b/120s"]
seeds = [1, 5]
length_d = 1.0
overlays = [{ kind = "nothing" }]
candidates = ["pressure, switch"]

[[group]]
name = "tight and leaking"
families = ["nitrogen-20l/railway/mixed/class-b/120s"]
seeds = [1, 2]
length_d = 1.0
overlays = [{ kind = "nothing" }, { kind = "leak", part_per_h = [0.05, 0.1], onset_h = [14.0, 15.0] }]
"#;
