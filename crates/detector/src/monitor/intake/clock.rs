//! The clock guard: where a stamp lies on the internal axis `t = stamp - offset`, and the run of rows that lie off it.
//!
//! Rows off the axis wait in a run, in order among themselves. A run that grows long enough is believed; one that a row on the axis
//! cuts short is not. When the clock has jumped, `offset += jump` with
//! `jump = (first stamp of the run - offset) - (latest time + usual interval)`.
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::row::{Readings, Row, United};
use super::{CONFIRM_JUMP, STAMP_LARGEST_S};
use crate::DetectorError;
use crate::monitor::restored::{self, Restored};

/// A row whose time is not believed yet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Stray {
    pub stamp_s: f64,
    pub readings: Readings,
}

/// Rows that may confirm each other: three are enough.
pub(super) type Run = SmallVec<[Stray; 3]>;

/// Where a stamp lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Where rows are expected.
    On,
    /// Later than any row may be.
    Behind,
    /// After a gap, or beyond any.
    Ahead,
}

/// Axis and run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Guard {
    /// Stamp minus internal time, s.
    pub offset_s: f64,
    /// Latest internal time that was believed, s; minus infinity before the first row.
    pub latest_s: f64,
    /// Sorted, of distinct stamps.
    run: Run,
}

impl Default for Guard {
    fn default() -> Self {
        Self { offset_s: 0.0, latest_s: f64::NEG_INFINITY, run: Run::new() }
    }
}

impl Guard {
    /// Checks one that was saved.
    pub(super) fn validate(&self, of: &Restored) -> Result<(), DetectorError> {
        let Self { offset_s, latest_s, run } = self;
        let believed = |time_s: f64| time_s.abs() <= 2.0 * STAMP_LARGEST_S;
        restored::require(believed(*offset_s), "intake.offset_s", *offset_s, "at most 2e12 s either way")?;
        let known = believed(*latest_s) || *latest_s == f64::NEG_INFINITY;
        restored::require(known, "intake.latest_s", *latest_s, "at most 2e12 s either way")?;
        restored::at_most(CONFIRM_JUMP, "intake.run", run.len())?;
        run.iter().try_for_each(|stray| of.each("intake.run", stray.readings.len()))
    }

    /// Where a stamp lies with an allowed lateness and a time ahead that needs no confirmation, s.
    pub(super) fn place(&self, stamp_s: f64, lateness_s: f64, reach_s: f64) -> Place {
        match self.ahead_s(stamp_s) {
            _ if self.latest_s == f64::NEG_INFINITY => Place::On,
            ahead_s if ahead_s < -lateness_s => Place::Behind,
            ahead_s if ahead_s > reach_s => Place::Ahead,
            _ => Place::On,
        }
    }

    /// How far a stamp lies ahead of the latest time, s.
    pub(super) fn ahead_s(&self, stamp_s: f64) -> f64 {
        stamp_s - self.offset_s - self.latest_s
    }

    /// Internal time of a stamp that is believed, s.
    pub(super) fn accept(&mut self, stamp_s: f64) -> f64 {
        let time_s = stamp_s - self.offset_s;
        self.latest_s = self.latest_s.max(time_s);
        time_s
    }

    /// Move the axis so that a stamp lies a usual interval after the latest time: that time and the jump, s.
    pub(super) fn jump(&mut self, stamp_s: f64, usual_s: f64) -> Option<(f64, f64)> {
        let time_s = self.latest_s + usual_s;
        let jump_s = stamp_s - self.offset_s - time_s;
        if !jump_s.is_finite() {
            return None;
        }
        self.offset_s += jump_s;
        Some((stamp_s - self.offset_s, jump_s))
    }

    /// Whether a stamp goes on where the run has come to; any does with an empty run.
    pub(super) fn fits_run(&self, stamp_s: f64, lateness_s: f64, longest_gap_s: f64) -> bool {
        let fits =
            |last: &Stray| (last.stamp_s - lateness_s..=last.stamp_s + longest_gap_s).contains(&stamp_s);
        self.run.last().is_none_or(fits)
    }

    /// Put a row into the run; one of a stamp that is there is united with it, says how, and confirms nothing.
    pub(super) fn join_run(&mut self, stray: Stray) -> Option<United> {
        let at = self.run.partition_point(|other| other.stamp_s < stray.stamp_s);
        match self.run.get_mut(at) {
            Some(same) if same.stamp_s == stray.stamp_s => {
                let readings = core::mem::take(&mut same.readings);
                let mut row = Row { time_s: same.stamp_s, stamp_s: same.stamp_s, readings };
                let united = row.unite(&stray.readings);
                same.readings = row.readings;
                Some(united)
            }
            _ => {
                self.run.insert(at, stray);
                None
            }
        }
    }

    /// Earliest stamp of the run, s.
    pub(super) fn run_first_s(&self) -> Option<f64> {
        self.run.first().map(|stray| stray.stamp_s)
    }

    /// The run; there is none afterwards.
    pub(super) fn take_run(&mut self) -> Run {
        core::mem::take(&mut self.run)
    }

    /// Rows in the run.
    pub(super) fn held(&self) -> usize {
        self.run.len()
    }
}
