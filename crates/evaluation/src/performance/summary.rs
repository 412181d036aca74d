//! All measures of one detector, for JSON; and as flat rows, for CSV.
use serde::{Deserialize, Serialize};

use super::detection::told;
use super::{
    Accuracy, AlarmRate, CONFIDENCE, Delay, Detection, Horizon, Proportion, Run, SmallestLeak, by_rate,
};

/// Part of the leaks that must be found for the smallest leak.
const FOUND: f64 = 0.95;

/// What one detector achieves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Performance {
    /// Name of the detector.
    pub detector: String,
    /// False alarms.
    pub reliability: AlarmRate,
    /// Against the rate of the leak, increasing.
    pub sensitivity: Vec<Sensitivity>,
    /// Smallest leak found with 95 % within each horizon that runs lasted for.
    pub smallest: Vec<(Horizon, SmallestLeak)>,
}

/// What happens to leaks of one rate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sensitivity {
    /// Loss of the pressure at 15 °C, Pa/s.
    pub rate_pa_s: f64,
    /// Found within each horizon.
    pub found: Vec<(Horizon, Proportion)>,
    /// Delays.
    pub delay: Delay,
    /// Shortest mean delay of any detector with that false-alarm rate, s, where it is known.
    pub bound_s: Option<f64>,
    /// What was said about the leak.
    pub accuracy: Accuracy,
}

impl Sensitivity {
    /// Found within a horizon.
    pub fn within(&self, horizon: Horizon) -> Proportion {
        let found = self.found.iter().find(|(of, _)| *of == horizon);
        found.map_or_else(Proportion::default, |(_, found)| *found)
    }

    /// Bound over mean delay, if the bound is known and all leaks were found.
    pub fn efficiency(&self) -> Option<f64> {
        self.delay.efficiency(self.bound_s?)
    }
}

impl Performance {
    /// Of all runs of a detector, tight ones among them; `bound_s` gives the shortest possible mean delay, s, for a rate, Pa/s.
    pub fn of(detector: &str, runs: &[Run], bound_s: impl Fn(f64) -> Option<f64>) -> Self {
        let groups = by_rate(runs);
        let sensitivity = |(rate_pa_s, runs): &(f64, Vec<Run>)| Sensitivity {
            rate_pa_s: *rate_pa_s,
            found: Horizon::ALL
                .iter()
                .map(|horizon| (*horizon, Proportion::count(told(runs, horizon.seconds()))))
                .collect(),
            delay: Delay::of(runs),
            bound_s: bound_s(*rate_pa_s),
            accuracy: Accuracy::of(runs),
        };
        let smallest = |horizon: &Horizon| {
            let detections = Detection::against_rate(&groups, horizon.seconds());
            SmallestLeak::of(&detections, FOUND).map(|smallest| (*horizon, smallest))
        };
        Self {
            detector: detector.to_owned(),
            reliability: AlarmRate::of(runs),
            sensitivity: groups.iter().map(sensitivity).collect(),
            smallest: Horizon::ALL.iter().filter_map(smallest).collect(),
        }
    }

    /// Smallest leak found with 95 % within a horizon; `None` if no run lasted for so long.
    pub fn smallest(&self, horizon: Horizon) -> Option<&SmallestLeak> {
        self.smallest.iter().find(|(of, _)| *of == horizon).map(|(_, smallest)| smallest)
    }

    /// One row per rate.
    pub fn rows(&self) -> Vec<Row> {
        self.sensitivity.iter().map(|sensitivity| Row::of(&self.detector, sensitivity)).collect()
    }
}

/// One detector at one rate, flat; `None`: not known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the detector.
    pub detector: String,
    /// Loss of the pressure at 15 °C, Pa/s.
    pub rate_pa_s: f64,
    /// Leaks, and how many of them were found in the time they were watched.
    pub leaks: u64,
    /// See `leaks`.
    pub found: u64,
    /// Part found within 1 h.
    pub found_1h: Option<f64>,
    /// Part found within 24 h.
    pub found_24h: Option<f64>,
    /// Part found within 7 d.
    pub found_7d: Option<f64>,
    /// Part found within 30 d.
    pub found_30d: Option<f64>,
    /// Wilson's 95 % interval of the part found within 24 h.
    pub found_24h_low: Option<f64>,
    /// See `found_24h_low`.
    pub found_24h_high: Option<f64>,
    /// Median delay, s.
    pub median_s: Option<f64>,
    /// Lower bound of its 95 % interval, s.
    pub median_low_s: Option<f64>,
    /// Upper bound of its 95 % interval, s.
    pub median_high_s: Option<f64>,
    /// Delay by which 95 % are found, s.
    pub p95_s: Option<f64>,
    /// Mean delay of those found, s.
    pub mean_found_s: Option<f64>,
    /// Shortest possible mean delay, s.
    pub bound_s: Option<f64>,
    /// Bound over mean.
    pub efficiency: Option<f64>,
    /// Root mean square error of the rate, in parts of the true one.
    pub rate_rms: Option<f64>,
    /// Part of the rate's 95 % intervals that held the truth.
    pub rate_covered: Option<f64>,
    /// Root mean square error of the onset, s.
    pub onset_rms_s: Option<f64>,
    /// Part of the onset's 95 % intervals that held the truth.
    pub onset_covered: Option<f64>,
}

impl Row {
    fn of(detector: &str, at: &Sensitivity) -> Self {
        let part = |proportion: Proportion| (proportion.trials > 0).then(|| proportion.value());
        let found = |horizon| part(at.within(horizon));
        let day = at.within(Horizon::Day);
        let interval = (day.trials > 0).then(|| day.wilson(CONFIDENCE));
        let (rate, onset) = (at.accuracy.rate, at.accuracy.onset_s);
        Self {
            detector: detector.to_owned(),
            rate_pa_s: at.rate_pa_s,
            leaks: at.delay.leaks,
            found: at.delay.found,
            found_1h: found(Horizon::Hour),
            found_24h: found(Horizon::Day),
            found_7d: found(Horizon::Week),
            found_30d: found(Horizon::Month),
            found_24h_low: interval.map(|(low, _)| low),
            found_24h_high: interval.map(|(_, high)| high),
            median_s: at.delay.median_s,
            median_low_s: at.delay.median_interval_s.0,
            median_high_s: at.delay.median_interval_s.1,
            p95_s: at.delay.p95_s,
            mean_found_s: at.delay.mean_found_s,
            bound_s: at.bound_s,
            efficiency: at.efficiency(),
            rate_rms: rate.map(|errors| errors.rms),
            rate_covered: rate.and_then(|errors| part(errors.covered)),
            onset_rms_s: onset.map(|errors| errors.rms),
            onset_covered: onset.and_then(|errors| part(errors.covered)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::performance::{Reached, TrueLeak};
    use cylwatch_thermal::units::HOUR_S;

    fn run(seed: u64, rate_pa_s: Option<f64>, delay_h: Option<f64>) -> Run {
        Run {
            seed,
            leak: rate_pa_s.map(|rate_pa_s| TrueLeak { rate_pa_s, onset_s: 24.0 * HOUR_S }),
            from_s: 0.0,
            until_s: 72.0 * HOUR_S,
            alarm_s: delay_h.map(|hours| (24.0 + hours) * HOUR_S),
            found: None,
        }
    }

    fn runs() -> Vec<Run> {
        let tight = (0..10).map(|seed| run(seed, None, None));
        let small = (0..10).map(|seed| run(seed, Some(1.0), (seed < 5).then_some(40.0)));
        let large = (0..10).map(|seed| run(seed, Some(4.0), Some(0.5 + 0.1 * seed as f64)));
        tight.chain(small).chain(large).collect()
    }

    #[test]
    fn all_measures_come_from_one_set_of_runs() {
        let performance = Performance::of("x", &runs(), |rate| (rate > 2.0).then_some(0.475 * HOUR_S));
        assert_eq!(performance.reliability.at_risk_s, (10.0 * 72.0 + 20.0 * 24.0) * HOUR_S);
        let [small, large] = &performance.sensitivity[..] else { panic!("two rates") };
        assert_eq!(small.within(Horizon::Day), Proportion { hits: 0, trials: 10 });
        assert_eq!(small.delay.found, 5);
        assert_eq!(large.within(Horizon::Hour), Proportion { hits: 6, trials: 10 });
        // Mean delay 0.95 h.
        assert!((large.efficiency().unwrap() - 0.5).abs() < 1e-9);
        // None of 10 at 1, all at 4: 95 % of the way in the logarithm.
        let Reached::At(rate) = performance.smallest(Horizon::Day).unwrap().rate else { panic!("between") };
        assert!((rate - 4.0_f64.powf(0.95)).abs() < 1e-9);
        assert_eq!(performance.smallest(Horizon::Week), None);
    }

    #[test]
    fn it_survives_json_and_its_rows_are_flat() {
        let performance = Performance::of("x", &runs(), |_| None);
        let text = serde_json::to_string(&performance).unwrap();
        assert_eq!(serde_json::from_str::<Performance>(&text).unwrap(), performance);
        let rows = performance.rows();
        assert_eq!((rows.len(), rows[0].found_24h, rows[0].found_7d), (2, Some(0.0), None));
        let flat = serde_json::to_value(&rows[1]).unwrap();
        assert!(flat.as_object().unwrap().values().all(|value| !value.is_object() && !value.is_array()));
    }
}
