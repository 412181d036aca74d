//! How large deviations usually are: a running mean of their squares that single ones hardly move.
//!
//! `D^2 = q + q_0/4`, `dq/dt = (min(d^2, 4 q) - q) / min(t + t_0, T)`, `q(0) = q_0`, with a prior `q_0` that counts for `t_0` = 3 d and a memory `T` of 5 d.
//! What is beyond two usual deviations counts as two, so that a leak of any size takes days to become usual (winsorised variance). A quarter of the prior stays for
//! ever: in a workshop nothing moves for weeks, which says nothing of what moves slowly, as a transmitter's drift does. Constants were chosen on worlds of the families
//! that tune (`tails` of `cylwatch-evaluation`).
use serde::{Deserialize, Serialize};

use crate::units::DAY_S;

/// Time for which the prior counts, and memory, s.
const PRIOR_S: f64 = 3.0 * DAY_S;
const MEMORY_S: f64 = 5.0 * DAY_S;
/// Usual deviations that a deviation counts for at most.
const MOST: f64 = 2.0;
/// Part of the prior's square that stays.
const ALWAYS: f64 = 0.25;

/// A usual deviation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Restless {
    square: f64,
    always: f64,
    seen_s: f64,
}

impl Restless {
    /// So large, until its own is known.
    pub(crate) fn with_prior(sd: f64) -> Self {
        Self { square: sd * sd, always: ALWAYS * sd * sd, seen_s: 0.0 }
    }

    /// Take the square of a deviation that lasted so long, s.
    pub(crate) fn update(&mut self, interval_s: f64, square: f64) {
        self.seen_s = (self.seen_s + interval_s).min(MEMORY_S);
        let gain = -libm::expm1(-interval_s / (self.seen_s + PRIOR_S).min(MEMORY_S));
        self.square += gain * (square.min(MOST * MOST * self.square) - self.square);
    }

    /// Standard deviation.
    pub(crate) fn sd(&self) -> f64 {
        libm::sqrt(self.square + self.always)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::HOUR_S;

    fn after(days: usize, of: impl Fn(usize) -> f64) -> f64 {
        let mut usual = Restless::with_prior(0.1);
        (0..24 * days).for_each(|hour| usual.update(HOUR_S, of(hour)));
        usual.sd()
    }

    #[test]
    fn what_is_usual_is_learnt_within_weeks_either_way() {
        for sd in [0.02_f64, 0.4] {
            let (found, expected) = (after(60, |_| sd * sd), sd.hypot(0.05));
            assert!((found / expected - 1.0).abs() < 0.01, "{sd} {found}");
        }
        assert!(after(1, |_| 0.0) > 0.07);
    }

    #[test]
    fn a_deviation_of_any_size_takes_days_to_become_usual() {
        let found = after(31, |hour| if hour < 30 * 24 { 0.01 } else { 1e6 });
        assert!(found < 0.14_f64.hypot(0.05), "{found}");
    }

    #[test]
    fn the_interval_of_the_rows_does_not_matter() {
        let of = |interval_s: f64| {
            let mut usual = Restless::with_prior(0.1);
            (0..(10.0 * DAY_S / interval_s) as usize).for_each(|_| usual.update(interval_s, 0.03));
            usual.sd()
        };
        assert!((of(60.0) / of(600.0) - 1.0).abs() < 0.01);
    }
}
