//! How high the statistics rise without a leak: a law for the tail, fitted to the largest values of stretches of operation.
//!
//! The largest values of stretches of length `b` that exceed a level `u` follow, if that is high, the generalised Pareto law
//! `P(x > u + y | x > u) = (1 + k y/s)^(-1/k)`. With the part `q` of the stretches that exceed it, the mean time between
//! exceedances of `u + y` is `(b/q) (1 + k y/s)^(1/k)`, and the threshold of a mean time `T` is
//!
//! `h = u + s/k [(T q/b)^k - 1]`.
//!
//! `u` is the value that one in ten stretches exceeds. Scale and shape are those of largest likelihood (Grimshaw's profile in `k/s`),
//! the shape kept within -1/4 to 1/4: beyond, hundreds of peaks do not tell it. The interval is that of thresholds from records drawn
//! again with replacement, whole cylinders at a time.
//!
//! Several statistics share the rate of false alarms in equal parts; that they alarm together makes the rate smaller than stated.
//!
//! Source: J. Pickands, Ann. Stat. 3 (1975) 119; S. D. Grimshaw, Technometrics 35 (1993) 185; S. Coles, An Introduction to
//! Statistical Modeling of Extreme Values, 2001, sections 4.3 and 5.3.
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::{Peaks, Scale, Thresholds};
use crate::{DetectorError, error::positive};

/// Part of the stretches that the tail is fitted to.
const PART: f64 = 0.1;
/// Fewest peaks above the level.
const FEWEST: usize = 20;
/// Largest shape either way.
const SHAPE: f64 = 0.25;
/// Draws for an interval.
const DRAWS: usize = 400;

/// Tail of one statistic without a leak.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tail {
    /// Value from which on the law holds.
    pub level: f64,
    /// Mean time between stretches that exceed it, s.
    pub interval_s: f64,
    /// Scale of the excess.
    pub scale: f64,
    /// Shape: 0 is exponential, below 0 bounded.
    pub shape: f64,
}

impl Tail {
    /// The value that is exceeded once in a mean time, s; the level for times that are too short for the law.
    pub fn threshold(&self, mean_time_s: f64) -> f64 {
        let log = (mean_time_s / self.interval_s).ln().max(0.0);
        let excess = if self.shape == 0.0 { log } else { (self.shape * log).exp_m1() / self.shape };
        self.level + self.scale * excess
    }

    /// Fit to the largest values of stretches of so many seconds.
    ///
    /// # Errors
    /// Too few stretches, or values that do not vary.
    pub fn fit(largest: &[f64], stretch_s: f64) -> Result<Self, DetectorError> {
        let mut sorted: Vec<f64> = largest.iter().copied().filter(|value| value.is_finite()).collect();
        let needed = (FEWEST as f64 / PART) as usize;
        if sorted.len() < needed {
            return Err(DetectorError::TooFewStretches { found: sorted.len(), needed });
        }
        sorted.sort_by(f64::total_cmp);
        let above = (sorted.len() as f64 * PART) as usize;
        let level = sorted[sorted.len() - above - 1];
        let excess: Vec<f64> = sorted[sorted.len() - above..].iter().map(|value| value - level).collect();
        let mean = excess.iter().sum::<f64>() / excess.len() as f64;
        if mean <= 0.0 {
            return Err(DetectorError::StatisticsConstant);
        }
        let (scale, shape) = pareto(&excess, mean);
        Ok(Self { level, interval_s: stretch_s * sorted.len() as f64 / above as f64, scale, shape })
    }
}

/// Scale and shape of largest likelihood, the shape within its bounds: `ln L = -n ln s - (1 + 1/k) sum ln(1 + k y/s)`.
fn pareto(excess: &[f64], mean: f64) -> (f64, f64) {
    const STEPS: i32 = 200;
    let largest = excess.iter().copied().fold(0.0, f64::max);
    let n = excess.len() as f64;
    let exponential = (-n * (mean.ln() + 1.0), mean, 0.0);
    let mut best = exponential;
    // Profile over t = k/s, from just above -1/largest on: k(t) = mean of ln(1 + t y), s = k/t.
    for step in -STEPS..=4 * STEPS {
        let t = f64::from(step) / f64::from(STEPS) / if step < 0 { 1.0001 * largest } else { 2.0 * mean };
        if step == 0 {
            continue;
        }
        let shape = excess.iter().map(|y| (t * y).ln_1p()).sum::<f64>() / n;
        let scale = shape / t;
        let likelihood = -n * (scale.ln() + 1.0 + shape);
        if likelihood > best.0 && shape.abs() <= SHAPE {
            best = (likelihood, scale, shape);
        }
    }
    let (_, scale, shape) = best;
    (scale, shape)
}

/// The tails of all statistics, in the order of [`Scale::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tails(pub [Tail; Scale::ALL.len()]);

impl Tails {
    /// Fit to the records of leak-free cylinders.
    ///
    /// # Errors
    /// As [`Tail::fit`].
    pub fn fit(records: &[Peaks]) -> Result<Self, DetectorError> {
        let fit = |scale: Scale| {
            let largest: Vec<f64> = records.iter().flat_map(|record| record.of(scale)).copied().collect();
            Tail::fit(&largest, scale.memory_s())
        };
        let [a, b, c, d, e] = Scale::ALL.map(fit);
        Ok(Self([a?, b?, c?, d?, e?]))
    }

    /// Thresholds of all statistics together for a mean time between false alarms, s.
    ///
    /// # Errors
    /// The time is not positive.
    pub fn thresholds(&self, mean_time_s: f64) -> Result<Thresholds, DetectorError> {
        positive("mean_time_s", mean_time_s)?;
        let each_s = mean_time_s * self.0.len() as f64;
        Ok(Thresholds { mean_time_s, levels: self.0.map(|tail| tail.threshold(each_s)) })
    }

    /// Low and high thresholds, 95 %, of a mean time between false alarms, s: of draws of as many records with replacement.
    ///
    /// # Errors
    /// As [`Tails::fit`] and [`Tails::thresholds`].
    pub fn interval(
        records: &[Peaks],
        mean_time_s: f64,
        seed: u64,
    ) -> Result<[(f64, f64); Scale::ALL.len()], DetectorError> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut drawn: Vec<Thresholds> = Vec::with_capacity(DRAWS);
        for _ in 0..DRAWS {
            let again: Vec<Peaks> =
                records.iter().map(|_| records[random.random_range(0..records.len())].clone()).collect();
            drawn.push(Self::fit(&again)?.thresholds(mean_time_s)?);
        }
        Ok(Scale::ALL.map(|scale| {
            let mut levels: Vec<f64> = drawn.iter().map(|thresholds| thresholds.of(scale)).collect();
            levels.sort_by(f64::total_cmp);
            (levels[DRAWS / 40], levels[DRAWS - 1 - DRAWS / 40])
        }))
    }
}
