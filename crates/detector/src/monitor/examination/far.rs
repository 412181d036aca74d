//! How often a transmitter's readings are far off, and for how long: a chain of two states.
//!
//! A reading is far off with the chance `b` after one that is not and `s` after one that is, learnt from jumps that were none. Both are
//! [`FAR_OFF`] at least, as where nothing is known; what was seen is forgotten within days.
use serde::{Deserialize, Serialize};

use crate::units::DAY_S;

/// Chance that a reading is far off, by up to the full pressure either way, and readings that this is worth.
const FAR_OFF: f64 = 0.01;
const WORTH: f64 = 300.0;
/// Time within which what a transmitter did is forgotten, s.
pub(crate) const FORGOTTEN_S: f64 = 5.0 * DAY_S;

/// Part of what a transmitter did so long ago, s, that is not forgotten.
pub(crate) fn kept(since_s: f64) -> f64 {
    libm::exp(-since_s / FORGOTTEN_S)
}

/// Readings that were good, that were the first ones far off, and that were so after one that was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct FarOff {
    good: f64,
    begun: f64,
    lasted: f64,
}

impl FarOff {
    /// Take in a reading that is as good as any, since the last of which a part of what was seen is kept.
    pub(crate) fn saw_a_good_one(&mut self, kept: f64) {
        *self = Self { good: kept * self.good + 1.0, begun: kept * self.begun, lasted: kept * self.lasted };
    }

    /// Take in a reading that is far off after one that is, or is not.
    pub(crate) fn saw_one_far_off(&mut self, again: bool) {
        *(if again { &mut self.lasted } else { &mut self.begun }) += 1.0;
    }

    /// What another one has seen beside it.
    pub(crate) fn add(&mut self, other: Self) {
        self.good += other.good;
        self.begun += other.begun;
        self.lasted += other.lasted;
    }

    /// Chance that a reading is far off after one that is, or is not.
    pub(crate) fn chance(&self, again: bool) -> f64 {
        let first = FAR_OFF * WORTH;
        let (seen, of, worth) = if again {
            (self.lasted, self.begun + self.lasted, first)
        } else {
            (self.begun, self.good + self.begun, WORTH)
        };
        ((seen + FAR_OFF * worth) / (of + worth)).max(FAR_OFF)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::MINUTE_S;

    #[test]
    fn spikes_of_three_readings_become_usual_and_are_forgotten() {
        let mut seen = FarOff::default();
        assert_eq!([false, true].map(|again| seen.chance(again)), [FAR_OFF; 2]);
        for _ in 0..100 {
            (0..50).for_each(|_| seen.saw_a_good_one(kept(MINUTE_S)));
            [false, true, true].into_iter().for_each(|again| seen.saw_one_far_off(again));
        }
        assert!((0.017..0.02).contains(&seen.chance(false)), "{}", seen.chance(false));
        assert!((0.6..0.667).contains(&seen.chance(true)), "{}", seen.chance(true));
        (0..60_000).for_each(|_| seen.saw_a_good_one(kept(MINUTE_S)));
        assert_eq!(seen.chance(false), FAR_OFF);
        assert!(seen.chance(true) < 0.1, "{}", seen.chance(true));
    }
}
