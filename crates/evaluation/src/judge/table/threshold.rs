//! Candidates without a verdict of their own: their threshold, and what they say at it.
//!
//! The threshold comes from the tight worlds of the families that tune ([`alarm_level`]); it knows nothing of those that judge. At the threshold
//! such a candidate says that it cannot tell until its statistic has a value, then that the cylinder is tight, and from its first alarm on
//! that it leaks.
use cylwatch_thermal::units::YEAR_S;
use serde::Serialize;

use crate::judge::entry::Facts;
use crate::judge::measures::{AlarmLevel, Class, Trace, alarm_level};
use crate::judge::score::detection::Detected;
use crate::judge::score::verdict::{Episode, Episodes, Shares};
use crate::judge::score::{FIRST_DAY_S, Score};
use crate::world::Overlay;

/// What the tight worlds that tune have reached.
#[derive(Clone, Debug, Default)]
pub(super) struct Tuning {
    largest: Vec<f64>,
    length_s: f64,
}

/// A threshold as found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tuned {
    /// The threshold.
    pub level: AlarmLevel,
    /// Worlds behind it.
    pub worlds: usize,
    /// Cylinder-years behind it.
    pub cylinder_years: f64,
}

impl Tuning {
    /// Take the largest value of a tight world.
    pub(super) fn take(&mut self, score: &Score, facts: &Facts) {
        if let Some((trace, _)) = &score.trace {
            self.largest.push(trace.most());
            self.length_s += facts.length_s;
        }
    }

    /// The threshold for a wished mean time between false alarms, s; `None`: too few worlds have a value.
    pub(super) fn finish(&self, between_alarms_s: f64) -> Option<Tuned> {
        let level = alarm_level(&self.largest, self.length_s, between_alarms_s).ok()?;
        Some(Tuned { level, worlds: self.largest.len(), cylinder_years: self.length_s / YEAR_S })
    }
}

/// A score with what the candidate says at a threshold.
pub(super) fn at_threshold(score: &mut Score, threshold: f64, facts: &Facts, overlay: &Overlay) {
    let silent = (Trace::default(), None);
    let (trace, told_s) = score.trace.as_ref().unwrap_or(&silent);
    let alarm_s = trace.alarm(threshold).map(|alarm| alarm.time_s);
    let told_s = told_s.unwrap_or(f64::INFINITY);
    if *overlay == Overlay::Nothing {
        let (shares, episodes) = statements(told_s, alarm_s, facts.length_s);
        (score.shares, score.episodes) = (Some(shares), Some(episodes));
    }
    // It says on: an alarm before the onset lasts until it.
    score.detected = facts.leak.map(|_| Detected { alarm_s });
}

/// Time by verdict and false alarms of a tight world.
fn statements(told_s: f64, alarm_s: Option<f64>, end_s: f64) -> (Shares, Episodes) {
    let alarm_from_s = alarm_s.unwrap_or(f64::INFINITY);
    let mut shares = Shares::default();
    let mut leak = Episode::default();
    let periods = [(0.0, FIRST_DAY_S.min(end_s)), (FIRST_DAY_S.min(end_s), end_s)];
    for (period, (from_s, to_s)) in periods.into_iter().enumerate() {
        let within = |a_s: f64, b_s: f64| (b_s.min(to_s) - a_s.max(from_s)).max(0.0);
        let of = &mut shares.tight_s[period];
        of[Class::Unknown as usize] = within(0.0, told_s);
        of[Class::Tight as usize] = within(told_s, alarm_from_s);
        of[Class::Leak as usize] = within(alarm_from_s, end_s);
        leak.at_risk_s[period] = within(0.0, alarm_from_s);
        leak.count[period] = u64::from((from_s..to_s).contains(&alarm_from_s));
    }
    // It cannot say anything else.
    let never = Episode { count: [0, 0], at_risk_s: shares.tight_s.map(|of| of.iter().sum()) };
    (shares, Episodes { loss: leak, leak, exchange: never, sensor_fault: never })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_threshold_says_unknown_then_tight_then_leak() {
        let (shares, episodes) = statements(36_000.0, Some(100_000.0), 200_000.0);
        let [unknown, tight, leak] = [Class::Unknown, Class::Tight, Class::Leak]
            .map(|class| [shares.tight_s[0][class as usize], shares.tight_s[1][class as usize]]);
        assert_eq!((unknown, tight, leak), ([36_000.0, 0.0], [50_400.0, 13_600.0], [0.0, 100_000.0]));
        assert_eq!((episodes.leak.count, episodes.leak.at_risk_s), ([0, 1], [86_400.0, 13_600.0]));
    }
}
