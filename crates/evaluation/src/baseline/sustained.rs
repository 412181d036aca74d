//! What a value has not fallen below for a while: "brief violations do not alarm" as a number, so that the threshold can stay with
//! the alarm.
//!
//! The value holds from sample to sample, and "above `h` without interruption for `hold_s`" is the same as "the smallest of the
//! last `hold_s` is above `h`". The smallest is kept in a queue of rising values. Samples closer than a thousandth of
//! `hold_s` are taken together by their smallest, which bounds the memory and can only delay an alarm, by as much.
use std::collections::VecDeque;

/// Parts of the holding time that are told apart.
const PARTS: f64 = 1000.0;
/// After a gap longer than this, s, the time counts anew: what was in it is not known.
const LONGEST_GAP_S: f64 = 3600.0;

/// The smallest value of the last `hold_s`.
#[derive(Clone, Debug)]
pub struct Sustained {
    hold_s: f64,
    /// First and last sample since the last gap, s.
    span_s: Option<(f64, f64)>,
    rising: VecDeque<Stretch>,
}

/// A value and when it held.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    value: f64,
    from_s: f64,
    until_s: f64,
}

impl Sustained {
    /// Over `hold_s`, s; 0: the last sample alone.
    pub fn new(hold_s: f64) -> Self {
        Self { hold_s, span_s: None, rising: VecDeque::new() }
    }

    /// Take a sample, later than the one before; `None` as long as `hold_s` has not passed.
    pub fn update(&mut self, time_s: f64, value: f64) -> Option<f64> {
        if self.span_s.is_some_and(|(_, last_s)| time_s - last_s > LONGEST_GAP_S) {
            self.span_s = None;
            self.rising.clear();
        }
        let start_s = self.span_s.map_or(time_s, |(start_s, _)| start_s);
        self.span_s = Some((start_s, time_s));
        self.push(time_s, value);
        while self.rising.front().is_some_and(|oldest| oldest.until_s <= time_s - self.hold_s) {
            self.rising.pop_front();
        }
        let smallest = self.rising.front().map(|oldest| oldest.value);
        smallest.filter(|_| time_s - start_s >= self.hold_s)
    }

    fn push(&mut self, time_s: f64, value: f64) {
        let mut stretch = Stretch { value, from_s: time_s, until_s: f64::MAX };
        if let Some(last) = self.rising.back_mut() {
            last.until_s = time_s;
            if time_s - last.from_s < self.hold_s / PARTS {
                stretch = Stretch { value: value.min(last.value), from_s: last.from_s, ..stretch };
                self.rising.pop_back();
            }
        }
        while self.rising.back().is_some_and(|last| last.value >= stretch.value) {
            self.rising.pop_back();
        }
        self.rising.push_back(stretch);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Smallest value that held at any time within the last `hold_s`, from all samples.
    fn smallest(samples: &[(f64, f64)], hold_s: f64) -> Option<f64> {
        let now_s = samples[samples.len() - 1].0;
        let until = |n: usize| samples.get(n + 1).map_or(f64::INFINITY, |next| next.0);
        let held = (0..samples.len()).filter(|n| until(*n) > now_s - hold_s).map(|n| samples[n].1);
        (now_s - samples[0].0 >= hold_s).then(|| held.fold(f64::INFINITY, f64::min))
    }

    proptest! {
        #[test]
        fn it_is_the_smallest_value_of_the_holding_time(
            steps in prop::collection::vec((1.0..20.0_f64, -3.0..3.0_f64), 1..80), hold_s in 0.0..100.0_f64
        ) {
            let mut sustained = Sustained::new(hold_s);
            let (mut time_s, mut samples) = (0.0, Vec::new());
            for (step_s, value) in steps {
                time_s += step_s;
                samples.push((time_s, value));
                prop_assert_eq!(sustained.update(time_s, value), smallest(&samples, hold_s));
            }
        }
    }

    #[test]
    fn a_violation_that_lasts_alarms_when_the_time_is_up_and_a_brief_one_never() {
        let mut sustained = Sustained::new(600.0);
        let error = |n: u32| if (20..29).contains(&n) || n >= 40 { 2.0 } else { 0.0 };
        let first =
            (0..100).find(|n| sustained.update(60.0 * f64::from(*n), error(*n)).is_some_and(|e| e >= 1.0));
        assert_eq!(first, Some(50));
    }

    #[test]
    fn memory_is_bounded_and_fast_samples_delay_by_a_thousandth_at_most() {
        let mut sustained = Sustained::new(1000.0);
        let mut first = None;
        for n in 0..200_000 {
            let time_s = 0.01 * f64::from(n);
            // Rising values are the longest queue there is; they pass 5 at 500 s.
            if sustained.update(time_s, 0.01 * time_s).is_some_and(|e| e >= 5.0) {
                first = first.or(Some(time_s));
            }
            assert!(sustained.rising.len() <= 1002);
        }
        assert!(first.is_some_and(|time_s| (1500.0..=1501.1).contains(&time_s)), "{first:?}");
    }

    #[test]
    fn time_counts_anew_after_a_gap() {
        let mut sustained = Sustained::new(100.0);
        assert_eq!(sustained.update(0.0, 1.0), None);
        assert_eq!(sustained.update(100.0, 2.0), Some(1.0));
        assert_eq!(sustained.update(3701.0, 3.0), None);
        assert_eq!(sustained.update(3801.0, 4.0), Some(3.0));
    }
}
