//! From evidence to a leak: found, described, over.
use serde::{Deserialize, Serialize};

use super::onset::{self, MassError};
use super::trace::MassTrace;
use crate::estimator::observer::{Estimate, Leak};
use crate::monitor::{Interval, LeakFinding};

/// Prior odds of a leak within the weeks that are remembered: one in a hundred.
const PRIOR_ODDS: f64 = 0.01;
/// Completed bins of the trace between two looks: an hour.
const BINS_PER_LOOK: u32 = 6;

/// What is known about a leak.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::monitor) struct LeakState {
    trace: MassTrace,
    bins: u32,
    found: Option<LeakFinding>,
    /// Time at which a leak was found, and at which something spoke for it last, s.
    found_s: f64,
    seen_s: f64,
    probability: f64,
}

impl Default for LeakState {
    fn default() -> Self {
        Self {
            trace: MassTrace::default(),
            bins: 0,
            found: None,
            found_s: f64::NAN,
            seen_s: f64::NAN,
            probability: probability(PRIOR_ODDS),
        }
    }
}

/// What changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::monitor) enum Change {
    None,
    Found(LeakFinding),
    Ended,
}

/// What a look rests on.
pub(in crate::monitor) struct Look<'a> {
    pub estimate: &'a Estimate,
    /// The freest member, whose mass is right in any leak.
    pub free: &'a Leak,
    /// The slow member whose rate stands in as long as the trace is short.
    pub slow: &'a Leak,
    pub pa_per_kg: f64,
    pub error: &'a MassError,
    /// Whether a statistic is above its threshold, and whether all are far below.
    pub alarm: bool,
    pub calm: bool,
    pub over_after_s: f64,
}

impl LeakState {
    /// Take in a sample.
    pub fn step(&mut self, look: &Look<'_>) -> Change {
        let time_s = look.estimate.time_s;
        let completed = self.trace.push(time_s, look.free.mass_kg);
        self.bins += u32::from(completed);
        let leaking = self.found.is_some();
        let newly = look.alarm && !leaking;
        if newly || (completed && self.bins >= BINS_PER_LOOK) {
            self.bins = 0;
            self.look(look, newly || leaking);
        }
        if newly {
            (self.found_s, self.seen_s) = (time_s, time_s);
            return self.found.map_or(Change::None, Change::Found);
        }
        if !look.calm {
            self.seen_s = time_s;
        }
        if leaking && time_s - self.seen_s > look.over_after_s {
            self.found = None;
            return Change::Ended;
        }
        Change::None
    }

    fn look(&mut self, look: &Look<'_>, leaking: bool) {
        let log_bayes_factor = if leaking {
            let fitted = onset::fit(&self.trace, look.error);
            let finding = fitted.map(|fitted| fitted.finding(look.pa_per_kg));
            self.found = finding.or(self.found).or_else(|| Some(self.by_rate(look)));
            fitted.map_or(0.0, |fitted| fitted.log_bayes_factor)
        } else {
            onset::log_bayes_factor(&self.trace, look.error)
        };
        self.probability = probability(PRIOR_ODDS * log_bayes_factor.exp().min(1e12));
    }

    /// What a member of the bank says, where the trace says nothing yet.
    fn by_rate(&self, look: &Look<'_>) -> LeakFinding {
        let (rate, spread) = (look.slow.rate_kg_s.max(0.0), 1.96 * look.slow.sd_kg_s);
        let rate_kg_s = Interval { value: rate, low: (rate - spread).max(0.0), high: rate + spread };
        let time_s = look.estimate.time_s;
        let oldest_s = self.trace.oldest_s().unwrap_or(time_s);
        let middle_s = 0.5 * (oldest_s + time_s);
        LeakFinding {
            rate_kg_s,
            rate_pa_s: rate_kg_s.scaled(look.pa_per_kg),
            onset_s: Interval { value: middle_s, low: oldest_s, high: time_s },
            lost_kg: rate_kg_s.scaled(time_s - middle_s),
        }
    }

    /// Other gas is in the cylinder: whatever was found is over.
    pub fn begin_anew(&mut self) -> Change {
        let was = self.found.is_some();
        *self = Self::default();
        if was { Change::Ended } else { Change::None }
    }

    /// The leak, while there is one.
    pub fn found(&self) -> Option<&LeakFinding> {
        self.found.as_ref()
    }

    /// Probability that gas is being lost.
    pub fn probability(&self) -> f64 {
        if self.found.is_some() { self.probability.max(0.5) } else { self.probability }
    }
}

fn probability(odds: f64) -> f64 {
    odds / (1.0 + odds)
}
