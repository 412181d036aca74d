//! Tails fitted to the largest values of stretches of operation.
//!
//! The law is that of [`Tail`]. Its level is the value that one in ten stretches exceeds. Scale and shape are those of largest likelihood
//! (Grimshaw's profile in `k/s`), the shape kept within -1/4 to 1/4: beyond, hundreds of peaks do not tell it. The interval of a threshold is that of
//! records drawn again with replacement, whole cylinders with all their sets of sensors at a time.
//!
//! Source: J. Pickands, Ann. Stat. 3 (1975) 119; S. D. Grimshaw, Technometrics 35 (1993) 185.
use cylwatch_thermal::units::HOUR_S;
use std::collections::BTreeMap;

use cylwatch_detector::evidence::{Scale, Tail, Tails, Thresholds};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::monitored::MonitoredCylinder;
use super::record::Record;
use crate::EvaluationError;
use crate::world::SimulationKey;

/// Part of the stretches that the tail is fitted to.
const TAIL_PART: f64 = 0.1;
/// Fewest peaks above the level.
const MIN_PEAKS: usize = 20;
/// Fewest stretches.
pub(super) const STRETCHES: usize = (MIN_PEAKS as f64 / TAIL_PART) as usize;
/// Largest shape either way.
const SHAPE: f64 = 0.25;
/// Draws for an interval.
const DRAWS: usize = 400;

/// Fit to the largest values of stretches of so many seconds.
///
/// # Errors
/// Too few stretches, or values that do not vary.
pub(super) fn fit_one(largest: &[f64], stretch_s: f64) -> Result<Tail, EvaluationError> {
    let mut sorted: Vec<f64> = largest.iter().copied().filter(|value| value.is_finite()).collect();
    let needed = STRETCHES;
    if sorted.len() < needed {
        return Err(EvaluationError::TooFewStretches { found: sorted.len(), needed });
    }
    sorted.sort_by(f64::total_cmp);
    let above = (sorted.len() as f64 * TAIL_PART) as usize;
    let level = sorted[sorted.len() - above - 1];
    let excess: Vec<f64> = sorted[sorted.len() - above..].iter().map(|value| value - level).collect();
    let mean = excess.iter().sum::<f64>() / excess.len() as f64;
    if mean <= 0.0 {
        return Err(EvaluationError::StatisticsConstant);
    }
    let (scale, shape) = pareto(&excess, mean);
    Ok(Tail { level, interval_s: stretch_s * sorted.len() as f64 / above as f64, scale, shape })
}

/// Fit to the records of leak-free cylinders; `stretch` as in `Record::stretch_h`.
///
/// # Errors
/// As [`fit_one`].
pub(super) fn fit(records: &[&Record], stretch: f64) -> Result<Tails, EvaluationError> {
    let peaks: Vec<Peaks> = records.iter().map(|record| peaks(record, stretch)).collect();
    fit_peaks(&peaks.iter().collect::<Vec<_>>(), stretch)
}

/// Largest values of the whole stretches of a cylinder, scale by scale.
type Peaks = [Vec<f64>; Scale::ALL.len()];

fn peaks(record: &Record, stretch: f64) -> Peaks {
    Scale::ALL.map(|scale| record.peaks(scale, stretch).collect())
}

fn fit_peaks(peaks: &[&Peaks], stretch: f64) -> Result<Tails, EvaluationError> {
    let one = |scale: Scale| {
        let largest: Vec<f64> = peaks.iter().flat_map(|peaks| &peaks[scale as usize]).copied().collect();
        fit_one(&largest, HOUR_S * Record::stretch_h(scale, stretch) as f64)
    };
    let [a, b, c, d, e] = Scale::ALL.map(one);
    Ok(Tails([a?, b?, c?, d?, e?]))
}

/// Low and high thresholds, 95 %, of a mean time between false alarms, s: of draws of as many cylinders with replacement.
///
/// # Errors
/// As [`fit`], or the time is not positive.
pub(super) fn interval(
    monitored: &[MonitoredCylinder],
    stretch: f64,
    mean_time_s: f64,
    seed: u64,
) -> Result<[(f64, f64); Scale::ALL.len()], EvaluationError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut of_simulations: BTreeMap<SimulationKey, Peaks> = BTreeMap::new();
    for MonitoredCylinder { request, record } in monitored {
        let all = of_simulations.entry(SimulationKey::of(request)).or_default();
        all.iter_mut().zip(peaks(record, stretch)).for_each(|(all, of_set)| all.extend(of_set));
    }
    let peaks: Vec<Peaks> = of_simulations.into_values().collect();
    let mut draw = || peaks.iter().map(|_| &peaks[random.random_range(0..peaks.len())]).collect();
    let draws: Vec<Vec<&Peaks>> = (0..DRAWS).map(|_| draw()).collect();
    let thresholds = |again: &Vec<&Peaks>| Ok(fit_peaks(again, stretch)?.thresholds(mean_time_s)?);
    let drawn: Vec<Thresholds> = draws.par_iter().map(thresholds).collect::<Result<_, EvaluationError>>()?;
    Ok(Scale::ALL.map(|scale| {
        let mut levels: Vec<f64> = drawn.iter().map(|thresholds| thresholds.of(scale)).collect();
        levels.sort_by(f64::total_cmp);
        (levels[DRAWS / 40], levels[DRAWS - 1 - DRAWS / 40])
    }))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pareto_tail_is_found_again_and_extrapolates_as_its_law() {
        // Quantiles of excesses 0.4 [(1 - p)^-0.1 - 1]/0.1 above 1, on top of nine in ten that stay below.
        let n = 4000;
        let quantile = |i: usize| {
            let p = (i as f64 + 0.5) / n as f64;
            if p < 0.9 { p / 0.9 } else { 1.0 + 4.0 * ((10.0 * (1.0 - p)).powf(-0.1) - 1.0) }
        };
        let largest: Vec<f64> = (0..n).map(quantile).collect();
        let tail = fit_one(&largest, 100.0).unwrap();
        assert!((tail.shape - 0.1).abs() < 0.03 && (tail.scale - 0.4).abs() < 0.02, "{tail:?}");
        // One in a million stretches.
        let expected = 1.0 + 4.0 * (1e5_f64.powf(0.1) - 1.0);
        assert!((tail.threshold(1e8) / expected - 1.0).abs() < 0.12, "{} {expected}", tail.threshold(1e8));
        assert!((tail.interval_s / 1000.0 - 1.0).abs() < 1e-9);
    }
}
