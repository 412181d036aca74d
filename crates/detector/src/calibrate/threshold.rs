//! The threshold of any detector by running it on residuals without a change.
//!
//! One run tells the time to the first alarm for every threshold at once: that of the first value to reach it. Over runs
//! cut off after the time `H`, the mean time to an alarm is the time at risk per alarm, `sum min(T_i, H)/#{T_i <= H}`, the
//! maximum-likelihood estimate for exponential times; the threshold is where it equals the wished one. Other runs, to
//! the first alarm at that threshold, then tell what it achieves.
//!
//! A mean time too long to be run is extrapolated: its logarithm is linear in the threshold of a log-likelihood ratio or a
//! cumulative sum, and in the square of the threshold of a normal value ([`Tail`]). The slope is that between an
//! eighth of the longest run and the longest run.
//!
//! Assumes that times to an alarm are nearly exponential, as they are for thresholds that are seldom reached.
//!
//! Source: censored exponential times: J. F. Lawless, Statistical Models and Methods for Lifetime Data, 2003, section
//! 4.1; nearly exponential run lengths: D. Siegmund and E. S. Venkatraman, Ann. Stat. 23 (1995) 255.
use serde::{Deserialize, Serialize};

use super::{FalseAlarms, ResidualSource};
use crate::{DetectorError, error::positive};

/// From the longest mean time that is run to the shorter one that gives the slope.
const STEP_BACK: f64 = 8.0;

/// How the logarithm of the mean time grows with the threshold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tail {
    /// Linearly: log-likelihood ratios, cumulative sums, Shiryaev-Roberts.
    #[default]
    Exponential,
    /// With the square: Shewhart's chart and moving averages.
    Normal,
}

/// How a threshold is calibrated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CalibrationSettings {
    /// Mean number of samples between false alarms that is wished.
    pub arl: f64,
    /// Number of runs to find the threshold, and as many again to see what it achieves.
    pub runs: u64,
    /// Samples of the longest run; for longer mean times the threshold is extrapolated.
    pub longest_run: u64,
    /// For the extrapolation.
    pub tail: Tail,
}

impl CalibrationSettings {
    /// 400 runs of at most 20 000 samples, which leaves some 6 % uncertainty of the mean time.
    pub fn new(arl: f64) -> Self {
        Self { arl, runs: 400, longest_run: 20_000, tail: Tail::default() }
    }
}

/// A threshold, and what is known about it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Calibrated {
    /// The threshold.
    pub threshold: f64,
    /// False alarms at it on runs that it was not found from; `None` if it was extrapolated.
    pub achieved: Option<FalseAlarms>,
    /// The longest mean time that was run: above it the threshold is extrapolated.
    pub run_to: f64,
}

/// Find the threshold of the statistic that `detector` makes anew for each run.
///
/// # Errors
/// The wished mean time is not above 1, there are no runs, or the statistic does not reach two different values in them.
pub fn calibrate_threshold<S: ResidualSource, D: FnMut(S::Sample) -> f64>(
    source: &mut S,
    detector: impl Fn() -> D,
    settings: &CalibrationSettings,
) -> Result<Calibrated, DetectorError> {
    positive("arl - 1", settings.arl - 1.0)?;
    positive("runs", settings.runs as f64)?;
    positive("longest_run", settings.longest_run as f64)?;
    let horizon = settings.arl.min(settings.longest_run as f64);
    let records: Vec<Records> =
        (0..settings.runs).map(|run| Records::of_run(source, &detector, run, horizon as u64)).collect();
    let at_horizon = threshold_from(&records, horizon)?;
    if settings.arl <= horizon {
        let other_runs = settings.runs..2 * settings.runs;
        let achieved = first_alarms(source, &detector, at_horizon, other_runs, 3.0 * horizon);
        return Ok(Calibrated { threshold: at_horizon, achieved: Some(achieved), run_to: horizon });
    }
    let below = threshold_from(&records, horizon / STEP_BACK)?;
    let extrapolated =
        |below: f64, at: f64| at + (at - below) * (settings.arl / horizon).ln() / STEP_BACK.ln();
    let threshold = match settings.tail {
        Tail::Exponential => extrapolated(below, at_horizon),
        Tail::Normal => extrapolated(below * below, at_horizon * at_horizon).sqrt(),
    };
    Ok(Calibrated { threshold, achieved: None, run_to: horizon })
}

/// First alarms at a threshold over runs cut off at `horizon` samples.
fn first_alarms<S: ResidualSource, D: FnMut(S::Sample) -> f64>(
    source: &mut S,
    detector: &impl Fn() -> D,
    threshold: f64,
    runs: std::ops::Range<u64>,
    horizon: f64,
) -> FalseAlarms {
    let mut found = FalseAlarms::default();
    for run in runs {
        source.begin(run);
        let mut running = detector();
        let at_risk = (1..horizon as u64).find(|_| running(source.next_residual()) >= threshold);
        found.alarms += u64::from(at_risk.is_some());
        found.samples += at_risk.map_or(horizon, |samples| samples as f64);
    }
    found
}

/// The values of a run that were larger than all before them.
struct Records {
    /// Number of the sample, from 1, and value, both increasing.
    values: Vec<(u64, f64)>,
    length: u64,
}

impl Records {
    fn of_run<S: ResidualSource, D: FnMut(S::Sample) -> f64>(
        source: &mut S,
        detector: &impl Fn() -> D,
        run: u64,
        length: u64,
    ) -> Self {
        source.begin(run);
        let mut running = detector();
        let mut values: Vec<(u64, f64)> = Vec::new();
        let mut largest = f64::NEG_INFINITY;
        for n in 1..=length {
            let value = running(source.next_residual());
            if value > largest {
                largest = value;
                values.push((n, value));
            }
        }
        Self { values, length }
    }

    /// When `threshold` was reached.
    fn alarm(&self, threshold: f64) -> Option<u64> {
        let first = self.values.partition_point(|(_, value)| *value < threshold);
        self.values.get(first).map(|(n, _)| *n)
    }
}

/// The smallest recorded value that has a mean time to alarm of at least `arl`.
fn threshold_from(records: &[Records], arl: f64) -> Result<f64, DetectorError> {
    let mut values: Vec<f64> =
        records.iter().flat_map(|run| run.values.iter().map(|(_, value)| *value)).collect();
    values.sort_by(f64::total_cmp);
    let mean = |threshold: f64| {
        let mut found = FalseAlarms::default();
        for run in records {
            let alarm = run.alarm(threshold);
            found.alarms += u64::from(alarm.is_some());
            found.samples += alarm.unwrap_or(run.length) as f64;
        }
        found.mean()
    };
    let index = values.partition_point(|value| mean(*value) < arl);
    let out_of_reach = || {
        let (low, high) = (values.first().copied(), values.last().copied());
        let (low, high) = (low.unwrap_or(f64::NAN), high.unwrap_or(f64::NAN));
        DetectorError::OutOfReach { wished: arl, low, high, shortest: mean(low), longest: mean(high) }
    };
    values.get(index).copied().filter(|value| value.is_finite()).ok_or_else(out_of_reach)
}
