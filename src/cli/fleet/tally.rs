//! How far a fleet is.
use crate::cli::fleet_progress::FleetProgress;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Counts what is done.
#[derive(Debug, Default)]
pub(super) struct Tally(Mutex<Option<Counts>>);

#[derive(Clone, Copy, Debug)]
struct Counts {
    began: Instant,
    done: (usize, u64),
    all: (usize, u64),
    rows: u64,
}

impl Tally {
    /// Begins: so many cylinders with logs of so many bytes.
    pub(super) fn begin(&self, cylinders: usize, bytes: u64) {
        let counts = Counts { began: Instant::now(), done: (0, 0), all: (cylinders, bytes), rows: 0 };
        *self.counts() = Some(counts);
    }

    /// A cylinder is done.
    pub(super) fn add(&self, bytes: u64, rows: u64) {
        if let Some(counts) = self.counts().as_mut() {
            counts.done = (counts.done.0 + 1, counts.done.1 + bytes);
            counts.rows += rows;
        }
    }

    /// How far the run is; `None` before it has begun.
    pub(super) fn so_far(&self) -> Option<FleetProgress> {
        self.counts().map(|counts| counts.after(counts.began.elapsed()))
    }

    fn counts(&self) -> MutexGuard<'_, Option<Counts>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Counts {
    fn after(&self, elapsed: Duration) -> FleetProgress {
        let elapsed_s = elapsed.as_secs_f64().max(1e-3);
        let (done, bytes) = (self.done.1 as f64, self.all.1 as f64);
        FleetProgress {
            done: self.done.0,
            cylinders: self.all.0,
            rows_per_s: self.rows as f64 / elapsed_s,
            left_s: (done > 0.0).then_some(elapsed_s * (bytes - done) / done),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_left_goes_by_bytes_and_is_unknown_before_the_first() {
        let tally = Tally::default();
        assert_eq!(tally.so_far(), None);
        tally.begin(4, 1000);
        assert!(tally.so_far().is_some_and(|so_far| so_far.done == 0 && so_far.left_s.is_none()));
        tally.add(250, 30_000);
        let counts = tally.counts().unwrap();
        let so_far = counts.after(Duration::from_secs(2));
        let expected = FleetProgress { done: 1, cylinders: 4, rows_per_s: 15_000.0, left_s: Some(6.0) };
        assert_eq!(so_far, expected);
        assert_eq!(so_far.to_string(), "1 of 4 cylinders, 15000 rows/s");
    }
}
