//! Mass that is missing now: what there should be less what there is, in standard deviations of the difference.
//!
//! `h = (m + c - m_free) / sqrt(max(P_free - P, P_free/4))`, with mass `m` and variance `P` of the member that allows a slow leak
//! alone, and those of the freest one; as in Hausman's statistic, the variances of a precise and of a merely consistent estimate
//! subtract. Constant errors of the sensors are in both masses and cancel.
//!
//! When the slow member has begun anew from the freest one, its mass is the other's, and a leak would be out of sight at the
//! moment it is largest. So the mass `c` that it gave up is carried on and fades over two hours; `P` follows with the same memory.
//!
//! The statistic is the low-pass of `h` over a quarter of an hour: what a tunnel does to the freest mass is over by then.
//!
//! Source: J. A. Hausman, Econometrica 46 (1978) 1251.
use cylwatch_estimator::observer::Leak;
use serde::{Deserialize, Serialize};

/// Memory of a mass that was given up, s.
const CARRY_S: f64 = 7200.0;
/// Time constant of the statistic, s.
const LOW_PASS_S: f64 = 900.0;
/// Least variance of the difference relative to that of the free mass.
const LEAST_PART: f64 = 0.25;
/// A difference counts so many standard deviations at most.
const MOST: f64 = 30.0;

/// The missing mass so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct MissingMass {
    /// Mass, kg, and variance, kg², of the slow member.
    last: Option<(f64, f64)>,
    /// Mass that was given up, kg.
    carried_kg: f64,
    value: f64,
}

impl MissingMass {
    /// Take the masses of the slow and of the freest member, so long after the last ones, s.
    pub fn update(&mut self, interval_s: f64, slow: &Leak, free: &Leak) {
        let fading = (-interval_s / CARRY_S).exp();
        self.carried_kg *= fading;
        let now = slow.mass_sd_kg * slow.mass_sd_kg;
        let (before_kg, held) = self.last.unwrap_or((slow.mass_kg, now));
        if slow.begun_anew {
            self.carried_kg += before_kg - slow.mass_kg;
        }
        let held = now + fading * (held - now);
        self.last = Some((slow.mass_kg, held));
        let free_variance = free.mass_sd_kg * free.mass_sd_kg;
        let variance = (free_variance - held).max(LEAST_PART * free_variance);
        if variance > 0.0 {
            let missing_kg = slow.mass_kg + self.carried_kg - free.mass_kg;
            let h = (missing_kg / variance.sqrt()).clamp(-MOST, MOST);
            self.value += -(-interval_s / LOW_PASS_S).exp_m1() * (h - self.value);
        }
    }

    pub fn value(&self) -> f64 {
        self.value
    }
}
