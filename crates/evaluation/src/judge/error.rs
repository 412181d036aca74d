//! What can go wrong while worlds are judged.
use std::path::PathBuf;

use crate::detector::DetectorError;
use crate::estimator::EstimatorError;
use crate::world::WorldError;

/// What went wrong, and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JudgeError {
    /// A plan that cannot be run.
    #[error("{file}: `{key}` = {value}: {remedy}")]
    Plan {
        /// The plan's file.
        file: String,
        /// Key.
        key: String,
        /// Its value.
        value: String,
        /// What would be right.
        remedy: String,
    },
    /// A file of a plan that is no TOML of a plan.
    #[error("{file}, line {line}: {reason}")]
    Document {
        /// The plan's file.
        file: String,
        /// Line, from 1.
        line: usize,
        /// What the parser says.
        reason: String,
    },
    /// The folder holds the results of something else.
    #[error("{path}: the journal is of another {what} ({found}, now {now}); give another folder")]
    OtherJournal {
        /// The journal.
        path: PathBuf,
        /// What differs.
        what: &'static str,
        /// As it is written there.
        found: String,
        /// As it is now.
        now: String,
    },
    /// A line of the journal is not what was written, and it is not the last one.
    #[error("{path}, line {line}: {reason}; the results after it cannot be trusted: remove the folder")]
    Journal {
        /// The journal.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
    /// Another process writes into the folder.
    #[error("{path}: another judge is writing here; wait for it or give another folder")]
    Busy {
        /// The journal.
        path: PathBuf,
    },
    /// A file cannot be read or written.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// Cause.
        #[source]
        source: std::io::Error,
    },
    /// A number that JSON cannot hold.
    #[error("a result cannot be written: {0}")]
    Json(#[from] serde_json::Error),
    /// A world cannot be made.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The detector refuses.
    #[error(transparent)]
    Detector(#[from] DetectorError),
    /// The estimator refuses.
    #[error(transparent)]
    Estimator(#[from] EstimatorError),
}
