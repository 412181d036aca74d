//! How well rate and onset of a leak are stated with its alarm.
use serde::{Deserialize, Serialize};

use super::{Estimated, Found, Proportion, Run};

/// Errors of one quantity over the runs that stated it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Number of runs that stated it.
    pub runs: u64,
    /// Mean error.
    pub bias: f64,
    /// Root mean square error.
    pub rms: f64,
    /// Median of the absolute error.
    pub median: f64,
    /// How many of the 95 % intervals that were stated held the truth.
    pub covered: Proportion,
}

/// Errors of rate and onset at one true rate; `None`: never stated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Of the leak rate, in parts of the true one.
    pub rate: Option<Errors>,
    /// Of the onset, s; positive: stated too late.
    pub onset_s: Option<Errors>,
}

impl Accuracy {
    /// Of the leaks of one rate that were found.
    pub fn of(runs: &[Run]) -> Self {
        let stated = |pick: fn(&Found) -> Option<Estimated>, truth: fn(&Run) -> Option<f64>| {
            let found = runs.iter().filter(|run| run.delay_s().is_some());
            found.filter_map(move |run| Some((pick(run.found.as_ref()?)?, truth(run)?))).collect::<Vec<_>>()
        };
        let rates = stated(|found| found.rate_pa_s, |run| run.leak.map(|leak| leak.rate_pa_s));
        let onsets = stated(|found| found.onset_s, |run| run.leak.map(|leak| leak.onset_s));
        Self {
            rate: Errors::of(&rates, |value, truth| value / truth - 1.0),
            onset_s: Errors::of(&onsets, |value, truth| value - truth),
        }
    }
}

impl Errors {
    /// Of estimates beside their truths; `None` without any.
    fn of(stated: &[(Estimated, f64)], error: impl Fn(f64, f64) -> f64) -> Option<Self> {
        let errors: Vec<f64> =
            stated.iter().map(|(estimated, truth)| error(estimated.value, *truth)).collect();
        let n = errors.len() as f64;
        let mut sizes: Vec<f64> = errors.iter().map(|error| error.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let (low, high) = (*sizes.get((sizes.len().max(1) - 1) / 2)?, *sizes.get(sizes.len() / 2)?);
        let holds = |(estimated, truth): &(Estimated, f64)| {
            estimated.interval.map(|(low, high)| (low..=high).contains(truth))
        };
        Some(Self {
            runs: errors.len() as u64,
            bias: errors.iter().sum::<f64>() / n,
            rms: (errors.iter().map(|error| error * error).sum::<f64>() / n).sqrt(),
            median: 0.5 * (low + high),
            covered: Proportion::count(stated.iter().filter_map(holds)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::performance::TrueLeak;
    use approx::assert_relative_eq;

    fn run(rate: (f64, Option<(f64, f64)>), onset_s: f64) -> Run {
        let estimated = |value, interval| Some(Estimated { value, interval });
        Run {
            seed: 0,
            leak: Some(TrueLeak { rate_pa_s: 2.0, onset_s: 100.0 }),
            from_s: 0.0,
            until_s: 1000.0,
            alarm_s: Some(300.0),
            found: Some(Found {
                rate_pa_s: estimated(rate.0, rate.1),
                onset_s: estimated(onset_s, Some((onset_s - 20.0, onset_s + 20.0))),
            }),
        }
    }

    #[test]
    fn errors_are_those_of_the_hand() {
        let runs =
            [run((2.2, Some((1.9, 2.5))), 110.0), run((1.6, Some((1.5, 1.7))), 70.0), run((2.4, None), 90.0)];
        let accuracy = Accuracy::of(&runs);
        let rate = accuracy.rate.unwrap();
        // Errors 0.1, -0.2, 0.2.
        assert_relative_eq!(rate.bias, 0.1 / 3.0, max_relative = 1e-9);
        assert_relative_eq!(rate.rms, (0.09_f64 / 3.0).sqrt(), max_relative = 1e-9);
        assert_relative_eq!(rate.median, 0.2, max_relative = 1e-9);
        assert_eq!(rate.covered, Proportion { hits: 1, trials: 2 });
        let onset = accuracy.onset_s.unwrap();
        assert_relative_eq!(onset.bias, -10.0, max_relative = 1e-9);
        assert_eq!(onset.covered, Proportion { hits: 2, trials: 3 });
        let pair = Accuracy::of(&runs[..2]).rate.unwrap();
        assert_relative_eq!(pair.median, 0.15, max_relative = 1e-9);
    }

    #[test]
    fn runs_without_an_alarm_to_the_leak_do_not_count() {
        let early = Run { alarm_s: Some(50.0), ..run((2.0, None), 100.0) };
        let silent = Run { found: None, ..run((2.0, None), 100.0) };
        assert_eq!(Accuracy::of(&[early, silent]), Accuracy::default());
    }
}
