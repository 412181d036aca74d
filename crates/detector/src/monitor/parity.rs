//! Whether one end of the cylinder is warmed or cooled by itself, so that the thermometers do not stand for the gas.
//!
//! Sensors sit at the top. Something warm beside the bottom, a hall with warm air under the roof, sun: the mean of the wall is then not what the
//! shoulder says, the gas is some kelvin off, and pressure and mass with it, with no leak. It shows in the difference of
//! the two thermometers. In calm windows of ten minutes (neither moves by more than 0.6 K) it stays within 0.1 to 0.2 K for weeks, tunnels and all;
//! with the air by 10 K warmer or colder at one end it is 0.5 to 3 K off within an hour or two.
//!
//! `d` is the median of the last three calm windows less that of the two days before. The evidence for a leak is divided by
//! `sqrt(1 + ((|d| - 0.3 K) / 0.2 K)^2)` from `|d|` = 0.3 K on, at most 4, beyond 2.5 the verdict is unknown; and for six hours after it by what is left of that, as the observer needs its time to come back. Where `d` was above 0.5 K for three
//! hours, the evidence from then counts for nothing once it is over. After two days the new difference is the usual one.
use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

/// Length of a window, s, the change within it that is calm, K, and its fewest rows.
const WINDOW_S: f64 = 600.0;
const CALM_K: f64 = 0.6;
const FEWEST_ROWS: u32 = 2;
/// Time over which the usual difference is taken, s, and fewest windows.
const USUAL_S: f64 = 48.0 * 3600.0;
const FEWEST_USUAL: usize = 36;
/// Windows whose median is the present difference, and time without one, s, after which nothing is known of it.
const LATEST: usize = 3;
const STALE_S: f64 = 3.0 * 3600.0;
/// Difference that is usual, K, and difference beyond it that raises what is needed by 40 %, K.
const HARMLESS_K: f64 = 0.3;
const SCALE_K: f64 = 0.2;
/// Largest divisor: a leak of 1 bar/h is found beside whatever heater.
const LARGEST: f64 = 4.0;
/// Divisor beyond which nothing is known of small leaks.
const BLIND: f64 = 2.5;
/// Time constant with which it comes back, s.
const BACK_S: f64 = 6.0 * 3600.0;
/// Difference, K, and time, s, from which what was seen counts for nothing, and the difference at which it is over, K.
const DISTURBED_K: f64 = 0.5;
const DISTURBED_S: f64 = 3.0 * 3600.0;
const OVER_K: f64 = 0.3;

/// Time for which it is off until it is told, s.
const TOLD_S: f64 = 3600.0;

/// What changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Disturbance {
    /// For an hour now the difference has been off, by so much, K.
    Begun(f64),
    /// It is over, and what was seen meanwhile counts for nothing.
    Over,
}

/// Watches the difference of two thermometers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Parity {
    window: Option<Window>,
    /// Ends, s, and mean differences, K, of calm windows.
    calm: VecDeque<(f64, f64)>,
    off_k: f64,
    /// What the evidence is divided by, less one.
    excess: f64,
    last_s: f64,
    disturbed_s: f64,
    told: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Window {
    begun_s: f64,
    lowest: [f64; 2],
    highest: [f64; 2],
    sum_k: f64,
    rows: u32,
}

impl Window {
    fn new(begun_s: f64) -> Self {
        let infinity = [f64::INFINITY; 2];
        Self { begun_s, lowest: infinity, highest: infinity.map(|high| -high), sum_k: 0.0, rows: 0 }
    }

    fn push(&mut self, readings: [f64; 2]) {
        self.lowest = [0, 1].map(|i| self.lowest[i].min(readings[i]));
        self.highest = [0, 1].map(|i| self.highest[i].max(readings[i]));
        self.sum_k += readings[0] - readings[1];
        self.rows += 1;
    }

    fn difference_k(&self) -> Option<f64> {
        let calm = (0..2).all(|i| self.highest[i] - self.lowest[i] < CALM_K);
        (calm && self.rows >= FEWEST_ROWS).then(|| self.sum_k / f64::from(self.rows))
    }
}

impl Parity {
    /// Take in both readings, K; those that are none count for nothing.
    pub fn push(&mut self, time_s: f64, readings: [f64; 2]) -> Option<Disturbance> {
        let elapsed_s = (time_s - self.last_s).max(0.0);
        self.last_s = time_s;
        let window = self.window.get_or_insert(Window::new(time_s));
        let completed = if time_s - window.begun_s >= WINDOW_S {
            let next = Window::new(time_s);
            let completed = std::mem::replace(window, next);
            completed.difference_k().map(|difference_k| (completed.begun_s, difference_k))
        } else {
            None
        };
        if readings.iter().all(|reading| reading.is_finite()) {
            window.push(readings);
        }
        if let Some(calm) = completed {
            self.compare(calm);
        }
        if self.calm.back().is_some_and(|(at_s, _)| time_s - at_s > STALE_S) {
            self.off_k = 0.0;
        }
        let beyond_k = (self.off_k.abs() - HARMLESS_K).max(0.0);
        let now = (beyond_k / SCALE_K).hypot(1.0).min(LARGEST) - 1.0;
        self.excess = now.max(self.excess * (-elapsed_s / BACK_S).exp());
        if self.off_k.abs() > DISTURBED_K {
            self.disturbed_s += elapsed_s;
        }
        if self.disturbed_s > TOLD_S && !self.told {
            self.told = true;
            return Some(Disturbance::Begun(self.off_k));
        }
        if self.off_k.abs() >= OVER_K {
            return None;
        }
        let forgotten = std::mem::take(&mut self.disturbed_s) > DISTURBED_S;
        self.told = false;
        forgotten.then_some(Disturbance::Over)
    }

    fn compare(&mut self, calm: (f64, f64)) {
        self.calm.push_back(calm);
        while self.calm.front().is_some_and(|(at_s, _)| *at_s < calm.0 - USUAL_S) {
            self.calm.pop_front();
        }
        let usual = self.calm.len().saturating_sub(LATEST);
        if usual >= FEWEST_USUAL {
            let of = |range: std::ops::Range<usize>| median(self.calm.range(range).map(|(_, off_k)| *off_k));
            self.off_k = of(usual..self.calm.len()) - of(0..usual);
        }
    }

    /// Whether the difference is the usual one, and has been for a while.
    pub fn is_usual(&self) -> bool {
        self.off_k.abs() < OVER_K && self.excess < 1.0
    }

    /// Whether nothing can be told of small leaks.
    pub fn is_blind(&self) -> bool {
        self.divisor() > BLIND
    }

    /// What the evidence for a leak is divided by.
    pub fn divisor(&self) -> f64 {
        1.0 + self.excess
    }

    /// Another offset of a thermometer is taken off from now on: the difference is learnt anew.
    pub fn forget(&mut self) {
        let (excess, last_s) = (self.excess, self.last_s);
        *self = Self { excess, last_s, ..Self::default() };
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOUR_S: f64 = 3600.0;

    /// The divisors of a course of minutes in hours, and the hours at which something changed.
    fn watched(
        hours: f64,
        shoulder: impl Fn(f64) -> f64,
        valve: impl Fn(f64) -> f64,
    ) -> (Vec<f64>, Vec<(f64, Disturbance)>) {
        let mut parity = Parity::default();
        let (mut divisors, mut changes) = (Vec::new(), Vec::new());
        for minute in 0..(60.0 * hours) as u32 {
            let hour = f64::from(minute) / 60.0;
            let noise = |n: u32| 0.01 * f64::from((minute * n) % 11) - 0.05;
            let change = parity.push(HOUR_S * hour, [shoulder(hour) + noise(7), valve(hour) + noise(4)]);
            changes.extend(change.map(|change| (hour, change)));
            divisors.push(parity.divisor());
        }
        (divisors, changes)
    }

    #[test]
    fn tunnels_are_no_disturbance() {
        // The body warms by 12 K/h inside, and cools as fast after it.
        let tunnel = |hour: f64, share: f64| match hour % 3.0 {
            inside if inside < 0.4 => 280.0 + 40.0 * share + 12.0 * inside,
            after => 280.0 + (4.8 - 12.0 * (after - 0.4)).max(0.0),
        };
        let (divisors, changes) = watched(72.0, |hour| tunnel(hour, 0.15), |hour| tunnel(hour, 0.05));
        assert!(divisors.iter().all(|divisor| *divisor < 1.1) && changes.is_empty());
    }

    #[test]
    fn one_end_that_is_warmed_makes_the_evidence_count_less_until_it_is_over() {
        let warmed = |hour: f64| if (40.0..52.0).contains(&hour) { 281.0 } else { 280.0 };
        let (divisors, changes) = watched(90.0, warmed, |_| 280.0);
        let at = |hour: f64| divisors[(60.0 * hour) as usize];
        assert!(at(39.0) < 1.1, "{}", at(39.0));
        for hour in [41.0, 46.0, 51.0] {
            assert!((at(hour) - 3.64).abs() < 0.3, "{} at {hour} h", at(hour));
        }
        assert!(at(58.5) > 1.8 && at(58.5) < 2.8 && at(85.0) < 1.1, "{} and {}", at(58.5), at(85.0));
        let [(begun_h, Disturbance::Begun(off_k)), (over_h, Disturbance::Over)] = changes[..] else {
            panic!("{changes:?}")
        };
        assert!((41.0..42.0).contains(&begun_h) && (52.0..53.0).contains(&over_h), "{changes:?}");
        assert!((off_k - 1.0).abs() < 0.1, "{off_k} K");
    }

    #[test]
    fn sun_of_an_hour_is_no_reason_to_forget_and_missing_readings_are_none() {
        let sunny = |hour: f64| if (40.0..41.5).contains(&hour) { 281.0 } else { 280.0 };
        let (_, changes) = watched(60.0, sunny, |_| 280.0);
        assert!(matches!(changes[..], [(_, Disturbance::Begun(_))]), "{changes:?}");
        let (divisors, _) = watched(60.0, |hour| if hour > 40.0 { f64::NAN } else { 280.0 }, |_| 280.0);
        assert!(divisors.iter().all(|divisor| divisor.is_finite() && *divisor < 1.1));
        // One that is lost while it is off says nothing more.
        let lost = |hour: f64| if hour > 41.0 { f64::NAN } else { 281.0 + (hour - 40.0).signum() };
        let (divisors, _) = watched(90.0, lost, |_| 280.0);
        assert!(divisors[2460] > 3.0 && *divisors.last().unwrap() < 1.1, "{:?}", divisors.last());
    }
}
