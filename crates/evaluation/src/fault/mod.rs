//! Faults put into good rows, to see what a monitor makes of them.
//!
//! A [`Fault`] is a pure function of a [`Record`], an onset and a seed. It changes what the sensors read ([`Fault::Stuck`],
//! [`Fault::Offset`], ...), how rows arrive ([`Fault::OutOfOrder`], [`Fault::ClockJump`], ...), or takes the power away
//! ([`Fault::PowerCycles`]). A [`TableRow`] is one row of the table of faults that a monitor has to survive: it draws a fault of its
//! kind ([`TableRow::draw`]) and says what must come of it ([`TableRow::requirement`]). Rows that happen to the cylinder and not
//! to its data are simulated with the [world](crate::world) that they are laid over.
//!
//! Source of the kinds: E. Balaban et al., IEEE Sensors J. 9 (2009) 1907 (bias, drift, scaling, dropout); B. de Bruijn et al.,
//! Sensors 16 (2016) (random, malfunction, bias, drift).
mod arrival;
mod reading;
mod record;
mod table;

use serde::{Deserialize, Serialize};

pub(crate) use self::arrival::EPOCH_S;
pub use self::reading::{DeadCode, UnitConfusion};
pub use self::record::{Arrival, Record, Snapshot, Step};
pub(crate) use self::table::TABLE_FULL_SCALE_PA;
pub use self::table::{Requirement, TableRow};
use crate::EvaluationError;

/// Something that goes wrong between a cylinder and its monitor. Sizes are in the sensor's unit, K or Pa.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "fault")]
pub enum Fault {
    /// A sensor repeats its reading.
    Stuck {
        /// Sensor.
        sensor: String,
        /// For so long, s.
        lasting_s: f64,
    },
    /// A sensor's readings are off by a constant from the onset on.
    Offset {
        /// Sensor.
        sensor: String,
        /// By so much.
        by: f64,
    },
    /// A sensor's readings move away from the onset on.
    Drift {
        /// Sensor.
        sensor: String,
        /// By so much in a second.
        per_s: f64,
    },
    /// A transmitter's span is wrong, and it depends on the valve's temperature; always, whatever the onset:
    /// `p (1 + share) + per_k (T_valve - 288.15 K)`.
    Span {
        /// Sensor.
        sensor: String,
        /// Relative error of the span.
        share: f64,
        /// Temperature coefficient, Pa/K.
        per_k: f64,
    },
    /// White noise on top of a sensor's own, from the onset on.
    Noise {
        /// Sensor.
        sensor: String,
        /// Its standard deviation.
        sd: f64,
    },
    /// A sensor's readings come in steps; always, whatever the onset.
    Quantised {
        /// Sensor.
        sensor: String,
        /// Step.
        step: f64,
    },
    /// Single readings, or a few in a row, are far off, from the onset on.
    Spikes {
        /// Sensor.
        sensor: String,
        /// How far, to either side.
        height: f64,
        /// Longest number of readings in a row.
        longest: usize,
        /// Share of readings that are off.
        share: f64,
    },
    /// A sensor gives what no sensor measures.
    Dead {
        /// Sensor.
        sensor: String,
        /// What it gives.
        code: DeadCode,
        /// Full scale of a transmitter, Pa.
        full_scale_pa: f64,
        /// For so long, s.
        lasting_s: f64,
    },
    /// Sensors have no readings.
    Lost {
        /// Sensors.
        sensors: Vec<String>,
        /// For so long, s.
        lasting_s: f64,
    },
    /// Two sensors have each other's place; always, whatever the onset.
    Swapped {
        /// One of them.
        first: String,
        /// The other.
        second: String,
    },
    /// Readings are taken in a wrong unit; always, whatever the onset.
    Units {
        /// Sensors.
        sensors: Vec<String>,
        /// Which for which.
        mix_up: UnitConfusion,
    },
    /// A thermometer hangs in the air, from the onset on; the record must have `ambient`.
    Detached {
        /// Sensor.
        sensor: String,
        /// Standard deviation of what the air does between two readings, K.
        noise_k: f64,
    },
    /// The pressure around a gauge transmitter rises and falls: pulses of either sign from the onset on.
    Pulses {
        /// Sensor.
        sensor: String,
        /// Height, Pa.
        height_pa: f64,
        /// Mean duration of a pulse, and of the time between two, s.
        mean_s: f64,
    },
    /// No rows.
    Gap {
        /// For so long, s.
        lasting_s: f64,
    },
    /// Rows come twice, the second time within ten minutes, from the onset on.
    Duplicates {
        /// Share of rows.
        share: f64,
    },
    /// Rows are delayed so that they overtake each other, from the onset on.
    OutOfOrder {
        /// Longest delay, s.
        by_s: f64,
        /// Share of rows that are delayed.
        share: f64,
    },
    /// The rows of a while come all at once after it.
    Replay {
        /// Duration of the while, s.
        length_s: f64,
        /// Whether they came at their time too.
        again: bool,
        /// Whether they say that they are replayed.
        historical: bool,
    },
    /// The clock is off, from the onset on.
    ClockJump {
        /// By so much, s.
        by_s: f64,
        /// For so long, s; `None`: to the end.
        lasting_s: Option<f64>,
    },
    /// The clock runs fast or slow from the onset on.
    ClockDrift {
        /// Relative, 1e-4: 100 ppm fast.
        rate: f64,
    },
    /// Rows come at random intervals from the onset on, linear between those that there are, with noise of their own.
    Irregular {
        /// Shortest interval, s.
        shortest_s: f64,
        /// Longest interval, s; intervals are spread evenly by their logarithm.
        longest_s: f64,
        /// Noise of temperatures, K.
        noise_k: f64,
        /// Noise of pressures, Pa.
        noise_pa: f64,
    },
    /// A sensor's readings are older than their rows say; always, whatever the onset.
    Shifted {
        /// Sensor.
        sensor: String,
        /// By so much, s.
        by_s: f64,
    },
    /// The power fails again and again from the onset on.
    PowerCycles {
        /// Mean time between two, s.
        mean_s: f64,
        /// What the monitor finds afterwards.
        snapshot: Snapshot,
    },
}

impl Fault {
    /// The record with this fault.
    ///
    /// # Errors
    /// The record has no such sensor.
    pub fn inject(&self, record: &Record, onset_s: f64, seed: u64) -> Result<Record, EvaluationError> {
        let mut record = record.clone();
        if !self.change_readings(&mut record, onset_s, seed)? {
            self.change_arrival(&mut record, onset_s, seed)?;
        }
        Ok(record)
    }

    /// One word for a table.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Stuck { .. } => "stuck",
            Self::Offset { .. } => "offset",
            Self::Drift { .. } => "drift",
            Self::Span { .. } => "span",
            Self::Noise { .. } => "noise",
            Self::Quantised { .. } => "quantised",
            Self::Spikes { .. } => "spikes",
            Self::Dead { .. } => "dead",
            Self::Lost { .. } => "lost",
            Self::Swapped { .. } => "swapped",
            Self::Units { .. } => "units",
            Self::Detached { .. } => "detached",
            Self::Pulses { .. } => "pulses",
            Self::Gap { .. } => "gap",
            Self::Duplicates { .. } => "duplicates",
            Self::OutOfOrder { .. } => "out-of-order",
            Self::Replay { .. } => "replay",
            Self::ClockJump { .. } => "clock-jump",
            Self::ClockDrift { .. } => "clock-drift",
            Self::Irregular { .. } => "irregular",
            Self::Shifted { .. } => "shifted",
            Self::PowerCycles { .. } => "power-cycles",
        }
    }

    /// Sensors whose readings are wrong.
    pub(crate) fn sensors(&self) -> Vec<&str> {
        match self {
            Self::Stuck { sensor, .. }
            | Self::Offset { sensor, .. }
            | Self::Drift { sensor, .. }
            | Self::Span { sensor, .. }
            | Self::Noise { sensor, .. }
            | Self::Quantised { sensor, .. }
            | Self::Spikes { sensor, .. }
            | Self::Dead { sensor, .. }
            | Self::Detached { sensor, .. }
            | Self::Pulses { sensor, .. }
            | Self::Shifted { sensor, .. } => vec![sensor],
            Self::Lost { sensors, .. } | Self::Units { sensors, .. } => {
                sensors.iter().map(String::as_str).collect()
            }
            Self::Swapped { first, second } => vec![first, second],
            Self::Gap { .. }
            | Self::Duplicates { .. }
            | Self::OutOfOrder { .. }
            | Self::Replay { .. }
            | Self::ClockJump { .. }
            | Self::ClockDrift { .. }
            | Self::Irregular { .. }
            | Self::PowerCycles { .. } => Vec::new(),
        }
    }

    /// How long it lasts, s; infinity: from its onset to the end.
    pub fn lasting_s(&self) -> f64 {
        match self {
            Self::Stuck { lasting_s, .. }
            | Self::Dead { lasting_s, .. }
            | Self::Lost { lasting_s, .. }
            | Self::Gap { lasting_s } => *lasting_s,
            Self::ClockJump { lasting_s, .. } => lasting_s.unwrap_or(f64::INFINITY),
            Self::Replay { length_s, .. } => *length_s,
            _ => f64::INFINITY,
        }
    }
}
