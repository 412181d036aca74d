//! Logs of several cylinders: a column `cylinder` says whose row it is.
use super::header::Header;
use super::record::Records;
use super::{LogError, LogOptions, is_parquet};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Name of the column.
const COLUMN: &str = "cylinder";

/// The cylinders of a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Cylinders {
    /// Names, sorted.
    pub names: Vec<String>,
    /// Line of the first row that names none.
    pub nameless: Option<u64>,
}

/// Whether a header is that of the column.
pub(super) fn is_column(header: &str) -> bool {
    header.trim().eq_ignore_ascii_case(COLUMN)
}

/// The cylinders of a file with a column `cylinder`, which is read to its end; `None`: it has no such column.
///
/// # Errors
/// The file cannot be read.
pub(crate) fn cylinders(path: &Path, options: &LogOptions) -> Result<Option<Cylinders>, LogError> {
    let file = path.display().to_string();
    let opened = File::open(path).map_err(|source| LogError::Io { file: file.clone(), source })?;
    let input: Box<dyn Read> = if is_parquet(path) { parquet(opened, &file)? } else { Box::new(opened) };
    let mut records = Records::new(input, &file)?;
    let Some(header) = Header::read(&mut records, options)? else { return Ok(None) };
    let Some(at) = header.names.iter().position(|name| is_column(name)) else { return Ok(None) };
    let mut found = BTreeSet::new();
    let mut nameless = None;
    while records.advance()? {
        if records.len() <= at || records.iter().eq(&header.cells) {
            continue;
        }
        match String::from_utf8_lossy(records.cell(at).trim_ascii()) {
            name if name.is_empty() => nameless = nameless.or(Some(records.line())),
            name if found.contains(name.as_ref()) => {}
            name => _ = found.insert(name.into_owned()),
        }
    }
    Ok(Some(Cylinders { names: found.into_iter().collect(), nameless }))
}

#[cfg(feature = "parquet")]
fn parquet(file: File, name: &str) -> Result<Box<dyn Read>, LogError> {
    Ok(Box::new(super::parquet::text(file, name)?))
}

#[cfg(not(feature = "parquet"))]
fn parquet(_: File, name: &str) -> Result<Box<dyn Read>, LogError> {
    Err(LogError::WithoutParquet { file: name.to_owned() })
}
