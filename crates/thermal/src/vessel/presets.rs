//! Built-in vessels: the files of `presets/vessels`, embedded.
use super::{Vessel, read_vessel};
use crate::ThermalError;
use crate::document::unknown_preset;

const FILES: [(&str, &str); 4] = [
    ("nitrogen-20l", include_str!("../../presets/vessels/nitrogen-20l.toml")),
    ("nitrogen-20l-paper", include_str!("../../presets/vessels/nitrogen-20l-paper.toml")),
    ("closed-bottle", include_str!("../../presets/vessels/closed-bottle.toml")),
    ("haque-i1", include_str!("../../presets/vessels/haque-i1.toml")),
];

/// Names of the built-in vessels.
pub fn names() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name)
}

/// Text of a built-in vessel's file.
pub fn text(name: &str) -> Option<&'static str> {
    FILES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// A built-in vessel.
///
/// # Errors
/// [`ThermalError::UnknownPreset`] for any other name.
pub fn load(name: &str) -> Result<Vessel, ThermalError> {
    let text = text(name).ok_or_else(|| unknown_preset("vessel", name, names()))?;
    read_vessel(text, &format!("vessels/{name}.toml"))
}
