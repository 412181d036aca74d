//! Vessel files: reading, writing, schema.
use super::{Vessel, VesselSpec};
use crate::ThermalError;
use crate::document;

/// Reads a vessel file; `source` is its name in messages.
///
/// # Errors
/// [`ThermalError::Document`] with file, line, value and remedy for whatever is wrong with the text.
pub fn read_vessel(text: &str, source: &str) -> Result<Vessel, ThermalError> {
    read_specification(text, source).map(|(_, vessel)| vessel)
}

/// Reads a vessel file and keeps its specification beside the vessel, to change values and write it again.
///
/// # Errors
/// Those of [`read_vessel`].
pub fn read_specification(text: &str, source: &str) -> Result<(VesselSpec, Vessel), ThermalError> {
    let (specification, places) = document::read::<VesselSpec>(text, source)?;
    let vessel = specification.build().map_err(|error| places.locate(error))?;
    Ok((specification, vessel))
}

impl VesselSpec {
    /// The specification as a vessel file in SI units.
    ///
    /// # Errors
    /// [`ThermalError::Unwritable`] if a value has no TOML form.
    pub fn to_toml(&self) -> Result<String, ThermalError> {
        document::to_toml(self)
    }
}

/// JSON schema of vessel files.
pub fn schema() -> serde_json::Value {
    document::schema::of::<VesselSpec>("cylwatch vessel")
}
