//! Formats of data.
use clap::ValueEnum;
use std::path::Path;

/// Format of data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Comma-separated columns; lines that begin with # say where they come from.
    Csv,
    /// One JSON document with a provenance object.
    Json,
}

impl Format {
    /// The format that an output's name asks for: JSON for `.json`, CSV for all others and for stdout.
    pub(super) fn of(output: Option<&Path>) -> Self {
        let ending = output.and_then(Path::extension);
        if ending.is_some_and(|ending| ending.eq_ignore_ascii_case("json")) { Self::Json } else { Self::Csv }
    }
}
