//! From evidence to a leak: found, described, over, and how likely it is.
//!
//! What the observer says of every onset makes a Bayes factor of a leak (`onset`), as if its errors were normal. What they do in this vessel and
//! climate the evidence knows: as often as its statistics come up without a leak, once in `T`, a leak comes up once in [`LEAK_INTERVAL_S`], so what they show is
//! one with odds of at most `T / LEAK_INTERVAL_S`. The odds are those of the Bayes factor, but beyond the prior no larger than that.
use serde::{Deserialize, Serialize};

use super::onset::Posterior;
use crate::DetectorError;
use crate::monitor::{Interval, LeakFinding, restored};

/// Prior odds of a leak within the weeks that are remembered: one in a hundred.
const PRIOR_ODDS: f64 = 0.01;
/// Mean time between leaks of a cylinder, s: ten years.
const LEAK_INTERVAL_S: f64 = 10.0 * 365.25 * 86_400.0;
/// Odds that are as good as certain.
const CERTAIN: f64 = 1e12;
/// Time between two looks, s.
const BETWEEN_LOOKS_S: f64 = 600.0;

/// What is known about a leak.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::monitor) struct LeakState {
    /// Time of the next look, s.
    due_s: f64,
    found: Option<LeakFinding>,
    /// Time at which something spoke for it last, s.
    seen_s: f64,
    /// Odds of a leak by the Bayes factor; `None`: too little has been seen.
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
            due_s: f64::NEG_INFINITY,
            found: None,
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

/// Gas that was lost while nothing was heard: from when until when, s, and how much, kg.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::monitor) struct LostUnheard {
    pub from_s: f64,
    pub until_s: f64,
    pub mass_kg: f64,
}

/// What a look rests on.
#[derive(Clone, Copy, Debug)]
pub(in crate::monitor) struct Look {
    pub time_s: f64,
    pub pa_per_kg: f64,
    /// Mass of the fill, kg.
    pub filled_kg: f64,
    /// Mean time between statistics like these without a leak, s.
    pub false_alarm_s: f64,
    /// Whether a statistic is above its threshold, and whether all are far below.
    pub alarm: bool,
    pub calm: bool,
    /// Gas that was lost while nothing was heard.
    pub lost_across: Option<LostUnheard>,
    pub over_after_s: f64,
}

impl LeakState {
    /// Checks one that was saved.
    pub(crate) fn validate(&self) -> Result<(), DetectorError> {
        let not_negative = |what, value: f64| restored::require(value >= 0.0, what, value, "at least 0");
        not_negative("leak.odds", self.odds.unwrap_or(0.0))?;
        not_negative("leak.largest_odds", self.largest_odds)?;
        not_negative("leak.largest_per_s", self.largest_per_s)
    }

    /// Take in a sample, and what is known of a leak at it where a look is due.
    // Its 7 kB of stack are not to lie below the observer's.
    #[inline(never)]
    pub(crate) fn step(&mut self, look: &Look, posterior: impl FnOnce() -> Option<Posterior>) -> Change {
        let time_s = look.time_s;
        self.largest_odds = (look.false_alarm_s / LEAK_INTERVAL_S).clamp(PRIOR_ODDS, CERTAIN);
        let leaking = self.found.is_some();
        let alarm = look.alarm || look.lost_across.is_some();
        let newly = alarm && !leaking;
        if newly || time_s >= self.due_s {
            self.due_s = time_s + BETWEEN_LOOKS_S;
            self.look(look, posterior(), newly || leaking);
        }
        if newly {
            self.seen_s = time_s;
            return self.found.map_or(Change::None, Change::Found);
        }
        if alarm || !look.calm {
            self.seen_s = time_s;
        }
        if leaking && time_s - self.seen_s > look.over_after_s {
            self.found = None;
            return Change::Ended;
        }
        Change::None
    }

    fn look(&mut self, look: &Look, posterior: Option<Posterior>, leaking: bool) {
        if leaking {
            let loss = posterior.as_ref().filter(|posterior| posterior.speaks_for_a_loss);
            let finding = loss.map(|posterior| posterior.finding(look.pa_per_kg));
            self.found = finding.or(self.found).or_else(|| Some(self.unseen(look)));
        }
        if let Some(posterior) = posterior {
            self.odds = Some((PRIOR_ODDS * libm::exp(posterior.log_bayes_factor)).min(CERTAIN));
            self.largest_per_s = posterior.largest_rate_kg_s() / look.filled_kg;
        }
    }

    /// A leak of which nothing has been seen but what it took while nothing was heard.
    fn unseen(&self, look: &Look) -> LeakFinding {
        let nothing = LostUnheard { from_s: look.time_s, until_s: look.time_s, mass_kg: 0.0 };
        let LostUnheard { from_s, until_s, mass_kg: lost_kg } = look.lost_across.unwrap_or(nothing);
        let silent_s = (until_s - from_s).max(BETWEEN_LOOKS_S);
        let rate_kg_s = Interval {
            value: lost_kg / silent_s,
            low: 0.0,
            high: (lost_kg / BETWEEN_LOOKS_S).max(self.largest_per_s * look.filled_kg),
        };
        LeakFinding {
            rate_kg_s,
            rate_pa_s: rate_kg_s.scaled(look.pa_per_kg),
            onset_s: Interval { value: 0.5 * (from_s + until_s), low: from_s, high: until_s },
            lost_kg: Interval { value: lost_kg, low: 0.0, high: 2.0 * lost_kg },
        }
    }

    /// Other gas is in the cylinder: whatever was found is over.
    pub(crate) fn begin_anew(&mut self) -> Change {
        let was = self.found.is_some();
        *self = Self::default();
        if was { Change::Ended } else { Change::None }
    }

    /// The leak, while there is one.
    pub(crate) fn found(&self) -> Option<&LeakFinding> {
        self.found.as_ref()
    }

    /// Probability that gas is being lost; `None`: too little has been seen.
    pub(crate) fn probability(&self) -> Option<f64> {
        self.odds.map(|odds| odds.min(self.largest_odds)).map(|odds| odds / (1.0 + odds))
    }

    /// What the rate of a leak is below with 97.5 %, as a part of the fill per second.
    pub(crate) fn largest_per_s(&self) -> f64 {
        self.largest_per_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn posterior(log_bayes_factor: f64) -> Posterior {
        let onsets = [(0.0, 1e-6, 1e-7), (600.0, 1e-6, 1e-7)];
        let mut posterior = Posterior::of(&onsets, 1200.0, 0.0).unwrap();
        posterior.log_bayes_factor = log_bayes_factor;
        posterior
    }

    fn look(time_s: f64, false_alarm_s: f64) -> Look {
        Look {
            time_s,
            pa_per_kg: 4.4e6,
            filled_kg: 4.5,
            false_alarm_s,
            alarm: false,
            calm: true,
            lost_across: None,
            over_after_s: 86_400.0,
        }
    }

    #[test]
    fn a_bayes_factor_is_no_leak_where_the_evidence_comes_up_every_week() {
        let probability = |false_alarm_s: f64| {
            let mut state = LeakState::default();
            assert_eq!(state.probability(), None);
            assert_eq!(state.step(&look(0.0, false_alarm_s), || Some(posterior(20.0))), Change::None);
            state.probability().unwrap()
        };
        assert!((probability(7.0 * 86_400.0) - 0.01 / 1.01).abs() < 1e-9, "the prior, no more");
        // As often without a leak as leaks come.
        assert!((probability(LEAK_INTERVAL_S) - 0.5).abs() < 1e-9);
        assert!(probability(f64::INFINITY) > 0.999_999);
    }

    #[test]
    fn a_leak_is_found_at_once_looked_at_every_ten_minutes_and_over_a_day_after_it_was_seen() {
        let mut state = LeakState::default();
        let (mut looks, alarm) = (0, Look { alarm: true, calm: false, ..look(0.0, 1e12) });
        let found = state.step(&alarm, || Some(posterior(10.0)));
        assert_eq!(found, Change::Found(posterior(10.0).finding(4.4e6)));
        for minute in 1..1440 {
            let quiet = look(60.0 * f64::from(minute), 1e3);
            let change = state.step(&quiet, || {
                looks += 1;
                None
            });
            assert_eq!(change, Change::None);
        }
        assert_eq!(looks, 143);
        assert_eq!(state.step(&look(86_401.0, 1e3), || None), Change::Ended);
    }

    #[test]
    fn what_went_while_nothing_was_heard_is_a_leak_of_hardly_known_rate() {
        let mut state = LeakState::default();
        let unheard = LostUnheard { from_s: 0.0, until_s: 36_000.0, mass_kg: 0.3 };
        let lost = Look { lost_across: Some(unheard), ..look(39_600.0, 1e3) };
        let Change::Found(finding) = state.step(&lost, || None) else { panic!("not found") };
        assert_eq!((finding.onset_s.low, finding.onset_s.high), (0.0, 36_000.0));
        assert!(finding.lost_kg.holds(0.3) && finding.rate_kg_s.holds(0.3 / 36_000.0));
        assert!(finding.rate_kg_s.holds(0.3 / 600.0));
    }
}
