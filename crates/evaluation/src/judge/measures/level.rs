//! The threshold for a wished mean time between false alarms, from what a statistic reached on tight cylinders.
//!
//! Each run gives one number, the largest value of its statistic. Above a high level `u` the largest values of runs are taken as
//! exponential: of `n` runs of the whole length `V`, the `k` largest exceed `u`, the next one, by `beta` on average, so that the
//! threshold `h` is exceeded once in `V/(k exp(-(h - u)/beta))`:
//!
//! `h = u + beta ln(k W/V)` for the wished mean time `W`.
//!
//! The relative error of `beta` is `1/sqrt(k)`. Where `W` lies within the runs that is an interpolation; beyond `V` it is an extrapolation by
//! the factor `W/V`.
//!
//! Assumes runs that are alike and a tail that falls exponentially or faster; heavier tails alarm more often than wished, which is what the
//! test runs are for.
//!
//! Source: I. Weissman, J. Am. Stat. Assoc. 73 (1978) 812.
use serde::{Deserialize, Serialize};

use crate::{EvaluationError, error::positive};

/// Part of the runs that makes the tail, and the fewest and most runs of it.
const TAIL_PART: f64 = 0.3;
const MIN_TAIL_RUNS: usize = 3;
const MAX_TAIL_RUNS: usize = 40;

/// A threshold and what stands behind it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AlarmLevel {
    /// The threshold, in the unit of the statistic.
    pub threshold: f64,
    /// Standard deviation of the threshold from that of the tail's scale.
    pub sd: f64,
    /// Wished mean time over the length of all runs: above 1 the threshold is extrapolated.
    pub factor: f64,
    /// Runs in the tail.
    pub tail: u64,
}

/// From the largest value of each run and the length of all runs together, s.
///
/// # Errors
/// Times are not positive, or fewer than five runs have a value.
pub(crate) fn alarm_level(
    largest: &[f64],
    length_s: f64,
    between_alarms_s: f64,
) -> Result<AlarmLevel, EvaluationError> {
    positive("length_s", length_s)?;
    positive("between_alarms_s", between_alarms_s)?;
    let mut sorted: Vec<f64> = largest.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(|a, b| b.total_cmp(a));
    if sorted.len() < MIN_TAIL_RUNS + 2 {
        return Err(EvaluationError::TooFewRuns { found: sorted.len(), needed: MIN_TAIL_RUNS + 2 });
    }
    let tail = ((TAIL_PART * sorted.len() as f64).round() as usize)
        .clamp(MIN_TAIL_RUNS, MAX_TAIL_RUNS.min(sorted.len() - 1));
    let level = sorted[tail];
    let scale = sorted[..tail].iter().map(|value| value - level).sum::<f64>() / tail as f64;
    let factor = between_alarms_s / length_s;
    let beyond = (tail as f64 * factor).ln();
    let sd = scale / (tail as f64).sqrt() * beyond.abs();
    Ok(AlarmLevel { threshold: level + scale * beyond, sd, factor, tail: tail as u64 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn the_level_is_that_of_the_hand() {
        // Ten runs of 1 s: the three largest exceed 7 by 1, 2, 3, mean 2; once in 10 s is ln 3 means above it.
        let largest = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0];
        let level = alarm_level(&largest, 10.0, 10.0).unwrap();
        assert_relative_eq!(level.threshold, 7.0 + 2.0 * 3.0_f64.ln(), max_relative = 1e-12);
        assert_relative_eq!(level.sd, 2.0 / 3.0_f64.sqrt() * 3.0_f64.ln(), max_relative = 1e-12);
        assert_eq!((level.factor, level.tail), (1.0, 3));
    }

    #[test]
    fn exponential_tails_are_extrapolated_without_bias() {
        // Largest of 1000 exponential numbers: h = ln(1000 W) is exceeded once in W runs.
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut largest = || {
            let all = (0..1000).map(|_| -random.random::<f64>().ln());
            all.fold(0.0, f64::max)
        };
        let trials = 200;
        let levels: Vec<f64> = (0..trials)
            .map(|_| {
                let runs: Vec<f64> = (0..40).map(|_| largest()).collect();
                alarm_level(&runs, 40.0, 400.0).unwrap().threshold
            })
            .collect();
        let mean = levels.iter().sum::<f64>() / f64::from(trials);
        let expected = (1000.0_f64 * 400.0).ln();
        // A level has a standard deviation of ln(120)/sqrt(12) = 1.4.
        assert!((mean - expected).abs() < 4.0 * 1.4 / f64::from(trials).sqrt(), "{mean} {expected}");
    }

    #[test]
    fn runs_without_a_value_do_not_count_and_too_few_are_refused() {
        let largest = [1.0, f64::NEG_INFINITY, 3.0, 4.0, f64::NAN, 6.0, 5.0];
        assert_eq!(alarm_level(&largest, 7.0, 7.0).unwrap().tail, 3);
        assert!(alarm_level(&largest[..6], 6.0, 7.0).is_err());
        assert!(alarm_level(&largest, 0.0, 7.0).is_err());
    }
}
