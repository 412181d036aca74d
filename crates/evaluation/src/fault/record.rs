//! What arrives at a monitor: rows, and the times at which it loses its power.
use serde::{Deserialize, Serialize};

use crate::EvaluationError;

/// What arrives, in the order in which it does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Names of the sensors in the order of the readings, e.g. `shoulder`, `valve`, `pressure`, `ambient`.
    pub sensors: Vec<String>,
    /// What arrives.
    pub steps: Vec<Step>,
}

/// One arrival.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Step {
    /// A row.
    Row(Arrival),
    /// The power fails and comes back: the monitor goes on from a snapshot.
    PowerCycle(Snapshot),
}

/// A row as it arrives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Arrival {
    /// Time as stamped, s.
    pub stamp_s: f64,
    /// Time at which it was measured, s: what the stamp would be with a good clock.
    pub(crate) measured_s: f64,
    /// Readings, SI, NaN where missing.
    pub readings: Vec<f64>,
    /// Whether the row says that it is replayed from a store.
    pub historical: bool,
}

/// State that a monitor finds when the power comes back.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Snapshot {
    /// That of the last row.
    Current,
    /// One of an hour before.
    Old,
    /// One that was cut off while it was written.
    Truncated,
    /// One in which bytes have changed.
    Corrupted,
    /// One of a monitor with other sensors.
    Foreign,
}

impl Record {
    /// Index of a sensor.
    ///
    /// # Errors
    /// [`EvaluationError::NoSuchSensor`]: there is none of that name.
    pub(crate) fn sensor(&self, name: &str) -> Result<usize, EvaluationError> {
        index_of(&self.sensors, name)
    }

    /// The rows, in the order in which they arrive.
    pub fn rows(&self) -> impl Iterator<Item = &Arrival> {
        self.steps.iter().filter_map(Step::row)
    }

    /// The rows, to change them.
    pub(crate) fn rows_mut(&mut self) -> impl Iterator<Item = &mut Arrival> {
        self.steps.iter_mut().filter_map(|step| match step {
            Step::Row(arrival) => Some(arrival),
            Step::PowerCycle(_) => None,
        })
    }

    /// Without a sensor, e.g. one that a fault needed but the monitor has not.
    pub fn without(mut self, name: &str) -> Self {
        if let Ok(index) = self.sensor(name) {
            self.sensors.remove(index);
            for row in self.rows_mut() {
                row.readings.remove(index);
            }
        }
        self
    }
}

impl Step {
    /// The row, if it is one.
    pub(crate) fn row(&self) -> Option<&Arrival> {
        match self {
            Self::Row(arrival) => Some(arrival),
            Self::PowerCycle(_) => None,
        }
    }
}

impl Arrival {
    /// A row that comes when it is stamped.
    pub fn live(stamp_s: f64, readings: Vec<f64>) -> Self {
        Self { stamp_s, measured_s: stamp_s, readings, historical: false }
    }
}

fn index_of(sensors: &[String], name: &str) -> Result<usize, EvaluationError> {
    sensors
        .iter()
        .position(|sensor| sensor == name)
        .ok_or_else(|| EvaluationError::NoSuchSensor { sensor: name.to_owned(), known: sensors.join(", ") })
}
