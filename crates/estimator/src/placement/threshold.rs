//! The threshold of a change whose course in the residuals is known but not its onset.
//!
//! A leak drives the innovations of a filter like a ramp that levels off. Its test is a maximum over onsets within a window. Maxima of
//! the normalised field `Z(n, k)` over time `n` and onset `k` above `b` come in clusters; their rate per sample is, summed over
//! the ages `l = n - k`,
//!
//! `(phi(b)/b) sum_l F_n(l) F_k(l)`,
//!
//! where `F` is the probability that a point of the field is the summit of its cluster along one direction: `(x^2/2) nu(x)` along a
//! random walk of standard deviation `x` per sample (time; the sample that an onset gains or loses), `2 Phi(u/2) - 1` along a smooth
//! course of curvature `u^2` (the rest of a ramp changes smoothly with its onset). For both at once `F = F1 + F2 - F1 F2`.
//!
//! Assumes a one-sided ramp in white noise at even intervals, known but for size and onset. A signature that levels off has rather
//! fewer independent onsets than a ramp, so that its false alarms are rarer. Simulated mean times between false alarms were
//! within 20 % of the formula, from 1000 samples on.
//!
//! Source: D. Siegmund and E. S. Venkatraman, Ann. Stat. 23 (1995) 255; D. Siegmund and B. Yakir, The Statistics of Gene Mapping, 2007;
//! smooth fields: S. O. Rice, Bell Syst. Tech. J. 24 (1945) 46; mean overshoot: D. Siegmund, Sequential Analysis, 1985.

use statrs::distribution::{Continuous, ContinuousCDF, Normal};

use crate::EstimatorError;

/// Mean overshoot of a standard normal random walk over a far barrier, `-zeta(1/2)/sqrt(2 pi)`.
const MEAN_OVERSHOOT: f64 = 0.582_597_157_939_010_6;
/// Thresholds of the log-likelihood ratio between which the one asked for is sought.
const LOWEST: f64 = 0.5;
const HIGHEST: f64 = 300.0;
/// Relative error of the mean time at the threshold found.
const TOLERANCE: f64 = 1e-9;

/// Threshold of the best statistic for a one-sided ramp of unknown onset in white residuals, in its standard deviations.
///
/// For onsets within `within_s`, s, sampled every `interval_s`, s, and one false alarm in `between_alarms_s`, s, on average.
///
/// # Errors
/// A time is not positive and finite, or no threshold gives so short or long a time between alarms.
pub fn signature_threshold_sd(
    within_s: f64,
    interval_s: f64,
    between_alarms_s: f64,
) -> Result<f64, EstimatorError> {
    for (setting, value) in
        [("within_s", within_s), ("interval_s", interval_s), ("between_alarms_s", between_alarms_s)]
    {
        if !(value > 0.0 && value.is_finite()) {
            return Err(EstimatorError::PlacementSetting { setting, value, bound: "positive and finite" });
        }
    }
    let window = (within_s / interval_s).round().max(1.0) as usize;
    let threshold = threshold(between_alarms_s / interval_s, |threshold| mean_samples(threshold, window));
    let threshold = threshold.ok_or(EstimatorError::PlacementSetting {
        setting: "between_alarms_s",
        value: between_alarms_s,
        bound: "above some ten intervals and below 1e100",
    })?;
    Ok((2.0 * threshold).sqrt())
}

/// Mean number of samples between false alarms at a threshold of the log-likelihood ratio, onsets up to `window` samples old.
fn mean_samples(threshold: f64, window: usize) -> f64 {
    let b = (2.0 * threshold).sqrt();
    // Sums over the samples after the first one of an onset.
    let (mut rest, mut cross, mut curvature) = (0.0, 0.0, 0.0);
    let mut summits = 0.0;
    let normal = Normal::standard();
    for age in 0..window {
        let signature = 1.0 + age as f64;
        if age > 0 {
            rest += signature * signature;
            cross += signature;
            curvature += 1.0;
        }
        let information: f64 = 1.0 + rest;
        let newest = b * signature / information.sqrt();
        let oldest = b / information.sqrt();
        let bent: f64 = if rest > 0.0 { (curvature - cross * cross / rest).max(0.0) } else { 0.0 };
        let smooth = 2.0 * normal.cdf(0.5 * b * (bent / information).sqrt()) - 1.0;
        let rough = walk_summit(oldest);
        summits += walk_summit(newest) * (rough + smooth - rough * smooth);
    }
    b / (normal.pdf(b) * summits)
}

/// Probability that a point is the summit of a random walk with drift away from it to both sides.
fn walk_summit(x: f64) -> f64 {
    0.5 * x * x * discreteness(x)
}

/// Share of the clusters of exceedances of a normal random walk, drift `-x^2/2` and variance `x^2`, that its discrete
/// time leaves: `nu(x) = (2/x) [Phi(x/2) - 1/2]/[(x/2) Phi(x/2) + phi(x/2)]`, nearly `exp(-0.583 x)`.
fn discreteness(x: f64) -> f64 {
    if x < 1e-6 {
        return 1.0 - MEAN_OVERSHOOT * x;
    }
    let half = 0.5 * x;
    let normal = Normal::standard();
    (normal.cdf(half) - 0.5) / half / (half * normal.cdf(half) + normal.pdf(half))
}

/// The threshold at which a mean time, which grows with it, is `wished`; `None` where there is none.
///
/// Regula falsi in the logarithm of the mean time, nearly linear in the threshold, with the Illinois correction.
fn threshold(wished: f64, mean: impl Fn(f64) -> f64) -> Option<f64> {
    let excess = |threshold: f64| mean(threshold).ln() - wished.ln();
    let (mut below, mut excess_below) = (LOWEST, excess(LOWEST));
    let (mut above, mut excess_above) = (below, excess_below);
    if excess_below > TOLERANCE {
        return None;
    }
    // Outwards in steps that grow: far beyond the target the mean time overflows.
    let mut step = 0.05 * (HIGHEST - LOWEST);
    while excess_above < 0.0 {
        if above >= HIGHEST {
            return None;
        }
        (below, excess_below) = (above, excess_above);
        above = (above + step).min(HIGHEST);
        excess_above = excess(above);
        step *= 1.3;
    }
    let mut middle = above;
    for _ in 0..200 {
        if (excess_above - excess_below).abs() < TOLERANCE || above - below < 1e-13 * above.abs() {
            break;
        }
        middle = (below * excess_above - above * excess_below) / (excess_above - excess_below);
        let found = excess(middle);
        if found.abs() < TOLERANCE {
            break;
        }
        if found > 0.0 {
            (above, excess_above) = (middle, found);
            excess_below *= 0.5;
        } else {
            (below, excess_below) = (middle, found);
            excess_above *= 0.5;
        }
    }
    Some(middle)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use cylwatch_thermal::units::{DAY_S, YEAR_S};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::*;

    #[test]
    fn a_day_of_minutes_at_one_alarm_in_ten_years_takes_between_five_and_six_deviations() {
        let threshold = signature_threshold_sd(DAY_S, 60.0, 10.0 * YEAR_S).unwrap();
        assert!((5.0..6.2).contains(&threshold), "{threshold}");
    }

    #[test]
    fn rarer_alarms_and_more_samples_take_a_higher_threshold() {
        let of = |interval_s, years: f64| signature_threshold_sd(DAY_S, interval_s, years * YEAR_S).unwrap();
        assert!(of(60.0, 1.0) < of(60.0, 10.0) && of(60.0, 10.0) < of(60.0, 100.0));
        assert!(of(600.0, 10.0) < of(60.0, 10.0));
    }

    #[test]
    fn ramps_sought_in_white_noise_alarm_as_seldom_as_asked_for() {
        // 1000 samples between false alarms, onsets up to 60 samples old.
        let threshold = signature_threshold_sd(60.0, 1.0, 1000.0).unwrap();
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let runs = 600;
        let mut samples = 0;
        for _ in 0..runs {
            let mut last: Vec<f64> = Vec::new();
            loop {
                samples += 1;
                last.push(random.sample(StandardNormal));
                // Both sums over the samples since an onset, oldest onset last: `sum (1 + j) x_j` and `sum (1 + j)^2`.
                let (mut sum, mut weighted, mut information, mut most) = (0.0, 0.0, 0.0, 0.0_f64);
                for (age, x) in last.iter().rev().take(60).enumerate() {
                    sum += x;
                    weighted += sum;
                    information += (1.0 + age as f64).powi(2);
                    most = most.max(weighted / f64::sqrt(information));
                }
                if most >= threshold {
                    break;
                }
            }
        }
        let mean = f64::from(samples) / f64::from(runs);
        assert!((800.0..1250.0).contains(&mean), "{mean}");
    }

    #[test]
    fn the_discreteness_is_the_exponential_of_the_overshoot_for_small_steps() {
        for x in [1e-7, 1e-3, 0.1, 0.5, 1.0] {
            assert_relative_eq!(discreteness(x), (-MEAN_OVERSHOOT * x).exp(), max_relative = 0.02);
        }
    }

    #[test]
    fn times_that_are_none_are_refused_by_name() {
        for (times, name) in [
            ((0.0, 60.0, YEAR_S), "within_s"),
            ((DAY_S, f64::NAN, YEAR_S), "interval_s"),
            ((DAY_S, 60.0, -1.0), "between_alarms_s"),
            ((DAY_S, 60.0, 60.0), "between_alarms_s"),
            ((DAY_S, 60.0, 1e200), "between_alarms_s"),
        ] {
            let message = signature_threshold_sd(times.0, times.1, times.2).unwrap_err().to_string();
            assert!(message.contains(name), "{message}");
        }
    }
}
