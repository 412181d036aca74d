//! Samples in any order: a late one is put where it belongs, and the observer filters again from there.
//!
//! The rows of the last while are kept, each with a [`Snapshot`] of the observer after it. A late row sends the observer back to the
//! snapshot before it; all later rows and events are taken again. The result is that of rows in order, to the last digit. Rows of one
//! time become one row, as if their readings had come together. What is older than the rows kept is counted and not used.
use std::collections::VecDeque;

use super::{Estimate, Observer, Snapshot};
use crate::EstimatorError;

/// What became of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Insertion {
    /// It was the latest.
    Appended(Estimate),
    /// It was late, and so many later rows were filtered again; the estimate is that at the latest time.
    Inserted {
        /// Later rows.
        refiltered: usize,
        /// Latest estimate.
        latest: Estimate,
    },
    /// There was a row of this time: they are one row now, and it and the later rows were filtered again. Where both had
    /// a reading, the new one stands.
    Merged {
        /// Later rows.
        refiltered: usize,
        /// Latest estimate.
        latest: Estimate,
    },
    /// It is older than what is kept, and was not used.
    TooLate,
}

/// An observer that takes rows in any order, within a span of time.
#[derive(Debug)]
pub struct LateSamples {
    observer: Observer,
    span_s: f64,
    /// Observer before the oldest entry, and the time of the last row in it.
    anchor: Snapshot,
    anchor_s: f64,
    entries: VecDeque<Entry>,
    too_late: u64,
}

#[derive(Debug)]
struct Entry {
    time_s: f64,
    what: What,
    after: Snapshot,
}

#[derive(Clone, Debug)]
enum What {
    Row { readings: Vec<f64>, estimate: Estimate },
    Begin,
    End,
}

impl LateSamples {
    /// Accept rows that are up to `span_s`, s, older than the latest.
    ///
    /// # Errors
    /// The span is not positive and finite.
    pub fn new(observer: Observer, span_s: f64) -> Result<Self, EstimatorError> {
        if !(span_s > 0.0 && span_s.is_finite()) {
            return Err(EstimatorError::ObserverSetting {
                setting: "late_span_s",
                value: span_s,
                bound: "positive and finite",
            });
        }
        let anchor = observer.snapshot();
        let anchor_s = observer.clock.time_s.unwrap_or(f64::NEG_INFINITY);
        Ok(Self { observer, span_s, anchor, anchor_s, entries: VecDeque::new(), too_late: 0 })
    }

    /// The observer, at the time of the latest row.
    pub fn observer(&self) -> &Observer {
        &self.observer
    }

    /// The observer itself.
    pub fn into_observer(self) -> Observer {
        self.observer
    }

    /// Rows so far that were too late to be used.
    pub fn too_late(&self) -> u64 {
        self.too_late
    }

    /// Estimates of the rows that are kept, oldest first: what late rows have made of them.
    pub fn estimates(&self) -> impl Iterator<Item = &Estimate> {
        self.entries.iter().filter_map(|entry| match &entry.what {
            What::Row { estimate, .. } => Some(estimate),
            What::Begin | What::End => None,
        })
    }

    /// Gas begins to flow in or out on purpose, after the latest row: as [`Observer::begin_exchange`].
    pub fn begin_exchange(&mut self) {
        self.observer.begin_exchange();
        self.enter(What::Begin);
    }

    /// The exchange is over: as [`Observer::end_exchange`].
    pub fn end_exchange(&mut self) {
        self.observer.end_exchange();
        self.enter(What::End);
    }

    fn enter(&mut self, what: What) {
        let time_s = self.latest_s();
        self.entries.push_back(Entry { time_s, what, after: self.observer.snapshot() });
    }

    fn latest_s(&self) -> f64 {
        self.entries.back().map_or(self.anchor_s, |entry| entry.time_s)
    }

    /// Take in a row of readings of a time, in any order.
    ///
    /// # Errors
    /// As [`Observer::step`], but for time that runs backwards. All is then as it was.
    pub fn insert(&mut self, time_s: f64, readings: &[f64]) -> Result<Insertion, EstimatorError> {
        let expected = self.anchor.clock.screens.len();
        if readings.len() != expected {
            return Err(EstimatorError::RowLength { expected, found: readings.len() });
        }
        if !time_s.is_finite() {
            return Err(EstimatorError::TimeNotFinite { time_s });
        }
        // A row of the anchor's time would have to be one with a row that is not kept.
        if time_s <= self.anchor_s || time_s < self.latest_s() - self.span_s {
            self.too_late += 1;
            return Ok(Insertion::TooLate);
        }
        let insertion = match self.entries.iter().position(|e| e.time_s == time_s && e.is_row()) {
            Some(index) => self.merge(index, readings)?,
            None => self.place(time_s, readings)?,
        };
        self.drop_oldest();
        Ok(insertion)
    }

    fn place(&mut self, time_s: f64, readings: &[f64]) -> Result<Insertion, EstimatorError> {
        let index = self.entries.partition_point(|entry| entry.time_s <= time_s);
        if index == self.entries.len() {
            let estimate = self.observer.step(time_s, readings)?;
            let what = What::Row { readings: readings.to_vec(), estimate };
            self.entries.push_back(Entry { time_s, what, after: self.observer.snapshot() });
            return Ok(Insertion::Appended(estimate));
        }
        // The estimate is a stand-in until the row has been filtered.
        let estimate = *self.latest_estimate();
        let what = What::Row { readings: readings.to_vec(), estimate };
        self.entries.insert(index, Entry { time_s, what, after: self.anchor.clone() });
        if let Err(error) = self.refilter(index) {
            self.entries.remove(index);
            self.refilter(index)?;
            return Err(error);
        }
        Ok(Insertion::Inserted { refiltered: self.rows_after(index), latest: *self.latest_estimate() })
    }

    fn merge(&mut self, index: usize, readings: &[f64]) -> Result<Insertion, EstimatorError> {
        let before = self.entries[index].what.clone();
        if let What::Row { readings: known, .. } = &mut self.entries[index].what {
            for (known, new) in known.iter_mut().zip(readings).filter(|(_, new)| new.is_finite()) {
                *known = *new;
            }
        }
        if let Err(error) = self.refilter(index) {
            self.entries[index].what = before;
            self.refilter(index)?;
            return Err(error);
        }
        Ok(Insertion::Merged { refiltered: self.rows_after(index), latest: *self.latest_estimate() })
    }

    /// Take the entries from `index` on again.
    fn refilter(&mut self, index: usize) -> Result<(), EstimatorError> {
        let before = index.checked_sub(1).map_or(&self.anchor, |last| &self.entries[last].after);
        self.observer.restore(before);
        for entry in self.entries.range_mut(index..) {
            match &mut entry.what {
                What::Row { readings, estimate } => *estimate = self.observer.step(entry.time_s, readings)?,
                What::Begin => self.observer.begin_exchange(),
                What::End => self.observer.end_exchange(),
            }
            entry.after = self.observer.snapshot();
        }
        Ok(())
    }

    fn rows_after(&self, index: usize) -> usize {
        self.entries.range(index + 1..).filter(|entry| entry.is_row()).count()
    }

    fn latest_estimate(&self) -> &Estimate {
        self.estimates().last().expect("a late row has a later one that is kept")
    }

    /// Let go of what is older than the span.
    fn drop_oldest(&mut self) {
        let keep_s = self.latest_s() - self.span_s;
        while self.entries.front().is_some_and(|entry| entry.time_s < keep_s) {
            if let Some(oldest) = self.entries.pop_front() {
                (self.anchor, self.anchor_s) = (oldest.after, oldest.time_s);
            }
        }
    }
}

impl Entry {
    fn is_row(&self) -> bool {
        matches!(self.what, What::Row { .. })
    }
}
