//! Logs of several cylinders: a column `cylinder` says whose row it is.
//!
//! Such a log is read once and its rows are [handed out](split) by cylinder, each as it stood in its line, so that what is read of a
//! cylinder then is what a log of its own would give.
use super::caution::{Cautions, Kind};
use super::cell::{Cell, shown};
use super::header::Header;
use super::label::is_cylinder;
use super::record::Records;
use super::{Caution, LogError, LogOptions, is_parquet};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// What a log holds beside rows of cylinders.
#[derive(Debug, Default)]
pub(crate) struct Rest {
    /// Line of the first row that names no cylinder.
    pub nameless: Option<u64>,
    /// What was left out.
    pub cautions: Vec<Caution>,
    /// Why the log cannot be read on.
    pub damage: Option<LogError>,
}

/// Whether a file has a column `cylinder`.
///
/// # Errors
/// Its header cannot be read.
pub(crate) fn has_column(path: &Path, options: &LogOptions) -> Result<bool, LogError> {
    let file = path.display().to_string();
    let opened = File::open(path).map_err(|source| LogError::Io { file: file.clone(), source })?;
    let mut records = Records::new(text(opened, &file, u64::MAX)?, &file)?;
    let header = Header::read(&mut records, options)?;
    Ok(header.is_some_and(|header| header.names.iter().any(|name| is_cylinder(name))))
}

/// Reads a log with a column `cylinder` up to a length and hands out each row: whose it is, and its bytes for a spool.
///
/// # Errors
/// `take` fails. What is wrong with the log is told in what is [left](Rest::damage).
pub(crate) fn split<E>(
    (input, length): (File, u64),
    file: &str,
    options: &LogOptions,
    mut take: impl FnMut(&str, &[u8]) -> Result<(), E>,
) -> Result<Rest, E> {
    let mut splitter = match Splitter::open((input, length), file, options) {
        Ok(splitter) => splitter,
        Err(damage) => return Ok(Rest { damage: Some(damage), ..Rest::default() }),
    };
    let mut frame = Vec::new();
    let damage = loop {
        match splitter.records.advance() {
            Ok(true) => {}
            Ok(false) => break None,
            Err(damage) => break Some(damage),
        }
        if let Some(name) = splitter.name() {
            frame.clear();
            splitter.records.spool(&mut frame);
            take(&name, &frame)?;
        }
    };
    let Splitter { nameless, cautions, .. } = splitter;
    Ok(Rest { nameless, cautions: cautions.list().to_vec(), damage })
}

/// Tells whose a row is.
struct Splitter {
    records: Records,
    header: Vec<Vec<u8>>,
    /// Position of the column.
    at: usize,
    decimal_comma: bool,
    nameless: Option<u64>,
    cautions: Cautions,
}

impl Splitter {
    fn open((input, length): (File, u64), file: &str, options: &LogOptions) -> Result<Self, LogError> {
        let mut records = Records::new(text(input, file, length)?, file)?;
        let header = Header::read(&mut records, options)?;
        let header = header.ok_or_else(|| LogError::Empty { file: file.to_owned() })?;
        let at = header.names.iter().position(|name| is_cylinder(name));
        let at = at.ok_or_else(|| LogError::Empty { file: file.to_owned() })?;
        let decimal_comma = header.separator != b',';
        let cautions = Cautions::default();
        Ok(Self { records, header: header.cells, at, decimal_comma, nameless: None, cautions })
    }

    /// The cylinder of the record; `None`: it is a row of none.
    fn name(&mut self) -> Option<String> {
        let Self { records, header, at, .. } = self;
        if records.iter().all(|cell| cell.trim_ascii().is_empty()) {
            return None;
        }
        if records.iter().eq(&*header) {
            self.cautions.count(Kind::HeaderAgain, "", || (records.place(), String::new()));
            return None;
        }
        // The last line of a log that is being written may lack the end of the name.
        let is_short = records.len() < header.len();
        if is_short && records.is_cut() && records.len() <= *at + 1 {
            self.cautions.count(Kind::CutOff, "", || (records.place(), String::new()));
            return None;
        }
        if is_short && self.is_words() {
            let (records, cautions) = (&self.records, &mut self.cautions);
            cautions.count(Kind::Remark, "", || (records.place(), shown(records.text())));
            return None;
        }
        let (records, at) = (&self.records, self.at);
        let cell = if records.len() > at { records.cell(at).trim_ascii() } else { b"" };
        if !cell.is_empty() {
            return Some(String::from_utf8_lossy(cell).into_owned());
        }
        self.nameless = self.nameless.or(Some(self.records.line()));
        None
    }

    fn is_words(&self) -> bool {
        let is_word = |cell| matches!(Cell::read(cell, self.decimal_comma), Cell::Unreadable | Cell::Missing);
        self.records.iter().all(is_word)
    }
}

/// The text of a file up to a length; of a Parquet file the text that all of its rows make.
pub(super) fn text(file: File, name: &str, length: u64) -> Result<Box<dyn Read>, LogError> {
    if !is_parquet(Path::new(name)) {
        return Ok(Box::new(file.take(length)));
    }
    #[cfg(feature = "parquet")]
    return Ok(Box::new(super::parquet::text(file, name)?));
    #[cfg(not(feature = "parquet"))]
    Err(LogError::WithoutParquet { file: name.to_owned() })
}
