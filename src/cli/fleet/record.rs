//! What is kept of a cylinder that is done, so that a run which is resumed need not do it again.
//!
//! A record is written after state and rows, whole or not at all. It is of use only for the same inputs: it has a key of them.
use crate::cli::monitor::Told;
use crate::cli::output::write_file;
use crate::report::Input;
use crate::report::fleet::Cylinder;
use anyhow::Context;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Version of the form of records.
pub(super) const VERSION: u32 = 1;
/// Length of the hash at the beginning of a file.
const HASH: usize = 64;

/// A cylinder that is done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Record {
    /// Hash of everything that the result follows from.
    pub key: String,
    /// Its row.
    pub cylinder: Cylinder,
    /// Events and changes of alarms.
    pub told: Vec<Told>,
}

impl Record {
    /// Reads a record; `None`: there is none, or it is damaged or of another version.
    pub(super) fn read(path: &Path) -> Option<Self> {
        let bytes = std::fs::read(path).ok()?;
        let (hash, content) = bytes.split_at_checked(HASH)?;
        (hash == Input::of("", content).sha256.as_bytes()).then_some(())?;
        postcard::from_bytes(content).ok()
    }

    /// Writes it.
    pub(super) fn write(&self, path: &Path) -> anyhow::Result<()> {
        let content = postcard::to_stdvec(self).context("a record cannot be put into bytes")?;
        let hash = Input::of("", &content).sha256;
        write_file(path, &[hash.as_bytes(), &content].concat())
    }
}
