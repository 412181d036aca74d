//! Whether a pressure has jumped; the rule stands in [`super`].
use serde::{Deserialize, Serialize};

use crate::monitor::readings::thermometers::Moved;

/// Change of the innovation that is a jump, Pa, beside so many usual changes, and so many steps of the transmitter,
const JUMP_PA: f64 = 0.12e5;
const JUMP_PER_USUAL: f64 = 4.0;
const JUMP_PER_STEP: f64 = 1.2;
/// Samples over which the usual change is a mean, and the largest that counts, Pa.
const USUAL_SAMPLES: f64 = 300.0;
const MINUTE_S: f64 = 60.0;
const USUAL_LARGEST_PA: f64 = 1e5;
/// Part of it that the reading's second difference makes at least.
const BY_READING: f64 = 0.6;
/// Part of it that is left against the sample before the last, below which it only returns.
const RETURNED: f64 = 0.4;
/// It is farther by the change of the expectation,
const JUMP_PER_CHANGE: f64 = 0.4;
/// and by the surprise of the thermometers, Pa/K, of which their change counts a part.
const JUMP_PER_K: f64 = 0.4e5;
const PER_CHANGE: f64 = 0.5;
/// The mouth of a tunnel moves it by no more, Pa; two and three samples later by less, Pa/K and Pa.
const MOUTH_PA: f64 = 0.9e5;
const MOUTH_BEFORE_PER_K: f64 = 0.3e5;
const MOUTH_BEFORE_PA: f64 = 0.5e5;
/// What goes on moves it by no more, Pa, unless the gas is warmed by so much in a minute, Pa.
const COOLING_PA: f64 = 0.45e5;
const WARMING_PA: f64 = 0.1e5;
/// The same per kelvin where the reading goes the other way, since the gas has not answered yet what the wall did.
const JUMP_PER_K_AGAINST: f64 = 0.1e5;
/// Interval in which the gas has answered, s.
const MINUTES_S: f64 = 90.0;
/// Interval beyond which two innovations are not compared, s.
const LONGEST_INTERVAL_S: f64 = 900.0;

/// Watches the innovations of the pressure for a jump.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct JumpWatch {
    last: Option<Innovated>,
    /// Slope of the reading to it, Pa/s, and the interval, s; the innovation before it, Pa.
    slope_pa_s: f64,
    interval_s: f64,
    before_pa: f64,
    /// Usual change of the innovation in a minute, Pa.
    usual_pa: f64,
}

/// A reading and what was expected.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Innovated {
    /// Time, s.
    pub time_s: f64,
    /// Reading, Pa.
    pub reading_pa: f64,
    /// Reading less what was expected, Pa.
    pub innovation_pa: f64,
}

impl Default for JumpWatch {
    /// Of a transmitter and a thermometer of which nothing is known.
    fn default() -> Self {
        Self { last: None, slope_pa_s: 0.0, interval_s: 0.0, before_pa: f64::NAN, usual_pa: JUMP_PA }
    }
}

impl JumpWatch {
    /// Take in a reading of a transmitter that reads in steps, Pa, with what two thermometers did; the innovation before it if this one is
    /// a jump.
    pub fn notice(&mut self, now: Innovated, step_pa: f64, moved: Moved) -> Option<f64> {
        if !(now.reading_pa.is_finite() && now.innovation_pa.is_finite()) {
            return None;
        }
        let last = self.last.replace(now)?;
        let interval_s = now.time_s - last.time_s;
        if interval_s > LONGEST_INTERVAL_S {
            return None;
        }
        let change_pa = now.innovation_pa - last.innovation_pa;
        let by_reading_pa = now.reading_pa - last.reading_pa;
        // A slope leads no farther than the interval that it was taken over.
        let second_pa = by_reading_pa - self.slope_pa_s * interval_s.min(self.interval_s);
        self.slope_pa_s = if interval_s > 0.0 { by_reading_pa / interval_s } else { 0.0 };
        self.interval_s = interval_s;
        // The errors walk: they change by more in a longer interval.
        let grown = (interval_s / MINUTE_S).max(1.0).sqrt();
        // What goes back to where it was has taken in a jump that was not noticed: the other way it would be believed.
        let before_pa = std::mem::replace(&mut self.before_pa, last.innovation_pa);
        let returns = (now.innovation_pa - before_pa).abs() < RETURNED * change_pa.abs();
        let limit_pa = JUMP_PA
            + JUMP_PER_USUAL * self.usual_pa * grown
            + JUMP_PER_STEP * step_pa
            + by_tunnel_pa(interval_s, by_reading_pa - change_pa, second_pa, moved);
        self.usual_pa += ((change_pa.abs() / grown).min(USUAL_LARGEST_PA) - self.usual_pa) / USUAL_SAMPLES;
        let read = second_pa * change_pa.signum() > BY_READING * change_pa.abs();
        (read && !returns && change_pa.abs() > limit_pa).then_some(last.innovation_pa)
    }

    /// Forget the last reading.
    pub fn forget(&mut self) {
        *self = Self { usual_pa: self.usual_pa, ..Self::default() };
    }
}

/// How far a tunnel can move it within an interval, s, in which the expectation changed by so much and the reading's second difference
/// was so much, Pa.
fn by_tunnel_pa(interval_s: f64, expected_pa: f64, second_pa: f64, moved: Moved) -> f64 {
    let by_change_pa = JUMP_PER_CHANGE * expected_pa.abs();
    if interval_s > MINUTES_S {
        return by_change_pa + JUMP_PER_K * (PER_CHANGE * moved.by_k + moved.surprise_k);
    }
    if second_pa * moved.together_k < 0.0 {
        let quickened_k = moved.quickened_k.max(moved.quickened_before_k);
        return by_change_pa + JUMP_PER_K_AGAINST * (PER_CHANGE * moved.by_k + quickened_k);
    }
    let now_pa = (JUMP_PER_K * moved.quickened_k).min(MOUTH_PA);
    let before_pa = (MOUTH_BEFORE_PER_K * moved.quickened_before_k).min(MOUTH_BEFORE_PA);
    let going_on_pa = by_change_pa + before_pa.max(JUMP_PER_K * PER_CHANGE * moved.by_k);
    if expected_pa > WARMING_PA { going_on_pa + now_pa } else { now_pa.max(going_on_pa.min(COOLING_PA)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a watch says of a row: minute, reading and innovation, Pa, and what the thermometers did.
    fn noticed(
        watch: &mut JumpWatch,
        minute: f64,
        reading_pa: f64,
        innovation_pa: f64,
        moved: Moved,
    ) -> Option<f64> {
        watch.notice(Innovated { time_s: MINUTE_S * minute, reading_pa, innovation_pa }, 0.0, moved)
    }

    /// A watch that has seen a thousand quiet rows, so many minutes apart.
    fn accustomed(reading_pa: f64, every: f64) -> JumpWatch {
        let mut watch = JumpWatch::default();
        for row in 0..1000 {
            let n = f64::from(row);
            noticed(&mut watch, every * (n - 1000.0), reading_pa, 2e3 * (n % 2.0), Moved::default());
        }
        watch
    }

    #[test]
    fn slow_changes_and_expected_ones_are_no_jumps() {
        let mut watch = JumpWatch::default();
        let still = Moved::default();
        for row in 0..1000 {
            let n = f64::from(row);
            assert_eq!(noticed(&mut watch, n, 180e5 + 3e4 * n, 2e4 + 1e3 * (n % 2.0), still), None);
        }
        let reading_pa = 180e5 + 3e4 * 999.0;
        assert_eq!(noticed(&mut watch, 1000.0, reading_pa - 0.5e5, -0.48e5, still), Some(2.1e4));
        // What the expectation did alone; what a tunnel does.
        assert_eq!(noticed(&mut watch, 1001.0, reading_pa - 0.5e5, 0.5e5, still), None);
        let mouth = Moved { by_k: 1.0, together_k: -1.0, quickened_k: 2.0, ..still };
        assert_eq!(noticed(&mut watch, 1002.0, reading_pa - 1.4e5, -0.4e5, mouth), None);
        assert_eq!(noticed(&mut watch, 1200.0, 100e5, -80e5, still), None, "too long ago");
    }

    #[test]
    fn the_mouth_of_a_tunnel_hides_less_than_a_bar_and_less_the_longer_ago_it_was() {
        let jumps = |by_pa: f64, moved: Moved| {
            noticed(&mut accustomed(184e5, 1.0), 0.0, 184e5 - by_pa, -by_pa, moved).is_some()
        };
        let now = Moved { together_k: -6.0, quickened_k: 6.0, ..Moved::default() };
        let before = Moved { together_k: -1.0, quickened_before_k: 6.0, ..Moved::default() };
        assert!(!jumps(0.9e5, now) && jumps(1.3e5, now));
        assert!(!jumps(0.5e5, before) && jumps(0.8e5, before));
    }

    #[test]
    fn a_pressure_that_falls_while_both_thermometers_rise_has_jumped() {
        let falls = |together_k: f64, minutes: f64| {
            let mouth =
                Moved { by_k: 2.2, together_k, surprise_k: 2.2, quickened_k: 2.2, quickened_before_k: 0.0 };
            noticed(&mut accustomed(184e5, minutes), 0.0, 183.2e5, -0.8e5, mouth).is_some()
        };
        assert!(falls(2.2, 1.0));
        assert!(!falls(-2.2, 1.0), "so a train that leaves the tunnel");
        assert!(!falls(2.2, 2.0), "within two minutes the gas has answered");
    }

    #[test]
    fn the_return_after_a_jump_that_was_not_noticed_is_none() {
        let mut watch = accustomed(200e5, 1.0);
        let mouth = Moved { by_k: 1.2, together_k: -1.2, quickened_k: 2.0, ..Moved::default() };
        assert_eq!(noticed(&mut watch, 0.0, 199.2e5, -0.8e5, mouth), None, "hidden by a tunnel");
        assert_eq!(noticed(&mut watch, 1.0, 199.2e5, 0.02e5, Moved::default()), None);
        noticed(&mut watch, 2.0, 199.2e5, 0.0, Moved::default());
        assert!(noticed(&mut watch, 3.0, 198.4e5, -0.8e5, Moved::default()).is_some());
    }
}
