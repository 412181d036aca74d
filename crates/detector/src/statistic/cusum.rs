//! Cumulative sum: how far the residuals have drifted beyond a reference value since the best onset.
//!
//! `S_n = max(0, S_{n-1} + x_n - k)`, alarm at `S_n >= h`; for a step from 0 to `delta` standard deviations
//! `k = delta/2`, and `delta S` is the log-likelihood ratio of the step maximised over its onset. The two-sided one
//! is the larger of an upper and a lower sum. Fast initial response starts at `S_0 = h/2` after a reset: a change
//! that was there already is found earlier, false alarms become hardly more frequent.
//!
//! Assumes independent normal samples of unit variance. Of all procedures with the same mean time between false
//! alarms it has the shortest worst mean delay for a step of the assumed size.
//!
//! Source: E. S. Page, Biometrika 41 (1954) 100; G. Lorden, Ann. Math. Stat. 42 (1971) 1897; G. V. Moustakides,
//! Ann. Stat. 14 (1986) 1379; J. M. Lucas and R. B. Crosier, Technometrics 24 (1982) 199.
use serde::{Deserialize, Serialize};

use super::Statistic;
use crate::DetectorError;

/// One-sided cumulative sum against an increase of the mean.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cusum {
    reference: f64,
    head_start: f64,
    sum: f64,
    /// When the sum was last zero, in samples before the last one.
    run: u64,
}

impl Cusum {
    /// Reference value `k` in standard deviations, usually half the step to be found.
    ///
    /// # Errors
    /// `reference` is not finite.
    pub fn try_new(reference: f64) -> Result<Self, DetectorError> {
        if !reference.is_finite() {
            return Err(DetectorError::Setting { setting: "reference", value: reference, bound: "finite" });
        }
        Ok(Self { reference, head_start: 0.0, sum: 0.0, run: 0 })
    }

    /// Start, now and after each reset, at `head_start` instead of 0: half the threshold for fast initial response.
    ///
    /// # Errors
    /// `head_start` is negative or not finite.
    pub fn with_head_start(self, head_start: f64) -> Result<Self, DetectorError> {
        if !(head_start >= 0.0 && head_start.is_finite()) {
            let bound = "finite and not negative";
            return Err(DetectorError::Setting { setting: "head_start", value: head_start, bound });
        }
        Ok(Self { head_start, sum: head_start, ..self })
    }

    /// Most likely onset: how many samples ago the sum left zero for the last time.
    pub fn run(&self) -> u64 {
        self.run
    }
}

impl Statistic for Cusum {
    type Sample = f64;

    fn update(&mut self, value: f64) -> f64 {
        if value.is_finite() {
            self.sum = (self.sum + value - self.reference).max(0.0);
            self.run = if self.sum > 0.0 { self.run + 1 } else { 0 };
        }
        self.sum
    }

    fn value(&self) -> f64 {
        self.sum
    }

    fn reset(&mut self) {
        self.sum = self.head_start;
        self.run = 0;
    }
}

/// Cumulative sums against an increase and against a decrease; the statistic is the larger one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwoSidedCusum {
    above: Cusum,
    below: Cusum,
}

impl TwoSidedCusum {
    /// The same sum, reference and head start to either side.
    pub fn new(one_sided: Cusum) -> Self {
        Self { above: one_sided, below: one_sided }
    }

    /// The sum against an increase.
    pub fn above(&self) -> &Cusum {
        &self.above
    }

    /// The sum against a decrease.
    pub fn below(&self) -> &Cusum {
        &self.below
    }
}

impl Statistic for TwoSidedCusum {
    type Sample = f64;

    fn update(&mut self, value: f64) -> f64 {
        self.above.update(value).max(self.below.update(-value))
    }

    fn value(&self) -> f64 {
        self.above.sum.max(self.below.sum)
    }

    fn reset(&mut self) {
        self.above.reset();
        self.below.reset();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// `max_k sum_{i>k} (x_i - reference)` over all onsets, the empty sum included: the definition of Page.
    fn largest_tail_sum(values: &[f64], reference: f64) -> f64 {
        (0..=values.len())
            .map(|k| values[k..].iter().map(|value| value - reference).sum::<f64>())
            .fold(0.0, f64::max)
    }

    proptest! {
        #[test]
        fn the_sum_is_the_largest_tail_sum_of_either_side(values in prop::collection::vec(-5.0..5.0_f64, 1..60)) {
            let mut statistic = TwoSidedCusum::new(Cusum::try_new(0.4).unwrap());
            values.iter().for_each(|value| {
                statistic.update(*value);
            });
            let negated: Vec<f64> = values.iter().map(|value| -value).collect();
            let expected = largest_tail_sum(&values, 0.4).max(largest_tail_sum(&negated, 0.4));
            prop_assert!((statistic.value() - expected).abs() < 1e-10);
        }
    }

    #[test]
    fn a_head_start_of_half_the_threshold_halves_the_way() {
        let plain = Cusum::try_new(0.5).unwrap();
        let mut fast = plain.with_head_start(2.5).unwrap();
        assert_eq!(fast.update(1.5), 3.5);
        fast.reset();
        assert_eq!(fast.value(), 2.5);
    }

    #[test]
    fn the_run_counts_samples_since_the_onset() {
        let mut statistic = Cusum::try_new(0.5).unwrap();
        for value in [3.0, -9.0, 1.0, f64::NAN, 1.0, 1.0] {
            statistic.update(value);
        }
        assert_eq!(statistic.run(), 3);
    }
}
