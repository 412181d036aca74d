//! What is to be done for a cylinder: nothing, all of it, or what has come since.
//!
//! Logs that have grown, by rows at their end or by files after the last, go on from the state: what comes out is what one run over all
//! of them would give. Where a log before has changed it would not, and all is done anew, unless the run is told to go on: then what is
//! new is read after what was.
use super::record::LogRecord;
use crate::cli::input::hashed;
use std::collections::HashMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::UNIX_EPOCH;

/// What is to be done.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Plan {
    /// Nothing: the record says it.
    Known,
    /// All of it.
    Anew,
    /// To go on from the state with these logs.
    GoOn(Vec<Step>),
}

/// A log to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Step {
    /// File.
    pub file: PathBuf,
    /// The record of the same log before it grew, by its position.
    pub grown: Option<usize>,
}

/// What has become of a log since it was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    /// Nothing.
    None,
    /// Lines were added.
    Grown,
    /// It is another one.
    Other,
}

/// Size and time of change of a file, ns.
pub(super) fn mark(file: &Path) -> Option<(u64, Option<u128>)> {
    let metadata = file.metadata().ok()?;
    let since = metadata.modified().ok().and_then(|at| at.duration_since(UNIX_EPOCH).ok());
    Some((metadata.len(), since.map(|since| since.as_nanos())))
}

/// Compares logs with what they were.
#[derive(Default)]
pub(super) struct Changes {
    /// What has become of logs of several cylinders, by path and by length and hash before.
    shared: Mutex<HashMap<(PathBuf, u64, String), Change>>,
}

impl Changes {
    /// The plan for a cylinder whose `files` were `logs`, in the order in which both are read.
    pub(super) fn plan(&self, logs: &[LogRecord], files: &[PathBuf], is_shared: bool, goes_on: bool) -> Plan {
        let change = |log: &LogRecord, file: &Path| self.change(log, file, is_shared);
        match grown(logs, files, &change) {
            Plan::Anew if goes_on => added(logs, files, &change),
            plan => plan,
        }
    }

    fn change(&self, log: &LogRecord, file: &Path, is_shared: bool) -> Change {
        let now = mark(file);
        if now == Some((log.length, log.changed_ns)) && log.changed_ns.is_some() {
            return Change::None;
        }
        if !is_shared {
            return compared(log, file).unwrap_or(Change::Other);
        }
        let key = (file.to_owned(), log.length, log.source.sha256.clone());
        let mut shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        *shared.entry(key).or_insert_with(|| compared(log, file).unwrap_or(Change::Other))
    }
}

/// The plan if nothing but the end has changed.
fn grown(logs: &[LogRecord], files: &[PathBuf], change: &impl Fn(&LogRecord, &Path) -> Change) -> Plan {
    let is_same = |(log, file): (&LogRecord, &PathBuf)| log.source.name == file.display().to_string();
    if files.len() < logs.len() || !logs.iter().zip(files).all(is_same) {
        return Plan::Anew;
    }
    let mut steps = Vec::new();
    for (at, (log, file)) in logs.iter().zip(files).enumerate() {
        match change(log, file) {
            Change::None => {}
            Change::Grown if at + 1 == logs.len() => {
                steps.push(Step { file: file.clone(), grown: Some(at) });
            }
            Change::Grown | Change::Other => return Plan::Anew,
        }
    }
    steps.extend(files[logs.len()..].iter().map(|file| Step { file: file.clone(), grown: None }));
    if steps.is_empty() { Plan::Known } else { Plan::GoOn(steps) }
}

/// The plan that takes whatever is new for what comes after.
fn added(logs: &[LogRecord], files: &[PathBuf], change: &impl Fn(&LogRecord, &Path) -> Change) -> Plan {
    let step = |file: &PathBuf| {
        let shown = file.display().to_string();
        let at = logs.iter().rposition(|log| log.source.name == shown);
        let grown = match at.map(|at| change(&logs[at], file)) {
            Some(Change::None) => return None,
            Some(Change::Grown) => at.filter(|at| at + 1 == logs.len()),
            Some(Change::Other) | None => None,
        };
        Some(Step { file: file.clone(), grown })
    };
    let steps: Vec<Step> = files.iter().filter_map(step).collect();
    if steps.is_empty() { Plan::Known } else { Plan::GoOn(steps) }
}

/// What has become of a log, by its bytes; `None`: it cannot be read.
fn compared(log: &LogRecord, file: &Path) -> Option<Change> {
    let mut opened = File::open(file).ok()?;
    let length = opened.metadata().ok()?.len();
    if length < log.length {
        return None;
    }
    let (before, read) = hashed(&mut (&mut opened).take(log.length), "").ok()?;
    if read != log.length || before.sha256 != log.source.sha256 {
        return None;
    }
    if length == log.length {
        return Some(Change::None);
    }
    Some(if is_whole_text(&mut opened, log.length).ok()? { Change::Grown } else { Change::Other })
}

/// Whether so many bytes are lines of a text: what has no end, or is packed, may have been read in another way than it would be now.
fn is_whole_text(file: &mut File, length: u64) -> std::io::Result<bool> {
    let mut byte = |at: u64| {
        let mut byte = [0];
        file.seek(SeekFrom::Start(at))?;
        file.read_exact(&mut byte).map(|()| byte[0])
    };
    let is_packed = byte(0)? == 0x1f || byte(0)? == b'P' && byte(1)? == b'A' && byte(2)? == b'R';
    Ok(!is_packed && byte(length - 1)? == b'\n')
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Input;
    use crate::report::fleet::Source;
    use tempfile::{TempDir, tempdir};

    fn folder(texts: &[&str]) -> (TempDir, Vec<PathBuf>, Vec<LogRecord>) {
        let folder = tempdir().unwrap();
        let files: Vec<PathBuf> = (0..texts.len()).map(|k| folder.path().join(format!("{k}.csv"))).collect();
        let record = |(file, text): (&PathBuf, &&str)| {
            std::fs::write(file, text).unwrap();
            let source = Source::from(Input::of(file.display().to_string(), text.as_bytes()));
            // A time of change that no file has: bytes decide.
            LogRecord { source, length: text.len() as u64, changed_ns: Some(1), ..LogRecord::default() }
        };
        let logs = files.iter().zip(texts).map(record).collect();
        (folder, files, logs)
    }

    fn plan(logs: &[LogRecord], files: &[PathBuf], goes_on: bool) -> Plan {
        let plans = [true, false].map(|shared| Changes::default().plan(logs, files, shared, goes_on));
        assert_eq!(plans[0], plans[1]);
        let [plan, _] = plans;
        plan
    }

    #[test]
    fn rows_at_the_end_and_files_after_the_last_go_on() {
        let (_folder, mut files, logs) = folder(&["a\n1\n", "a\n2\n"]);
        assert_eq!(plan(&logs, &files, false), Plan::Known);
        std::fs::write(&files[1], "a\n2\n3\n").unwrap();
        files.push(files[1].with_file_name("2.csv"));
        let steps = vec![
            Step { file: files[1].clone(), grown: Some(1) },
            Step { file: files[2].clone(), grown: None },
        ];
        assert_eq!(plan(&logs, &files, false), Plan::GoOn(steps));
    }

    #[test]
    fn what_has_changed_before_the_end_is_done_anew_unless_the_run_is_to_go_on() {
        for (at, text) in [(0, "a\n1\n2\n"), (1, "a\n7\n"), (1, "a\n"), (0, "b\n1\n")] {
            let (_folder, files, logs) = folder(&["a\n1\n", "a\n2\n"]);
            std::fs::write(&files[at], text).unwrap();
            assert_eq!(plan(&logs, &files, false), Plan::Anew, "{at} {text}");
            let step = Step { file: files[at].clone(), grown: None };
            assert_eq!(plan(&logs, &files, true), Plan::GoOn(vec![step]), "{at} {text}");
        }
        let (_folder, files, logs) = folder(&["a\n1\n", "a\n2\n"]);
        assert_eq!(plan(&logs, &files[..1], false), Plan::Anew);
        assert_eq!(plan(&logs, &files[..1], true), Plan::Known);
    }

    #[test]
    fn a_log_whose_last_line_had_no_end_or_that_is_packed_has_not_simply_grown() {
        for before in ["a\n1\n2", "\u{1f}\u{8b}\n", "PAR1\n"] {
            let (_folder, files, logs) = folder(&[before]);
            std::fs::write(&files[0], format!("{before}5\n")).unwrap();
            assert_eq!(plan(&logs, &files, false), Plan::Anew, "{before:?}");
        }
    }
}
