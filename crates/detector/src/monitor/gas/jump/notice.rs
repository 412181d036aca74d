//! Whether a pressure has jumped; the rule stands in [`super`].
use serde::{Deserialize, Serialize};

use crate::monitor::examination::{FarOff, kept};
use crate::units::MINUTE_S;

/// Change of the innovation that is a jump, as a part of the full pressure, beside so many usual changes, and so many steps of the transmitter.
const JUMP: f64 = 6e-4;
const JUMP_PER_USUAL: f64 = 4.0;
const JUMP_PER_STEP: f64 = 1.2;
/// Samples over which the usual change is a mean.
const USUAL_SAMPLES: f64 = 300.0;
/// Largest change that counts for it, as a part of the full pressure.
pub const USUAL_LARGEST: f64 = 5e-3;
/// Part of it that the reading itself makes at least, and that is left against the sample before the last where it does not only return.
const HALF: f64 = 0.5;
/// How far beyond the largest change that was none.
const BEYOND: f64 = 1.25;
/// Part of the limit that is for the surroundings at least where they may have made it, and how much it counts for at most.
const THEIRS: f64 = 0.3;
const MOST: f64 = 3.0;
/// Interval beyond which two innovations are not compared, s.
pub const LONGEST_INTERVAL_S: f64 = 900.0;

/// Watches the innovations of the pressure for a jump.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct JumpWatch {
    last: Option<Innovated>,
    /// Innovation before it.
    before: f64,
    /// Usual change of the innovation in a minute.
    usual: f64,
    /// What the limit is multiplied by, at least 1, and when a reading was seen last, s.
    excess: f64,
    seen_s: Option<f64>,
    far_off: FarOff,
    /// How large the last change was against the limit, if the surroundings made it.
    latest: f64,
}

/// A reading and what was expected, as parts of the full pressure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Innovated {
    /// Time, s.
    pub time_s: f64,
    /// Reading.
    pub reading: f64,
    /// Reading less what was expected.
    pub innovation: f64,
    /// Largest change of the innovation by the surroundings since the reading before.
    pub doubt: f64,
}

impl Default for JumpWatch {
    /// Of a transmitter and a thermometer of which nothing is known.
    fn default() -> Self {
        Self {
            last: None,
            before: f64::NAN,
            usual: JUMP,
            excess: 1.0,
            seen_s: None,
            far_off: FarOff::default(),
            latest: 0.0,
        }
    }
}

impl JumpWatch {
    /// Take in a reading. `step` is the resolution of the transmitter; `part` the relative uncertainty of a change of the expected
    /// pressure. Returns the innovation before the reading if the reading is a jump.
    pub(crate) fn notice(&mut self, now: Innovated, step: f64, part: f64) -> Option<f64> {
        if !(now.reading.is_finite() && now.innovation.is_finite()) {
            return None;
        }
        let since_s = self.seen_s.replace(now.time_s).map_or(0.0, |seen_s| now.time_s - seen_s);
        let kept = kept(since_s);
        self.excess = 1.0 + (self.excess - 1.0) * kept;
        self.far_off.saw_a_good_one(kept);
        let last = self.last.replace(now)?;
        let interval_s = now.time_s - last.time_s;
        if interval_s > LONGEST_INTERVAL_S {
            return None;
        }
        let change = now.innovation - last.innovation;
        let by_reading = now.reading - last.reading;
        // The errors walk: they change by more in a longer interval.
        let grown = libm::sqrt((interval_s / MINUTE_S).max(1.0));
        // What goes back to where it was has taken in a jump that was not noticed: the other way it would be believed.
        let before = core::mem::replace(&mut self.before, last.innovation);
        let returns = (now.innovation - before).abs() < HALF * change.abs();
        let surroundings = now.doubt + part * (by_reading - change).abs();
        let limit = JUMP + JUMP_PER_USUAL * self.usual * grown + JUMP_PER_STEP * step + surroundings;
        self.usual += ((change.abs() / grown).min(USUAL_LARGEST) - self.usual) / USUAL_SAMPLES;
        // What the expectation alone did is the model's.
        let read = by_reading * change.signum() > HALF * change.abs();
        let beyond = change.abs() / limit;
        // What a reading does by itself, at rest, says nothing of the surroundings.
        self.latest = if surroundings > THEIRS * limit { beyond.min(MOST) } else { 0.0 };
        if read && !returns && beyond > self.excess {
            return Some(last.innovation);
        }
        self.was_none();
        None
    }

    /// How much more than is considered the surroundings have done to it lately, at least 1.
    pub(crate) fn excess(&self) -> f64 {
        self.excess
    }

    /// How often readings have been far off lately.
    pub(crate) fn far_off(&self) -> FarOff {
        self.far_off
    }

    /// Readings were far off in an examination.
    pub(crate) fn were_far_off(&mut self, seen: FarOff) {
        self.far_off.add(seen);
    }

    /// The last change was no jump: only what is beyond it is one.
    pub(crate) fn was_none(&mut self) {
        self.excess = self.excess.max(BEYOND * self.latest);
    }

    /// A jump was none, or the transmitter's: go on after this reading.
    pub(crate) fn go_on(&mut self, last: Innovated) {
        self.forget();
        self.last = Some(last);
    }

    /// Forget the last reading, and the change that it was.
    pub(crate) fn forget(&mut self) {
        (self.last, self.before, self.latest) = (None, f64::NAN, 0.0);
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
        let [reading, innovation, doubt] = [reading_pa, innovation_pa, doubt_pa].map(|pa| pa / 200e5);
        let before =
            watch.notice(Innovated { time_s: MINUTE_S * minute, reading, innovation, doubt }, 0.0, 0.4);
        before.map(|before| 200e5 * before)
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
    fn the_first_reading_after_an_examination_may_jump_again() {
        let mut watch = accustomed(200e5, 1.0);
        watch.go_on(Innovated { time_s: 0.0, reading: 1.0, innovation: 0.0, doubt: 0.0 });
        assert!(noticed(&mut watch, 1.0, 250e5, 50e5, 0.0).is_some());
    }

    /// Whether a watch that was accustomed jumps by so much, Pa, after it jumped by so much and that was none, with what the surroundings may have done, Pa.
    fn jumps_again(by_pa: f64, none_pa: f64, doubt_pa: f64, days: f64) -> bool {
        let mut watch = accustomed(184e5, 1.0);
        assert!(noticed(&mut watch, 0.0, 184e5 - none_pa, -none_pa, doubt_pa).is_some());
        watch.was_none();
        watch.forget();
        let minute = 1440.0 * days;
        for row in 0..3 {
            // Nothing is compared across days.
            assert_eq!(noticed(&mut watch, minute + f64::from(row), 184e5, 0.0, doubt_pa), None);
        }
        noticed(&mut watch, minute + 3.0, 184e5 - by_pa, -by_pa, doubt_pa).is_some()
    }

    #[test]
    fn what_the_surroundings_were_seen_to_do_is_no_jump_for_some_days() {
        assert!(jumps_again(2.6e5, 2e5, 0.9e5, 0.01) && !jumps_again(2.2e5, 2e5, 0.9e5, 0.01));
        // At rest, it was the reading that was far off; weeks later, nothing is known of it.
        assert!(jumps_again(2.2e5, 2e5, 0.0, 0.01) && jumps_again(2.2e5, 2e5, 0.9e5, 20.0));
        // However much it was.
        assert!(jumps_again(6e5, 60e5, 0.9e5, 0.01));
    }

    /// A restart of the observer begins an examination without a jump; what a jump of before was is not told by it.
    #[test]
    fn what_was_forgotten_is_not_learnt_from() {
        let mut watch = accustomed(184e5, 1.0);
        assert!(noticed(&mut watch, 0.0, 182e5, -2e5, 0.9e5).is_some());
        watch.forget();
        let known = watch.excess();
        watch.was_none();
        assert_eq!(watch.excess(), known);
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
