//! What is laid over a world: leaks, fast losses, discharges, refills, and the faults of the fault table.
use cylwatch_thermal::units::HOUR_S;
use serde::{Deserialize, Serialize};

use super::WorldError;

pub use crate::fault::TableRow as FaultRow;

/// What is laid over a world. Parts are of the gas that the cylinder begins with; onsets are true times from the start of the log.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "overlay")]
pub enum Overlay {
    /// Nothing: a tight cylinder with good sensors.
    #[default]
    Nothing,
    /// A leak of constant mass flow.
    Leak {
        /// Part of the gas per hour.
        part_per_h: f64,
        /// Onset, s.
        onset_s: f64,
    },
    /// A fast loss that nobody ordered.
    FastLoss {
        /// Part of the gas that is lost within the time.
        part: f64,
        /// Time within which it is lost, s.
        within_s: f64,
        /// Onset, s.
        onset_s: f64,
        /// Whether it goes on at its rate afterwards, until a fifth of the gas is left.
        goes_on: bool,
    },
    /// A discharge.
    Discharge {
        /// Part of the gas that is let out.
        part: f64,
        /// Time within which it is let out, s.
        within_s: f64,
        /// Onset, s.
        onset_s: f64,
        /// Whether the candidate is told beforehand.
        announced: bool,
    },
    /// Gas is put in.
    Refill {
        /// Part of the gas that is added.
        part: f64,
        /// Time within which it is added, s.
        within_s: f64,
        /// Onset, s.
        onset_s: f64,
    },
    /// A fault of the fault table, its parameters drawn by the request's seed and set.
    Fault {
        /// Row of the table.
        row: FaultRow,
        /// Onset, s.
        onset_s: f64,
        /// A leak beside it.
        #[serde(default)]
        leak: Option<Leak>,
    },
}

/// A leak of constant mass flow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Leak {
    /// Part of the gas per hour.
    pub part_per_h: f64,
    /// Onset, s.
    pub onset_s: f64,
}

impl Leak {
    /// Whether it has to be simulated.
    fn is_simulated(&self, length_s: f64) -> bool {
        let part = self.part_per_h * (length_s - self.onset_s).max(0.0) / HOUR_S;
        self.part_per_h > SLOW_PART_PER_H || part > SLOW_PART
    }
}

/// Largest leak that is laid over a finished simulation, part of the gas per hour, and largest part that it may lose in all: that the
/// gas is not cooled by its own expansion, and that less gas follows the wall sooner, then stays below a transmitter's noise.
const SLOW_PART_PER_H: f64 = 1e-4;
const SLOW_PART: f64 = 0.005;

impl Overlay {
    /// Whether it changes the simulation; else it is laid over a finished one.
    pub fn is_simulated(&self, length_s: f64) -> bool {
        match *self {
            Self::Nothing => false,
            Self::Leak { part_per_h, onset_s } => Leak { part_per_h, onset_s }.is_simulated(length_s),
            Self::FastLoss { .. } | Self::Discharge { .. } | Self::Refill { .. } => true,
            Self::Fault { row, leak, .. } => {
                !row.is_of_data() || leak.is_some_and(|leak| leak.is_simulated(length_s))
            }
        }
    }

    /// What of it is simulated: a fault of data leaves its leak alone.
    pub(super) fn simulated_part(&self, length_s: f64) -> Self {
        match *self {
            _ if !self.is_simulated(length_s) => Self::Nothing,
            Self::Fault { row, leak: Some(leak), .. } if row.is_of_data() => {
                Self::Leak { part_per_h: leak.part_per_h, onset_s: leak.onset_s }
            }
            other => other,
        }
    }

    /// Its leak.
    pub fn leak(&self) -> Option<Leak> {
        match *self {
            Self::Leak { part_per_h, onset_s } => Some(Leak { part_per_h, onset_s }),
            Self::Fault { leak, .. } => leak,
            _ => None,
        }
    }

    /// When it begins, s; `None` for nothing.
    pub const fn onset_s(&self) -> Option<f64> {
        match *self {
            Self::Nothing => None,
            Self::Leak { onset_s, .. }
            | Self::FastLoss { onset_s, .. }
            | Self::Discharge { onset_s, .. }
            | Self::Refill { onset_s, .. }
            | Self::Fault { onset_s, .. } => Some(onset_s),
        }
    }

    /// Check its numbers.
    ///
    /// # Errors
    /// [`WorldError::Number`] with the first one outside its range.
    pub fn validate(&self) -> Result<(), WorldError> {
        let check = |what, value: f64, (low, high): (f64, f64)| {
            let is_within = value >= low && value <= high;
            if is_within { Ok(()) } else { Err(WorldError::Number { what, value, low, high }) }
        };
        check("onset_s", self.onset_s().unwrap_or(0.0), (0.0, 1e9))?;
        if let Some(leak) = self.leak() {
            check("part_per_h", leak.part_per_h, (0.0, 10.0))?;
            check("leak onset_s", leak.onset_s, (0.0, 1e9))?;
        }
        match *self {
            Self::FastLoss { part, within_s, .. }
            | Self::Discharge { part, within_s, .. }
            | Self::Refill { part, within_s, .. } => {
                check("part", part, (1e-6, 0.95))?;
                check("within_s", within_s, (1.0, 1e7))
            }
            Self::Nothing | Self::Leak { .. } | Self::Fault { .. } => Ok(()),
        }
    }
}
