//! What comes out of the intake.
use alloc::collections::VecDeque;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::super::Event;
use crate::DetectorError;
use crate::monitor::restored::Restored;

/// Readings of a row, one per sensor, SI, NaN where missing; up to eight of them lie in the row itself.
pub type Readings = SmallVec<[f64; 8]>;

/// A row in its place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Time on the internal axis, s: the stamp without the jumps of the clock. Never before that of the row handed out last.
    pub time_s: f64,
    /// Time as it was stamped, s.
    pub stamp_s: f64,
    /// Readings, SI, NaN where missing. A second row of one time has only what the first had not.
    pub readings: Readings,
}

impl Row {
    /// Checks one that was saved.
    pub(in crate::monitor) fn validate(
        &self,
        what: &'static str,
        of: &Restored,
    ) -> Result<(), DetectorError> {
        of.each(what, self.readings.len())?;
        of.time(what, self.time_s)
    }

    /// Take over readings of the same time. New finite ones stand.
    pub(super) fn unite(&mut self, with: &[f64]) -> United {
        let mut united = United::Same;
        for (known, &with) in self.readings.iter_mut().zip(with) {
            let stands = with.is_finite() || (known.is_nan() && !with.is_nan());
            if stands && with.to_bits() != known.to_bits() {
                united = united.max(if known.is_nan() { United::Filled } else { United::Replaced });
                *known = with;
            }
        }
        united
    }
}

/// What rows of one time say together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum United {
    /// No more than the first.
    Same,
    /// The second has what the first had not.
    Filled,
    /// The second has another value of the same.
    Replaced,
}

/// What a step of the intake hands out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Taken {
    /// Rows in order of time.
    pub rows: VecDeque<Row>,
    /// Gaps, jumps of the clock, rows that were too late.
    pub events: Vec<Event>,
}

impl Taken {
    /// Memory for what a row usually makes ready.
    pub(in crate::monitor) fn make_room(&mut self) {
        self.rows.reserve(4);
        self.events.reserve(8);
    }
}

/// What has become of rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Rows that came.
    pub rows: u64,
    /// Rows with nothing new: of a time and readings that were there already.
    pub duplicates: u64,
    /// Rows united with another of the same time.
    pub merged: u64,
    /// Rows with another value for what the row of that time had, which came first and stands if it has been handed out.
    pub contradictions: u64,
    /// Rows later than the lateness, not used.
    pub too_late: u64,
    /// Rows whose stamp was no time or far ahead without confirmation, not used.
    pub wild: u64,
    /// Jumps of the clock.
    pub jumps: u64,
    /// Gaps.
    pub gaps: u64,
}
