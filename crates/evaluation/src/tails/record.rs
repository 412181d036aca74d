//! What the statistics of a leak-free cylinder reached: their largest values of each hour.
//!
//! From these follow the largest values of longer stretches and the alarms at any thresholds, as the monitor raises them.
use cylwatch_detector::evidence::{Scale, Statistics, Thresholds};
use cylwatch_thermal::units::HOUR_S;

/// Largest values of the statistics, hour by hour of operation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// `None`: an hour without a sample.
    hours: Vec<Option<Statistics>>,
    first_s: Option<f64>,
}

/// Alarms of a cylinder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Alarms {
    /// How many began.
    pub count: u64,
    /// Hours with samples in which none stood, or one began.
    pub at_risk_h: u64,
}

impl Record {
    /// Take the statistics of a sample.
    pub(crate) fn update(&mut self, time_s: f64, statistics: &Statistics) {
        let since_s = time_s - *self.first_s.get_or_insert(time_s);
        let hour = (since_s / HOUR_S) as usize;
        if hour >= self.hours.len() {
            self.hours.resize(hour + 1, None);
        }
        let largest = self.hours[hour].get_or_insert(*statistics);
        rise(largest, statistics);
    }

    /// Hours of a stretch. It is as long as the statistic remembers ([`Scale::memory_s`]), so that an excursion counts once, or twice where it
    /// crosses from one stretch to the next; `stretch` is 1, or a part of that time for a rehearsal.
    pub(crate) fn stretch_h(scale: Scale, stretch: f64) -> usize {
        ((stretch * scale.memory_s() / HOUR_S).round() as usize).max(1)
    }

    /// Largest values of the whole stretches of a scale.
    pub(crate) fn peaks(&self, scale: Scale, stretch: f64) -> impl Iterator<Item = f64> + '_ {
        let stretch_h = Self::stretch_h(scale, stretch);
        let whole = self.hours.len().saturating_sub(1) / stretch_h;
        let of_hours = move |hours: &[Option<Statistics>]| {
            hours.iter().flatten().map(|statistics| statistics[scale as usize]).reduce(f64::max)
        };
        self.hours.chunks(stretch_h).take(whole).filter_map(of_hours)
    }

    /// Largest values of all; 0 without a sample.
    pub fn largest(&self) -> Statistics {
        let mut largest = [0.0; Scale::ALL.len()];
        self.hours.iter().flatten().for_each(|statistics| rise(&mut largest, statistics));
        largest
    }

    /// Alarms at thresholds. One begins when a statistic reaches its threshold, however many follow, and is over when all have been below half of
    /// theirs for longer than a time, s ([`MonitorSettings::leak_over_after_s`]).
    ///
    /// [`MonitorSettings::leak_over_after_s`]: cylwatch_detector::monitor::MonitorSettings::leak_over_after_s
    pub(crate) fn alarms(&self, thresholds: &Thresholds, over_after_s: f64) -> Alarms {
        let mut alarms = Alarms::default();
        // The last hour of an alarm that was not calm.
        let mut stands: Option<usize> = None;
        let sampled = self.hours.iter().enumerate().filter_map(|(hour, found)| Some((hour, found.as_ref()?)));
        for (hour, statistics) in sampled {
            let is_over = |seen: usize| (hour - seen) as f64 * HOUR_S > over_after_s;
            let is_calm = thresholds.is_calm(statistics);
            stands = match stands {
                Some(seen) if is_calm && is_over(seen) => None,
                Some(seen) => Some(if is_calm { seen } else { hour }),
                None => None,
            };
            alarms.at_risk_h += u64::from(stands.is_none());
            if stands.is_none() && thresholds.alarm(statistics).is_some() {
                stands = Some(hour);
                alarms.count += 1;
            }
        }
        alarms
    }
}

fn rise(largest: &mut Statistics, statistics: &Statistics) {
    largest.iter_mut().zip(statistics).for_each(|(largest, value)| *largest = largest.max(*value));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(hours: impl IntoIterator<Item = Statistics>) -> Record {
        let mut record = Record::default();
        (0..).map(f64::from).zip(hours).for_each(|(hour, value)| record.update(3600.0 * hour, &value));
        record
    }

    #[test]
    fn peaks_are_the_largest_values_of_whole_stretches() {
        let record = record((0..40).map(|hour| [f64::from(hour) % 7.0; Scale::ALL.len()]));
        let peaks = |scale, stretch| record.peaks(scale, stretch).collect::<Vec<f64>>();
        assert_eq!(peaks(Scale::Hour, 1.0), [6.0, 6.0, 6.0]);
        assert!(peaks(Scale::HalfDay, 1.0).is_empty(), "not over yet");
        assert_eq!(peaks(Scale::HalfDay, 0.25), [6.0, 6.0, 6.0]);
    }

    #[test]
    fn peaks_from_hours_are_those_of_the_samples_themselves_at_any_times() {
        // Uneven times with gaps; values that never repeat.
        let samples: Vec<(f64, f64)> = (0..4000_u32)
            .scan(1234.5, |time_s, n| {
                let uneven = f64::from(n * 7919 % 1000) / 1000.0;
                *time_s += 40.0 + 600.0 * uneven + if n % 400 == 399 { 2e5 } else { 0.0 };
                Some((*time_s, f64::from(n * 104_729 % 65_537)))
            })
            .collect();
        let mut record = Record::default();
        samples.iter().for_each(|(time_s, value)| record.update(*time_s, &[*value; Scale::ALL.len()]));
        for scale in Scale::ALL {
            let stretch = |time_s: f64| ((time_s - samples[0].0) / scale.memory_s()) as u64;
            let last = stretch(samples[samples.len() - 1].0);
            let largest = |number| {
                let of_it = samples.iter().filter(|(time_s, _)| stretch(*time_s) == number);
                of_it.map(|(_, value)| *value).reduce(f64::max)
            };
            let expected: Vec<f64> = (0..last).filter_map(largest).collect();
            assert_eq!(record.peaks(scale, 1.0).collect::<Vec<f64>>(), expected, "{scale:?}");
        }
    }

    #[test]
    fn every_sample_of_an_hour_counts_and_hours_without_one_do_not() {
        let mut record = Record::default();
        for (hours, value) in [(0.0, 1.0), (0.3, 4.0), (0.9, 2.0), (30.0, 3.0), (60.0, 9.0)] {
            record.update(1e6 + 3600.0 * hours, &[value; Scale::ALL.len()]);
        }
        // 0 to 12 h, 24 to 36 h; nothing from 12 to 24 h, and 60 to 72 h is not over.
        assert_eq!(record.peaks(Scale::Hour, 1.0).collect::<Vec<f64>>(), [4.0, 3.0]);
        assert_eq!(record.largest(), [9.0; Scale::ALL.len()]);
        let thresholds = Thresholds { mean_time_s: 1.0, levels: [100.0; Scale::ALL.len()] };
        assert_eq!(record.alarms(&thresholds, 24.0 * HOUR_S), Alarms { count: 0, at_risk_h: 3 });
    }

    #[test]
    fn an_alarm_counts_once_until_all_have_been_below_half_for_a_time_though_two_scales_exceed() {
        let thresholds = Thresholds { mean_time_s: 1.0, levels: [4.0; Scale::ALL.len()] };
        let of = |hour: f64, week: f64| [hour, 0.0, 0.0, week, 0.0];
        let hours = [
            of(1.0, 1.0),
            // Two scales in the same hour, one that goes on, and both between half and all of it.
            of(5.0, 4.0),
            of(1.0, 6.0),
            of(3.0, 2.0),
            of(4.0, 1.0),
            // Calm for an hour, and back.
            of(1.9, 1.9),
            of(0.0, 4.0),
            of(1.0, 1.0),
            of(1.0, 1.9),
            // Over after the second hour, and another one.
            of(1.0, 1.0),
            of(4.0, 0.0),
        ];
        let alarms = |over_after_s| record(hours).alarms(&thresholds, over_after_s);
        assert_eq!(alarms(2.0 * HOUR_S), Alarms { count: 2, at_risk_h: 4 });
        assert_eq!(alarms(0.0), Alarms { count: 3, at_risk_h: 8 });
        assert_eq!(alarms(100.0 * HOUR_S), Alarms { count: 1, at_risk_h: 2 });
    }
}
