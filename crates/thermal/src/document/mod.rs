//! Reading of TOML documents whose keys carry units.
//!
//! A specification is a plain struct that derives `Deserialize` and whose fields are SI, with the unit in the
//! name (`fill_pressure_pa`). The reader matches a document's key with a field by quantity and dimension, so
//! that `fill_pressure_bar` and `fill_pressure_psig` both arrive in Pa; see [`crate::units`]. Every value's
//! place is kept under its path (`layer[1].thickness_m`), so that a bound that is checked after reading still
//! points at file, line and text as they were written.
pub mod check;
#[cfg(feature = "simulate")]
pub(crate) mod column;
mod keys;
mod presets;
mod read_error;
pub mod schema;
mod value;

use std::cell::RefCell;
use std::collections::BTreeMap;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde::de::value::BorrowedStrDeserializer;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::ThermalError;
pub use crate::problem::Problem;
use crate::problem::with_table;
pub use presets::Presets;
use read_error::ReadError;
use value::ValueReader;

/// Where a value stands and how it was written.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Place {
    /// Line, from 1.
    pub line: usize,
    /// Key as written.
    pub key: String,
    /// Value as written; empty for a table.
    pub text: String,
}

/// The places of a document's values by path.
#[derive(Clone, Debug)]
pub struct Places {
    file: String,
    by_path: BTreeMap<String, Place>,
}

impl Places {
    /// Key and value of a path as they are written; a long value is cut.
    pub fn written(&self, path: &str) -> Option<(&str, &str)> {
        self.by_path.get(path).map(|place| (place.key.as_str(), place.text.as_str()))
    }

    /// The place of a path, or of the innermost table around it that the document has.
    pub(crate) fn nearest(&self, path: &str) -> Option<(&str, &Place)> {
        let mut path = path;
        loop {
            if let Some((found, place)) = self.by_path.get_key_value(path) {
                return Some((found, place));
            }
            let cut = path.rfind(['.', '['])?;
            path = &path[..cut];
        }
    }

    /// Turns an error about a path into one about a line of the file; other errors pass.
    pub fn locate(&self, error: ThermalError) -> ThermalError {
        let ThermalError::Specification { path, problem } = error else { return error };
        let problem = *problem;
        let nearest = self.nearest(&path);
        let line = nearest.map_or(1, |(_, place)| place.line);
        let problem = match (problem, nearest) {
            (Problem::Value { bound, remedy, .. }, Some((found, place))) if found == path => {
                let key = with_table(&path, &place.key);
                Problem::Value { key, text: place.text.clone(), bound, remedy }
            }
            (Problem::UnknownChoice { nearest, known, .. }, Some((found, place))) if found == path => {
                let key = with_table(&path, &place.key);
                Problem::UnknownChoice { key, text: place.text.clone(), nearest, known }
            }
            (Problem::Conflict { other, remedy, .. }, Some((found, place))) if found == path => {
                Problem::Conflict { key: with_table(&path, &place.key), other, remedy }
            }
            (problem, _) => problem,
        };
        ThermalError::Document { file: self.file.clone(), line, problem: Box::new(problem) }
    }
}

/// What the reader of a value needs to know of the whole document.
struct Context<'t> {
    text: &'t str,
    line_starts: Vec<usize>,
    places: RefCell<BTreeMap<String, Place>>,
}

impl Context<'_> {
    fn line(&self, offset: usize) -> usize {
        self.line_starts.partition_point(|&start| start <= offset).max(1)
    }

    /// The value as written, on one line and not longer than a message bears.
    fn written(&self, span: std::ops::Range<usize>) -> String {
        let text = self.text.get(span).unwrap_or_default();
        let line = text.lines().next().unwrap_or_default();
        match line.char_indices().nth(60) {
            Some((cut, _)) => format!("{}...", &line[..cut]),
            None => line.to_owned(),
        }
    }
}

/// A specification as a document in SI units.
///
/// # Errors
/// [`ThermalError::Unwritable`] if a value has no TOML form.
pub fn to_toml<T: Serialize>(specification: &T) -> Result<String, ThermalError> {
    toml::to_string(specification).map_err(|error| ThermalError::Unwritable { message: error.to_string() })
}

/// Reads a document into a specification.
///
/// # Errors
/// [`ThermalError::Document`] for text that is no TOML, keys that are unknown, without unit, in a unit of another
/// dimension, twice or missing, and values of a wrong type or not finite.
pub fn read<T: DeserializeOwned>(text: &str, file: &str) -> Result<(T, Places), ThermalError> {
    let starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1));
    let context = Context { text, line_starts: starts.collect(), places: RefCell::default() };
    let document =
        |line, problem| ThermalError::Document { file: file.to_owned(), line, problem: Box::new(problem) };
    let table = DeTable::parse(text).map_err(|error| {
        let line = error.span().map_or(1, |span| context.line(span.start));
        document(line, Problem::Syntax { message: error.message().replace('\n', ", ") })
    })?;
    let span = table.span();
    let root = Spanned::new(span, DeValue::Table(table.into_inner()));
    let reader = ValueReader::root(&root, &context);
    match T::deserialize(reader) {
        Ok(specification) => {
            Ok((specification, Places { file: file.to_owned(), by_path: context.places.into_inner() }))
        }
        Err(ReadError::Placed(placed)) => Err(document(placed.0, placed.1)),
        Err(other) => Err(document(1, Problem::Syntax { message: other.to_string() })),
    }
}

/// A field's name, as serde wants to have it.
fn field_name(name: &'static str) -> BorrowedStrDeserializer<'static, ReadError> {
    BorrowedStrDeserializer::new(name)
}

/// `, did you mean x?` for the candidate most similar to `word`, or nothing if none is.
pub(crate) fn suggestion<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    candidates
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(word, candidate), candidate))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(similarity, _)| *similarity > 0.75)
        .map_or(String::new(), |(_, candidate)| format!(", did you mean {candidate}?"))
}
