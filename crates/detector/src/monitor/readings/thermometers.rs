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

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::of_its_own;
use crate::DetectorError;
use crate::monitor::examination::{Before, Cause, Compared, Examination, FarOff, SPAN, Subject};
use crate::monitor::extremes::Extremes;
use crate::monitor::gas::jump::LONGEST_INTERVAL_S;
use crate::monitor::restored;
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
    /// Of the readings lately, K.
    extremes_k: [Extremes; 2],
    /// The last samples: time, s, and readings, K.
    recent: SmallVec<[(f64, [f64; 2]); SAMPLES]>,
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
    /// Checks one that was saved.
    pub(crate) fn validate(&self) -> Result<(), DetectorError> {
        restored::at_most(SAMPLES, "pair.recent", self.recent.len())?;
        if let Some((which, _)) = self.probation {
            restored::one_of_two("pair.probation", which)?;
        }
        let Some(Suspect { which, examination }) = &self.suspect else { return Ok(()) };
        restored::one_of_two("pair.suspect", *which)?;
        examination.validate()
    }

    /// Of thermometers that read in steps of so much at most, K, where the model misses so much of a temperature on the surface, K.
    pub fn new(resolution_k: f64, error_k: f64) -> Self {
        Self { error_k, steps_k: STEPS * resolution_k, ..Self::default() }
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
        let interval_s = self.recent.last().map_or(0.0, |(last_s, _)| time_s - last_s);
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
            self.look_for_a_jump(time_s, second_k, at_once_k, surroundings.memory_s);
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
        if self.recent.len() == SAMPLES {
            self.recent.remove(0);
        }
        self.recent.push((time_s, readings));
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
        let &(last_s, last) = self.recent.last()?;
        let first = [0, 1].map(|i| readings[i] - last[i]);
        self.moved_k = self.smaller_k(first);
        let &(before_s, before) = self.recent.first().filter(|_| self.recent.len() == SAMPLES)?;
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
        let kept = libm::exp(-interval_s / memory_s);
        for (extremes_k, reading_k) in self.extremes_k.iter_mut().zip(readings) {
            if reading_k.is_finite() {
                extremes_k.follow((reading_k, reading_k), kept);
            }
        }
        // Not a number counts for nothing.
        self.extremes_k.iter().map(Extremes::spread).fold(0.0, f64::max)
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

    fn look_for_a_jump(&mut self, time_s: f64, second_k: [f64; 2], doubt_k: f64, memory_s: f64) {
        let Some(&(last_s, last)) = self.recent.last() else { return };
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
            self.extremes_k[which] = Extremes::default();
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
            noise: libm::hypot(self.error_k, self.steps_k) / span_k,
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
            let share = -libm::expm1(-interval_s / memory_s);
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
mod tests;
