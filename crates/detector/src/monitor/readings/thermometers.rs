//! Thermometers that jump alone.
//!
//! Air, sun and rain reach shoulder and valve alike, if not as much; a thermometer that jumps while the other one does not, and stays
//! there, has changed its offset. A jump is what a reading adds to where the readings before lead, so that a tunnel in which both move
//! steadily hides none:
//!
//! `s = T_n - T_{n-1} - (T_{n-1} - T_{n-3}) / 2`, in samples that are evenly apart.
//!
//! Temperatures are held against `e`, what the model misses of a temperature on the surface
//! ([`ModelError::surface_k`](crate::estimator::observer::ModelError), 0.12 K), or a thermometer's noise where that is more.
//!
//! A jump is lonely where `|s| > 6 e` in a minute and that of the other one is below `0.05 |s| + 2 e`. Readings in steps of `q` make up to `3 q` of the difference of two `s`: so much is added
//! to what a jump is. Nor is it one where the surroundings may have made it: 0.44 of how far the nearer thermometer is from the gas, and of how far both went in one of the last three
//! samples (see the observer's flowing member).
//!
//! What it was the bank of causes tells from how far both are apart: an offset, or nothing that lasts. What the surroundings make of that, `x`, has the standard
//! deviation 0.44 of how far the nearer one is from the gas, or of how far either went within the time in which the cylinder follows (the suspected one since its jump), whichever is more:
//! while a wall that lags cools, the shoulder stays warmer than the valve. How far both are usually apart is a mean over two hours in which each sample counts by the inverse of that variance;
//! it is known half an hour after the first one. Until it is told the thermometer is not used, and for an hour after an offset neither: if it reads the air, it shows by then. One that jumps by more than an offset can, or is
//! restless while the other one is not and more so than usually, reads the air.
//!
//! How often a jump is believed that is none, and one missed, the plans `tight.toml` and `fault.toml` (row T2) of `cylwatch-evaluation` measure; see `book/src/measured.md`.
use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::monitor::examination::{Before, Cause, Compared, Examination, FarOff, SPAN, Subject};
use crate::monitor::gas::jump::LONGEST_INTERVAL_S;
use crate::units::{DAY_S, HOUR_S, MINUTE_S};

/// Jump against the slope before, in errors of a surface temperature, in a minute: what a tunnel does grows with the interval.
const JUMP: f64 = 6.0;
/// Part of it by which the other thermometer may jump too, beside the noise of both differences, errors.
const ALONE: f64 = 0.05;
const STILL: f64 = 2.0;
/// Mean size of the second differences lately, errors, that is restless, where that of the other one is a smaller part of it than usually by so much, and the times that both
/// are means of, s. Until a day is seen that part is the one of a massive shoulder beside a thin valve in gusts. One counts no more than ten times that.
const RESTLESS: f64 = 1.7;
const UNUSUAL: f64 = 0.5;
const LATELY_S: f64 = 2.0 * HOUR_S;
const USUALLY_S: f64 = 2.0 * DAY_S;
const IN_GUSTS: f64 = 1.0 / 3.0;
/// Steps of a reading in the difference of two second differences at most.
const STEPS: f64 = 3.0;
/// Time after which it is known how far both are usually apart, s.
const KNOWN_S: f64 = 0.5 * HOUR_S;
/// Samples that slopes are taken from.
const SAMPLES: usize = 3;
/// What both may have done while neither can be read, errors.
const UNSEEN: f64 = 40.0;

/// What a pair of thermometers showed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lonely {
    /// The one of this index may have jumped: its reading is not to be used.
    Suspected(usize),
    /// The one of this index changed its offset by so much, K.
    Shifted(usize, f64),
    /// The one of this index reads the air.
    Detached(usize),
}

/// Two thermometers on one cylinder.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// What the model misses of a temperature on the surface, K.
    error_k: f64,
    /// What their steps may make of a second difference, K.
    steps_k: f64,
    moved_k: f64,
    /// Lowest and highest readings lately, K, not a number before the first.
    extremes_k: [(f64, f64); 2],
    /// The last samples: time, s, and readings, K.
    recent: VecDeque<(f64, [f64; 2])>,
    usual: Usual,
    suspect: Option<Suspect>,
    /// Which one jumped last, and until when it is not used, s.
    probation: Option<(usize, f64)>,
    restless: Restlessness,
}

/// First less second thermometer lately: a mean in which what is in doubt counts little.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Usual {
    apart_k: f64,
    /// Time at rest that it is worth, and time that it was seen for, s.
    worth_s: f64,
    seen_s: f64,
}

impl Usual {
    /// Take in a difference, K, that the surroundings may have done so much to, errors.
    fn push(&mut self, interval_s: f64, apart_k: f64, doubt: f64) {
        if apart_k.is_nan() {
            return;
        }
        let worth_s = interval_s / (1.0 + doubt * doubt);
        self.seen_s += interval_s;
        self.worth_s = (self.worth_s + worth_s).min(LATELY_S);
        self.apart_k += worth_s / self.worth_s.max(f64::MIN_POSITIVE) * (apart_k - self.apart_k);
    }
}

/// A thermometer under suspicion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Suspect {
    which: usize,
    examination: Examination,
}

/// What the surroundings do to the thermometers.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings {
    /// Part of it that may reach one of them alone.
    pub part: f64,
    /// How far the nearer one is from the gas, K.
    pub away_k: f64,
    /// Time within which the cylinder follows, s.
    pub memory_s: f64,
}

impl Pair {
    /// Of thermometers that read in steps of so much at most, K, where the model misses so much of a temperature on the surface, K.
    pub fn new(resolution_k: f64, error_k: f64) -> Self {
        Self {
            error_k,
            steps_k: STEPS * resolution_k,
            extremes_k: [(f64::NAN, f64::NAN); 2],
            ..Self::default()
        }
    }

    /// What the model misses of a temperature on the surface, K.
    pub fn error_k(&self) -> f64 {
        self.error_k
    }

    /// Compare nothing with the last readings.
    fn forget(&mut self) {
        self.recent.clear();
        (self.suspect, self.moved_k) = (None, 0.0);
    }

    /// How far both went from the last sample to this one, K: the less far of them, as air, sun and rain reach both.
    pub fn moved_k(&self) -> f64 {
        self.moved_k
    }

    /// Take in both readings, K, NaN where there is none. Not judged while other gas warms or cools the one before the other.
    pub fn update(
        &mut self,
        time_s: f64,
        readings: [f64; 2],
        surroundings: Surroundings,
        judged: bool,
    ) -> Option<Lonely> {
        let interval_s = self.recent.back().map_or(0.0, |(last_s, _)| time_s - last_s);
        if interval_s > LONGEST_INTERVAL_S {
            self.forget();
        }
        let second_k = self.second_differences(time_s, readings);
        let may_be = |by_k: f64| surroundings.part * surroundings.away_k.max(by_k);
        let at_once_k = may_be(self.shaken_k());
        if !judged {
            self.suspect = None;
        }
        if let Some(second_k) = second_k.filter(|_| judged && self.suspect.is_none()) {
            self.look_for_a_jump((time_s, readings), second_k, at_once_k, surroundings.memory_s);
        }
        let doubt_k = may_be(self.went_k(interval_s, readings, surroundings.memory_s));
        let shown = match self.suspect.take() {
            Some(suspect) => self.follow(suspect, time_s, readings, doubt_k),
            None => {
                self.usual.push(interval_s, readings[0] - readings[1], doubt_k / self.error_k);
                None
            }
        };
        let restless = second_k
            .and_then(|second_k| self.restless.push(interval_s, second_k, (self.error_k, self.steps_k)));
        self.recent.push_back((time_s, readings));
        if self.recent.len() > SAMPLES {
            self.recent.pop_front();
        }
        if let Some(Lonely::Shifted(which, _)) = shown {
            self.probation = Some((which, time_s + HOUR_S));
        }
        restless.or(shown).or_else(|| self.on_probation(time_s))
    }

    /// Whether one of them has jumped, and is not used yet.
    pub(crate) fn is_on_probation(&self) -> bool {
        self.probation.is_some()
    }

    fn on_probation(&mut self, time_s: f64) -> Option<Lonely> {
        self.probation = self.probation.filter(|(_, until_s)| time_s < *until_s);
        self.probation.map(|(which, _)| Lonely::Suspected(which))
    }

    /// What this sample adds to the slopes before, K, NaN where there is none; also notes how far both moved.
    fn second_differences(&mut self, time_s: f64, readings: [f64; 2]) -> Option<[f64; 2]> {
        let &(last_s, last) = self.recent.back()?;
        let first = [0, 1].map(|i| readings[i] - last[i]);
        self.moved_k = self.smaller_k(first);
        let &(before_s, before) = self.recent.front().filter(|_| self.recent.len() == SAMPLES)?;
        // After a short interval a slope is mostly noise.
        let along = ((time_s - last_s) / (last_s - before_s).max(f64::MIN_POSITIVE)).min(0.5);
        Some([0, 1].map(|i| first[i] - along * (last[i] - before[i])))
    }

    /// Smaller size of two changes, K, of which one may be none.
    fn smaller_k(&self, changes: [f64; 2]) -> f64 {
        let size = changes[0].abs().min(changes[1].abs());
        if size.is_nan() { UNSEEN * self.error_k } else { size }
    }

    /// How far the one that went farther did lately, K; one that is suspected, since its jump. Extremes fade to the present readings.
    fn went_k(&mut self, interval_s: f64, readings: [f64; 2], memory_s: f64) -> f64 {
        let share = -(-interval_s / memory_s).exp_m1();
        for ((low_k, high_k), reading_k) in self.extremes_k.iter_mut().zip(readings) {
            if !reading_k.is_finite() {
                continue;
            }
            *low_k = (*low_k + share * (reading_k - *low_k)).min(reading_k);
            *high_k = (*high_k + share * (reading_k - *high_k)).max(reading_k);
        }
        // Not a number counts for nothing.
        self.extremes_k.iter().map(|(low_k, high_k)| high_k - low_k).fold(0.0, f64::max)
    }

    /// How far both went in one of the last samples at most, K.
    fn shaken_k(&self) -> f64 {
        let later = self.recent.iter().skip(1);
        let moved = self
            .recent
            .iter()
            .zip(later)
            .map(|((_, before), (_, now))| self.smaller_k([0, 1].map(|i| now[i] - before[i])));
        moved.fold(self.moved_k, f64::max)
    }

    fn look_for_a_jump(
        &mut self,
        (time_s, readings): (f64, [f64; 2]),
        second_k: [f64; 2],
        doubt_k: f64,
        memory_s: f64,
    ) {
        let Some(&(last_s, last)) = self.recent.back() else { return };
        let which = usize::from(second_k[1].abs() > second_k[0].abs());
        let (own_k, other_k) = (second_k[which], second_k[1 - which]);
        let minutes = ((time_s - last_s) / MINUTE_S).max(1.0);
        let jumps = own_k.abs().min((own_k - other_k).abs())
            > (JUMP * self.error_k * minutes + self.steps_k).max(doubt_k);
        // Not so where one of them is no number.
        let alone = other_k.abs() < ALONE * own_k.abs() + STILL * self.error_k;
        if jumps && alone && self.usual.seen_s > KNOWN_S {
            let of_span = |of_k: f64| of_k / (SPAN * self.error_k);
            let missing = -of_its_own(which, of_span(last[0] - last[1] - self.usual.apart_k));
            let before = Before { missing, fresh: of_span(doubt_k), unseen: 0.0 };
            let examination =
                Examination::new(Subject::Thermometer, time_s, before, memory_s, FarOff::default());
            self.suspect = Some(Suspect { which, examination });
            self.extremes_k[which] = (readings[which], readings[which]);
        }
    }

    fn follow(
        &mut self,
        mut suspect: Suspect,
        time_s: f64,
        readings: [f64; 2],
        doubt_k: f64,
    ) -> Option<Lonely> {
        let (which, span_k) = (suspect.which, SPAN * self.error_k);
        let off_k = of_its_own(which, readings[0] - readings[1] - self.usual.apart_k);
        let cause = suspect.examination.push(Compared {
            time_s,
            missing: -off_k / span_k,
            considered: doubt_k / span_k,
            noise: self.error_k.hypot(self.steps_k) / span_k,
        });
        match cause {
            Cause::Open => {
                self.suspect = Some(suspect);
                Some(Lonely::Suspected(which))
            }
            Cause::Spike | Cause::Passed | Cause::Unclear => None,
            Cause::Offset(by) => {
                self.usual = Usual::default();
                Some(Lonely::Shifted(which, by * span_k))
            }
            Cause::Flowing | Cause::Gas => Some(Lonely::Detached(which)),
        }
    }
}

/// What a difference of the first less the second is of one of them.
fn of_its_own(which: usize, difference: f64) -> f64 {
    if which == 0 { difference } else { -difference }
}

/// How restless both are: mean sizes of their second differences.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Restlessness {
    lately_k: [f64; 2],
    usually_k: [f64; 2],
    /// How long they have been seen, s.
    seen_s: f64,
}

impl Restlessness {
    /// Take in the second differences, K, of a sample so long after the last one, s: which one reads the air.
    fn push(
        &mut self,
        interval_s: f64,
        second_k: [f64; 2],
        (error_k, steps_k): (f64, f64),
    ) -> Option<Lonely> {
        if second_k.iter().any(|second| second.is_nan()) {
            return None;
        }
        self.seen_s += interval_s;
        let restless_k = RESTLESS * error_k;
        let size_k = second_k.map(|second| second.abs().min(10.0 * restless_k));
        for (means, memory_s) in [(&mut self.lately_k, LATELY_S), (&mut self.usually_k, USUALLY_S)] {
            let share = -(-interval_s / memory_s).exp_m1();
            for (mean, size) in means.iter_mut().zip(size_k) {
                *mean += share * (size - *mean);
            }
        }
        let which = usize::from(self.lately_k[1] > self.lately_k[0]);
        let part = |of: [f64; 2]| of[1 - which] / of[which];
        let usual = if self.seen_s < DAY_S { IN_GUSTS } else { part(self.usually_k) };
        let alone = part(self.lately_k) < UNUSUAL * usual.min(1.0);
        (self.lately_k[which] > restless_k + steps_k && alone).then_some(Lonely::Detached(which))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ERROR_K: f64 = 0.12;

    fn surroundings(part: f64, away_k: f64) -> Surroundings {
        Surroundings { part, away_k, memory_s: 1200.0 }
    }

    fn course(shoulder: impl Fn(f64) -> f64, valve: impl Fn(f64) -> f64) -> Vec<Lonely> {
        told(Pair::new(0.0, ERROR_K), shoulder, valve)
    }

    fn told(mut pair: Pair, shoulder: impl Fn(f64) -> f64, valve: impl Fn(f64) -> f64) -> Vec<Lonely> {
        (0..600)
            .filter_map(|minute| {
                let t = f64::from(minute);
                pair.update(60.0 * t, [shoulder(t), valve(t)], surroundings(0.44, 0.0), true)
            })
            .filter(|lonely| !matches!(lonely, Lonely::Suspected(_)))
            .collect()
    }

    /// That this is the one thing told; the size is an estimate.
    fn assert_shifted(told: &[Lonely], which: usize, by_k: f64) {
        let fits = matches!(told, [Lonely::Shifted(of, size_k)] if *of == which && (size_k / by_k - 1.0).abs() < 0.05);
        assert!(fits, "{told:?}");
    }

    #[test]
    fn a_lonely_step_that_stays_is_an_offset() {
        let step = |t: f64| if t >= 100.0 { 281.0 } else { 280.0 };
        assert_shifted(&course(step, |_| 280.5), 0, 1.0);
        assert_shifted(&course(|_| 280.5, step), 1, 1.0);
    }

    #[test]
    fn a_step_is_held_against_what_the_model_misses() {
        let step = |t: f64| if t >= 100.0 { 281.0 } else { 280.0 };
        assert_eq!(told(Pair::new(0.0, 2.0 * ERROR_K), step, |_| 280.5), []);
        let twice = |t: f64| 2.0 * step(t) - 280.0;
        assert_shifted(&told(Pair::new(0.0, 2.0 * ERROR_K), twice, |_| 280.5), 0, 2.0);
    }

    #[test]
    fn a_reading_in_steps_jumps_by_more_than_its_steps() {
        // It drifts, and changes by a whole step of 0.5 K at a time.
        let coarse = |t: f64| 0.5 * (560.0 + 0.02 * t).floor();
        assert_eq!(told(Pair::new(0.5, ERROR_K), coarse, |_| 280.0), []);
        let jumps = |t: f64| coarse(t) + if t >= 120.0 { 5.0 } else { 0.0 };
        assert_shifted(&told(Pair::new(0.5, ERROR_K), jumps, |_| 280.0), 0, 5.0);
        // The mouth of a tunnel, where one bends by 3.8 K and the other one by 1.9 K.
        let mouth = |t: f64, by: f64| 280.0 + if t >= 120.0 { by } else { 0.0 };
        assert_eq!(told(Pair::new(0.5, ERROR_K), |t| mouth(t, 4.0), |t| mouth(t, 1.5)), []);
    }

    #[test]
    fn what_the_surroundings_may_have_done_to_one_alone_is_no_jump() {
        let shifts = |doubt_k: f64| {
            let mut pair = Pair::new(0.0, ERROR_K);
            let step = |t: f64| if t >= 100.0 { 281.0 } else { 280.0 };
            let away_k = |t: f64| if t <= 100.0 { doubt_k } else { 0.0 };
            (0..200).map(f64::from).any(|t| {
                matches!(
                    pair.update(60.0 * t, [step(t), 280.5], surroundings(1.0, away_k(t)), true),
                    Some(Lonely::Shifted(0, _))
                )
            })
        };
        assert!(shifts(0.9) && !shifts(1.1));
    }

    #[test]
    fn a_spike_and_a_tunnel_are_none() {
        assert_eq!(course(|t| if t == 100.0 { 290.0 } else { 280.0 }, |_| 280.0), []);
        let tunnel = |t: f64, coupling: f64| {
            let inside = if (100.0..130.0).contains(&t) { coupling * 45.0 } else { 0.0 };
            280.0 + inside
        };
        assert_eq!(course(|t| tunnel(t, 0.15), |t| tunnel(t, 0.05)), []);
    }

    #[test]
    fn an_offset_in_a_tunnel_is_one_and_sun_on_both_is_none() {
        let warming = |t: f64| 280.0 + 0.5 * t.min(90.0);
        assert_shifted(&course(|t| warming(t) + if t >= 60.0 { -1.0 } else { 0.0 }, warming), 0, -1.0);
        assert_eq!(course(|t| 280.0 + (t - 100.0).max(0.0), |t| 280.0 + 0.3 * (t - 100.0).max(0.0)), []);
    }

    #[test]
    fn what_is_apart_in_a_tunnel_alone_is_no_offset() {
        // Both meet warm air at once and warm up; what the valve reads of the air passes, the shoulder of a composite cylinder stays 3 K warmer until it is outside.
        let inside = |t: f64| (100.0..130.0).contains(&t);
        let warmed = |t: f64| 262.0 + 0.5 * (t - 100.0).clamp(0.0, 30.0);
        let shoulder = |t: f64| warmed(t) + if inside(t) { 3.0 } else { 0.0 };
        let valve = |t: f64| warmed(t) + if inside(t) { 3.0 * ((100.0 - t) / 8.0).exp() } else { 0.0 };
        assert_eq!(course(shoulder, valve), []);
    }

    #[test]
    fn what_a_tunnel_hides_is_seen_after_it() {
        let tunnel = |t: f64, coupling: f64| {
            let warmed = 0.4 * (t - 100.0).clamp(0.0, 25.0);
            280.0 + warmed + if (100.0..125.0).contains(&t) { coupling * 45.0 } else { 0.0 }
        };
        let jumped = course(|t| tunnel(t, 0.15) + if t >= 98.0 { 5.0 } else { 0.0 }, |t| tunnel(t, 0.05));
        assert!(matches!(jumped[..], [Lonely::Shifted(0, by_k)] if (by_k - 5.0).abs() < 0.5), "{jumped:?}");
    }

    #[test]
    fn at_the_mouth_of_a_tunnel_each_bends_in_its_own_way() {
        // As simulated: the shoulder bends two minutes after the mouth while the valve goes on.
        let shoulder = [1.72, 4.99, 8.18, 9.72, 10.66, 11.61, 12.56, 13.34, 14.05];
        let valve = [1.53, 2.89, 4.68, 6.34, 7.74, 8.98, 10.23, 11.38, 12.40];
        let of = |course: [f64; 9], t: f64| {
            let at = (t - 100.0).max(0.0);
            let (n, last) = (at as usize, course.len() - 1);
            273.15 + if n < last { course[n] } else { course[last] + 0.8 * (at - last as f64) }
        };
        assert_eq!(course(|t| of(shoulder, t), |t| of(valve, t)), []);
    }

    #[test]
    fn what_bends_just_after_both_were_shaken_is_no_jump() {
        // As simulated: a train leaves a warm tunnel, and sun keeps the shoulder 0.9 K warmer than the valve from then on.
        let of = |mouth: [f64; 4], t: f64, after_k: f64| match t - 100.0 {
            at if at < 0.0 => 280.0,
            at if at < 4.0 => mouth[at as usize],
            _ => after_k,
        };
        let (shoulder, valve) = ([312.0, 312.82, 305.4, 303.58], [316.42, 316.95, 308.72, 305.06]);
        let courses = course(|t| of(shoulder, t, 300.9), |t| of(valve, t, 300.0));
        assert_eq!(courses, []);
    }

    #[test]
    fn noise_of_the_other_one_hides_no_jump() {
        let step = |t: f64| if t >= 100.0 { 279.0 } else { 280.0 };
        let noise = |t: f64| [0.08, -0.1, 0.07][t as usize % 3];
        let jumped = course(step, |t| 280.5 + if t > 97.0 && t < 103.0 { noise(t) } else { 0.0 });
        assert!(matches!(jumped[..], [Lonely::Shifted(0, by_k)] if (by_k + 1.0).abs() < 0.35), "{jumped:?}");
    }

    #[test]
    fn a_restless_one_beside_a_calm_one_is_detached() {
        let noise = |t: f64| 0.5 * if t as i64 % 3 == 0 { 1.0 } else { -0.5 };
        assert!(course(|_| 280.0, |t| 281.0 + noise(t)).contains(&Lonely::Detached(1)));
        assert_eq!(course(|t| 280.0 + noise(t), |t| 281.0 + 0.6 * noise(t)), []);
    }

    /// What a pair says first, with its minute, of readings that are so restless, K; five minutes apart for four days.
    fn restless(sizes_k: impl Fn(f64) -> [f64; 2]) -> Option<(f64, Lonely)> {
        let mut pair = Pair::new(0.0, ERROR_K);
        (0..1152).find_map(|row| {
            let minute = 5.0 * f64::from(row);
            let noise = if row % 3 == 0 { 1.0 } else { -0.5 };
            let readings = sizes_k(minute).map(|size_k| 290.0 + size_k * noise);
            pair.update(60.0 * minute, readings, surroundings(0.44, 0.0), true).map(|told| (minute, told))
        })
    }

    #[test]
    fn a_thin_valve_in_gusts_is_not_detached_and_one_that_comes_off_there_is() {
        assert_eq!(restless(|_| [0.1, 0.23]), None);
        let comes_off = |minute: f64| if minute < 2880.0 { [0.1, 0.23] } else { [0.1, 0.7] };
        let told = restless(comes_off);
        assert!(matches!(told, Some((2880.0..3120.0, Lonely::Detached(1)))), "{told:?}");
    }

    #[test]
    fn one_that_jumps_with_the_air_again_and_again_is_detached() {
        let air = |t: f64| if (t / 50.0) as i64 % 2 == 0 { 270.0 } else { 300.0 };
        assert!(course(air, |_| 280.0).contains(&Lonely::Detached(0)));
    }
}
