//! What can be wrong with a document or a value, in words that name key, value, bound and remedy.
use alloc::borrow::ToOwned;
use alloc::string::String;

/// A fault of a document or of a specification; where it is stands in the error around it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// The text is not TOML (or not CSV).
    #[error("the text cannot be read: {message}")]
    Syntax {
        /// The parser's words, in one line.
        message: String,
    },
    /// A key that means nothing here.
    #[error("unknown key {key}{nearest}; known here: {known}")]
    UnknownKey {
        /// Key as written, with its table.
        key: String,
        /// Suggestion, empty or `, did you mean ...?`.
        nearest: String,
        /// The keys of this table.
        known: String,
    },
    /// A quantity without a unit.
    #[error("{key} has no unit: write {example}, or another of {units}")]
    NoUnit {
        /// Key as written, with its table.
        key: String,
        /// Key with the customary unit.
        example: String,
        /// Suffixes that would be right.
        units: String,
    },
    /// A quantity in a unit that is unknown or of another dimension.
    #[error("{key} is in _{unit}, which is no unit of {quantity}: use one of {units}")]
    WrongUnit {
        /// Key as written, with its table.
        key: String,
        /// Suffix as written.
        unit: String,
        /// The quantity.
        quantity: String,
        /// Suffixes that would be right.
        units: String,
    },
    /// One quantity in two units.
    #[error("{key} says again what {first} in line {first_line} says: keep one of them")]
    Twice {
        /// Second key, with its table.
        key: String,
        /// First key.
        first: String,
        /// Line of the first key.
        first_line: usize,
    },
    /// A value of another type than the key takes.
    #[error("{key} = {text} must be {expected}")]
    WrongType {
        /// Key as written, with its table.
        key: String,
        /// Value as written.
        text: String,
        /// What it has to be.
        expected: String,
    },
    /// NaN, an infinity, or a number too large for floating point.
    #[error("{key} = {text} must be a finite number: write a number or leave it out")]
    NotFinite {
        /// Key as written, with its table.
        key: String,
        /// Value as written.
        text: String,
    },
    /// A word that is none of the choices.
    #[error("{key} = {text} is not known{nearest}; choose one of {known}")]
    UnknownChoice {
        /// Key as written, with its table.
        key: String,
        /// Value as written.
        text: String,
        /// Suggestion, empty or `, did you mean ...?`.
        nearest: String,
        /// The choices.
        known: String,
    },
    /// A key that has to be there.
    #[error("{key} is missing: {remedy}")]
    Missing {
        /// The key, with its table.
        key: String,
        /// What to do.
        remedy: String,
    },
    /// Two keys that cannot stand together.
    #[error("{key} cannot stand beside {other}: {remedy}")]
    Conflict {
        /// The key, with its table.
        key: String,
        /// The other key.
        other: String,
        /// What to do.
        remedy: String,
    },
    /// A value out of its bounds.
    #[error("{key} = {text} must be {bound}: {remedy}")]
    Value {
        /// The key, with its table.
        key: String,
        /// The value, as written where it comes from a file.
        text: String,
        /// The bound it breaks.
        bound: String,
        /// What to do.
        remedy: String,
    },
}

/// The key as people read it: the tables of `path` without indices, then the key itself.
pub(crate) fn with_table(path: &str, key: &str) -> String {
    match path.rsplit_once('.') {
        Some((table, _)) => format!("{} {key}", without_indices(table)),
        None => key.to_owned(),
    }
}

/// A path without its indices: `layer[1].cells` is `layer.cells`.
pub(crate) fn without_indices(path: &str) -> String {
    let mut inside = false;
    path.chars()
        .filter(|&c| {
            let keep = !inside && c != '[';
            inside = if inside { c != ']' } else { c == '[' };
            keep
        })
        .collect()
}
