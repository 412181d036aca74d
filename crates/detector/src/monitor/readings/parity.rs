//! Whether one end of the cylinder is warmed or cooled by itself, so that the thermometers do not stand for the gas.
//!
//! Sensors sit at the top. Something warm beside the bottom, a hall with warm air under the roof, sun: the mean of the wall is then not
//! what the shoulder says, the gas is some kelvin off, and pressure and mass with it, with no leak. It shows in the difference of the
//! two thermometers. In calm windows of ten minutes (neither moves by more than 0.6 K) it stays within 0.1 to 0.2 K for weeks, tunnels
//! and all; with the air by 10 K warmer or colder at one end it is 0.5 to 3 K off within an hour or two.
//!
//! `d` is the median of the last three calm windows less that of the two days before. Where the difference usually varies, as with every day's sun in a
//! desert, that much is usual: with the median `s` of its deviations in these days beyond 0.15 K, all limits below are those of `|d| - 2 s`. The evidence
//! for a leak is divided by `sqrt(1 + ((|d| - 2 s - 0.3 K) / (0.2 K + s))^2)` from there on, at most 4, and by 1.3 at least where no three calm windows of the last
//! one and a half hours give `d`, for as long again; beyond 2.5 the verdict is unknown; for six hours after it by what is left of that,
//! as the observer needs its time to come back. Where `d` was above 0.5 K for three hours, the evidence from then counts for nothing
//! once it is over.
//!
//! Which of the two is off the pressure says: with `T_p` the temperature at which the stated mass has this pressure,
//! `a_i = T_i - T_p` less its usual value, or less that of an hour before, is `d` for the one that is off and nothing for the other.
//! Sun, day and night, and a leak move both `a` alike (by 1 K from night to noon, as the thermometers sit outside), so it is named where
//! `|d| > 0.6 K` and the other `|a| < 0.4 |d|` in three windows running. One end that is warmed by itself may look the same for hours.
//! What stays within 0.3 K of itself for sixteen hours of the same one is an offset of that thermometer. A difference that nobody
//! could be named for is the usual one after a day: either may have shifted.
use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::monitor::median::median;

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
/// Usual deviations of the difference that are harmless, too.
const USUAL_SPREADS: f64 = 2.0;
/// Largest divisor: a leak of 1 bar/h is found beside whatever heater.
const LARGEST: f64 = 4.0;
/// Time within which three calm windows say whether the difference is usual, s, and the divisor where they do not, until it is stale: in a tunnel nobody sees a kelvin.
const KNOWN_S: f64 = 5400.0;
const UNKNOWN: f64 = 1.3;
/// Divisor beyond which nothing is known of small leaks.
const BLIND: f64 = 2.5;
/// Time constant with which it comes back, s.
const BACK_S: f64 = 6.0 * 3600.0;
/// Difference, K, and time, s, from which what was seen counts for nothing, and the difference at which it is over, K.
const DISTURBED_K: f64 = 0.5;
const DISTURBED_S: f64 = 3.0 * 3600.0;
const OVER_K: f64 = 0.3;
/// Time for which it is off until it is told, s, and the difference from which it is, K: from then on small leaks are not seen.
const TOLD_S: f64 = 3600.0;
const TOLD_K: f64 = 0.8;
/// Difference from which one is named, K, windows running that name it, and parts of the difference that the other one may be off and it
/// must be.
const NAMED_K: f64 = 0.6;
const NAMED_WINDOWS: u32 = 3;
const OTHER_PART: f64 = 0.4;
const OWN_PART: f64 = 0.5;
/// Windows before the last ones in which a leak makes little of it.
const LATELY: usize = 6;
/// Time for which the same one is named, s, with a difference within so much of its mean, K, until it is an offset.
const LASTING_S: f64 = 16.0 * 3600.0;
const LASTING_K: f64 = 0.3;

/// What changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::monitor) enum Disturbance {
    /// For an hour the difference has been off, now by so much, K, that small leaks are not seen.
    Begun(f64),
    /// It is over, and what was seen meanwhile counts for nothing. The difference that is usual now is by so much another one, K.
    Over(f64),
    /// It was an offset of the thermometer of this index, by so much, K.
    Shifted(usize, f64),
}

/// Means of a calm window.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Calm {
    begun_s: f64,
    /// First less second thermometer, K.
    apart_k: f64,
    /// Each less the temperature that the pressure stands for, K; NaN without a pressure.
    above_k: [f64; 2],
}

/// A thermometer that is off while the other one agrees with the pressure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Named {
    which: usize,
    since_s: f64,
    windows: u32,
    /// Mean of the difference since, K.
    mean_k: f64,
    /// Whether the difference has stayed what it was.
    steady: bool,
}

/// Watches the difference of two thermometers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::monitor) struct Parity {
    window: Option<Window>,
    calm: VecDeque<Calm>,
    off_k: f64,
    /// How far the difference usually is from its median, K: median absolute deviation beyond the harmless.
    spread_k: f64,
    named: Option<Named>,
    /// Usual difference before it was off, K.
    usual_k: f64,
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
    sum_k: [f64; 2],
    sum_pa: f64,
    rows: u32,
}

impl Window {
    fn new(begun_s: f64) -> Self {
        let infinity = [f64::INFINITY; 2];
        Self {
            begun_s,
            lowest: infinity,
            highest: infinity.map(|high| -high),
            sum_k: [0.0; 2],
            sum_pa: 0.0,
            rows: 0,
        }
    }

    fn push(&mut self, readings: [f64; 2], pressure_pa: f64) {
        self.lowest = [0, 1].map(|i| self.lowest[i].min(readings[i]));
        self.highest = [0, 1].map(|i| self.highest[i].max(readings[i]));
        self.sum_k = [0, 1].map(|i| self.sum_k[i] + readings[i]);
        self.sum_pa += pressure_pa;
        self.rows += 1;
    }

    /// Means, if it was calm; `gas_k` gives the temperature that a pressure, Pa, stands for near one, K.
    fn close(&self, gas_k: impl Fn(f64, f64) -> f64) -> Option<Calm> {
        let calm = (0..2).all(|i| self.highest[i] - self.lowest[i] < CALM_K);
        if !calm || self.rows < FEWEST_ROWS {
            return None;
        }
        let mean_k = self.sum_k.map(|sum_k| sum_k / f64::from(self.rows));
        let gas_k = gas_k(self.sum_pa / f64::from(self.rows), 0.5 * (mean_k[0] + mean_k[1]));
        Some(Calm {
            begun_s: self.begun_s,
            apart_k: mean_k[0] - mean_k[1],
            above_k: mean_k.map(|mean_k| mean_k - gas_k),
        })
    }
}

impl Parity {
    /// Take in both thermometers, K, and the pressure, Pa; those that are none count for nothing. `gas_k` gives the temperature that a pressure,
    /// Pa, stands for near one, K.
    pub fn push(
        &mut self,
        time_s: f64,
        readings: [f64; 2],
        pressure_pa: f64,
        gas_k: impl Fn(f64, f64) -> f64,
    ) -> Option<Disturbance> {
        let elapsed_s = (time_s - self.last_s).max(0.0);
        self.last_s = time_s;
        let window = self.window.get_or_insert(Window::new(time_s));
        let completed = if time_s - window.begun_s >= WINDOW_S {
            std::mem::replace(window, Window::new(time_s)).close(gas_k)
        } else {
            None
        };
        if readings.iter().all(|reading| reading.is_finite()) {
            window.push(readings, pressure_pa);
        }
        if let Some(calm) = completed {
            self.compare(calm);
        }
        if self.calm.back().is_some_and(|calm| time_s - calm.begun_s > STALE_S) {
            (self.off_k, self.named) = (0.0, None);
        }
        let beyond_k = (self.unusual_k() - HARMLESS_K).max(0.0);
        let now = (beyond_k / (SCALE_K + self.spread_k)).hypot(1.0).min(LARGEST) - 1.0;
        self.excess = now.max(self.excess * (-elapsed_s / BACK_S).exp());
        self.tell(elapsed_s)
    }

    /// What has changed with a row so long after the last one, s.
    fn tell(&mut self, elapsed_s: f64) -> Option<Disturbance> {
        if self.unusual_k() > DISTURBED_K {
            self.disturbed_s += elapsed_s;
        }
        if let Some(named) =
            self.named.filter(|named| named.steady && self.last_s - named.since_s > LASTING_S)
        {
            return Some(Disturbance::Shifted(named.which, named.of_its_own(named.mean_k)));
        }
        if self.disturbed_s > TOLD_S && self.unusual_k() > TOLD_K && !self.told {
            self.told = true;
            return Some(Disturbance::Begun(self.off_k));
        }
        if self.unusual_k() >= OVER_K {
            return None;
        }
        let forgotten = std::mem::take(&mut self.disturbed_s) > DISTURBED_S;
        self.told = false;
        forgotten.then(|| Disturbance::Over(self.latest_k(|calm| calm.apart_k) - self.usual_k))
    }

    fn compare(&mut self, calm: Calm) {
        self.calm.push_back(calm);
        while self.calm.front().is_some_and(|first| first.begun_s < calm.begun_s - USUAL_S) {
            self.calm.pop_front();
        }
        let usual = self.calm.len().saturating_sub(LATEST);
        if usual < FEWEST_USUAL {
            // What was found against other days is no finding of these.
            (self.off_k, self.named) = (0.0, None);
            return;
        }
        let before = self.calm.iter().rev().skip(LATEST);
        let usual_k = median(before.clone().map(|calm| calm.apart_k));
        let spread_k = median(before.map(|calm| (calm.apart_k - usual_k).abs()));
        self.off_k = self.latest_k(|calm| calm.apart_k) - usual_k;
        self.spread_k = (spread_k - HARMLESS_K / 2.0).max(0.0);
        if self.disturbed_s == 0.0 {
            self.usual_k = usual_k;
        }
        self.name(calm.begun_s);
    }

    fn name(&mut self, time_s: f64) {
        if self.unusual_k() < OVER_K {
            self.named = None;
            return;
        }
        let off = [usize::MAX, LATELY].map(|against| self.which_is_off(against));
        let is_off = |which: usize| off.contains(&Some(which));
        self.named = match self.named {
            // Once it is named, what the night makes of it names nobody else.
            Some(named) if is_off(named.which) || named.windows >= NAMED_WINDOWS => {
                Some(named.goes_on(self.off_k))
            }
            _ if self.unusual_k() < NAMED_K => None,
            _ => off[0].or(off[1]).map(|which| Named::new(which, time_s, self.off_k)),
        };
    }

    /// Which one has left what the pressure stands for, against so many windows before, while the other one has not.
    fn which_is_off(&self, against: usize) -> Option<usize> {
        let above_k = [0, 1].map(|i| self.change_k(against, |calm| calm.above_k[i]));
        let which = usize::from(above_k[1].abs() > above_k[0].abs());
        // Not so without a pressure.
        let agrees = above_k[1 - which].abs() < OTHER_PART * self.off_k.abs();
        (agrees && above_k[which].abs() > OWN_PART * self.off_k.abs()).then_some(which)
    }

    /// Median over the last windows less that over so many before them.
    fn change_k(&self, against: usize, of: impl Fn(&Calm) -> f64) -> f64 {
        self.latest_k(&of) - median(self.calm.iter().rev().skip(LATEST).take(against).map(of))
    }

    /// Median over the last windows.
    fn latest_k(&self, of: impl Fn(&Calm) -> f64) -> f64 {
        median(self.calm.iter().rev().take(LATEST).map(of))
    }

    /// A thermometer that is off while the other one agrees with the pressure, and by how much, K.
    pub fn deviating(&self) -> Option<(usize, f64)> {
        let named = self.named.filter(|named| named.windows >= NAMED_WINDOWS)?;
        Some((named.which, named.of_its_own(self.off_k)))
    }

    /// How far the present difference is from the usual one beyond the usual deviations, K.
    fn unusual_k(&self) -> f64 {
        (self.off_k.abs() - USUAL_SPREADS * self.spread_k).max(0.0)
    }

    /// Whether the difference is the usual one, and has been for a while.
    pub fn is_usual(&self) -> bool {
        self.unusual_k() < OVER_K && self.excess < 1.0
    }

    /// Whether nothing can be told of small leaks.
    pub fn is_blind(&self) -> bool {
        self.divisor() > BLIND
    }

    /// What the evidence for a leak is divided by.
    pub fn divisor(&self) -> f64 {
        let first = self.calm.len().checked_sub(LATEST).and_then(|at| self.calm.get(at));
        let unknown = first.is_some_and(|first| (KNOWN_S..STALE_S).contains(&(self.last_s - first.begun_s)));
        (1.0 + self.excess).max(if unknown { UNKNOWN } else { 1.0 })
    }

    /// Another offset of a thermometer is taken off from now on: the difference is learnt anew.
    pub fn forget(&mut self) {
        let (excess, last_s) = (self.excess, self.last_s);
        *self = Self { excess, last_s, ..Self::default() };
    }
}

impl Named {
    /// Named for the first time, with the difference then, K.
    fn new(which: usize, since_s: f64, mean_k: f64) -> Self {
        Self { which, since_s, windows: 1, mean_k, steady: true }
    }

    /// How far it is off itself where the difference is, K.
    fn of_its_own(&self, off_k: f64) -> f64 {
        if self.which == 0 { off_k } else { -off_k }
    }

    /// After a further window, with the difference in it, K.
    fn goes_on(self, off_k: f64) -> Self {
        let windows = self.windows + 1;
        let mean_k = self.mean_k + (off_k - self.mean_k) / f64::from(windows);
        Self { windows, mean_k, steady: self.steady && (off_k - mean_k).abs() < LASTING_K, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOUR_S: f64 = 3600.0;

    /// A course of minutes.
    struct Watched {
        parity: Parity,
        divisors: Vec<f64>,
        /// Hours at which something changed.
        changes: Vec<(f64, Disturbance)>,
        /// Hours at which another one deviates, and by how much, K.
        deviating: Vec<(f64, Option<(usize, f64)>)>,
    }

    /// So many hours of both thermometers and the temperature that the pressure stands for, K.
    fn compared(hours: f64, course: impl Fn(f64) -> [f64; 3]) -> Watched {
        let parity = Parity::default();
        let mut watched =
            Watched { parity, divisors: Vec::new(), changes: Vec::new(), deviating: Vec::new() };
        for minute in 0..(60.0 * hours) as u32 {
            let hour = f64::from(minute) / 60.0;
            let noise = |n: u32| 0.01 * f64::from((minute * n) % 11) - 0.05;
            let [shoulder, valve, gas] = course(hour);
            let readings = [shoulder + noise(7), valve + noise(4)];
            let change = watched.parity.push(HOUR_S * hour, readings, gas, |gas_k, _| gas_k);
            watched.changes.extend(change.map(|change| (hour, change)));
            watched.divisors.push(watched.parity.divisor());
            let deviating = watched.parity.deviating();
            let which = |of: &Option<(usize, f64)>| of.map(|(which, _)| which);
            if watched.deviating.last().and_then(|(_, last)| which(last)) != which(&deviating) {
                watched.deviating.push((hour, deviating));
            }
        }
        watched
    }

    /// The divisors of a course without a pressure, and the hours at which something changed.
    fn watched(
        hours: f64,
        shoulder: impl Fn(f64) -> f64,
        valve: impl Fn(f64) -> f64,
    ) -> (Vec<f64>, Vec<(f64, Disturbance)>) {
        let watched = compared(hours, |hour| [shoulder(hour), valve(hour), f64::NAN]);
        assert!(watched.deviating.is_empty());
        (watched.divisors, watched.changes)
    }

    /// Night and day, by half a kelvin.
    fn day_k(hour: f64) -> f64 {
        0.5 * (std::f64::consts::TAU * hour / 24.0).sin()
    }

    #[test]
    fn the_one_that_leaves_the_pressure_is_named_and_is_shifted_when_it_lasts() {
        // From hour 40 on the valve reads 1 K more; a leak lets the pressure stand for less from then on.
        for leak_k_h in [0.0, 0.1, 1.0] {
            let course = |hour: f64| {
                let since: f64 = if hour > 40.0 { 1.0 } else { 0.0 };
                let leak_k = leak_k_h * (hour - 40.0).max(0.0);
                [280.0 + day_k(hour), 280.0 + day_k(hour) + since, 280.0 - leak_k]
            };
            let watched = compared(60.0, course);
            let Some(&(named_h, Some((1, by_k)))) = watched.deviating.first() else {
                panic!("{:?} with {leak_k_h} K/h", watched.deviating)
            };
            assert!((40.4..41.2).contains(&named_h) && (by_k - 1.0).abs() < 0.15, "{named_h} h, {by_k} K");
            let shifted = watched.changes.iter().find_map(|(hour, change)| match change {
                Disturbance::Shifted(which, by_k) => Some((*hour, *which, *by_k)),
                _ => None,
            });
            let (shifted_h, which, by_k) = shifted.expect("it lasts");
            assert!(
                (56.0..57.5).contains(&shifted_h) && which == 1 && (by_k - 1.0).abs() < 0.1,
                "{shifted_h} h"
            );
        }
    }

    #[test]
    fn one_that_was_named_is_no_more_when_too_few_calm_windows_are_left_to_tell_what_is_usual() {
        // From hour 40 on both are shaken but for a few minutes in two hours, so that by hour 86 too few windows of two days are calm. The
        // valve reads 1 K more for ten hours before.
        let course = |hour: f64| {
            let shaken = if hour > 40.0 && hour % 2.0 > 0.2 { 3.0 * (7.0 * hour).fract() } else { 0.0 };
            let off = if (75.0..85.0).contains(&hour) { 1.0 } else { 0.0 };
            [280.0 + shaken, 280.0 + shaken + off, 280.0]
        };
        let watched = compared(120.0, course);
        assert!(!watched.deviating.is_empty(), "it is named at first");
        let shifted = watched.changes.iter().find(|(_, change)| matches!(change, Disturbance::Shifted(..)));
        assert!(shifted.is_none(), "{:?}", watched.changes);
    }

    #[test]
    fn a_difference_that_swings_with_every_day_is_usual_and_a_heater_beside_it_is_not() {
        let swing = |hour: f64| 1.2 * (std::f64::consts::TAU * hour / 24.0).sin();
        let heater = |hour: f64| if hour > 130.0 { 5.0 } else { 0.0 };
        let (divisors, _) = watched(140.0, |hour| 280.0 + swing(hour) + heater(hour), |_| 280.0);
        let at = |hour: f64| divisors[(60.0 * hour) as usize];
        let later: Vec<f64> = (60..130).map(|hour| at(f64::from(hour))).collect();
        assert!(later.iter().all(|divisor| *divisor < BLIND), "{later:?}");
        assert!(at(132.0) > BLIND, "{}", at(132.0));
    }

    #[test]
    fn sun_on_one_of_them_warms_the_gas_and_names_nobody() {
        let sun = |hour: f64| if (40.0..46.0).contains(&hour) { 1.0 } else { 0.0 };
        let watched = compared(60.0, |hour| [280.0 + 1.6 * sun(hour), 280.0 + 0.8 * sun(hour), 280.0]);
        assert!(watched.deviating.is_empty(), "{:?}", watched.deviating);
        let [(_, Disturbance::Begun(_)), (_, Disturbance::Over(by_k))] = watched.changes[..] else {
            panic!("{:?}", watched.changes)
        };
        assert!(by_k.abs() < 0.1, "the usual difference is what it was, not {by_k} K from it");
    }

    #[test]
    fn a_difference_that_became_usual_is_told_with_its_end() {
        let (_, changes) = watched(90.0, |hour| if hour > 40.0 { 281.0 } else { 280.0 }, |_| 280.0);
        let Some((over_h, Disturbance::Over(by_k))) = changes.last() else { panic!("{changes:?}") };
        assert!((60.0..68.0).contains(over_h) && (by_k - 1.0).abs() < 0.1, "{by_k} K at {over_h} h");
    }

    #[test]
    fn without_calm_windows_the_evidence_counts_a_little_less() {
        let shaken = |hour: f64| if hour > 40.0 { 280.0 + (7.0 * hour).fract() } else { 280.0 };
        let (divisors, _) = watched(44.0, shaken, shaken);
        assert_eq!([2399, 2520, 2639].map(|minute| divisors[minute]), [1.0, UNKNOWN, 1.0]);
    }

    #[test]
    fn tunnels_are_no_disturbance() {
        // The body warms by 12 K/h inside, and cools as fast after it.
        let tunnel = |hour: f64, share: f64| match hour % 3.0 {
            inside if inside < 0.4 => 280.0 + 40.0 * share + 12.0 * inside,
            after => 280.0 + (4.8 - 12.0 * (after - 0.4)).max(0.0),
        };
        let (divisors, changes) = watched(72.0, |hour| tunnel(hour, 0.15), |hour| tunnel(hour, 0.05));
        assert!(divisors.iter().all(|divisor| *divisor <= UNKNOWN) && changes.is_empty());
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
        let [(begun_h, Disturbance::Begun(off_k)), (over_h, Disturbance::Over(_))] = changes[..] else {
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
        assert!(divisors.iter().all(|divisor| divisor.is_finite() && *divisor <= UNKNOWN));
        // One that is lost while it is off says nothing more.
        let lost = |hour: f64| if hour > 41.0 { f64::NAN } else { 281.0 + (hour - 40.0).signum() };
        let (divisors, _) = watched(90.0, lost, |_| 280.0);
        assert!(divisors[2460] > 3.0 && *divisors.last().unwrap() < 1.1, "{:?}", divisors.last());
    }
}
