//! State files: a monitor that stops and goes on as if it had not.
//!
//! The first line says what the file is, its version, and length and SHA-256 of what follows, in a binary form. A file is written beside its
//! place and renamed, so that there is always a whole one, the new or the old.
use crate::cli::output::write_file;
use crate::detector::DetectorError;
use crate::detector::monitor::Output;
use crate::report::{Input, Shown};
use anyhow::Context;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Version of the format; another one is refused.
const VERSION: u32 = 3;
/// First words of the file.
const MARK: &str = "cylwatch-monitor-state";

/// What is saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct State {
    /// What the state belongs to.
    pub identity: Identity,
    /// Date of second 0 in RFC 3339; `None`: the log has no dates.
    pub origin: Option<String>,
    /// What the clock of the log has shown.
    pub clock: Shown,
    /// Time of the last row that was taken in, as it was stamped, s; NaN: none.
    pub last_stamp_s: f64,
    /// Times of the first rows of the last logs, s: a log that begins with one of them is that log again.
    pub log_starts_s: Vec<f64>,
    /// Pressure of the full cylinder at 15 °C, Pa.
    pub full_pa: f64,
    /// Whether all was at rest at the first row.
    pub settled: bool,
    /// Whether the fill was stated, not read.
    pub stated: bool,
    /// The table of the rows and its length, bytes, when the state was saved.
    pub table: Option<(PathBuf, u64)>,
    /// The last output.
    pub last: Option<Output>,
    /// The monitor, as it saves itself.
    pub monitor: Vec<u8>,
}

/// What a state belongs to: names and values; a state is of use only to the same.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Identity(pub Vec<(String, String)>);

impl Identity {
    /// With what an earlier one says and this one does not, as a fill that is not stated again.
    pub(super) fn after(mut self, earlier: &Self) -> Self {
        for entry in &earlier.0 {
            if !self.0.iter().any(|(what, _)| *what == entry.0) {
                self.0.push(entry.clone());
            }
        }
        self
    }
}

/// Why a state is refused.
#[derive(Debug, thiserror::Error)]
pub(super) enum Refusal {
    /// The file cannot be read.
    #[error("it cannot be read: {0}")]
    Unreadable(std::io::Error),
    /// It is something else.
    #[error("it is no state of a monitor")]
    Foreign,
    /// It was written by a program with another format.
    #[error("it has version {found}, this program reads {VERSION}")]
    Version {
        /// Version of the file.
        found: String,
    },
    /// Its end is missing.
    #[error("it is cut short: {found} of {expected} bytes")]
    Short {
        /// Bytes there are.
        found: usize,
        /// Bytes there should be.
        expected: usize,
    },
    /// Its content does not fit its checksum.
    #[error("it is damaged: its content does not fit its checksum")]
    Damaged,
    /// It belongs to something else.
    #[error("it was made with {what} {then}, and this run has {now}")]
    Other {
        /// What differs.
        what: String,
        /// As it was.
        then: String,
        /// As it is.
        now: String,
    },
    /// It counts time in another way.
    #[error("its log {then}, and this one {now}")]
    Clock {
        /// As it was.
        then: &'static str,
        /// As it is.
        now: &'static str,
    },
    /// The monitor does not take it.
    #[error("{0}")]
    Monitor(DetectorError),
}

impl State {
    /// The bytes of a file.
    pub(super) fn to_bytes(&self) -> anyhow::Result<Vec<u8>> {
        let content = postcard::to_allocvec(self).context("the state cannot be put into bytes")?;
        let head = head(VERSION, &content);
        Ok([head.as_bytes(), &content].concat())
    }

    /// Of the bytes of a file.
    pub(super) fn from_bytes(bytes: &[u8]) -> Result<Self, Refusal> {
        let end = bytes.iter().position(|&byte| byte == b'\n').ok_or(Refusal::Foreign)?;
        let line = std::str::from_utf8(&bytes[..end]).map_err(|_| Refusal::Foreign)?;
        let words: Vec<&str> = line.split(' ').collect();
        let [MARK, version, rest @ ..] = words.as_slice() else { return Err(Refusal::Foreign) };
        if version.parse() != Ok(VERSION) {
            return Err(Refusal::Version { found: (*version).to_owned() });
        }
        let [_, length, _, _] = rest else { return Err(Refusal::Damaged) };
        let expected: usize = length.parse().map_err(|_| Refusal::Damaged)?;
        let content = &bytes[end + 1..];
        if content.len() < expected {
            return Err(Refusal::Short { found: content.len(), expected });
        }
        if words != head(VERSION, content).trim_end().split(' ').collect::<Vec<_>>() {
            return Err(Refusal::Damaged);
        }
        postcard::from_bytes(content).map_err(|_| Refusal::Damaged)
    }

    /// Reads a file; `None` where there is none.
    pub(super) fn read(path: &Path) -> Result<Option<Self>, Refusal> {
        match std::fs::read(path) {
            Ok(bytes) => Self::from_bytes(&bytes).map(Some),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(Refusal::Unreadable(error)),
        }
    }

    /// Writes the file, whole or not at all.
    pub(super) fn write(&self, path: &Path) -> anyhow::Result<()> {
        write_file(path, &self.to_bytes()?)
    }

    /// Refuses the state if it belongs to something else.
    pub(super) fn check(&self, now: &Identity) -> Result<(), Refusal> {
        for (what, value) in &now.0 {
            let same = self.identity.0.iter().find(|(name, _)| name == what);
            let was = same.map_or("none", |(_, value)| value.as_str());
            if was != value {
                let (what, then, now) = (what.clone(), was.to_owned(), value.clone());
                return Err(Refusal::Other { what, then, now });
            }
        }
        Ok(())
    }
}

/// First line of a file with this content.
fn head(version: u32, content: &[u8]) -> String {
    let hash = Input::of("", content).sha256;
    format!("{MARK} {version} bytes {} sha256 {hash}\n", content.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state() -> State {
        State {
            identity: Identity(vec![("vessel".into(), "a".into()), ("a lateness of".into(), "0 s".into())]),
            origin: None,
            clock: Shown::default(),
            last_stamp_s: f64::NAN,
            log_starts_s: vec![0.0],
            full_pa: 200e5,
            settled: true,
            stated: true,
            table: Some(("rows.csv".into(), 300)),
            last: None,
            monitor: (0..200).collect(),
        }
    }

    fn refusal(bytes: &[u8]) -> String {
        State::from_bytes(bytes).unwrap_err().to_string()
    }

    #[test]
    fn what_is_read_is_what_was_written() {
        let read = State::from_bytes(&state().to_bytes().unwrap()).unwrap();
        assert!(read.last_stamp_s.is_nan());
        assert_eq!(State { last_stamp_s: 0.0, ..read }, State { last_stamp_s: 0.0, ..state() });
    }

    #[test]
    fn a_file_that_lacks_its_end_wherever_it_was_cut_is_refused() {
        let bytes = state().to_bytes().unwrap();
        for length in 0..bytes.len() {
            let reason = refusal(&bytes[..length]);
            assert!(reason.contains("cut short") || reason.contains("no state"), "{length}: {reason}");
        }
        assert!(refusal(&bytes[..bytes.len() - 1]).contains("cut short"));
    }

    #[test]
    fn a_file_with_any_byte_changed_is_refused() {
        let bytes = state().to_bytes().unwrap();
        for at in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[at] ^= 1;
            assert!(State::from_bytes(&changed).is_err(), "byte {at}");
        }
        let mut longer = bytes.clone();
        longer.push(0);
        assert!(refusal(&longer).contains("damaged"));
    }

    #[test]
    fn another_version_and_another_kind_of_file_are_named() {
        let bytes = state().to_bytes().unwrap();
        let text = String::from_utf8_lossy(&bytes).replacen(" 3 ", " 9 ", 1);
        assert!(refusal(text.as_bytes()).contains("version 9, this program reads 3"));
        assert!(refusal(b"time_s,shoulder_degc\n0,15\n").contains("no state"));
    }

    #[test]
    fn the_first_thing_that_differs_is_named_with_both_values() {
        let mut now = state().identity;
        assert!(state().check(&now).is_ok());
        now.0[1].1 = "60 s".into();
        let reason = state().check(&now).unwrap_err().to_string();
        assert_eq!(reason, "it was made with a lateness of 0 s, and this run has 60 s");
        now.0[1].0 = "another".into();
        assert!(state().check(&now).unwrap_err().to_string().contains("another none"));
    }
}
