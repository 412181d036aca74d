//! Mass that is missing now: what there should be less what there is, over what is in doubt of it.
//!
//! `h = (m + c - m_free) / sqrt((m/500)^2 + s^2)`, with mass `m` of the member that allows a slow leak alone, that of the freest one, and the
//! error `s` of their difference by what comes and goes of a mass that follows the pressure, and by what has been learnt of the sensors ([`Doubt`](super::Doubt)). Constant errors are in both masses and
//! cancel; an unknown temperature coefficient does not, in the first cold night. At the mouth of a tunnel much is in doubt, in a calm hour next to nothing: there a leak
//! shows first.
//!
//! When the slow member has begun anew from the freest one, its mass is the other's, and a leak would be out of sight at the
//! moment it is largest. So the mass `c` that it gave up is carried on and fades over two hours.
//!
//! The value is the low-pass of `h` over 450 s; its deviation is from a low-pass over a day.
use cylwatch_estimator::observer::Leak;
use serde::{Deserialize, Serialize};

/// Memory of a mass that was given up, s.
const CARRY_S: f64 = 7200.0;
/// Time constant of the value, and of what it deviates from, s.
const LOW_PASS_S: f64 = 450.0;
const LEVEL_S: f64 = 24.0 * 3600.0;
/// Part of the mass that is always in doubt.
const LEAST_PART: f64 = 2e-3;
/// A difference counts so many doubts at most.
const MOST: f64 = 30.0;

/// The missing mass so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct MissingMass {
    /// Mass of the slow member, kg.
    last_kg: Option<f64>,
    /// Mass that was given up, kg.
    carried_kg: f64,
    value: f64,
    level: f64,
}

impl MissingMass {
    /// Take the masses of the slow and of the freest member, so long after the last ones, s, and what is in doubt of them, kg.
    pub fn update(&mut self, interval_s: f64, slow: &Leak, free: &Leak, doubt_kg: f64) {
        self.carried_kg *= (-interval_s / CARRY_S).exp();
        let before_kg = self.last_kg.replace(slow.mass_kg).unwrap_or(slow.mass_kg);
        if slow.begun_anew {
            self.carried_kg += before_kg - slow.mass_kg;
        }
        let missing_kg = slow.mass_kg + self.carried_kg - free.mass_kg;
        let h = (missing_kg / doubt_kg.hypot(LEAST_PART * slow.mass_kg)).clamp(-MOST, MOST);
        if h.is_finite() {
            self.value += -(-interval_s / LOW_PASS_S).exp_m1() * (h - self.value);
            self.level += -(-interval_s / LEVEL_S).exp_m1() * (h - self.level);
        }
    }

    pub fn value(&self) -> f64 {
        self.value
    }

    /// How far the value is from what it has been for hours.
    pub fn deviation(&self) -> f64 {
        self.value - self.level
    }
}
