//! What is left of a detector when something is wrong: a sensor lost, readings disturbed, a model that does not fit.
use serde::{Deserialize, Serialize};

use super::{AlarmRate, CONFIDENCE, Horizon, Performance, Reached};

/// One detector under a disturbance against itself without one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Robustness {
    /// What is wrong.
    pub disturbance: String,
    /// False alarms under it.
    pub reliability: AlarmRate,
    /// Whether they may still be as rare as without: the intervals of both rates meet.
    pub as_reliable: bool,
    /// By what factor the smallest leak found with 95 % is larger, for each horizon in which it is reached in both.
    pub smallest_factor: Vec<(Horizon, f64)>,
    /// By what factor the median delay is longer, for each rate, Pa/s, where it is reached in both.
    pub delay_factor: Vec<(f64, f64)>,
}

impl Robustness {
    /// From the measures with and without the disturbance.
    pub fn between(disturbance: &str, without: &Performance, with: &Performance) -> Self {
        let interval = |performance: &Performance| performance.reliability.per_year_interval(CONFIDENCE);
        let (usual, disturbed) = (interval(without), interval(with));
        let smallest = |performance: &Performance, horizon| match performance.smallest(horizon)?.rate {
            Reached::At(rate_pa_s) => Some(rate_pa_s),
            _ => None,
        };
        let larger =
            |horizon: &Horizon| Some((*horizon, smallest(with, *horizon)? / smallest(without, *horizon)?));
        let longer = |at: &super::Sensitivity| {
            let usual = without.sensitivity.iter().find(|usual| usual.rate_pa_s == at.rate_pa_s)?;
            Some((at.rate_pa_s, at.delay.median_s? / usual.delay.median_s?))
        };
        Self {
            disturbance: disturbance.to_owned(),
            reliability: with.reliability,
            as_reliable: disturbed.0 <= usual.1,
            smallest_factor: Horizon::ALL.iter().filter_map(larger).collect(),
            delay_factor: with.sensitivity.iter().filter_map(longer).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::performance::{Run, TrueLeak};

    const DAY_S: f64 = 86_400.0;

    /// Ten cylinders watched tight, and leaks of 1, 2, 4, 8 Pa/s of which all from `smallest` on are found after `delay_s`.
    fn performance(false_alarms: u64, smallest: f64, delay_s: f64) -> Performance {
        let tight = (0..10).map(|seed| Run {
            seed,
            leak: None,
            from_s: 0.0,
            until_s: 365.0 * DAY_S,
            alarm_s: (seed < false_alarms).then_some(DAY_S),
            found: None,
        });
        let leaking = [1.0, 2.0, 4.0, 8.0].into_iter().flat_map(|rate_pa_s| {
            (0..10).map(move |seed| Run {
                seed,
                leak: Some(TrueLeak { rate_pa_s, onset_s: 0.0 }),
                from_s: 0.0,
                until_s: 2.0 * DAY_S,
                alarm_s: (rate_pa_s >= smallest).then_some(delay_s),
                found: None,
            })
        });
        Performance::of("x", &tight.chain(leaking).collect::<Vec<_>>(), |_| None)
    }

    #[test]
    fn factors_say_how_much_worse_it_became() {
        let (usual, disturbed) = (performance(0, 2.0, 7200.0), performance(1, 8.0, 10_800.0));
        let robustness = Robustness::between("valve sensor lost", &usual, &disturbed);
        assert!(robustness.as_reliable);
        let (horizon, factor) = robustness.smallest_factor[0];
        assert_eq!(horizon, Horizon::Day);
        assert!((factor - 4.0).abs() < 1e-9, "{factor}");
        assert_eq!(robustness.delay_factor, [(8.0, 1.5)]);
        let many = Robustness::between("no temperature", &usual, &performance(10, 2.0, 7200.0));
        assert!(!many.as_reliable);
    }
}
