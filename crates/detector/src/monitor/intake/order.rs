//! Rows that wait for later ones to overtake them, sorted by time, rows of one time united.
use alloc::collections::VecDeque;

use serde::{Deserialize, Serialize};

use super::row::{Row, United};
use crate::DetectorError;
use crate::monitor::restored::{self, Restored};

/// Rows that are held back at most; the oldest one beyond that is handed out early.
const HELD_AT_MOST: usize = 4096;

/// What became of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Inserted {
    /// It waits.
    New,
    /// It waits in one with another of its time.
    Merged,
    /// It says nothing new.
    Duplicate,
    /// It says something else than the one of its time.
    Contradicts,
    /// A row of a later time has been handed out.
    TooLate,
}

/// Rows that wait, and the one that was handed out last.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Order {
    waiting: VecDeque<Row>,
    handed_out: Option<Row>,
}

impl Order {
    /// Checks one that was saved.
    pub(super) fn validate(&self, of: &Restored) -> Result<(), DetectorError> {
        restored::at_most(HELD_AT_MOST + 1, "intake.waiting", self.waiting.len())?;
        self.waiting.iter().chain(&self.handed_out).try_for_each(|row| row.validate("intake.waiting", of))
    }

    /// Memory for the rows that wait where none are late.
    pub(super) fn make_room(&mut self) {
        self.waiting.reserve(4);
    }

    /// Put a row in its place.
    pub(super) fn insert(&mut self, mut row: Row) -> Inserted {
        match &self.handed_out {
            Some(last) if row.time_s < last.time_s => return Inserted::TooLate,
            Some(last) if row.time_s == last.time_s => {
                let contradicts = remove_known(&mut row.readings, &last.readings);
                if row.readings.iter().all(|reading| reading.is_nan()) {
                    return if contradicts { Inserted::Contradicts } else { Inserted::Duplicate };
                }
            }
            _ => {}
        }
        // Rows come nearly in order: the place is near the end.
        let after = self.waiting.iter().rev().take_while(|other| other.time_s > row.time_s).count();
        let at = self.waiting.len() - after;
        match at.checked_sub(1).and_then(|before| self.waiting.get_mut(before)) {
            Some(same) if same.time_s == row.time_s => match same.unite(&row.readings) {
                United::Same => Inserted::Duplicate,
                United::Filled => Inserted::Merged,
                United::Replaced => Inserted::Contradicts,
            },
            _ => {
                self.waiting.insert(at, row);
                Inserted::New
            }
        }
    }

    /// The earliest row if it is before a time, s, or one too many.
    pub(super) fn pop(&mut self, before_s: f64) -> Option<Row> {
        let due = self.waiting.len() > HELD_AT_MOST
            || self.waiting.front().is_some_and(|first| first.time_s < before_s);
        if due { self.waiting.pop_front() } else { None }
    }

    /// A row is handed out; with another of its time before it, it stands together with that.
    pub(super) fn note(&mut self, row: &Row) {
        match &mut self.handed_out {
            Some(last) if last.time_s == row.time_s => {
                last.unite(&row.readings);
            }
            Some(last) => {
                (last.time_s, last.stamp_s) = (row.time_s, row.stamp_s);
                last.readings.copy_from_slice(&row.readings);
            }
            none => *none = Some(row.clone()),
        }
    }

    /// Time of the row handed out last, s.
    pub(super) fn handed_out_s(&self) -> Option<f64> {
        self.handed_out.as_ref().map(|last| last.time_s)
    }

    /// Rows that wait.
    pub(super) fn held(&self) -> usize {
        self.waiting.len()
    }
}

/// Leave of a row what has not been handed out of its time; whether it says anything else of what has.
fn remove_known(readings: &mut [f64], handed_out: &[f64]) -> bool {
    let mut contradicts = false;
    for (reading, known) in readings.iter_mut().zip(handed_out).filter(|(_, known)| !known.is_nan()) {
        contradicts |= !reading.is_nan() && reading.to_bits() != known.to_bits();
        *reading = f64::NAN;
    }
    contradicts
}
