//! Gas that comes in so slowly that no pressure jumps: a filling of an hour from a small bottle.
//!
//! Nothing but a filling makes a cylinder heavier. Errors of the mass stay below 4 % whatever stands beside it, so a gain of 8 % within six hours is one, told
//! once it is over: when the mass has not risen by a twentieth of it for twenty minutes.

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::DetectorError;
use crate::monitor::restored;

/// Interval of the masses that are kept, s, and how long they are kept, s.
const INTERVAL_S: f64 = 600.0;
const KEPT_S: f64 = 6.0 * 3600.0;
/// Masses that are kept at most: those of that time, and one more.
const KEPT: usize = (KEPT_S / INTERVAL_S) as usize + 2;
/// Gain that is a filling, as a part of the stated one, and part of the gain in the last while, s, at which it is over.
const FILLED: f64 = 0.08;
const RISING: f64 = 0.05;
const OVER_S: f64 = 1200.0;

/// Watches the mass.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::monitor) struct GainWatch {
    /// Times, s, and masses, kg.
    recent: SmallVec<[(f64, f64); KEPT]>,
}

impl GainWatch {
    /// Checks one that was saved.
    pub(crate) fn validate(&self) -> Result<(), DetectorError> {
        restored::require(
            self.recent.len() <= KEPT,
            "gains.recent",
            self.recent.len() as f64,
            "those of six hours",
        )
    }

    /// Take in a mass, kg, of a cylinder that was filled with so much, kg; when a filling began that is over now, s, and its gain, kg.
    pub(crate) fn push(&mut self, time_s: f64, mass_kg: f64, filled_kg: f64) -> Option<(f64, f64)> {
        if self.recent.last().is_some_and(|(last_s, _)| time_s - last_s < INTERVAL_S) {
            return None;
        }
        self.recent.push((time_s, mass_kg));
        while self.recent.first().is_some_and(|(first_s, _)| time_s - first_s > KEPT_S) {
            self.recent.remove(0);
        }
        let least_kg = self.recent.iter().map(|(_, mass_kg)| *mass_kg).fold(f64::INFINITY, f64::min);
        let gain_kg = mass_kg - least_kg;
        let low = |(_, kg): &&(f64, f64)| *kg <= least_kg + RISING * gain_kg;
        let begun_s = self.recent.iter().rev().find(low)?.0;
        let before = self.recent.iter().rev().find(|(at_s, _)| time_s - at_s >= OVER_S)?;
        let over = mass_kg - before.1 < RISING * gain_kg;
        (gain_kg > FILLED * filled_kg && over).then_some((begun_s, gain_kg))
    }

    /// Other gas is in the cylinder.
    pub(crate) fn forget(&mut self) {
        self.recent.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(mass_kg: impl Fn(f64) -> f64) -> Option<(f64, (f64, f64))> {
        let mut watch = GainWatch::default();
        (0..2000)
            .map(|minute| 60.0 * f64::from(minute))
            .find_map(|t| Some((t, watch.push(t, mass_kg(t), 4.48)?)))
    }

    #[test]
    fn a_slow_filling_is_told_when_it_is_over() {
        let filling = |t: f64| 3.67 + 0.8 * ((t - 30_000.0) / 4500.0).clamp(0.0, 1.0);
        let (at_s, (begun_s, gain_kg)) = told(filling).expect("800 g");
        assert!((35_700.0..37_500.0).contains(&at_s), "{at_s} s");
        assert!((gain_kg - 0.8).abs() < 1e-9 && (29_400.0..30_600.0).contains(&begun_s));
    }

    #[test]
    fn errors_and_leaks_are_none() {
        assert_eq!(told(|t| 4.48 + 0.15 * (t / 3000.0).sin()), None);
        assert_eq!(told(|t| 4.48 - 1e-5 * t), None);
        assert_eq!(told(|t| 4.48 + 4e-6 * t), None, "a filling of a day is a drift");
    }
}
