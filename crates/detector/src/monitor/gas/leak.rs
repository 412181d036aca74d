//! From evidence to a leak: found, described, over, and how likely it is.
//!
//! The masses have a Bayes factor of a leak (`onset`), by a law of their errors that is the same everywhere. What they do in this vessel and
//! climate the evidence knows: as often as its statistics come up without a leak, once in `T`, a leak comes up once in [`LEAK_INTERVAL_S`], so what they show is
//! one with odds of at most `T / LEAK_INTERVAL_S`. The odds are those of the masses, but beyond the prior no larger than that.
use serde::{Deserialize, Serialize};

use super::onset::{self, MassError};
use super::trace::MassTrace;
use crate::estimator::observer::{Estimate, Leak};
use crate::monitor::{Interval, LeakFinding};

/// Prior odds of a leak within the weeks that are remembered: one in a hundred.
const PRIOR_ODDS: f64 = 0.01;
/// Mean time between leaks of a cylinder, s: ten years.
const LEAK_INTERVAL_S: f64 = 10.0 * 365.25 * 86_400.0;
/// Odds that are as good as certain.
const CERTAIN: f64 = 1e12;
/// Completed bins of the trace between two looks: an hour; but a look at each while the trace is short.
const BINS_PER_LOOK: u32 = 6;
const SHORT: u32 = 36;

/// What is known about a leak.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::monitor) struct LeakState {
    trace: MassTrace,
    /// Bins since the last look, and all.
    bins: u32,
    seen_bins: u32,
    found: Option<LeakFinding>,
    /// Time at which a leak was found, and at which something spoke for it last, s.
    found_s: f64,
    seen_s: f64,
    /// Odds of a leak by the masses; `None`: they have not said anything yet.
    odds: Option<f64>,
    /// Largest odds by the evidence.
    largest_odds: f64,
    /// What the rate of a leak is below with 97.5 %, as a part of the fill per second.
    largest_per_s: f64,
}

/// What the rate of a leak is below before anything is known, as a part of the fill per second: the whole fill in twenty hours.
const LARGEST_PER_S: f64 = 0.05 / 3600.0;

impl Default for LeakState {
    fn default() -> Self {
        Self {
            trace: MassTrace::default(),
            bins: 0,
            seen_bins: 0,
            found: None,
            found_s: f64::NAN,
            seen_s: f64::NAN,
            odds: None,
            largest_odds: PRIOR_ODDS,
            largest_per_s: LARGEST_PER_S,
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
    /// Considered error of the mass by what the surroundings do, standard deviation, kg.
    pub doubt_kg: f64,
    /// Mass of the fill, kg.
    pub filled_kg: f64,
    /// Mean time between statistics like these without a leak, s.
    pub false_alarm_s: f64,
    /// Whether a statistic is above its threshold, and whether all are far below.
    pub alarm: bool,
    pub calm: bool,
    pub over_after_s: f64,
}

impl LeakState {
    /// Take in a sample.
    pub fn step(&mut self, look: &Look<'_>) -> Change {
        let time_s = look.estimate.time_s;
        self.largest_odds = (look.false_alarm_s / LEAK_INTERVAL_S).clamp(PRIOR_ODDS, CERTAIN);
        // A tunnel or the sun may have moved this mass: it would count as lost gas.
        let doubtful = look.doubt_kg > look.error.sd_kg;
        let completed = !doubtful && self.trace.push(time_s, look.free.mass_kg);
        self.bins += u32::from(completed);
        self.seen_bins += u32::from(completed);
        let leaking = self.found.is_some();
        let newly = look.alarm && !leaking;
        let due = self.bins >= if self.seen_bins < SHORT { 1 } else { BINS_PER_LOOK };
        if newly || (completed && due) {
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
        let fitted = if leaking { onset::fit(&self.trace, look.error) } else { None };
        if leaking {
            let finding = fitted.map(|fitted| fitted.finding(look.pa_per_kg));
            self.found = finding.or(self.found).or_else(|| Some(self.by_rate(look)));
        }
        // A fit has both already: the upper end of its rate is what a leak is below with 97.5 %.
        let known = fitted.map(|fitted| (fitted.log_bayes_factor, fitted.rate_kg_s.high));
        if let Some((log_bayes_factor, largest_kg_s)) =
            known.or_else(|| onset::outlook(&self.trace, look.error))
        {
            self.odds = Some((PRIOR_ODDS * log_bayes_factor.exp()).min(CERTAIN));
            self.largest_per_s = largest_kg_s / look.filled_kg;
        }
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

    /// Probability that gas is being lost, by masses and evidence; `None`: the masses have not said anything yet.
    pub fn probability(&self) -> Option<f64> {
        self.odds.map(|odds| odds.min(self.largest_odds)).map(|odds| odds / (1.0 + odds))
    }

    /// What the rate of a leak is below with 97.5 %, as a part of the fill per second.
    pub fn largest_per_s(&self) -> f64 {
        self.largest_per_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimator::observer::Quality;
    use crate::units::MINUTE_S;

    /// Probability of a leak after a day in which the mass was 0.4 % too small for the last twenty minutes, so far in doubt, kg, with evidence that comes up
    /// once in such a time without a leak, s.
    fn after_a_tunnel(doubt_kg: f64, false_alarm_s: f64) -> f64 {
        let error = MassError::default();
        let mut state = LeakState::default();
        for minute in 0..1440 {
            let time_s = MINUTE_S * f64::from(minute);
            let in_tunnel = minute >= 1420;
            let mass_kg = 4.5 - if in_tunnel { 0.02 } else { 0.0 };
            let estimate = Estimate {
                time_s,
                gas_mean_k: 288.15,
                gas_mean_sd_k: 0.2,
                mass_kg,
                mass_sd_kg: 0.01,
                leak_kg_s: 0.0,
                leak_sd_kg_s: 1e-8,
                pressure_pa: 2e7,
                pressure_expected_pa: 2e7,
                p15_pa: 2e7,
                quality: Quality::Good,
            };
            let member = Leak {
                rate_kg_s: 0.0,
                sd_kg_s: 1e-8,
                mass_kg,
                mass_sd_kg: 0.01,
                covariance_kg2_s: 0.0,
                begun_anew: false,
            };
            let look = Look {
                estimate: &estimate,
                free: &member,
                slow: &member,
                pa_per_kg: 4.4e6,
                error: &error,
                doubt_kg: if in_tunnel { doubt_kg } else { 0.0 },
                filled_kg: 4.5,
                false_alarm_s,
                alarm: false,
                calm: true,
                over_after_s: 86_400.0,
            };
            assert_eq!(state.step(&look), Change::None);
        }
        state.probability().unwrap_or(0.0)
    }

    #[test]
    fn a_mass_in_doubt_makes_no_leak_likely() {
        let [doubted, certain] = [0.02, 0.0].map(|doubt_kg| after_a_tunnel(doubt_kg, f64::INFINITY));
        assert!(doubted < 0.05 && certain > 0.5, "{doubted} {certain}");
    }

    #[test]
    fn a_mass_is_no_leak_where_the_evidence_comes_up_every_week() {
        let weekly = after_a_tunnel(0.0, 7.0 * 86_400.0);
        assert!((weekly - 0.01 / 1.01).abs() < 1e-9, "the prior, no more: {weekly}");
        // As often without a leak as leaks come.
        assert!((after_a_tunnel(0.0, LEAK_INTERVAL_S) - 0.5).abs() < 1e-9);
    }
}
