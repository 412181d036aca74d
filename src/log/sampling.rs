//! How a log is sampled: rows, usual interval, gaps, in memory that does not grow.
use std::collections::BTreeMap;

/// Buckets of the intervals' histogram; two neighbours differ by this factor.
const FACTOR: f64 = 1.05;
/// Shortest interval that has a bucket of its own, s.
const SHORTEST_S: f64 = 1e-6;
/// Buckets: up to 1e-6 s * 1.05^750 = 240 years.
const BUCKETS: u16 = 750;
/// An interval longer than this many usual ones is a gap.
const GAP: f64 = 5.0;

/// Times of a log, counted while they pass.
#[derive(Clone, Debug)]
pub struct Sampling {
    rows: u64,
    first_s: f64,
    last_s: f64,
    /// By their numbers; a log has few of them.
    histogram: BTreeMap<u16, Bucket>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Bucket {
    count: u64,
    sum_s: f64,
    longest_s: f64,
}

/// Intervals much longer than the usual one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gaps {
    /// How many.
    pub count: u64,
    /// Longest, s.
    pub longest_s: f64,
    /// All together, s.
    pub total_s: f64,
}

impl Default for Sampling {
    fn default() -> Self {
        Self { rows: 0, first_s: f64::NAN, last_s: f64::NAN, histogram: BTreeMap::new() }
    }
}

impl Sampling {
    /// Counts a row.
    pub(crate) fn push(&mut self, time_s: f64) {
        if self.rows == 0 {
            self.first_s = time_s;
        } else if time_s <= self.last_s {
            // A late row says nothing of the intervals.
            self.rows += 1;
            return;
        } else {
            let interval_s = time_s - self.last_s;
            let bucket = (interval_s / SHORTEST_S).max(1.0).ln() / FACTOR.ln();
            let bucket = self.histogram.entry((bucket as u16).min(BUCKETS - 1)).or_default();
            bucket.count += 1;
            bucket.sum_s += interval_s;
            bucket.longest_s = bucket.longest_s.max(interval_s);
        }
        self.rows += 1;
        self.last_s = time_s;
    }

    /// Rows so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// From the first to the last row, s; NaN without rows.
    pub fn duration_s(&self) -> f64 {
        self.last_s - self.first_s
    }

    /// Times of the first and the last row, s; NaN without rows.
    pub(crate) fn span_s(&self) -> (f64, f64) {
        (self.first_s, self.last_s)
    }

    /// Median of the intervals, s, within 5 %; NaN below two rows.
    pub fn usual_interval_s(&self) -> f64 {
        let half = self.rows.saturating_sub(1).div_ceil(2);
        let mut below = 0;
        for bucket in self.histogram.values() {
            below += bucket.count;
            if below >= half {
                return bucket.sum_s / bucket.count as f64;
            }
        }
        f64::NAN
    }

    /// Intervals longer than five usual ones, within the histogram's 5 %.
    pub fn gaps(&self) -> Gaps {
        let bound_s = GAP * self.usual_interval_s();
        let none = Gaps { count: 0, longest_s: 0.0, total_s: 0.0 };
        self.histogram.values().filter(|bucket| bucket.sum_s / bucket.count as f64 > bound_s).fold(
            none,
            |gaps, bucket| Gaps {
                count: gaps.count + bucket.count,
                longest_s: gaps.longest_s.max(bucket.longest_s),
                total_s: gaps.total_s + bucket.sum_s,
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_gaps_in_a_minutely_day_are_found_with_their_lengths() {
        let mut sampling = Sampling::default();
        let mut time_s = 1e9;
        for row in 0..1440 {
            time_s += match row {
                500 => 3600.0,
                900 => 7200.0,
                _ => 60.0 + if row % 2 == 0 { 0.5 } else { -0.5 },
            };
            sampling.push(time_s);
        }
        assert_eq!(sampling.rows(), 1440);
        assert!((sampling.usual_interval_s() - 60.0).abs() <= 0.5);
        assert_eq!(sampling.gaps(), Gaps { count: 2, longest_s: 7200.0, total_s: 10800.0 });
    }

    #[test]
    fn one_row_has_no_interval_and_no_gap() {
        let mut sampling = Sampling::default();
        sampling.push(5.0);
        assert!(sampling.usual_interval_s().is_nan());
        assert_eq!((sampling.duration_s(), sampling.gaps().count), (0.0, 0));
    }
}
