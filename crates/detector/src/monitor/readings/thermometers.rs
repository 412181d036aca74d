//! Thermometers that jump alone.
//!
//! Air, sun and rain reach shoulder and valve alike, if not as much; a thermometer that jumps while the other one does not, and stays
//! there, has changed its offset. A jump is what a reading adds to where the readings before lead, so that a tunnel in which both move
//! steadily hides none:
//!
//! `s_k = T_n - T_{n-1} - (T_{n-1} - T_{n-1-k}) / k`, in samples that are evenly apart.
//!
//! It is lonely where `|s_2| > 0.7 K` and `|s_1| > 0.5 K` in a minute, those of the other one are below `0.05 |s| + 0.25 K` and
//! `0.05 |s| + 0.35 K`, and not both were surprised by more than `0.1 |s| + 0.4 K` within the three samples before: at the mouth of a
//! tunnel each bends in its own way. It is then not used until both have been calm for five samples, and is believed if their difference is by `(1 -+ 0.4) |s|` another one
//! than it was when both were calm last: at the mouth of a tunnel it is what it was. After two hours without calm it is used again.
//! One that jumps alone by 8 K again and again, or once by more than an offset can be, reads the air; so does one
//! that is restless while the other one is not. For an hour after its jump a thermometer is not used: if it reads the air, it shows by then.
//!
//! Readings in steps of `q` make up to `3 q` of the difference of two `s_2`: so much is added to what a jump is, and to what the other one may do; and a jump
//! is at least 2.5 times what the other one may do, as at the mouth of a tunnel one bends twice as far as the other.
//!
//! While the surroundings warm or cool the cylinder, what they do to one thermometer alone is in doubt (see the observer's flowing member): a jump is more than that.
//!
//! Noise of 0.05 K makes 0.09 K of `s_2` and 0.12 K of `s_1`; what is beside the parts is some three times that. How often a jump is believed that is none, and one missed, is measured by the examples `quiet_monitor`
//! and `fault_campaign` (row T2); see `book/src/measured.md`.
use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

/// Jump against the slope over two samples, and at least against that over one, K, in a minute: what a tunnel does grows with the interval.
const JUMP_K: f64 = 0.7;
const JUMP_AT_LEAST_K: f64 = 0.5;
const MINUTE_S: f64 = 60.0;
/// Part of it by which the other thermometer may jump too, beside the noise of both differences, K.
const ALONE: f64 = 0.05;
const STILL_K: f64 = 0.25;
const STILL_ONE_K: f64 = 0.35;
/// Part of it by which both may have been surprised shortly before, and beside it, K.
const SURPRISED: f64 = 0.1;
const SURPRISED_K: f64 = 0.4;
/// Least jump in parts of what the other one may do beside it.
const APART: f64 = 2.5;
/// Samples in which neither moves by more than this, K in a minute, that say how far they are apart, and time within which they must come after a jump, s.
const CALM_SAMPLES: u32 = 5;
const CALM_K: f64 = 0.15;
const DECIDED_S: f64 = 7200.0;
/// How far the change of the difference may be from the jump, as a part of it.
const STEADY: f64 = 0.4;
/// Part of it that is left when it has gone, beside the noise, K.
const BACK: f64 = 0.2;
const BACK_K: f64 = 0.15;
/// Jump that no offset makes, K.
const NO_OFFSET_K: f64 = 10.0;
/// Lonely jumps of this size, K, within this time, s, that tell a thermometer which reads the air.
const AIR_JUMP_K: f64 = 8.0;
const DETACHED_JUMPS: usize = 4;
const DETACHED_S: f64 = 86_400.0;
/// Samples after a jump in which it is not used.
const PROBATION: u32 = 60;
/// Mean size of the second differences over so many samples, K, that is restless, where that of the other one is below a part of it; one
/// counts no more than this, K.
const RESTLESS_K: f64 = 0.2;
const RESTLESS_SAMPLES: f64 = 60.0;
const RESTLESS_PART: f64 = 0.4;
const RESTLESS_LARGEST_K: f64 = 1.0;
/// Steps of a reading in the difference of two second differences at most.
const STEPS: f64 = 3.0;
/// Interval beyond which two samples are not compared, s.
const LONGEST_INTERVAL_S: f64 = 900.0;
/// Samples that slopes are taken from.
const SAMPLES: usize = 3;
/// Samples before a jump over which a surprise of both is remembered.
const SURPRISE_SAMPLES: usize = 3;
/// What both may have done while neither can be read, K.
const UNSEEN_K: f64 = 5.0;

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
    /// What their steps may make of a second difference, K.
    steps_k: f64,
    moved_k: f64,
    surprises_k: VecDeque<f64>,
    /// The last samples: time, s, and readings, K.
    recent: VecDeque<(f64, [f64; 2])>,
    calm: Calm,
    suspect: Option<Suspect>,
    /// Which one jumped last, and for how many samples it is not used yet.
    probation: Option<(usize, u32)>,
    restless_k: [f64; 2],
    /// Times of the last lonely jumps of each, s.
    jumps_s: [Vec<f64>; 2],
}

/// A thermometer under suspicion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Suspect {
    which: usize,
    jump_k: f64,
    since_s: f64,
    /// First less second thermometer when both were calm last; without that, before the jump, K.
    apart_k: f64,
}

/// How far both are apart while neither moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Calm {
    samples: u32,
    sum_k: f64,
    /// Mean of the last calm time, K, and its end, s.
    level: Option<(f64, f64)>,
}

impl Calm {
    /// A sample with this difference, K, which both have come to without moving or not.
    fn push(&mut self, time_s: f64, apart_k: f64, is_calm: bool) {
        (self.samples, self.sum_k) =
            if is_calm { (self.samples + 1, self.sum_k + apart_k) } else { (0, 0.0) };
        if self.samples == CALM_SAMPLES {
            self.level = Some((self.sum_k / f64::from(CALM_SAMPLES), time_s));
            (self.samples, self.sum_k) = (0, 0.0);
        }
    }

    /// The level, K, if it was found after that time, s.
    fn since(&self, time_s: f64) -> Option<f64> {
        self.level.filter(|(_, at_s)| *at_s > time_s).map(|(apart_k, _)| apart_k)
    }
}

impl Pair {
    /// Of thermometers that read in steps of so much at most, K.
    pub fn new(resolution_k: f64) -> Self {
        Self { steps_k: STEPS * resolution_k, ..Self::default() }
    }

    /// Compare nothing with the last readings.
    fn forget(&mut self) {
        self.recent.clear();
        self.surprises_k.clear();
        (self.suspect, self.moved_k, self.calm) = (None, 0.0, Calm::default());
    }

    /// How far both went from the last sample to this one, K: the less far of them, as air, sun and rain reach both.
    pub fn moved_k(&self) -> f64 {
        self.moved_k
    }

    /// Take in both readings, K, NaN where there is none, and what the surroundings may have done to one of them alone, K; not judged while other gas warms or cools
    /// the one before the other.
    pub fn update(&mut self, time_s: f64, readings: [f64; 2], doubt_k: f64, judged: bool) -> Option<Lonely> {
        if self.recent.back().is_some_and(|(last_s, _)| time_s - last_s > LONGEST_INTERVAL_S) {
            self.forget();
        }
        let second_k = self.second_differences(time_s, readings);
        if !judged {
            self.suspect = None;
        }
        self.be_calm(time_s, readings);
        let shown = match (self.suspect, second_k) {
            (Some(suspect), _) => self.follow(suspect, time_s, readings),
            (None, Some(second_k)) if judged => self.look_for_a_jump(time_s, second_k, doubt_k),
            (None, _) => None,
        };
        self.recent.push_back((time_s, readings));
        if self.recent.len() > SAMPLES {
            self.recent.pop_front();
        }
        if let Some(Lonely::Shifted(which, _)) = shown {
            self.probation = Some((which, PROBATION));
        }
        shown.or_else(|| self.restless(second_k?[0])).or_else(|| self.on_probation())
    }

    /// Whether one of them has jumped, and is not used yet.
    pub fn is_on_probation(&self) -> bool {
        self.probation.is_some()
    }

    fn on_probation(&mut self) -> Option<Lonely> {
        let (which, left) = self.probation?;
        self.probation = (left > 1).then_some((which, left - 1));
        Some(Lonely::Suspected(which))
    }

    /// What this sample adds to the slopes over one sample and over two, K, NaN where there is none; also notes what both did.
    fn second_differences(&mut self, time_s: f64, readings: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let mut latest = self.recent.iter().rev();
        let &(last_s, last) = latest.next()?;
        let first = [0, 1].map(|i| readings[i] - last[i]);
        self.moved_k = smaller(first);
        let against = |before: &(f64, [f64; 2]), samples: f64| {
            // After a short interval a slope is mostly noise.
            let along = ((time_s - last_s) / (last_s - before.0).max(f64::MIN_POSITIVE)).min(samples.recip());
            [0, 1].map(|i| first[i] - along * (last[i] - before.1[i]))
        };
        let one = against(latest.next()?, 1.0);
        let two = latest.next().map_or([f64::NAN; 2], |before| against(before, 2.0));
        self.surprises_k.push_back(smaller(one));
        if self.surprises_k.len() > SURPRISE_SAMPLES + 1 {
            self.surprises_k.pop_front();
        }
        Some([one, two])
    }

    fn look_for_a_jump(
        &mut self,
        time_s: f64,
        [one_k, two_k]: [[f64; 2]; 2],
        doubt_k: f64,
    ) -> Option<Lonely> {
        let (last_s, last) = *self.recent.back()?;
        let which = usize::from(two_k[1].abs() > two_k[0].abs());
        let (own_k, other_k) = (two_k[which], two_k[1 - which]);
        let minutes = ((time_s - last_s) / MINUTE_S).max(1.0);
        let beside_k = |part: f64, noise_k: f64| part * own_k.abs() + noise_k;
        let steps_k = self.steps_k;
        let least_k = (JUMP_K * minutes + steps_k).max(APART * (STILL_K + steps_k)).max(doubt_k);
        let jumps = own_k.abs().min((own_k - other_k).abs()) > least_k
            && one_k[which].abs() > JUMP_AT_LEAST_K * minutes + steps_k;
        // Not so where one of them is no number.
        let still = other_k.abs() < beside_k(ALONE, STILL_K + steps_k)
            && one_k[1 - which].abs() < beside_k(ALONE, STILL_ONE_K + steps_k);
        let surprised =
            largest(&self.surprises_k, 1..SURPRISE_SAMPLES + 1) > beside_k(SURPRISED, SURPRISED_K) * minutes;
        if !jumps || !still || surprised {
            return None;
        }
        self.suspect = Some(Suspect {
            which,
            jump_k: own_k - other_k,
            since_s: time_s,
            apart_k: self.calm.since(f64::NEG_INFINITY).unwrap_or(last[0] - last[1]),
        });
        if own_k.abs() < AIR_JUMP_K {
            return Some(Lonely::Suspected(which));
        }
        let jumps = &mut self.jumps_s[which];
        jumps.retain(|at_s| time_s - at_s < DETACHED_S && *at_s <= last_s);
        jumps.push(time_s);
        if jumps.len() < DETACHED_JUMPS {
            return Some(Lonely::Suspected(which));
        }
        jumps.clear();
        self.suspect = None;
        Some(Lonely::Detached(which))
    }

    /// Note how far both are apart while neither moves.
    fn be_calm(&mut self, time_s: f64, readings: [f64; 2]) {
        let Some(&(last_s, last)) = self.recent.back() else { return };
        let most_k = CALM_K * ((time_s - last_s) / MINUTE_S).max(1.0);
        let is_calm = [0, 1].iter().all(|&i| (readings[i] - last[i]).abs() < most_k);
        self.calm.push(time_s, readings[0] - readings[1], is_calm);
    }

    fn follow(&mut self, suspect: Suspect, time_s: f64, readings: [f64; 2]) -> Option<Lonely> {
        let Suspect { which, jump_k, since_s, apart_k } = suspect;
        let changed_k = |now_k: f64| if which == 0 { now_k - apart_k } else { apart_k - now_k };
        let is_back = changed_k(readings[0] - readings[1]).abs() < BACK * jump_k.abs() + BACK_K;
        let by_k = self.calm.since(since_s).map(changed_k);
        let decided = is_back || by_k.is_some() || time_s - since_s > DECIDED_S;
        if !decided {
            return Some(Lonely::Suspected(which));
        }
        self.suspect = None;
        let by_k = by_k.filter(|by_k| !is_back && (by_k - jump_k).abs() < STEADY * jump_k.abs())?;
        Some(if by_k.abs() < NO_OFFSET_K { Lonely::Shifted(which, by_k) } else { Lonely::Detached(which) })
    }

    fn restless(&mut self, second_k: [f64; 2]) -> Option<Lonely> {
        if second_k.iter().any(|second| second.is_nan()) {
            return None;
        }
        for (mean, second) in self.restless_k.iter_mut().zip(second_k) {
            *mean += (second.abs().min(RESTLESS_LARGEST_K) - *mean) / RESTLESS_SAMPLES;
        }
        let which = usize::from(self.restless_k[1] > self.restless_k[0]);
        let (own_k, other_k) = (self.restless_k[which], self.restless_k[1 - which]);
        (own_k > RESTLESS_K + self.steps_k && other_k < RESTLESS_PART * own_k)
            .then_some(Lonely::Detached(which))
    }
}

/// Largest within samples, counted back from the last one.
fn largest(of: &VecDeque<f64>, samples: std::ops::Range<usize>) -> f64 {
    of.iter().rev().skip(samples.start).take(samples.len()).copied().fold(0.0, f64::max)
}

/// Smaller size of two changes, of which one may be none.
fn smaller(changes: [f64; 2]) -> f64 {
    let size = changes[0].abs().min(changes[1].abs());
    if size.is_nan() { UNSEEN_K } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn course(shoulder: impl Fn(f64) -> f64, valve: impl Fn(f64) -> f64) -> Vec<Lonely> {
        told(Pair::default(), shoulder, valve)
    }

    fn told(mut pair: Pair, shoulder: impl Fn(f64) -> f64, valve: impl Fn(f64) -> f64) -> Vec<Lonely> {
        (0..600)
            .filter_map(|minute| {
                let t = f64::from(minute);
                pair.update(60.0 * t, [shoulder(t), valve(t)], 0.0, true)
            })
            .filter(|lonely| !matches!(lonely, Lonely::Suspected(_)))
            .collect()
    }

    #[test]
    fn a_lonely_step_that_stays_is_an_offset() {
        let step = |t: f64| if t >= 100.0 { 281.0 } else { 280.0 };
        assert_eq!(course(step, |_| 280.5), [Lonely::Shifted(0, 1.0)]);
        assert_eq!(course(|_| 280.5, step), [Lonely::Shifted(1, 1.0)]);
    }

    #[test]
    fn a_reading_in_steps_jumps_by_more_than_its_steps() {
        // It drifts, and changes by a whole step of 0.5 K at a time.
        let coarse = |t: f64| 0.5 * (560.0 + 0.02 * t).floor();
        assert_eq!(told(Pair::new(0.5), coarse, |_| 280.0), []);
        let jumps = |t: f64| coarse(t) + if t >= 120.0 { 5.0 } else { 0.0 };
        assert_eq!(told(Pair::new(0.5), jumps, |_| 280.0), [Lonely::Shifted(0, 5.0)]);
        // The mouth of a tunnel, where one bends by 3.8 K and the other one by 1.9 K.
        let mouth = |t: f64, by: f64| 280.0 + if t >= 120.0 { by } else { 0.0 };
        assert_eq!(told(Pair::new(0.5), |t| mouth(t, 4.0), |t| mouth(t, 1.5)), []);
    }

    #[test]
    fn what_the_surroundings_may_have_done_to_one_alone_is_no_jump() {
        let shifts = |doubt_k: f64| {
            let mut pair = Pair::default();
            let step = |t: f64| if t >= 100.0 { 281.0 } else { 280.0 };
            (0..200).map(f64::from).any(|t| {
                matches!(pair.update(60.0 * t, [step(t), 280.5], doubt_k, true), Some(Lonely::Shifted(0, _)))
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
        assert_eq!(
            course(|t| warming(t) + if t >= 60.0 { -1.0 } else { 0.0 }, warming),
            [Lonely::Shifted(0, -1.0)]
        );
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

    #[test]
    fn one_that_jumps_with_the_air_again_and_again_is_detached() {
        let air = |t: f64| if (t / 50.0) as i64 % 2 == 0 { 270.0 } else { 300.0 };
        assert!(course(air, |_| 280.0).contains(&Lonely::Detached(0)));
    }
}
