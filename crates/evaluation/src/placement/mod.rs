//! Whether layouts achieve what they are predicted to: Monte Carlo runs of the ordinary [`Observer`](crate::estimator::observer::Observer).
//!
//! A prediction is the steady state of a linearised filter. Here truths are drawn, all candidates read them, and one observer for
//! each layout reads its own candidates' columns; so all layouts see the same truths. At several times after a burn-in the errors of gas
//! temperature, mass and leak rate are collected:
//!
//! `rms^2 = sum_seeds sum_times e^2 / n`.
//!
//! | world | truth | observer |
//! |---|---|---|
//! | [`matched()`] | the observer's own equations, nonlinear, with its own noise | one member, no allowance for the model |
//! | [`mismatched()`] | drawn cylinders in railway weather ([`crate::world`]) read by drawn specimens | as the settings say |
//!
//! The interval of an rms is that of a bootstrap over seeds, since the times of one run hang together. In the matched world the constants
//! of all seeds are drawn together, with exactly the moments of their prior; the bootstrap does not know that, so its interval is too wide
//! rather than too narrow.
//!
//! Source: Efron and Tibshirani 1993, chapter 13 (percentile interval).
mod closed_loop;
mod detection;
mod draws;
mod matched;
mod mismatched;
mod sink;
mod tally;
mod trial;

use cylwatch_thermal::units::{DAY_S, HOUR_S};
use serde::{Deserialize, Serialize};

use crate::EvaluationError;
use crate::estimator::EstimatorError;
use crate::estimator::consistency::Band;
use crate::estimator::observer::{LeakHypothesis, ObserverSettings};
use crate::estimator::placement::Conditions;
use crate::estimator::sensor::Sensor;
use crate::thermal::vessel::Vessel;
use crate::world::SteadyLeak;

pub use closed_loop::{ClosedLoop, ClosedLoopSettings, confirm, confirm_study};
pub use detection::{Detected, detected_matched, detected_mismatched};
pub use matched::{calm, matched};
pub use mismatched::mismatched;
pub use sink::{InnovationSink, RunId};

/// What is to be confirmed.
#[derive(Clone, Copy, Debug)]
pub struct Claim<'a> {
    /// The nominal vessel.
    pub vessel: &'a Vessel,
    /// The candidates.
    pub candidates: &'a [Sensor],
    /// The observer's settings.
    pub settings: &'a ObserverSettings,
    /// The member of the bank that the predictions hold for.
    pub member: &'a LeakHypothesis,
    /// Where the cylinder was linearised, its filling, and the interval of the rows.
    pub conditions: &'a Conditions,
    /// Indices of each layout's candidates.
    pub layouts: &'a [Vec<usize>],
}

/// How it is confirmed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConfirmSettings {
    /// First seed.
    pub first_seed: u64,
    /// Number of seeds.
    pub seeds: u64,
    /// Length of a run, s.
    pub duration_s: f64,
    /// Time from which on errors count, s.
    pub burn_in_s: f64,
    /// From one time at which they are taken to the next, s: well apart.
    pub every_s: f64,
    /// A leak of the truth that the observer is not told of.
    pub leak: Option<SteadyLeak>,
    /// Standard deviation of the truth's process noise in that of the filter; in the matched world alone. 1: they are matched.
    pub noise_factor: f64,
}

impl Default for ConfirmSettings {
    /// A hundred runs of six days, judged every six hours of the last three.
    fn default() -> Self {
        Self {
            first_seed: 1,
            seeds: 100,
            duration_s: 6.0 * DAY_S,
            burn_in_s: 3.0 * DAY_S,
            every_s: 6.0 * HOUR_S,
            leak: None,
            noise_factor: 1.0,
        }
    }
}

/// Predicted, stated and achieved, in the unit of the quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Achieved {
    /// Standard deviation of the steady state; `None`: the layout has none, or the member does not estimate the quantity.
    pub predicted: Option<f64>,
    /// Mean of the standard deviation that the observer states.
    pub stated: f64,
    /// Root mean square of the error.
    pub rms: f64,
    /// Its 95 % interval over seeds.
    pub interval: Band,
    /// Mean of the error.
    pub bias: f64,
    /// Share of the times whose stated 95 % band holds the truth.
    pub coverage: f64,
    /// Its 95 % interval over seeds.
    pub coverage_interval: Band,
}

impl Achieved {
    /// Achieved in parts of what was predicted.
    pub fn ratio(&self) -> Option<f64> {
        self.predicted.map(|predicted| self.rms / predicted)
    }
}

/// What a layout achieves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Confirmed {
    /// Indices of its candidates.
    pub layout: Vec<usize>,
    /// Runs that count.
    pub seeds: u64,
    /// Mean gas temperature, K.
    pub gas_k: Achieved,
    /// Gas mass, kg.
    pub mass_kg: Achieved,
    /// Leak rate, kg/s, if a member of the bank has one.
    pub leak_kg_s: Option<Achieved>,
}

/// One observer's run with the sink of its innovations.
#[derive(Clone, Debug, PartialEq)]
pub struct Run<L> {
    /// Which run.
    pub id: RunId,
    /// The sink after it.
    pub sink: L,
}

/// All that came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Confirmation<L> {
    /// One for each layout, in their order; none without a seed.
    pub layouts: Vec<Confirmed>,
    /// Every run, seed by seed and layout by layout.
    pub runs: Vec<Run<L>>,
    /// It was stopped: later seeds are missing.
    pub partial: bool,
}

/// When rows come, and which are judged.
#[derive(Clone, Copy, Debug)]
struct Rows {
    interval_s: f64,
    count: usize,
    first: usize,
    every: usize,
}

impl Rows {
    fn new(claim: &Claim<'_>, settings: &ConfirmSettings) -> Result<Self, EvaluationError> {
        let interval_s = claim.conditions.interval_s;
        let require = |ok: bool, setting: &'static str, value: f64, bound: &'static str| {
            if ok { Ok(()) } else { Err(EstimatorError::PlacementSetting { setting, value, bound }) }
        };
        let ConfirmSettings { seeds, duration_s, burn_in_s, every_s, noise_factor, .. } = *settings;
        require(interval_s > 0.0 && interval_s.is_finite(), "interval_s", interval_s, "positive")?;
        require(seeds > 0, "seeds", seeds as f64, "at least 1")?;
        require((0.0..1e10).contains(&duration_s), "duration_s", duration_s, "between 0 and 1e10 s")?;
        require((0.0..=duration_s).contains(&burn_in_s), "burn_in_s", burn_in_s, "within the duration")?;
        require(every_s > 0.0, "every_s", every_s, "positive")?;
        let is_factor = noise_factor >= 0.0 && noise_factor.is_finite();
        require(is_factor, "noise_factor", noise_factor, "finite and at least 0")?;
        let candidates = claim.candidates.len();
        if let Some(index) = claim.layouts.iter().flatten().find(|index| **index >= candidates) {
            let what = format!("candidate {index} is named, but there are only {candidates}");
            return Err(EstimatorError::PlacementConstraints { what }.into());
        }
        Ok(Self {
            interval_s,
            count: (duration_s / interval_s).floor() as usize + 1,
            first: (burn_in_s / interval_s).ceil() as usize,
            every: ((every_s / interval_s).round() as usize).max(1),
        })
    }

    fn is_judged(&self, row: usize) -> bool {
        row >= self.first && (row - self.first).is_multiple_of(self.every)
    }
}
