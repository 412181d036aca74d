//! Typical sensors, for a log of which nothing but its columns is known.
use super::Sensor;
use crate::EstimatorError;
use cylwatch_thermal::sensor::SensorSpec;

impl Sensor {
    /// The typical sensor of a log's column: `shoulder`, `valve`, `wall_<place>`, `ambient`, `pressure`, `gas_<k>`.
    ///
    /// # Errors
    /// [`EstimatorError::Thermal`] for a name that says no place.
    pub fn typical(name: &str) -> Result<Self, EstimatorError> {
        let spec = SensorSpec { name: name.to_owned(), ..SensorSpec::default() };
        Self::try_from(&spec.completed())
    }

    /// The typical thermometer on the wall at a height above the outer bottom, m: `wall_<height in mm>mm`.
    ///
    /// # Errors
    /// As [`Sensor::typical`].
    pub fn typical_at_height(height_m: f64) -> Result<Self, EstimatorError> {
        let name = format!("wall_{:.0}mm", 1e3 * height_m);
        let spec = SensorSpec { name, height_m: Some(height_m), ..SensorSpec::default() };
        Self::try_from(&spec.completed())
    }
}
