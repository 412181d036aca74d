//! Thresholds of the statistics, and the tails that they follow from where a vessel has none of its own.
//!
//! The usual tails were fitted to leak-free worlds of the families that tune, in railway winters, parked, in a workshop, a metro, a desert and showers: one set to six cylinders of
//! 180 to 300 bar, one to a tank of 3 to 8 bar, whose gas takes up little heat beside its wall and follows it at once. They hold for a vessel of which nothing else is
//! known. What the statistics of one vessel reach where it stands, `cylwatch commission` finds. For the cylinder under a rail vehicle it has been run, in railway winters, parked
//! and in a workshop, and its tails stand here. A third of all of them have gas in layers.
//!
//! `cargo run --release -p cylwatch-evaluation --example tails`, `cylwatch commission nitrogen-20l`
use core::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use cylwatch_estimator::thermal::vessel::Vessel;
#[cfg(feature = "presets")]
use cylwatch_estimator::thermal::vessel::presets;
use cylwatch_estimator::thermal::wall::mesh::Mesh;

use crate::units::QUOTED_K;

use super::{Scale, Statistics, Tail, Tails};

/// Heat capacity `p V / T` of the gas as a part of the wall's below which a vessel is a tank. The tank that was tried has 0.006 to 0.016, the cylinders 0.10 to 0.19.
const TANK: f64 = 0.04;

impl Tails {
    /// Those of a vessel that holds so much at 15 °C, Pa: its own if it is a built-in one that has been commissioned, filled as it was then; else the usual ones.
    pub fn of(vessel: &Vessel, full_pa: f64) -> Self {
        let own = OWN.iter().find(|own| own.full_pa.contains(&full_pa) && is_built_in(vessel, own.preset));
        own.map_or_else(|| Self::usual(vessel, full_pa), |own| own.tails)
    }

    /// The usual ones of a vessel that holds so much at 15 °C, Pa; see the module's head.
    pub fn usual(vessel: &Vessel, full_pa: f64) -> Self {
        let gas_j_k = full_pa * vessel.volume.volume_m3 / QUOTED_K;
        let part = gas_j_k / Mesh::new(&vessel.geometry).capacity_j_k();
        if part < TANK { Self::TANK } else { Self::CYLINDER }
    }
}

#[cfg(feature = "presets")]
fn is_built_in(vessel: &Vessel, preset: &str) -> bool {
    presets::load(preset).is_ok_and(|known| format!("{known:?}") == format!("{vessel:?}"))
}

/// None is built in.
#[cfg(not(feature = "presets"))]
fn is_built_in(_: &Vessel, _: &str) -> bool {
    false
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
    // Of 204 cylinders, 34.6 years together, a third of them with gas in layers.
    tails: Tails([
        Tail { level: 1.8239, interval_s: 4.3212e5, scale: 1.0834, shape: -0.086 },
        Tail { level: 3.5588, interval_s: 1.7294e6, scale: 1.5122, shape: -0.223 },
        Tail { level: 3.3987, interval_s: 3.4560e6, scale: 1.2393, shape: -0.203 },
        Tail { level: 3.5676, interval_s: 1.2186e7, scale: 1.1631, shape: -0.051 },
        Tail { level: 2.8058, interval_s: 2.6438e7, scale: 0.8693, shape: 0.249 },
    ]),
}];

impl Tails {
    /// Of 204 tanks, 34.6 years together, a third of them with gas in layers.
    pub const TANK: Self = Self([
        Tail { level: 2.2271, interval_s: 4.3214e5, scale: 0.8038, shape: 0.015 },
        Tail { level: 3.7712, interval_s: 1.7297e6, scale: 0.9746, shape: 0.015 },
        Tail { level: 3.8159, interval_s: 3.4560e6, scale: 0.8488, shape: 0.115 },
        Tail { level: 4.1913, interval_s: 1.2186e7, scale: 1.4480, shape: 0.155 },
        Tail { level: 4.0314, interval_s: 2.6438e7, scale: 1.7149, shape: 0.249 },
    ]);

    /// Of 252 cylinders, 42.8 years together, a third of them with gas in layers.
    pub const CYLINDER: Self = Self([
        Tail { level: 1.9555, interval_s: 4.3206e5, scale: 0.6246, shape: -0.033 },
        Tail { level: 3.3326, interval_s: 1.7298e6, scale: 0.6595, shape: 0.203 },
        Tail { level: 3.5014, interval_s: 3.4560e6, scale: 0.7243, shape: 0.151 },
        Tail { level: 3.7429, interval_s: 1.2193e7, scale: 0.7054, shape: 0.017 },
        Tail { level: 3.1069, interval_s: 2.6127e7, scale: 0.9006, shape: -0.018 },
    ]);
}

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
