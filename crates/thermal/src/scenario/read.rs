//! Scenario files: reading, schema.
use super::{Scenario, ScenarioSpec};
use crate::ThermalError;
use crate::document;

/// Reads a scenario file; `source` is its name in messages, `files` reads the CSV files that it names.
///
/// # Errors
/// [`ThermalError::Document`] with file, line, value and remedy for whatever is wrong with the text or a table.
pub fn read_scenario(
    text: &str,
    source: &str,
    files: &dyn Fn(&str) -> std::io::Result<String>,
) -> Result<Scenario, ThermalError> {
    let (specification, places) = document::read::<ScenarioSpec>(text, source)?;
    specification.build(files).map_err(|error| places.locate(error))
}

/// JSON schema of scenario files.
pub fn schema() -> serde_json::Value {
    document::schema::of::<ScenarioSpec>("cylwatch scenario")
}
