//! Files of sensors with their priors: `[[sensor]]` tables as in a scenario.
use super::{Sensor, SensorSuite};
use crate::EstimatorError;
use cylwatch_thermal::document;
use cylwatch_thermal::sensor::{SensorSpec, mounted};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Raw content of a file of sensors. Whatever a table leaves out is that of the typical sensor of its kind
/// ([`Sensor::typical`]); in a scenario it would be nothing.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema, PartialEq)]
pub struct SensorsSpec {
    /// Sensors.
    pub sensor: Vec<SensorSpec>,
}

impl SensorsSpec {
    /// Checks the sensors and fills in the typical numbers.
    ///
    /// # Errors
    /// [`EstimatorError::Thermal`] with the path of the first value that breaks a bound.
    pub fn build(&self) -> Result<SensorSuite, EstimatorError> {
        let complete: Vec<SensorSpec> = self.sensor.iter().map(SensorSpec::completed).collect();
        SensorSuite::try_new(mounted(&complete, "sensor")?.iter().map(Sensor::from).collect())
    }

    /// Typical sensors of these names.
    pub fn typical(names: &[&str]) -> Self {
        let of = |name: &&str| SensorSpec { name: (*name).to_owned(), ..SensorSpec::default() };
        Self { sensor: names.iter().map(of).collect() }
    }

    /// The content as a file of sensors in SI units.
    ///
    /// # Errors
    /// [`EstimatorError::Thermal`] if a value has no TOML form.
    pub fn to_toml(&self) -> Result<String, EstimatorError> {
        Ok(document::to_toml(self)?)
    }
}

/// Reads a file of sensors; `source` is its name in messages.
///
/// # Errors
/// [`EstimatorError::Thermal`] with file, line, value and remedy for whatever is wrong with the text.
pub fn read_sensors(text: &str, source: &str) -> Result<(SensorsSpec, SensorSuite), EstimatorError> {
    let (specification, places) = document::read::<SensorsSpec>(text, source)?;
    let suite = specification.build().map_err(|error| match error {
        EstimatorError::Thermal(error) => places.locate(error).into(),
        other => other,
    })?;
    Ok((specification, suite))
}

/// JSON schema of files of sensors.
pub fn schema() -> serde_json::Value {
    document::schema::of::<SensorsSpec>("cylwatch sensors")
}
