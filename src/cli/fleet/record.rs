//! What is kept of a cylinder that is done, so that a run which is resumed need not do it again, and a later one goes on from it.
//!
//! A record is written whole or not at all, and belongs to one state, whose hash it has. A new state first waits in another place, then
//! the record is written, then the state takes its place: whenever a run is killed, the record finds the state that it belongs to.
use super::folder::Files;
use crate::cli::monitor::Told;
use crate::cli::output::write_file;
use crate::report::Input;
use crate::report::fleet::{Cylinder, Source, Trace};
use crate::report::monitor::RowCounts;
use anyhow::Context;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Version of the form of records.
pub(super) const VERSION: u32 = 2;
/// Length of the hash at the beginning of a file.
const HASH: usize = 64;

/// A cylinder that is done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Record {
    /// Hash of everything but the logs that the result follows from.
    pub settings: String,
    /// The logs that the result follows from, in the order in which they were read.
    pub logs: Vec<LogRecord>,
    /// SHA-256 of its state.
    pub state: String,
    /// Its row.
    pub cylinder: Cylinder,
    /// Events and changes of alarms.
    pub told: Vec<Told>,
    /// Course of the pressure at 15 °C.
    pub trace: Trace,
}

/// A log that was read, of a cylinder.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct LogRecord {
    /// Its path and hash.
    pub source: Source,
    /// Its length, bytes.
    pub length: u64,
    /// When it was changed, ns; `None`: nobody knows.
    pub changed_ns: Option<u128>,
    /// Rows that it has of the cylinder.
    pub rows: u64,
    /// Those among them that a log before had brought.
    pub known_rows: u64,
    /// What became of rows that were not simply used.
    pub counts: RowCounts,
    /// Time of its first row, s and as date; `None`: none has come out.
    pub first: Option<(f64, String)>,
    /// What a run cautioned about before its rows.
    pub before_rows: Vec<String>,
    /// What its rows cautioned about.
    pub of_rows: Vec<String>,
}

impl Record {
    /// The record of a cylinder and its state, which takes its place if it has not yet; `None`: there is none, or they do not fit.
    pub(super) fn recovered(files: &Files) -> Option<Self> {
        let record: Self = read(&files.record)?;
        let is_its = |path: &Path| file_hash(path).is_some_and(|hash| hash == record.state);
        let is_there = is_its(&files.state)
            || (is_its(&files.work) && std::fs::rename(&files.work, &files.state).is_ok());
        is_there.then_some(record)
    }

    /// Writes the record of the state that waits, and lets that take its place.
    pub(super) fn commit(&self, files: &Files) -> anyhow::Result<()> {
        write(self, &files.record)?;
        std::fs::rename(&files.work, &files.state)
            .with_context(|| format!("{} cannot be written", files.state.display()))
    }
}

/// SHA-256 of a file; `None`: it cannot be read.
pub(super) fn file_hash(path: &Path) -> Option<String> {
    Some(Input::of("", &std::fs::read(path).ok()?).sha256)
}

/// Reads a value; `None`: there is none, or it is damaged or of another version.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> Option<T> {
    let bytes = std::fs::read(path).ok()?;
    let (hash, content) = bytes.split_at_checked(HASH)?;
    (hash == Input::of("", content).sha256.as_bytes()).then_some(())?;
    postcard::from_bytes(content).ok()
}

/// Writes a value with its hash.
pub(super) fn write<T: Serialize>(value: &T, path: &Path) -> anyhow::Result<()> {
    let content = postcard::to_allocvec(value).context("a record cannot be put into bytes")?;
    let hash = Input::of("", &content).sha256;
    write_file(path, &[hash.as_bytes(), &content].concat())
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    #[test]
    fn a_record_finds_its_state_wherever_a_kill_left_it_and_takes_no_other() {
        let folder = tempdir().unwrap();
        let of = |name: &str| folder.path().join(name);
        let files = Files { state: of("state"), rows: of("rows"), record: of("record"), work: of("work") };
        let cylinder = Cylinder {
            name: "A".to_owned(),
            vessel: String::new(),
            logs: Vec::new(),
            found: None,
            fault: String::new(),
            cautions: Vec::new(),
            events: 0,
            last_events: Vec::new(),
        };
        let record = |state: &[u8]| Record {
            settings: String::new(),
            logs: vec![LogRecord { rows: 7, ..LogRecord::default() }],
            state: Input::of("", state).sha256,
            cylinder: cylinder.clone(),
            told: Vec::new(),
            trace: Trace::default(),
        };
        let lay = |place: &Path, bytes: &[u8]| std::fs::write(place, bytes).unwrap();
        lay(&files.work, b"first");
        record(b"first").commit(&files).unwrap();
        assert_eq!(Record::recovered(&files), Some(record(b"first")));
        // Killed before the record: the new state goes.
        lay(&files.work, b"second");
        assert_eq!(Record::recovered(&files), Some(record(b"first")));
        // Killed after it: the new state takes its place.
        write(&record(b"second"), &files.record).unwrap();
        assert_eq!(Record::recovered(&files), Some(record(b"second")));
        assert_eq!((std::fs::read(&files.state).unwrap(), files.work.exists()), (b"second".to_vec(), false));
        lay(&files.state, b"of someone else");
        assert_eq!(Record::recovered(&files), None);
        lay(&files.record, b"damaged");
        assert_eq!(Record::recovered(&files), None);
    }
}
