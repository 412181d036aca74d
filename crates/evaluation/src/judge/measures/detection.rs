//! Probability of finding a leak within a time, against its rate.
use cylwatch_thermal::units::HOUR_S;
use std::fmt;

use serde::{Deserialize, Serialize};

use super::Run;

/// Times within which a leak should be found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Horizon {
    /// 1 h.
    Hour,
    /// 24 h.
    Day,
    /// 7 d.
    Week,
    /// 30 d.
    Month,
}

impl Horizon {
    /// How long it is, s.
    pub(crate) fn seconds(self) -> f64 {
        match self {
            Self::Hour => HOUR_S,
            Self::Day => 24.0 * HOUR_S,
            Self::Week => 168.0 * HOUR_S,
            Self::Month => 720.0 * HOUR_S,
        }
    }
}

impl fmt::Display for Horizon {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Hour => "1 h",
            Self::Day => "24 h",
            Self::Week => "7 d",
            Self::Month => "30 d",
        })
    }
}

/// `hits` of `trials`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Proportion {
    /// How often it happened.
    pub hits: u64,
    /// How often it could have.
    pub trials: u64,
}

impl Proportion {
    /// Count those that are true.
    pub(crate) fn count(outcomes: impl IntoIterator<Item = bool>) -> Self {
        outcomes.into_iter().fold(Self::default(), |sum, hit| Self {
            hits: sum.hits + u64::from(hit),
            trials: sum.trials + 1,
        })
    }
}

/// How many leaks of one rate were found within a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Detection {
    /// Rate, part of the gas per hour.
    pub part_per_h: f64,
    /// Found of those that were watched for so long, or found before.
    pub found: Proportion,
}

impl Detection {
    /// Of runs with one rate each, in the order of [`by_rate`](super::by_rate), within `horizon_s`.
    pub(crate) fn against_rate(groups: &[(f64, Vec<Run>)], horizon_s: f64) -> Vec<Self> {
        let of = |(part_per_h, runs): &(f64, Vec<Run>)| Self {
            part_per_h: *part_per_h,
            found: Proportion::count(told(runs, horizon_s)),
        };
        groups.iter().map(of).collect()
    }
}

/// Outcomes of the runs that can tell.
///
/// A run that ends before the horizon could add a hit but never a miss: then it counts neither way.
fn told(runs: &[Run], horizon_s: f64) -> impl Iterator<Item = bool> + '_ {
    let long_enough = move |run: &&Run| run.watched_s().is_some_and(|watched_s| watched_s >= horizon_s);
    runs.iter().filter(long_enough).filter_map(move |run| run.found_within(horizon_s))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::measures::by_rate;

    #[test]
    fn runs_that_end_before_the_horizon_count_neither_way() {
        let run = |watched_h: f64, delay_h: Option<f64>| Run {
            part_per_h: 1.0,
            onset_s: 0.0,
            until_s: watched_h * HOUR_S,
            alarm_s: delay_h.map(|hours| hours * HOUR_S),
        };
        let runs = [
            run(48.0, Some(10.0)),
            run(48.0, Some(30.0)),
            run(48.0, None),
            run(12.0, Some(2.0)),
            run(12.0, None),
        ];
        let within = |horizon: Horizon| Detection::against_rate(&by_rate(&runs), horizon.seconds())[0].found;
        assert_eq!(within(Horizon::Day), Proportion { hits: 1, trials: 3 });
        assert_eq!(within(Horizon::Hour), Proportion { hits: 0, trials: 5 });
        assert_eq!(within(Horizon::Week), Proportion { hits: 0, trials: 0 });
    }
}
