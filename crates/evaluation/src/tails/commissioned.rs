//! Tails and thresholds of a vessel, and how often they alarm without a leak.
use cylwatch_detector::evidence::{Scale, Tail, Tails};
use serde::{Deserialize, Serialize};

use super::cross_validation::false_alarm_rate;
use super::fit::{fit, interval};
use super::monitored::MonitoredCylinder;
use super::record::Record;
use crate::EvaluationError;
use crate::judge::table::Rate;

/// How tails and thresholds are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitSettings {
    /// Mean time between false alarms that the thresholds are for, s.
    pub mean_time_s: f64,
    /// Length of the stretches, as in `Record::stretch_h`.
    pub stretch: f64,
    /// Seed of the draws for intervals.
    pub seed: u64,
}

/// What was found for a vessel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Commissioned {
    /// In the order of [`Scale::ALL`].
    pub scales: [CommissionedScale; Scale::ALL.len()],
    /// False alarms out of sample; the interval by simulation holds where alarms come several to a cylinder, too.
    pub false_alarms: Rate,
}

/// One scale of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CommissionedScale {
    /// The scale.
    pub scale: Scale,
    /// Tail of its statistic without a leak.
    pub tail: Tail,
    /// Threshold of the mean time between false alarms.
    pub threshold: f64,
    /// Its 95 % interval.
    pub threshold_interval: (f64, f64),
}

impl Commissioned {
    /// The tails, for the settings of a monitor.
    ///
    /// # Errors
    /// The scales are not all there in their order, or a tail is none.
    pub fn tails(&self) -> Result<Tails, EvaluationError> {
        if self.scales.map(|of| of.scale) != Scale::ALL {
            return Err(EvaluationError::Scales);
        }
        let tails = Tails(self.scales.map(|of| of.tail));
        tails.validate()?;
        Ok(tails)
    }
}

/// Tails, thresholds with their intervals, and the rate of false alarms out of sample, of tight cylinders around a vessel.
///
/// # Errors
/// Too few cylinders, or statistics that do not vary.
pub fn commission(
    monitored: &[MonitoredCylinder],
    settings: &FitSettings,
) -> Result<Commissioned, EvaluationError> {
    let &FitSettings { mean_time_s, stretch, seed } = settings;
    let records: Vec<&Record> = monitored.iter().map(|monitored| &monitored.record).collect();
    let tails = fit(&records, stretch)?;
    let thresholds = tails.thresholds(mean_time_s)?;
    let intervals = interval(monitored, stretch, mean_time_s, seed)?;
    let of = |scale: Scale| CommissionedScale {
        scale,
        tail: tails.0[scale as usize],
        threshold: thresholds.of(scale),
        threshold_interval: intervals[scale as usize],
    };
    Ok(Commissioned {
        scales: Scale::ALL.map(of),
        false_alarms: false_alarm_rate(monitored, stretch, mean_time_s)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Family, Request};

    const MEAN_TIME_S: f64 = 3652.5 * 86_400.0;

    /// Five days of stretches whose peaks fall off exponentially, scale by scale larger.
    fn monitored(seed: u64) -> MonitoredCylinder {
        let mut record = Record::default();
        for hour in 0..5 * 24_u32 {
            let even = f64::from(hour).mul_add(0.618_034, seed as f64 * 0.414_213_6).fract();
            let peak = -(1.0 - even).ln();
            record.update(3600.0 * f64::from(hour), &[1.0, 2.0, 3.0, 4.0, 5.0].map(|scale| scale * peak));
        }
        MonitoredCylinder { request: Request::tight(Family::usual(), seed, 5.0 * 86_400.0), record }
    }

    fn settings() -> FitSettings {
        FitSettings { mean_time_s: MEAN_TIME_S, stretch: 0.001, seed: 7 }
    }

    #[test]
    fn thresholds_are_those_of_the_tails_and_lie_within_their_intervals() {
        let monitored: Vec<MonitoredCylinder> = (0..8).map(monitored).collect();
        let found = commission(&monitored, &settings()).unwrap();
        let thresholds = found.tails().unwrap().thresholds(MEAN_TIME_S).unwrap();
        for (of, factor) in found.scales.iter().zip([1.0, 2.0, 3.0, 4.0, 5.0]) {
            let (low, high) = of.threshold_interval;
            assert_eq!(of.threshold, thresholds.of(of.scale));
            assert!(low < of.threshold && of.threshold < high, "{of:?}");
            // One hour in 5 times ten years, exponential: ln(5 T/1 h).
            let expected = factor * (5.0 * MEAN_TIME_S / 3600.0).ln();
            assert!((of.threshold / expected - 1.0).abs() < 0.5, "{of:?} {expected}");
        }
        assert_eq!(commission(&monitored, &settings()).unwrap(), found, "the same seed, the same draws");
        let json = serde_json::to_string(&found).unwrap();
        assert_eq!(serde_json::from_str::<Commissioned>(&json).unwrap().tails().unwrap().0.len(), 5);
    }

    /// Another set of sensors on the same cylinder tells little more of the tails.
    #[test]
    fn intervals_are_those_of_cylinders_however_many_sets_of_sensors_each_has() {
        let cylinders: Vec<MonitoredCylinder> = (0..8).map(monitored).collect();
        let width = |monitored: &[MonitoredCylinder]| {
            let (low, high) = commission(monitored, &settings()).unwrap().scales[0].threshold_interval;
            high - low
        };
        let sets = |cylinder: &MonitoredCylinder| {
            (0..4)
                .map(|set| MonitoredCylinder {
                    request: Request { set, ..cylinder.request },
                    ..cylinder.clone()
                })
                .collect()
        };
        let of_sets: Vec<MonitoredCylinder> =
            cylinders.iter().flat_map::<Vec<MonitoredCylinder>, _>(sets).collect();
        assert!(width(&of_sets) > 0.8 * width(&cylinders), "{} {}", width(&of_sets), width(&cylinders));
    }

    #[test]
    fn scales_in_another_order_and_tails_that_are_none_are_refused() {
        let monitored: Vec<MonitoredCylinder> = (0..8).map(monitored).collect();
        let found = commission(&monitored, &settings()).unwrap();
        let mut exchanged = found.clone();
        exchanged.scales.swap(0, 1);
        assert!(matches!(exchanged.tails(), Err(EvaluationError::Scales)));
        let mut none = found;
        none.scales[2].tail.scale = 0.0;
        assert!(none.tails().unwrap_err().to_string().contains("tails.scale"));
    }
}
