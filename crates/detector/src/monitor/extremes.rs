//! Extremes that readings had lately: they follow at once outwards, and fade to the present readings inwards.
use serde::{Deserialize, Serialize};

/// Lowest and highest lately, not a number before the first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Extremes {
    pub low: f64,
    pub high: f64,
}

impl Extremes {
    /// Take in the lowest and the highest of now, where this part of what was beyond them is kept.
    pub(super) fn follow(&mut self, (low, high): (f64, f64), kept: f64) {
        self.low = low.min(low + kept * (self.low - low));
        self.high = high.max(high + kept * (self.high - high));
    }

    /// How far they are apart.
    pub(super) fn spread(&self) -> f64 {
        self.high - self.low
    }
}

impl Default for Extremes {
    /// Of nothing.
    fn default() -> Self {
        Self { low: f64::NAN, high: f64::NAN }
    }
}
