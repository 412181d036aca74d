//! The data that an operator has of a cylinder, and a candidate is given.
use cylwatch_estimator::observer::Commissioning;
use cylwatch_estimator::sensor::{Sensor, SensorsSpec};
use cylwatch_thermal::vessel::Vessel;

/// Nominal vessel, data sheets, the fill as it was stated, announced discharges.
#[derive(Clone, Debug)]
pub struct OperatorData {
    /// Nominal vessel.
    pub vessel: Vessel,
    /// Sensors as their data sheets state them, in the order of the log's channels.
    pub sensors: Vec<Sensor>,
    /// The same as a file of sensors.
    pub sensors_spec: SensorsSpec,
    /// Fill as stated at commissioning.
    pub commissioning: Commissioning,
    /// Announced discharges: start and end by the log's clock, s.
    pub announced: Vec<(f64, f64)>,
}
