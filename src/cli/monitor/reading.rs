//! What a run has read of its log.
use crate::cli::input::LogInput;

/// What was read.
pub(in crate::cli) struct Reading {
    /// Length of the log, bytes; `None`: it was a pipe.
    pub length: Option<u64>,
    /// Rows.
    pub rows: u64,
    /// Those among them that the state had taken in before.
    pub known_rows: u64,
    /// What the log was cautioned about.
    pub cautions: Vec<String>,
}

impl Reading {
    /// Of a log that has been read.
    pub(super) fn of(log: &LogInput, known_rows: u64) -> Self {
        Self {
            length: log.length(),
            rows: log.reader.sampling().rows(),
            known_rows,
            cautions: log.reader.cautions().iter().map(ToString::to_string).collect(),
        }
    }
}
