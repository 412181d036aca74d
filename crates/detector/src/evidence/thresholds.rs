//! Thresholds of the statistics, and the tails that they follow from where a vessel has none of its own.
//!
//! The usual tails were fitted to leak-free worlds of the families that tune: seven vessels together in railway winters, parked and in a workshop.
//! What the statistics of one vessel reach, `cylwatch commission` finds.
//!
//! `cargo run --release -p cylwatch-evaluation --example tails`
use serde::{Deserialize, Serialize};

use super::{Scale, Statistics, Tail, Tails};

impl Default for Tails {
    /// The usual ones; see the module's head.
    fn default() -> Self {
        USUAL
    }
}

/// Of 210 cylinders, 35.6 years together.
const USUAL: Tails = Tails([
    Tail { level: 5.1360, interval_s: 4.3205e5, scale: 1.5978, shape: -0.051 },
    Tail { level: 2.0305, interval_s: 1.7288e6, scale: 0.5797, shape: -0.049 },
    Tail { level: 1.2459, interval_s: 3.4560e6, scale: 0.3614, shape: -0.090 },
    Tail { level: 0.7523, interval_s: 1.2096e7, scale: 0.2393, shape: -0.172 },
    Tail { level: 0.3631, interval_s: 2.5920e7, scale: 0.0856, shape: 0.054 },
]);

/// A threshold for each statistic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Thresholds {
    /// Mean time between false alarms of all statistics together that they stand for, s.
    pub mean_time_s: f64,
    /// In the order of [`Scale::ALL`].
    pub levels: Statistics,
}

impl Thresholds {
    /// Threshold of a scale.
    pub fn of(&self, scale: Scale) -> f64 {
        self.levels[scale as usize]
    }

    /// The scale whose statistic exceeds its threshold farthest, relative to it; `None` without an alarm.
    pub fn alarm(&self, statistics: &Statistics) -> Option<Scale> {
        let part = |scale: &Scale| statistics[*scale as usize] / self.of(*scale);
        Scale::ALL.into_iter().filter(|scale| part(scale) >= 1.0).max_by(|a, b| part(a).total_cmp(&part(b)))
    }

    /// Whether nothing speaks for a leak any more: every statistic is below half of its threshold.
    pub fn is_calm(&self, statistics: &Statistics) -> bool {
        Scale::ALL.into_iter().all(|scale| statistics[scale as usize] < 0.5 * self.of(scale))
    }
}
