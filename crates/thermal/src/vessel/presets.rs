//! Built-in vessels: the files of `presets/vessels`, embedded.
use super::{Vessel, read_vessel};
use crate::ThermalError;
use crate::document::Presets;

/// The built-in vessels.
pub const FILES: Presets = Presets {
    kind: "vessel",
    files: &[
        ("nitrogen-20l", include_str!("../../presets/vessels/nitrogen-20l.toml")),
        ("nitrogen-20l-paper", include_str!("../../presets/vessels/nitrogen-20l-paper.toml")),
        ("closed-bottle", include_str!("../../presets/vessels/closed-bottle.toml")),
        ("haque-i1", include_str!("../../presets/vessels/haque-i1.toml")),
    ],
};

/// A built-in vessel.
///
/// # Errors
/// [`ThermalError::UnknownPreset`] for any other name.
pub fn load(name: &str) -> Result<Vessel, ThermalError> {
    read_vessel(FILES.text(name)?, &format!("vessels/{name}.toml"))
}
