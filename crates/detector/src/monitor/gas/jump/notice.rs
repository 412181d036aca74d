//! Whether a pressure has jumped; the rule stands in [`super`].
use serde::{Deserialize, Serialize};

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
    /// Largest change of the innovation by the surroundings since the reading before, Pa.
    pub doubt_pa: f64,
}

impl Default for JumpWatch {
    /// Of a transmitter and a thermometer of which nothing is known.
    fn default() -> Self {
        Self { last: None, slope_pa_s: 0.0, interval_s: 0.0, before_pa: f64::NAN, usual_pa: JUMP_PA }
    }
}

impl JumpWatch {
    /// Take in a reading. `step_pa` is the resolution of the transmitter, Pa; `part` the relative uncertainty of a change of the expected
    /// pressure. Returns the innovation before the reading if the reading is a jump.
    pub fn notice(&mut self, now: Innovated, step_pa: f64, part: f64) -> Option<f64> {
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
            + now.doubt_pa
            + part * (by_reading_pa - change_pa).abs();
        self.usual_pa += ((change_pa.abs() / grown).min(USUAL_LARGEST_PA) - self.usual_pa) / USUAL_SAMPLES;
        let read = second_pa * change_pa.signum() > BY_READING * change_pa.abs();
        (read && !returns && change_pa.abs() > limit_pa).then_some(last.innovation_pa)
    }

    /// Forget the last reading.
    pub fn forget(&mut self) {
        *self = Self { usual_pa: self.usual_pa, ..Self::default() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a watch says of a row: minute, reading and innovation, Pa, and what the surroundings may have done, Pa.
    fn noticed(
        watch: &mut JumpWatch,
        minute: f64,
        reading_pa: f64,
        innovation_pa: f64,
        doubt_pa: f64,
    ) -> Option<f64> {
        watch.notice(Innovated { time_s: MINUTE_S * minute, reading_pa, innovation_pa, doubt_pa }, 0.0, 0.4)
    }

    /// A watch that has seen a thousand quiet rows, so many minutes apart.
    fn accustomed(reading_pa: f64, every: f64) -> JumpWatch {
        let mut watch = JumpWatch::default();
        for row in 0..1000 {
            let n = f64::from(row);
            noticed(&mut watch, every * (n - 1000.0), reading_pa, 2e3 * (n % 2.0), 0.0);
        }
        watch
    }

    #[test]
    fn slow_changes_and_expected_ones_are_no_jumps() {
        let mut watch = JumpWatch::default();
        let still = 0.0;
        for row in 0..1000 {
            let n = f64::from(row);
            assert_eq!(noticed(&mut watch, n, 180e5 + 3e4 * n, 2e4 + 1e3 * (n % 2.0), still), None);
        }
        let reading_pa = 180e5 + 3e4 * 999.0;
        assert_eq!(noticed(&mut watch, 1000.0, reading_pa - 0.5e5, -0.48e5, still), Some(2.1e4));
        // What the expectation did alone; what a tunnel may do.
        assert_eq!(noticed(&mut watch, 1001.0, reading_pa - 0.5e5, 0.5e5, still), None);
        assert_eq!(noticed(&mut watch, 1002.0, reading_pa - 1.4e5, -0.4e5, 0.9e5), None);
        assert_eq!(noticed(&mut watch, 1200.0, 100e5, -80e5, still), None, "too long ago");
    }

    #[test]
    fn what_the_surroundings_may_have_done_is_no_jump_and_what_is_beyond_it_is() {
        let jumps =
            |by_pa: f64| noticed(&mut accustomed(184e5, 1.0), 0.0, 184e5 - by_pa, -by_pa, 0.9e5).is_some();
        assert!(!jumps(0.9e5) && jumps(1.3e5));
        assert!(!jumps(-0.9e5) && jumps(-1.3e5));
    }

    #[test]
    fn a_part_of_what_the_expectation_moved_by_is_no_jump() {
        // 1.9 bar too little, where the expectation rises by 5 bar and where it stays.
        let jumps = |rise_pa: f64| {
            noticed(&mut accustomed(184e5, 1.0), 0.0, 184e5 + rise_pa - 1.9e5, -1.9e5, 0.0).is_some()
        };
        assert!(!jumps(5e5) && jumps(0.0));
    }

    #[test]
    fn the_return_after_a_jump_that_was_not_noticed_is_none() {
        let mut watch = accustomed(200e5, 1.0);
        assert_eq!(noticed(&mut watch, 0.0, 199.2e5, -0.8e5, 0.9e5), None, "hidden by a tunnel");
        assert_eq!(noticed(&mut watch, 1.0, 199.2e5, 0.02e5, 0.0), None);
        noticed(&mut watch, 2.0, 199.2e5, 0.0, 0.0);
        assert!(noticed(&mut watch, 3.0, 198.4e5, -0.8e5, 0.0).is_some());
    }
}
