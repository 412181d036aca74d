//! The usual interval between rows: median of the last few.
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::DetectorError;
use crate::monitor::restored;

/// Intervals that are remembered: seven gaps among them change nothing.
const REMEMBERED: usize = 15;

/// Running median of the intervals.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct UsualInterval {
    recent_s: SmallVec<[f64; REMEMBERED]>,
    next: usize,
    median_s: f64,
}

impl UsualInterval {
    /// Checks one that was saved.
    pub(super) fn validate(&self) -> Result<(), DetectorError> {
        restored::at_most(REMEMBERED, "intake.usual.recent_s", self.recent_s.len())?;
        restored::at_most(REMEMBERED - 1, "intake.usual.next", self.next)
    }

    /// Take an interval, s; one that is not positive is none.
    pub(super) fn push(&mut self, interval_s: f64) {
        if interval_s <= 0.0 {
            return;
        }
        if self.recent_s.len() < REMEMBERED {
            self.recent_s.push(interval_s);
        } else {
            self.recent_s[self.next] = interval_s;
        }
        self.next = (self.next + 1) % REMEMBERED;
        let mut sorted = [f64::INFINITY; REMEMBERED];
        sorted[..self.recent_s.len()].copy_from_slice(&self.recent_s);
        let middle = (self.recent_s.len() - 1) / 2;
        self.median_s = *sorted.select_nth_unstable_by(middle, f64::total_cmp).1;
    }

    /// Median, s, the lower one of an even number; `None` before the first interval.
    pub(super) fn median_s(&self) -> Option<f64> {
        (!self.recent_s.is_empty()).then_some(self.median_s)
    }
}
