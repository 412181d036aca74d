//! How far the mass by the observer's flowing member usually is from what it was the day before.
//!
//! Free to follow the pressure, that member cannot learn what the transmitter does with its temperature: by night it may see a hundredth of the gas less than by day, which is
//! no gas. What it does in this cylinder is learnt as the evidence for a leak learns how restless a cylinder is ([`Restless`]), from the difference to its low-pass over a day.
use cylwatch_estimator::thermal::real::powi;
use serde::{Deserialize, Serialize};

use crate::evidence::Restless;

/// Time constant of what it was, s.
const LEVEL_S: f64 = 86_400.0;
/// What it does in a typical cylinder, as a part of the fill.
const USUAL: f64 = 1e-3;

/// What the mass, as a part of the fill, usually does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Wander {
    level: Option<f64>,
    usual: Restless,
}

impl Default for Wander {
    fn default() -> Self {
        Self { level: None, usual: Restless::with_prior(USUAL) }
    }
}

impl Wander {
    /// Take in the mass, so long after the last one, s.
    pub(super) fn push(&mut self, since_s: f64, part: f64) {
        let level = self.level.get_or_insert(part);
        *level += -libm::expm1(-since_s / LEVEL_S) * (part - *level);
        self.usual.update(since_s, powi(part - *level, 2));
    }

    /// Standard deviation.
    pub(super) fn sd(&self) -> f64 {
        self.usual.sd()
    }

    /// Other gas, or an observer that began anew: what it was before counts no more, what is usual does.
    pub(super) fn begin_anew(&mut self) {
        self.level = None;
    }
}
