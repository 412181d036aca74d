//! Built-in scenarios: the files of `presets/scenarios`, embedded, with the tables they name.
use std::io;

use super::{Scenario, read_scenario};
use crate::ThermalError;
use crate::document::Presets;

/// The built-in scenarios.
pub const FILES: Presets = Presets {
    kind: "scenario",
    files: &[
        ("shock-cold", include_str!("../../presets/scenarios/shock-cold.toml")),
        ("tunnel-winter", include_str!("../../presets/scenarios/tunnel-winter.toml")),
        ("ramp-warm", include_str!("../../presets/scenarios/ramp-warm.toml")),
        ("cool-down", include_str!("../../presets/scenarios/cool-down.toml")),
        ("tunnel-step", include_str!("../../presets/scenarios/tunnel-step.toml")),
        ("leak-after-tunnel", include_str!("../../presets/scenarios/leak-after-tunnel.toml")),
        ("bottle-step", include_str!("../../presets/scenarios/bottle-step.toml")),
        ("haque-i1", include_str!("../../presets/scenarios/haque-i1.toml")),
        ("railway-week", include_str!("../../presets/scenarios/railway-week.toml")),
        ("refill-from-bank", include_str!("../../presets/scenarios/refill-from-bank.toml")),
    ],
};

const TABLES: [(&str, &str); 1] =
    [("railway-week.csv", include_str!("../../presets/scenarios/railway-week.csv"))];

/// Text of a table that a built-in scenario names.
///
/// # Errors
/// [`io::ErrorKind::NotFound`] for any other name.
pub fn table(file: &str) -> io::Result<String> {
    let found = TABLES.iter().find(|(known, _)| *known == file);
    found
        .map(|(_, text)| (*text).to_owned())
        .ok_or_else(|| io::Error::new(io::ErrorKind::NotFound, "the built-in scenarios have no such table"))
}

/// A built-in scenario.
///
/// # Errors
/// [`ThermalError::UnknownPreset`] for any other name.
pub fn load(name: &str) -> Result<Scenario, ThermalError> {
    read_scenario(FILES.text(name)?, &format!("scenarios/{name}.toml"), &table)
}
