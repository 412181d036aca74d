//! Normality: Lilliefors' test.
//!
//! The Kolmogorov-Smirnov distance `D = max |F_n - Phi((x - mean)/sd)|` with mean and standard deviation of the sample
//! itself is far smaller than with given ones; quantiles of the plain test hardly ever reject. Its own distribution:
//! Lilliefors 1967, by the formula of Dallal and Wilkinson 1986, which holds for probabilities up to 0.1 and samples of 5 to
//! 100. Larger ones are led back to 100 by what Stephens 1974 found not to depend on the size,
//! `D (sqrt n - 0.01 + 0.85/sqrt n)`.
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, Normal};

use super::{Finding, Significance};

/// Fewest values that a distribution is judged by.
const MIN_SAMPLES: usize = 8;
/// Largest probability that the formula gives.
const LARGEST_P: f64 = 0.1;

/// Outcome of Lilliefors' test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Lilliefors {
    /// Number of values.
    pub values: usize,
    /// Largest distance of the two distribution functions.
    pub distance: f64,
    /// Probability that normal values lie this far apart; 0.1 stands for everything above.
    pub p_value: f64,
}

/// Lilliefors' test that a sample is normal, whatever its mean and standard deviation. `None` with fewer than eight
/// values, without spread, or with values that are not finite.
pub(crate) fn lilliefors(sample: &[f64]) -> Option<Lilliefors> {
    let n = sample.len() as f64;
    if sample.len() < MIN_SAMPLES || sample.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let mean = sample.iter().sum::<f64>() / n;
    let sd = (sample.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
    let normal = Normal::new(mean, sd).ok()?;
    let mut sorted = sample.to_vec();
    sorted.sort_by(f64::total_cmp);
    let distance = sorted.iter().enumerate().fold(0.0_f64, |largest, (i, value)| {
        let p = normal.cdf(*value);
        largest.max(p - i as f64 / n).max((i + 1) as f64 / n - p)
    });
    Some(Lilliefors { values: sample.len(), distance, p_value: p_value(distance, n) })
}

/// Probability of a distance in a sample of `n` normal values.
pub(super) fn p_value(distance: f64, n: f64) -> f64 {
    let stephens = |n: f64| n.sqrt() - 0.01 + 0.85 / n.sqrt();
    let (d, n) = if n > 100.0 { (distance * stephens(n) / stephens(100.0), 100.0) } else { (distance, n) };
    let k = n + 2.78019;
    let exponent =
        -7.01256 * d * d * k + 2.99587 * d * k.sqrt() - 0.122119 + 0.974598 / n.sqrt() + 1.67997 / n;
    // The exponent falls only from this distance on; below, the probability is far above what the formula gives.
    let falling = 2.99587 / (2.0 * 7.01256 * k.sqrt());
    if d < falling { LARGEST_P } else { exponent.exp().min(LARGEST_P) }
}

/// Values of a run to be tested for normality, thinned evenly so that they never take more than a fixed room.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Normality {
    pub(super) kept: Vec<f64>,
    capacity: usize,
    /// Every `stride`-th value is kept.
    stride: u64,
    seen: u64,
}

impl Default for Normality {
    /// Room for 4096 values.
    fn default() -> Self {
        Self::with_capacity(4096)
    }
}

impl Normality {
    /// Room for `capacity` values, at least eight; the test is made with half of them or more once there were so many.
    pub(crate) fn with_capacity(capacity: usize) -> Self {
        let capacity = capacity.max(MIN_SAMPLES);
        Self { kept: Vec::with_capacity(capacity), capacity, stride: 1, seen: 0 }
    }

    /// Add a value; one that is not finite was none.
    pub(crate) fn push(&mut self, value: f64) {
        if !value.is_finite() {
            return;
        }
        if self.seen.is_multiple_of(self.stride) {
            if self.kept.len() == self.capacity {
                let mut index = 0;
                self.kept.retain(|_| {
                    index += 1;
                    index % 2 == 1
                });
                self.stride *= 2;
            }
            if self.seen.is_multiple_of(self.stride) {
                self.kept.push(value);
            }
        }
        self.seen += 1;
    }

    /// The test on what was kept.
    pub(crate) fn test(&self) -> Option<Lilliefors> {
        lilliefors(&self.kept)
    }

    /// What the test says. A significance above 0.1 is taken as 0.1.
    pub(crate) fn finding(&self, significance: Significance) -> Finding {
        match self.test() {
            None => Finding::TooFew,
            Some(test) if test.p_value < significance.probability().min(LARGEST_P) => Finding::NotNormal,
            Some(_) => Finding::Consistent,
        }
    }
}
