//! What serde and the reader of values tell each other when something is wrong.
use std::fmt;

use serde::de::{self, Expected, Unexpected};

use crate::problem::Problem;

/// A problem on its way up, first without and then with its line.
#[derive(Debug)]
pub(super) enum ReadError {
    /// The value has another type.
    Type { expected: String },
    /// A table lacks a field.
    Missing { field: &'static str },
    /// A word is none of the choices.
    Choice { known: &'static [&'static str] },
    /// Anything else that serde says.
    Other(String),
    /// With its line.
    Placed(Box<(usize, Problem)>),
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Type { expected } => write!(f, "expected {expected}"),
            Self::Missing { field } => write!(f, "missing {field}"),
            Self::Choice { known } => write!(f, "expected one of {}", known.join(", ")),
            Self::Other(message) => f.write_str(message),
            Self::Placed(placed) => write!(f, "line {}: {}", placed.0, placed.1),
        }
    }
}

impl std::error::Error for ReadError {}

impl de::Error for ReadError {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self::Other(message.to_string())
    }

    fn invalid_type(_: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::Type { expected: in_words(&expected.to_string()) }
    }

    fn invalid_value(_: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::Type { expected: in_words(&expected.to_string()) }
    }

    fn missing_field(field: &'static str) -> Self {
        Self::Missing { field }
    }

    fn unknown_variant(_: &str, expected: &'static [&'static str]) -> Self {
        Self::Choice { known: expected }
    }
}

/// Rust's words for a type in the words of a file's author.
fn in_words(expected: &str) -> String {
    match expected {
        "usize" | "u64" | "u32" => "a whole number of at least 0".to_owned(),
        "f64" => "a number".to_owned(),
        "a string" => "text in quotes".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "a sequence" => "a list".to_owned(),
        other if other.starts_with("struct ") => "a table".to_owned(),
        other => other.to_owned(),
    }
}
