//! Samples that come late: go back, insert, and filter again.
//!
//! A ring of the last samples, each with a snapshot of the filter after it. A late sample is put where it belongs, the
//! filter returns to the snapshot before it and takes all later samples again. The result is that of samples in order:
//! no approximation for out-of-sequence measurements is needed.
use std::collections::VecDeque;

use super::failure::{StepError, check_sample};
use super::sequential::SequentialFilter;
use crate::EstimatorError;

/// What became of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// It was the latest and has been taken in.
    Appended,
    /// It was late: so many later samples were filtered again.
    Inserted {
        /// Number of later samples.
        refiltered: usize,
    },
    /// There was a sample of this time: its gaps were filled, its readings replaced where both had one, and it and the
    /// later samples were filtered again.
    Merged {
        /// Number of readings that took the place of an earlier one.
        replaced: usize,
        /// Number of later samples.
        refiltered: usize,
    },
    /// It is older than what the ring can return to, and was not used.
    TooOld,
}

/// A filter that takes samples in any order, as far as its ring reaches back.
#[derive(Clone, Debug)]
pub struct Refilter<F: SequentialFilter> {
    filter: F,
    /// Time and snapshot before the oldest entry.
    anchor: (f64, F::Snapshot),
    /// Whether a sample of the anchor's time has left the ring: none can be merged with it any more.
    anchor_sampled: bool,
    entries: VecDeque<Entry<F::Snapshot>>,
    capacity: usize,
    /// Readings of an entry before others were merged with it.
    unmerged: Vec<f64>,
    /// An entry's memory for the next one.
    spare: Option<Entry<F::Snapshot>>,
}

/// A sample and the filter after it.
#[derive(Clone, Debug)]
struct Entry<S> {
    time_s: f64,
    z: Vec<f64>,
    snapshot: S,
}

impl<F: SequentialFilter> Refilter<F> {
    /// Hold the last `capacity` samples (at least one) of `filter`, which is at `start_s`, s.
    pub fn new(filter: F, start_s: f64, capacity: usize) -> Self {
        let capacity = capacity.max(1);
        Self {
            anchor: (start_s, filter.snapshot()),
            anchor_sampled: false,
            entries: VecDeque::with_capacity(capacity + 1),
            capacity,
            unmerged: vec![f64::NAN; filter.outputs()],
            spare: None,
            filter,
        }
    }

    /// The filter, at the time of the latest sample.
    pub fn filter(&self) -> &F {
        &self.filter
    }

    /// Change the filter from outside, e.g. its state at an event. The past cannot be filtered again after that: samples
    /// older than the latest are then too old.
    pub fn change<T>(&mut self, change: impl FnOnce(&mut F) -> T) -> T {
        let result = change(&mut self.filter);
        self.anchor_sampled |= !self.entries.is_empty();
        self.anchor.0 = self.time_s();
        self.filter.save(&mut self.anchor.1);
        self.spare = self.entries.pop_front().or(self.spare.take());
        self.entries.clear();
        result
    }

    /// Time of the latest sample, s.
    pub fn time_s(&self) -> f64 {
        self.entries.back().map_or(self.anchor.0, |entry| entry.time_s)
    }

    /// Oldest time, s, at which a sample can still be inserted.
    pub fn horizon_s(&self) -> f64 {
        self.anchor.0
    }

    /// Number of samples held.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether no sample is held.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Take in the readings `z` (one per output, NaN where there is none) of the time `time_s`, s.
    ///
    /// # Errors
    /// The time is not finite, or the filter refuses. The sample is then dropped, and all else as before.
    pub fn insert(&mut self, time_s: f64, z: &[f64]) -> Result<Placement, StepError<F::Error>> {
        check_sample(0.0, z.len(), self.filter.outputs())?;
        if !time_s.is_finite() {
            return Err(EstimatorError::TimeNotFinite { time_s }.into());
        }
        if time_s < self.anchor.0 || (time_s == self.anchor.0 && self.anchor_sampled) {
            return Ok(Placement::TooOld);
        }
        let at = self.entries.partition_point(|entry| entry.time_s < time_s);
        let placement = if self.entries.get(at).is_some_and(|entry| entry.time_s == time_s) {
            self.merge(at, z)?
        } else {
            self.place(at, time_s, z)?
        };
        self.drop_oldest();
        Ok(placement)
    }

    /// Put a new sample before entry `at`.
    fn place(&mut self, at: usize, time_s: f64, z: &[f64]) -> Result<Placement, StepError<F::Error>> {
        let mut entry = self.spare.take().unwrap_or_else(|| Entry {
            time_s,
            z: z.to_vec(),
            snapshot: self.filter.snapshot(),
        });
        entry.time_s = time_s;
        entry.z.copy_from_slice(z);
        self.entries.insert(at, entry);
        let refiltered = self.entries.len() - 1 - at;
        if let Err(error) = self.refilter(at) {
            self.spare = self.entries.remove(at);
            self.refilter(at)?;
            return Err(error);
        }
        Ok(if refiltered == 0 { Placement::Appended } else { Placement::Inserted { refiltered } })
    }

    /// Add readings to entry `at`.
    fn merge(&mut self, at: usize, z: &[f64]) -> Result<Placement, StepError<F::Error>> {
        let entry = &mut self.entries[at];
        self.unmerged.copy_from_slice(&entry.z);
        let mut replaced = 0;
        for (old, new) in entry.z.iter_mut().zip(z).filter(|(_, new)| new.is_finite()) {
            replaced += usize::from(old.is_finite());
            *old = *new;
        }
        if let Err(error) = self.refilter(at) {
            self.entries[at].z.copy_from_slice(&self.unmerged);
            self.refilter(at)?;
            return Err(error);
        }
        Ok(Placement::Merged { replaced, refiltered: self.entries.len() - 1 - at })
    }

    /// Take the samples from entry `at` on, again or for the first time.
    fn refilter(&mut self, at: usize) -> Result<(), StepError<F::Error>> {
        let (mut time_s, snapshot) = match at.checked_sub(1) {
            None => (self.anchor.0, &self.anchor.1),
            Some(before) => (self.entries[before].time_s, &self.entries[before].snapshot),
        };
        self.filter.restore(snapshot);
        for entry in self.entries.range_mut(at..) {
            self.filter.step(entry.time_s - time_s, &entry.z)?;
            self.filter.save(&mut entry.snapshot);
            time_s = entry.time_s;
        }
        Ok(())
    }

    /// Let the oldest entry become the anchor if there are too many.
    fn drop_oldest(&mut self) {
        if self.entries.len() > self.capacity
            && let Some(mut oldest) = self.entries.pop_front()
        {
            self.anchor.0 = oldest.time_s;
            std::mem::swap(&mut self.anchor.1, &mut oldest.snapshot);
            self.anchor_sampled = true;
            self.spare = Some(oldest);
        }
    }
}
