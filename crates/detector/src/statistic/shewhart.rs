//! Shewhart's chart with a run rule: a residual is outside a limit `m` times among the last `n`.
//!
//! "`m` of the last `n` exceed `h`" is the same as "the `m`-th largest of the last `n` exceeds `h`", so the statistic
//! is that order statistic, and the limit stays with the alarm. `m = n` is the rule "`m` in a row" (debouncing).
//!
//! Assumes independent samples of unit variance for the run lengths of [`crate::calibrate::RunRule`].
//! Detects changes of several standard deviations at once, small ones late.
//!
//! Source: W. A. Shewhart, Economic Control of Quality of Manufactured Product, 1931; run rules: Western Electric,
//! Statistical Quality Control Handbook, 1956.
use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use super::{Side, Statistic};
use crate::DetectorError;

/// Longest span of a run rule, samples.
const LONGEST_RUN: usize = 1000;

/// The `count`-th largest of the last `of` residuals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shewhart {
    side: Side,
    count: usize,
    of: usize,
    last: VecDeque<f64>,
    /// The same in ascending order.
    sorted: Vec<f64>,
}

impl Shewhart {
    /// A single residual decides.
    pub fn new(side: Side) -> Self {
        Self { side, count: 1, of: 1, last: VecDeque::with_capacity(1), sorted: Vec::with_capacity(1) }
    }

    /// `count` of the last `of` residuals decide; equal numbers: `count` in a row.
    ///
    /// # Errors
    /// `count` is not between 1 and `of`, or `of` is above 1000.
    pub fn with_run(side: Side, count: usize, of: usize) -> Result<Self, DetectorError> {
        if count == 0 || count > of {
            let value = count as f64;
            return Err(DetectorError::Setting { setting: "count", value, bound: "between 1 and `of`" });
        }
        if of > LONGEST_RUN {
            return Err(DetectorError::Setting { setting: "of", value: of as f64, bound: "at most 1000" });
        }
        Ok(Self { side, count, of, last: VecDeque::with_capacity(of), sorted: Vec::with_capacity(of) })
    }
}

impl Statistic for Shewhart {
    type Sample = f64;

    fn update(&mut self, value: f64) -> f64 {
        if value.is_finite() {
            let gone = if self.last.len() == self.of { self.last.pop_front() } else { None };
            if let Some(gone) = gone {
                self.sorted.remove(self.sorted.partition_point(|kept| *kept < gone));
            }
            let seen = self.side.of(value);
            self.sorted.insert(self.sorted.partition_point(|kept| *kept < seen), seen);
            self.last.push_back(seen);
        }
        self.value()
    }

    /// Minus infinity as long as there are fewer than `count` samples.
    fn value(&self) -> f64 {
        let index = self.sorted.len().checked_sub(self.count);
        index.map_or(f64::NEG_INFINITY, |index| self.sorted[index])
    }

    fn reset(&mut self) {
        self.last.clear();
        self.sorted.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_of_three_is_the_second_largest_of_the_last_three() {
        let mut statistic = Shewhart::with_run(Side::Above, 2, 3).unwrap();
        let values = [5.0, 1.0, 2.0, 7.0, -1.0, 7.0, 7.0].map(|value| statistic.update(value));
        assert_eq!(values, [f64::NEG_INFINITY, 1.0, 2.0, 2.0, 2.0, 7.0, 7.0]);
    }

    #[test]
    fn three_in_a_row_is_the_smallest_of_three_and_a_single_return_breaks_the_run() {
        let mut statistic = Shewhart::with_run(Side::Both, 3, 3).unwrap();
        let values = [4.0, -5.0, 4.5, 0.1, 6.0, 6.0, -6.0].map(|value| statistic.update(value));
        assert_eq!(values[2], 4.0);
        assert_eq!(values[3..6], [0.1, 0.1, 0.1]);
        assert_eq!(values[6], 6.0);
    }

    #[test]
    fn a_missing_sample_changes_nothing() {
        let mut statistic = Shewhart::new(Side::Below);
        assert_eq!(statistic.update(-2.0), 2.0);
        assert_eq!(statistic.update(f64::NAN), 2.0);
    }
}
