//! What a candidate may know beforehand.
use cylwatch_estimator::observer::Commissioning;
use cylwatch_estimator::sensor::{Sensor, SensorsSpec};
use cylwatch_thermal::vessel::Vessel;

/// What a candidate may know: nominal vessel, data sheets, the fill as it was stated, discharges that are ordered.
#[derive(Clone, Debug)]
pub struct Told {
    /// Nominal vessel.
    pub vessel: Vessel,
    /// Sensors as their data sheets state them, in the order of the log's channels.
    pub sensors: Vec<Sensor>,
    /// The same as a file of sensors.
    pub sensors_spec: SensorsSpec,
    /// Fill as stated at commissioning.
    pub commissioning: Commissioning,
    /// Discharges that are announced: start and end by the log's clock, s.
    pub announced: Vec<(f64, f64)>,
}
