//! Logs with a column `cylinder`: whose rows they have, and the rows of each cylinder, taken out once.
//!
//! Rows wait in a file for each cylinder below the hidden folder of the output, and go with it when the run has ended. What is known of a log
//! without its rows is kept as an index: a run that finds nothing new does not read the log.
use super::folder::{Folder, stem};
use super::plan::mark;
use super::record;
use crate::cli::input::{Spooled, hashed};
use crate::log::cylinders::{Rest, split};
use crate::log::{LogError, LogOptions};
use crate::report::fleet::Source;
use crate::report::{Input, digest};
use anyhow::{Context, bail};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs::File;
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Bytes of rows that wait in memory before they are written.
const BUFFER: usize = 16 << 20;
/// File that says that all rows have been taken out.
const WHOLE: &str = "whole";

/// What is known of a log without its rows.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Index {
    /// Size and time of change of the log, and how it was read.
    key: String,
    log: Source,
    length: u64,
    /// Cylinders, sorted.
    pub names: Vec<String>,
    /// Line of the first row that names none.
    pub nameless: Option<u64>,
    /// What was left out.
    pub cautions: Vec<String>,
    /// Why the log cannot be read on.
    pub damage: Option<String>,
}

/// A log with a column `cylinder`.
pub(super) struct ColumnLog {
    file: PathBuf,
    options: LogOptions,
    /// Folder of the rows.
    rows: PathBuf,
    /// What is known of it.
    pub index: Index,
    /// Whether the rows have been taken out.
    is_split: Mutex<bool>,
}

impl ColumnLog {
    /// Reads a log, or the index of it if it is the same; `stop` tells whether the run is to end.
    ///
    /// # Errors
    /// The output folder cannot be written, or the run is to end.
    pub(super) fn read(
        file: &Path,
        options: &LogOptions,
        folder: &Folder,
        stop: &dyn Fn() -> bool,
    ) -> anyhow::Result<Self> {
        let name = digest(&file.display().to_string());
        let path = folder.index(&name);
        let key = format!("{} {:?} {options:?}", record::VERSION, mark(file));
        let mut log = Self {
            file: file.to_owned(),
            options: options.clone(),
            rows: folder.spool(&name),
            index: Index::default(),
            is_split: Mutex::new(false),
        };
        match record::read::<Index>(&path).filter(|index| index.key == key) {
            Some(index) => {
                let is_split = std::fs::read(log.rows.join(WHOLE)).is_ok_and(|found| found == key.as_bytes());
                (log.index, log.is_split) = (index, Mutex::new(is_split));
            }
            None => {
                log.index = log.split(key, stop)?;
                log.is_split = Mutex::new(true);
                if log.index.damage.is_none() {
                    record::write(&log.index, &path)?;
                }
            }
        }
        Ok(log)
    }

    /// The rows of a cylinder; they are taken out of the log if they have not been.
    ///
    /// # Errors
    /// As of [`ColumnLog::read`], or the log has changed since.
    pub(super) fn spooled(&self, cylinder: &str, stop: &dyn Fn() -> bool) -> anyhow::Result<Spooled> {
        let mut is_split = self.is_split.lock().unwrap_or_else(PoisonError::into_inner);
        if !*is_split {
            if self.split(self.index.key.clone(), stop)? != self.index {
                bail!("{} has changed while it was read: run again", self.file.display());
            }
            *is_split = true;
        }
        let Source { name, sha256 } = self.index.log.clone();
        Ok(Spooled {
            cylinder: cylinder.to_owned(),
            log: Input { name, sha256 },
            length: self.index.length,
            rows: place(&self.rows, cylinder),
        })
    }

    /// Takes the rows out, in one go through the log.
    fn split(&self, key: String, stop: &dyn Fn() -> bool) -> anyhow::Result<Index> {
        let name = self.file.display().to_string();
        // What an earlier run has left is of no use.
        _ = std::fs::remove_dir_all(&self.rows);
        std::fs::create_dir_all(&self.rows)
            .with_context(|| format!("{} cannot be made", self.rows.display()))?;
        let mut spools = Spools { folder: &self.rows, rows: HashMap::new(), bytes: 0, stop, log: &name };
        let opened = File::open(&self.file).and_then(|mut file| {
            let (log, length) = hashed(&mut file, &name)?;
            file.rewind()?;
            Ok((file, log, length))
        });
        let (rest, log, length) = match opened {
            Ok((file, log, length)) => {
                let take = |cylinder: &str, row: &[u8]| spools.push(cylinder, row);
                (split((file, length), &name, &self.options, take)?, log, length)
            }
            Err(source) => {
                let damage = Some(LogError::Io { file: name.clone(), source });
                (Rest { damage, ..Rest::default() }, Input::of(&name, b""), 0)
            }
        };
        spools.flush()?;
        let mut names: Vec<String> = spools.rows.into_keys().collect();
        names.sort_unstable();
        let cautions = rest.cautions.iter().map(ToString::to_string).collect();
        let damage = rest.damage.map(|damage| format!("{:#}", anyhow::Error::from(damage)));
        if damage.is_none() {
            let whole = self.rows.join(WHOLE);
            std::fs::write(&whole, &key).with_context(|| format!("{} cannot be written", whole.display()))?;
        }
        Ok(Index { key, log: log.into(), length, names, nameless: rest.nameless, cautions, damage })
    }
}

/// File of the rows of a cylinder.
fn place(folder: &Path, cylinder: &str) -> PathBuf {
    folder.join(format!("{}.rows", stem(cylinder)))
}

/// Rows on their way into files.
struct Spools<'a> {
    folder: &'a Path,
    /// Those that wait, by cylinder.
    rows: HashMap<String, Vec<u8>>,
    bytes: usize,
    stop: &'a dyn Fn() -> bool,
    log: &'a str,
}

impl Spools<'_> {
    fn push(&mut self, cylinder: &str, row: &[u8]) -> anyhow::Result<()> {
        match self.rows.get_mut(cylinder) {
            Some(rows) => rows.extend_from_slice(row),
            None => _ = self.rows.insert(cylinder.to_owned(), row.to_vec()),
        }
        self.bytes += row.len();
        if self.bytes > BUFFER { self.flush() } else { Ok(()) }
    }

    /// Adds what waits to the files.
    fn flush(&mut self) -> anyhow::Result<()> {
        if (self.stop)() {
            return Err(LogError::Stopped { at: self.log.to_owned() }.into());
        }
        for (cylinder, rows) in self.rows.iter_mut().filter(|(_, rows)| !rows.is_empty()) {
            let path = place(self.folder, cylinder);
            let added = File::options().create(true).append(true).open(&path);
            added
                .and_then(|mut file| file.write_all(rows))
                .with_context(|| format!("{} cannot be written", path.display()))?;
            *rows = Vec::new();
        }
        self.bytes = 0;
        Ok(())
    }
}
