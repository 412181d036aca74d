//! Built-in scenarios: the files of `presets/scenarios`, embedded, with the tables they name.
use std::io;

use super::{Scenario, read_scenario};
use crate::ThermalError;
use crate::document::unknown_preset;

const FILES: [(&str, &str); 1] = [
    ("shock-cold", include_str!("../../presets/scenarios/shock-cold.toml")),
];

const TABLES: [(&str, &str); 0] = [];

/// Names of the built-in scenarios.
pub fn names() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name)
}

/// Text of a built-in scenario's file.
pub fn text(name: &str) -> Option<&'static str> {
    FILES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// Text of a table that a built-in scenario names.
///
/// # Errors
/// [`io::ErrorKind::NotFound`] for any other name.
pub fn table(file: &str) -> io::Result<String> {
    let found = TABLES.iter().find(|(known, _)| *known == file);
    found.map(|(_, text)| (*text).to_owned()).ok_or_else(|| {
        io::Error::new(io::ErrorKind::NotFound, "the built-in scenarios have no such table")
    })
}

/// A built-in scenario.
///
/// # Errors
/// [`ThermalError::UnknownPreset`] for any other name.
pub fn load(name: &str) -> Result<Scenario, ThermalError> {
    let text = text(name).ok_or_else(|| unknown_preset("scenario", name, names()))?;
    read_scenario(text, &format!("scenarios/{name}.toml"), &table)
}
