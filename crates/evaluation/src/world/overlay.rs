//! What is laid over a world: leaks, fast losses, discharges, refills, and the faults of the fault table.
use serde::{Deserialize, Serialize};

/// A row of the fault table.
pub type FaultRow = cylwatch_detector::performance::fault::TableRow;

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
        /// Whether it goes on at its rate afterwards, until a twentieth of the gas is left.
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
    /// A fault of the fault table, its parameters drawn by the request's seed.
    Fault {
        /// Row of the table.
        row: FaultRow,
        /// Onset, s.
        onset_s: f64,
    },
}
