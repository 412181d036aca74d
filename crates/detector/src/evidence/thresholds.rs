//! Thresholds of the statistics, and the tails that they follow from where a vessel has none of its own.
//!
//! The usual tails were fitted to leak-free worlds of the families that tune: seven vessels together in railway winters, parked, in a workshop, a metro, a desert and
//! showers. They hold for a vessel of which nothing else is known. What the statistics of one vessel reach where it stands, `cylwatch commission` finds. For the cylinder under a rail vehicle
//! it has been run, in railway winters, parked and in a workshop, and its tails stand here.
//!
//! `cargo run --release -p cylwatch-evaluation --example tails`, `cylwatch commission nitrogen-20l`
use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use cylwatch_estimator::thermal::vessel::{Vessel, presets};

use super::{Scale, Statistics, Tail, Tails};

impl Default for Tails {
    /// The usual ones; see the module's head.
    fn default() -> Self {
        USUAL
    }
}

impl Tails {
    /// Those of a vessel that holds so much at 15 °C, Pa: its own if it is a built-in one that has been commissioned, filled as it was then; else the usual ones.
    pub fn of(vessel: &Vessel, full_pa: f64) -> Self {
        let says = |of: &Vessel| format!("{of:?}");
        let is_built_in = |name: &str| presets::load(name).is_ok_and(|known| says(&known) == says(vessel));
        let own = OWN.iter().find(|own| own.full_pa.contains(&full_pa) && is_built_in(own.preset));
        own.map_or(USUAL, |own| own.tails)
    }
}

/// Tails of a built-in vessel.
struct Own {
    preset: &'static str,
    /// Fills that they hold for, at 15 °C, Pa.
    full_pa: RangeInclusive<f64>,
    tails: Tails,
}

const OWN: [Own; 1] = [Own {
    preset: "nitrogen-20l",
    full_pa: 170e5..=210e5,
    // Of 204 cylinders, 34.6 years together.
    tails: Tails([
        Tail { level: 3.3325, interval_s: 4.3212e5, scale: 1.1505, shape: -0.019 },
        Tail { level: 1.8107, interval_s: 1.7294e6, scale: 0.4842, shape: 0.010 },
        Tail { level: 1.1667, interval_s: 3.4560e6, scale: 0.2770, shape: 0.029 },
        Tail { level: 0.6603, interval_s: 1.2186e7, scale: 0.1497, shape: 0.059 },
        Tail { level: 0.3567, interval_s: 2.6438e7, scale: 0.0931, shape: -0.171 },
    ]),
}];

/// Of 294 cylinders, 49.9 years together.
const USUAL: Tails = Tails([
    Tail { level: 4.0753, interval_s: 4.3210e5, scale: 1.4563, shape: -0.019 },
    Tail { level: 2.4909, interval_s: 1.7292e6, scale: 0.5763, shape: 0.107 },
    Tail { level: 1.4264, interval_s: 3.4560e6, scale: 0.3351, shape: 0.185 },
    Tail { level: 0.8418, interval_s: 1.2158e7, scale: 0.1742, shape: 0.249 },
    Tail { level: 0.3783, interval_s: 2.6278e7, scale: 0.1423, shape: 0.169 },
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
