//! What a detector did in one run, and what the truth was.
use serde::{Deserialize, Serialize};

use crate::detector::monitor::Interval;

/// A leak as it was.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrueLeak {
    /// Loss of the pressure at 15 °C, Pa/s, as the case names it: runs of one case have the same.
    pub rate_pa_s: f64,
    /// When it began, s.
    pub onset_s: f64,
}

/// A quantity as a detector stated it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimated {
    /// The value.
    pub value: f64,
    /// Its 95 % interval; `None` if the detector states none.
    pub interval: Option<(f64, f64)>,
}

impl From<Interval> for Estimated {
    fn from(interval: Interval) -> Self {
        Self { value: interval.value, interval: Some((interval.low, interval.high)) }
    }
}

/// The leak as a detector stated it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// Loss of the pressure at 15 °C, Pa/s.
    pub rate_pa_s: Option<Estimated>,
    /// When it began, s.
    pub onset_s: Option<Estimated>,
}

/// One run of one detector over one cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Seed of cylinder and surroundings.
    pub seed: u64,
    /// The leak; `None`: the cylinder was tight.
    pub leak: Option<TrueLeak>,
    /// Alarms count from here on, s.
    pub from_s: f64,
    /// End of the run, s.
    pub until_s: f64,
    /// First alarm that counts, s.
    pub alarm_s: Option<f64>,
    /// What the detector said about the leak when it alarmed.
    pub found: Option<Found>,
}

impl Run {
    /// Whether it alarmed although nothing leaked (yet).
    pub fn is_false_alarm(&self) -> bool {
        let onset_s = self.onset_s();
        self.alarm_s.is_some_and(|alarm_s| alarm_s < onset_s)
    }

    /// Time without a leak and without an alarm so far, s.
    pub fn at_risk_s(&self) -> f64 {
        let end_s = self.alarm_s.unwrap_or(f64::INFINITY).min(self.onset_s()).min(self.until_s);
        (end_s - self.from_s).max(0.0)
    }

    /// From the onset to the alarm, s; `None`: no leak, or not found, or an alarm before it.
    pub fn delay_s(&self) -> Option<f64> {
        let delay_s = self.alarm_s? - self.leak?.onset_s;
        (delay_s >= 0.0).then_some(delay_s)
    }

    /// Time for which the leak was watched, s; `None`: no leak, or an alarm before it.
    pub fn watched_s(&self) -> Option<f64> {
        let leak = self.leak.filter(|_| !self.is_false_alarm())?;
        Some(self.until_s - leak.onset_s)
    }

    /// Whether the leak was found so soon; `None`: no leak, an alarm before it, or it was not watched for so long.
    pub fn found_within(&self, horizon_s: f64) -> Option<bool> {
        let watched_s = self.watched_s()?;
        match self.delay_s() {
            Some(delay_s) if delay_s <= horizon_s => Some(true),
            _ => (watched_s >= horizon_s).then_some(false),
        }
    }

    fn onset_s(&self) -> f64 {
        self.leak.map_or(f64::INFINITY, |leak| leak.onset_s)
    }
}

/// Runs with a leak by its rate, Pa/s, increasing.
pub fn by_rate(runs: &[Run]) -> Vec<(f64, Vec<Run>)> {
    let mut leaking: Vec<(f64, Run)> =
        runs.iter().filter_map(|run| run.leak.map(|leak| (leak.rate_pa_s, *run))).collect();
    leaking.sort_by(|a, b| a.0.total_cmp(&b.0));
    let group = |chunk: &[(f64, Run)]| (chunk[0].0, chunk.iter().map(|(_, run)| *run).collect());
    leaking.chunk_by(|a, b| a.0 == b.0).map(group).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUN: Run = Run {
        seed: 1,
        leak: Some(TrueLeak { rate_pa_s: 1.0, onset_s: 100.0 }),
        from_s: 10.0,
        until_s: 200.0,
        alarm_s: None,
        found: None,
    };

    #[test]
    fn an_alarm_before_the_onset_is_false_and_says_nothing_about_the_leak() {
        let run = Run { alarm_s: Some(60.0), ..RUN };
        assert!(run.is_false_alarm());
        assert_eq!((run.at_risk_s(), run.delay_s(), run.watched_s()), (50.0, None, None));
        assert_eq!(run.found_within(10.0), None);
    }

    #[test]
    fn the_time_at_risk_ends_with_the_leak_and_without_one_with_the_run() {
        assert_eq!(RUN.at_risk_s(), 90.0);
        assert_eq!(Run { alarm_s: Some(150.0), ..RUN }.at_risk_s(), 90.0);
        assert_eq!(Run { leak: None, ..RUN }.at_risk_s(), 190.0);
        assert_eq!(Run { leak: None, alarm_s: Some(40.0), ..RUN }.at_risk_s(), 30.0);
    }

    #[test]
    fn a_leak_that_was_not_watched_for_so_long_is_neither_found_nor_missed() {
        let found = Run { alarm_s: Some(130.0), ..RUN };
        assert_eq!([20.0, 30.0, 500.0].map(|s| found.found_within(s)), [Some(false), Some(true), Some(true)]);
        assert_eq!([50.0, 100.0, 101.0].map(|s| RUN.found_within(s)), [Some(false), Some(false), None]);
        assert_eq!(Run { leak: None, ..RUN }.found_within(50.0), None);
    }

    #[test]
    fn runs_are_grouped_by_their_rate() {
        let of = |rate_pa_s| Run { leak: Some(TrueLeak { rate_pa_s, onset_s: 100.0 }), ..RUN };
        let groups = by_rate(&[of(3.0), Run { leak: None, ..RUN }, of(1.0), of(3.0)]);
        let sizes: Vec<(f64, usize)> = groups.iter().map(|(rate, runs)| (*rate, runs.len())).collect();
        assert_eq!(sizes, [(1.0, 1), (3.0, 2)]);
    }
}
