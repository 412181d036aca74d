//! Thermometers that jump alone.
//!
//! Air, sun and rain reach shoulder and valve alike, if not as much; a thermometer whose reading jumps against its
//! expectation while the other one's does not, and stays there, has changed its offset. For eight samples more
//! neither the step nor the other one may move before it is believed. One that jumps alone again and again, or
//! by more than an offset can be, reads the air.
use serde::{Deserialize, Serialize};

/// Jump of an innovation, K.
const JUMP_K: f64 = 0.7;
/// Part of it by which the other thermometer may have moved.
const ALONE: f64 = 0.15;
/// Samples that a jump must last, and how far their difference and the other one may move meanwhile, as parts of it.
const LASTING: u32 = 8;
const STEADY: f64 = 0.25;
/// Jump that no offset makes, K.
const NO_OFFSET_K: f64 = 10.0;
/// Lonely jumps within this time, s, that tell a thermometer which reads the air.
const DETACHED_JUMPS: usize = 4;
const DETACHED_S: f64 = 86_400.0;
/// Interval beyond which two samples are not compared, s.
const LONGEST_INTERVAL_S: f64 = 900.0;

/// What a pair of thermometers showed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lonely {
    /// The one of this index changed its offset by so much, K.
    Shifted(usize, f64),
    /// The one of this index reads the air.
    Detached(usize),
}

/// Two thermometers on one cylinder.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// Smaller change of the two at the last sample, K.
    moved_k: f64,
    last: Option<(f64, [f64; 2])>,
    suspect: Option<Suspect>,
    /// Times of the last lonely jumps of each, s.
    jumps_s: [Vec<f64>; 2],
}

/// A thermometer under suspicion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Suspect {
    which: usize,
    /// Difference of the two before the jump, K, and the jump, K.
    before_k: f64,
    jump_k: f64,
    /// The other one before the jump, K.
    other_k: f64,
    samples: u32,
    sum_k: f64,
}

impl Pair {
    /// Compare nothing with the last readings.
    pub fn forget(&mut self) {
        (self.last, self.suspect) = (None, None);
    }

    /// Smaller change of the two at the last sample, K.
    pub fn moved_k(&self) -> f64 {
        self.moved_k
    }

    /// Take in both readings, K.
    pub fn update(&mut self, time_s: f64, readings: [f64; 2]) -> Option<Lonely> {
        if readings.iter().any(|reading| !reading.is_finite()) {
            (self.last, self.suspect, self.moved_k) = (None, None, 0.0);
            return None;
        }
        let last = self.last.replace((time_s, readings));
        self.moved_k = last
            .map_or(0.0, |(_, before)| (readings[0] - before[0]).abs().min((readings[1] - before[1]).abs()));
        if let Some(suspect) = &mut self.suspect {
            let apart = readings[suspect.which] - readings[1 - suspect.which] - suspect.before_k;
            suspect.samples += 1;
            suspect.sum_k += apart;
            let other_k = readings[1 - suspect.which] - suspect.other_k;
            if (apart - suspect.jump_k).abs().max(other_k.abs()) > STEADY * suspect.jump_k.abs() {
                self.suspect = None;
                return None;
            }
            if suspect.samples < LASTING {
                return None;
            }
            let (which, by_k) = (suspect.which, suspect.sum_k / f64::from(suspect.samples));
            self.suspect = None;
            let offset = by_k.abs() < NO_OFFSET_K;
            return Some(if offset { Lonely::Shifted(which, by_k) } else { Lonely::Detached(which) });
        }
        let (last_s, before) = last.filter(|(last_s, _)| time_s - last_s <= LONGEST_INTERVAL_S)?;
        let moved = [readings[0] - before[0], readings[1] - before[1]];
        let which = usize::from(moved[1].abs() > moved[0].abs());
        let (jump_k, other_k) = (moved[which], moved[1 - which]);
        if jump_k.abs() < JUMP_K || other_k.abs() > ALONE * jump_k.abs() {
            return None;
        }
        let before_k = before[which] - before[1 - which];
        let other_k = before[1 - which];
        self.suspect = Some(Suspect { which, before_k, jump_k, other_k, samples: 0, sum_k: 0.0 });
        let jumps = &mut self.jumps_s[which];
        jumps.retain(|at_s| time_s - at_s < DETACHED_S && *at_s <= last_s);
        jumps.push(time_s);
        if jumps.len() < DETACHED_JUMPS {
            return None;
        }
        jumps.clear();
        self.suspect = None;
        Some(Lonely::Detached(which))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn course(shoulder: impl Fn(f64) -> f64, valve: impl Fn(f64) -> f64) -> Vec<Lonely> {
        let mut pair = Pair::default();
        (0..600)
            .filter_map(|minute| {
                let t = f64::from(minute);
                pair.update(60.0 * t, [shoulder(t), valve(t)])
            })
            .collect()
    }

    #[test]
    fn a_lonely_step_that_stays_is_an_offset() {
        let step = |t: f64| if t >= 100.0 { 281.0 } else { 280.0 };
        assert_eq!(course(step, |_| 280.5), [Lonely::Shifted(0, 1.0)]);
        assert_eq!(course(|_| 280.5, step), [Lonely::Shifted(1, 1.0)]);
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
    fn one_that_jumps_with_the_air_again_and_again_is_detached() {
        let air = |t: f64| if (t / 50.0) as i64 % 2 == 0 { 270.0 } else { 300.0 };
        assert!(course(air, |_| 280.0).contains(&Lonely::Detached(0)));
    }
}
