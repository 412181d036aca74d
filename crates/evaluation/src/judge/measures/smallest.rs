//! Smallest leak that is found with a probability, by monotone interpolation.
//!
//! A larger leak is not harder to find: the parts found at the rates that were tried are first made increasing by pooling
//! adjacent violators (weighted least squares, which is maximum likelihood here), then interpolated linearly in the
//! logarithm of the rate. The probability bends downwards where it is high, so that the chord lies below it: between rates a
//! factor of 1.6 apart the rate comes out up to a tenth too large, never too small.
//!
//! Interval by bootstrap: the numbers found are drawn anew from the binomial distribution with `(k + 1/2)/(n + 1)`, Jeffreys'
//! mean, instead of `k/n`, so that "all of 40" is not taken for certainty; each draw goes through the same
//! interpolation.
//!
//! Source: M. Ayer et al., Ann. Math. Stat. 26 (1955) 641; B. Efron and R. J. Tibshirani, An Introduction to the Bootstrap,
//! 1993, percentile intervals.
use std::cmp::Ordering;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::{CONFIDENCE, Detection, Proportion};

/// Draws of the bootstrap.
const DRAWS: usize = 2000;
/// Seed of the bootstrap: the same runs have the same interval.
const SEED: u64 = 7;

/// A rate at which the probability is reached, part of the gas per hour, as far as the rates that were tried tell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reached {
    /// It is reached already at the smallest rate tried.
    AtMost(f64),
    /// It is reached here.
    At(f64),
    /// It is not reached even at the largest rate tried.
    Above(f64),
}

impl Reached {
    /// The rate, or the end of the rates tried.
    pub(crate) fn rate(self) -> f64 {
        match self {
            Self::AtMost(rate) | Self::At(rate) | Self::Above(rate) => rate,
        }
    }

    /// In another unit, of which the old one has `factor`.
    fn times(self, factor: f64) -> Self {
        match self {
            Self::AtMost(rate) => Self::AtMost(factor * rate),
            Self::At(rate) => Self::At(factor * rate),
            Self::Above(rate) => Self::Above(factor * rate),
        }
    }

    /// In the order of what they say: at most, at, above.
    fn compare(&self, other: &Self) -> Ordering {
        let order = |of: &Self| match *of {
            Self::AtMost(rate) => (0, rate),
            Self::At(rate) => (1, rate),
            Self::Above(rate) => (2, rate),
        };
        let (a, b) = (order(self), order(other));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    }
}

/// Smallest leak that is found with a probability within a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SmallestLeak {
    /// The probability.
    pub probability: f64,
    /// The rate.
    pub rate: Reached,
    /// Lower and upper bound of its 95 % interval.
    pub interval: (Reached, Reached),
}

impl SmallestLeak {
    /// From the parts found at increasing rates; rates without trials are left out. `None` without any.
    pub(crate) fn of(detections: &[Detection], probability: f64) -> Option<Self> {
        let tried: Vec<Detection> = detections.iter().filter(|d| d.found.trials > 0).copied().collect();
        let rate = reached(&tried, probability)?;
        let mut random = ChaCha8Rng::seed_from_u64(SEED);
        let mut draws: Vec<Reached> =
            (0..DRAWS).filter_map(|_| reached(&redrawn(&tried, &mut random), probability)).collect();
        draws.sort_by(Reached::compare);
        let tail = 0.5 * (1.0 - CONFIDENCE) * DRAWS as f64;
        let (low, high) = (draws[tail as usize], draws[DRAWS - 1 - tail as usize]);
        Some(Self { probability, rate, interval: holding(rate, low, high) })
    }

    /// In another unit, of which the old one has `factor`.
    pub(crate) fn times(self, factor: f64) -> Self {
        let (low, high) = self.interval;
        Self { rate: self.rate.times(factor), interval: (low.times(factor), high.times(factor)), ..self }
    }
}

/// The interval, widened to its rate: "all of 24" is not taken for certainty in the draws, which may all lie on one side of it.
fn holding(rate: Reached, low: Reached, high: Reached) -> (Reached, Reached) {
    (std::cmp::min_by(low, rate, Reached::compare), std::cmp::max_by(high, rate, Reached::compare))
}

/// Where the interpolated probability is reached.
fn reached(tried: &[Detection], probability: f64) -> Option<Reached> {
    let fitted = increasing(tried);
    let (first, last) = (tried.first()?.part_per_h, tried.last()?.part_per_h);
    // Fractions of counts: 38 of 40 are 0.95.
    let enough = |part: f64| part >= probability - 1e-9;
    let Some(index) = fitted.iter().position(|part| enough(*part)) else {
        return Some(Reached::Above(last));
    };
    let Some(before) = index.checked_sub(1) else {
        return Some(Reached::AtMost(first));
    };
    let share = ((probability - fitted[before]) / (fitted[index] - fitted[before])).clamp(0.0, 1.0);
    let (low, high) = (tried[before].part_per_h.ln(), tried[index].part_per_h.ln());
    Some(Reached::At((low + share * (high - low)).exp()))
}

/// Parts found, made increasing by pooling neighbours that are not.
fn increasing(tried: &[Detection]) -> Vec<f64> {
    let mut pools: Vec<(f64, f64, usize)> = Vec::new();
    for detection in tried {
        let mut pool = (detection.found.hits as f64, detection.found.trials as f64, 1);
        while let Some(last) = pools.last().filter(|last| last.0 * pool.1 >= pool.0 * last.1).copied() {
            pools.pop();
            pool = (pool.0 + last.0, pool.1 + last.1, pool.2 + last.2);
        }
        pools.push(pool);
    }
    pools.into_iter().flat_map(|(hits, trials, count)| std::iter::repeat_n(hits / trials, count)).collect()
}

fn redrawn(tried: &[Detection], random: &mut ChaCha8Rng) -> Vec<Detection> {
    let draw = |detection: &Detection| {
        let Proportion { hits, trials } = detection.found;
        let chance = (hits as f64 + 0.5) / (trials as f64 + 1.0);
        let outcomes = (0..trials).map(|_| random.random::<f64>() < chance);
        Detection { found: Proportion::count(outcomes), ..*detection }
    };
    tried.iter().map(draw).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn detections(counts: &[(f64, u64, u64)]) -> Vec<Detection> {
        let of = |&(part_per_h, hits, trials): &(f64, u64, u64)| Detection {
            part_per_h,
            found: Proportion { hits, trials },
        };
        counts.iter().map(of).collect()
    }

    #[test]
    fn the_rate_lies_between_its_neighbours_in_the_logarithm() {
        // 0.9 at 0.1, 1.0 at 1: 0.95 halfway, at 0.1 times the root of 10.
        let found = SmallestLeak::of(&detections(&[(0.01, 0, 40), (0.1, 36, 40), (1.0, 40, 40)]), 0.95);
        let Some(SmallestLeak { rate: Reached::At(rate), interval, .. }) = found else { panic!("{found:?}") };
        assert_relative_eq!(rate, 0.1 * 10.0_f64.sqrt(), max_relative = 1e-9);
        assert!(interval.0.rate() < rate && rate < interval.1.rate());
    }

    #[test]
    fn the_interval_holds_the_rate_where_none_turns_into_all() {
        let found = SmallestLeak::of(&detections(&[(0.01, 0, 24), (0.1, 24, 24), (1.0, 24, 24)]), 0.95);
        let SmallestLeak { rate, interval, .. } = found.unwrap();
        let (low, high) = (interval.0.rate(), interval.1.rate());
        assert!(low <= rate.rate() && rate.rate() < high, "{low} {rate:?} {high}");
    }

    #[test]
    fn an_interval_on_one_side_of_its_rate_is_widened_to_it() {
        let [a, b, c] = [1.0, 2.0, 3.0].map(Reached::At);
        assert_eq!(holding(a, b, Reached::Above(3.0)), (a, Reached::Above(3.0)));
        assert_eq!(holding(c, Reached::AtMost(1.0), b), (Reached::AtMost(1.0), c));
        assert_eq!(holding(b, a, c), (a, c));
    }

    #[test]
    fn parts_that_fall_with_the_rate_are_pooled() {
        let parts = increasing(&detections(&[(1.0, 2, 10), (2.0, 8, 10), (3.0, 6, 10), (4.0, 9, 10)]));
        assert_eq!(parts, [0.2, 0.7, 0.7, 0.9]);
        // A single miss at a high rate pulls down what was found before it.
        let found = SmallestLeak::of(&detections(&[(1.0, 10, 10), (2.0, 9, 10), (3.0, 10, 10)]), 0.95);
        assert_eq!(found.unwrap().rate, Reached::AtMost(1.0));
    }

    #[test]
    fn outside_the_rates_tried_only_a_bound_is_known() {
        let none = SmallestLeak::of(&detections(&[(1.0, 0, 40), (2.0, 10, 40)]), 0.95).unwrap();
        assert_eq!((none.rate, none.interval.1), (Reached::Above(2.0), Reached::Above(2.0)));
        let all = SmallestLeak::of(&detections(&[(1.0, 40, 40), (2.0, 40, 40)]), 0.95).unwrap();
        assert_eq!(all.rate, Reached::AtMost(1.0));
        assert_eq!(SmallestLeak::of(&detections(&[(1.0, 0, 0)]), 0.95), None);
        assert_eq!(SmallestLeak::of(&[], 0.95), None);
    }

    #[test]
    fn between_coarse_rates_the_rate_comes_out_a_little_too_large() {
        // Logistic probabilities of 0.8632 and 0.9755 at 1.5849 and 2.5119; 0.95 is reached at 2.0878.
        let counts = [(1.5849, 86_320, 100_000), (2.5119, 97_550, 100_000)];
        let Reached::At(rate) = reached(&detections(&counts), 0.95).unwrap() else { panic!("between") };
        assert!((1.0..1.09).contains(&(rate / 2.0878)), "{rate}");
    }

    #[test]
    fn more_runs_make_the_interval_narrower_and_it_holds_the_truth() {
        // Probability of finding by a logistic law: 0.95 at ln r = ln 19 / 4.
        let truth = (19.0_f64.ln() / 4.0).exp();
        let part = |rate: f64| 1.0 / (1.0 + (-4.0 * rate.ln()).exp());
        let width = |trials: u64| {
            let rates: Vec<f64> = (0..48).map(|n| 10_f64.powf(-1.0 + 0.05 * f64::from(n))).collect();
            let counts: Vec<(f64, u64, u64)> =
                rates.iter().map(|r| (*r, (part(*r) * trials as f64).round() as u64, trials)).collect();
            let found = SmallestLeak::of(&detections(&counts), 0.95).unwrap();
            let (low, high) = (found.interval.0.rate(), found.interval.1.rate());
            assert!((low..=high).contains(&truth), "{trials}: {low} {truth} {high}");
            (high / low).ln()
        };
        assert!(width(2000) < 0.5 * width(100));
    }
}
