//! Times by their lengths.
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Duration;

/// Upper bounds of the buckets, s.
pub(in crate::cli::serve) const BOUNDS_S: [f64; 15] =
    [1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 1.0, 10.0];

/// Counts of times in buckets, the last without bound.
#[derive(Default)]
pub(in crate::cli::serve) struct Histogram {
    counts: [AtomicU64; BOUNDS_S.len() + 1],
    sum_ns: AtomicU64,
}

impl Histogram {
    /// Counts a time.
    pub(in crate::cli::serve) fn observe(&self, time: Duration) {
        let time_s = time.as_secs_f64();
        let bucket = BOUNDS_S.iter().position(|bound_s| time_s <= *bound_s).unwrap_or(BOUNDS_S.len());
        self.counts[bucket].fetch_add(1, Relaxed);
        self.sum_ns.fetch_add(time.as_nanos() as u64, Relaxed);
    }

    /// How many times are at most as long as each bound, and all.
    pub(in crate::cli::serve) fn cumulative(&self) -> [u64; BOUNDS_S.len() + 1] {
        let mut sum = 0;
        self.counts.each_ref().map(|count| {
            sum += count.load(Relaxed);
            sum
        })
    }

    /// All times together, s.
    pub(in crate::cli::serve) fn sum_s(&self) -> f64 {
        self.sum_ns.load(Relaxed) as f64 / 1e9
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_counts_in_every_bucket_that_it_fits_in() {
        let histogram = Histogram::default();
        for nanos in [10_000, 10_001, 100_000_000, 60_000_000_000] {
            histogram.observe(Duration::from_nanos(nanos));
        }
        let counts = histogram.cumulative();
        assert_eq!(
            (counts[0], counts[1], counts[11], counts[12], counts[14], counts[15]),
            (1, 2, 2, 3, 3, 4)
        );
        assert!((histogram.sum_s() - 60.100_020_001).abs() < 1e-9);
    }
}
