//! The times of a log: gaps with their begin, steps back, and what looks like summer time.

use super::sketch::Sketch;
use crate::thermal::units::HOUR_S;

/// Longest intervals that are kept.
const LISTED_INTERVALS: usize = 20;

/// An interval between two rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Time of the row before it, s.
    pub begin_s: f64,
    /// Length, s; negative: a step back.
    pub length_s: f64,
    /// Line of the row after it.
    pub line: u64,
}

/// Times while they pass.
#[derive(Clone, Debug, Default)]
pub(super) struct Clock {
    last_s: Option<f64>,
    longest: Vec<Interval>,
    intervals: Sketch,
    pub steps_back: u64,
    pub first_back: Option<Interval>,
}

impl Clock {
    /// Takes in the time of a row.
    pub(super) fn push(&mut self, time_s: f64, line: u64) {
        if let Some(begin_s) = self.last_s.replace(time_s) {
            let interval = Interval { begin_s, length_s: time_s - begin_s, line };
            if interval.length_s < 0.0 {
                self.steps_back += 1;
                self.first_back.get_or_insert(interval);
            } else if interval.length_s > 0.0 {
                self.intervals.push(interval.length_s);
                self.keep(interval);
            }
        }
    }

    /// The interval, s, that this share of all does not exceed; NaN without any.
    pub(super) fn quantile(&self, share: f64) -> f64 {
        self.intervals.quantile(share)
    }

    /// The longest intervals above a length, in the order of time.
    pub(super) fn above(&self, length_s: f64) -> Vec<Interval> {
        let mut gaps: Vec<Interval> =
            self.longest.iter().filter(|interval| interval.length_s > length_s).copied().collect();
        gaps.sort_by(|a, b| a.begin_s.total_cmp(&b.begin_s));
        gaps
    }

    fn keep(&mut self, interval: Interval) {
        if self.longest.len() < LISTED_INTERVALS {
            self.longest.push(interval);
        } else if let Some(shortest) =
            self.longest.iter_mut().min_by(|a, b| a.length_s.total_cmp(&b.length_s))
            && interval.length_s > shortest.length_s
        {
            *shortest = interval;
        }
    }
}

impl Interval {
    /// Whether a local clock changed to or from summer time here, at an interval of so many seconds.
    pub(crate) fn is_summer_time(&self, usual_s: f64) -> bool {
        let near = |length_s: f64| (length_s - usual_s).abs() <= 0.5 * usual_s.max(1.0);
        usual_s < HOUR_S / 4.0 && (near(self.length_s - HOUR_S) || near(self.length_s + HOUR_S))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_have_a_begin_and_an_hour_back_is_summer_time() {
        let mut clock = Clock::default();
        let mut time_s = 0.0;
        for line in 2..1000 {
            time_s += match line {
                300 => 600.0,
                500 => 60.0 - 3600.0,
                _ => 60.0,
            };
            clock.push(time_s, line);
        }
        let gaps = clock.above(300.0);
        assert_eq!((gaps.len(), gaps[0].begin_s, gaps[0].length_s), (1, 60.0 * 298.0, 600.0));
        let back = clock.first_back.unwrap();
        assert_eq!((clock.steps_back, back.line), (1, 500));
        assert!(back.is_summer_time(60.0) && !gaps[0].is_summer_time(60.0));
    }
}
