//! From a mean time between false alarms to thresholds.
//!
//! The numbers were fitted to leak-free winters of mismatched cylinders under a train:
//!
//! `cargo run --release -p cylwatch-evaluation --example long_run -- FOLDER train`, then `... -- FOLDER fit`
use serde::{Deserialize, Serialize};

use super::{Scale, Statistics, Tail, Tails};
use crate::DetectorError;

/// Tails of the statistics without a leak; see the module's head.
const USUAL: Tails = Tails([
    Tail { level: 0.9291, interval_s: 4.3207e5, scale: 0.2904, shape: -0.079 },
    Tail { level: 0.4369, interval_s: 1.7283e6, scale: 0.1384, shape: -0.126 },
    Tail { level: 0.2225, interval_s: 3.4560e6, scale: 0.0535, shape: -0.082 },
    Tail { level: 0.1057, interval_s: 1.2143e7, scale: 0.0259, shape: -0.165 },
    Tail { level: 0.0471, interval_s: 2.6193e7, scale: 0.0112, shape: -0.184 },
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
    /// For a mean time between false alarms, s.
    ///
    /// # Errors
    /// The time is not positive.
    pub fn for_mean_time_s(mean_time_s: f64) -> Result<Self, DetectorError> {
        USUAL.thresholds(mean_time_s)
    }

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
