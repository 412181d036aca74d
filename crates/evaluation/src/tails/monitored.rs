//! A cylinder and what the statistics of its monitor reached.
use cylwatch_detector::monitor::{Monitor, MonitorSettings};

use super::record::Record;
use crate::EvaluationError;
use crate::world::{Request, World};

/// A cylinder that was monitored with one set of sensors.
#[derive(Clone, Debug, PartialEq)]
pub struct MonitoredCylinder {
    /// What decided its world.
    pub request: Request,
    /// What the statistics reached.
    pub record: Record,
}

/// Run the monitor over a world and keep what its statistics reach.
///
/// # Errors
/// What the monitor refuses.
pub fn monitor(world: &World, settings: &MonitorSettings) -> Result<MonitoredCylinder, EvaluationError> {
    let data = &world.operator_data;
    let mut monitor = Monitor::new(&data.vessel, &data.sensors, &data.commissioning, settings)?;
    let mut record = Record::default();
    for (stamp_s, readings) in world.log.rows() {
        for output in monitor.step(stamp_s, readings)? {
            record.update(output.estimate.time_s, &monitor.evidence());
        }
    }
    Ok(MonitoredCylinder { request: world.request, record })
}
