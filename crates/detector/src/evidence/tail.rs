//! How high the statistics rise without a leak: the law of the tail.
//!
//! The largest values of stretches of length `b` that exceed a level `u` follow, if that is high, the generalised Pareto law
//! `P(x > u + y | x > u) = (1 + k y/s)^(-1/k)`. With the part `q` of the stretches that exceed it, the mean time between
//! exceedances of `u + y` is `(b/q) (1 + k y/s)^(1/k)`, and the threshold of a mean time `T` is
//!
//! `h = u + s/k [(T q/b)^k - 1]`.
//!
//! Several statistics share the rate of false alarms in equal parts; that they alarm together makes the rate smaller than stated.
//!
//! Source: J. Pickands, Ann. Stat. 3 (1975) 119; S. Coles, An Introduction to Statistical Modeling of Extreme Values, 2001, sections 4.3
//! and 5.3.
use serde::{Deserialize, Serialize};

use super::{Scale, Statistics, Thresholds};
use crate::DetectorError;
use crate::error::positive;

/// Largest shape either way: from 1/2 on the excess has no variance, and no fit to records finds it.
const LARGEST_SHAPE: f64 = 0.5;

/// Tail of one statistic without a leak.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tail {
    /// Value from which on the law holds.
    pub level: f64,
    /// Mean time between stretches that exceed it, s.
    pub interval_s: f64,
    /// Scale of the excess.
    pub scale: f64,
    /// Shape: 0 is exponential, below 0 bounded.
    pub shape: f64,
}

impl Tail {
    /// Check every number.
    ///
    /// # Errors
    /// Names the number, its value and the bound.
    pub(crate) fn validate(&self) -> Result<(), DetectorError> {
        positive("tails.level", self.level)?;
        positive("tails.interval_s", self.interval_s)?;
        positive("tails.scale", self.scale)?;
        if self.shape.abs() <= LARGEST_SHAPE {
            return Ok(());
        }
        let bound = "between -0.5 and 0.5";
        Err(DetectorError::Setting { setting: "tails.shape", value: self.shape, bound })
    }

    /// The value that is exceeded once in a mean time, s; the level for times that are too short for the law.
    pub fn threshold(&self, mean_time_s: f64) -> f64 {
        let log = libm::log(mean_time_s / self.interval_s).max(0.0);
        let excess = if self.shape == 0.0 { log } else { libm::expm1(self.shape * log) / self.shape };
        self.level + self.scale * excess
    }

    /// Mean time between stretches that exceed a value, s: infinite beyond the end of a bounded tail. Below the level, where the law says nothing,
    /// it is continued so that it is 0 where nothing speaks for a leak.
    pub(crate) fn mean_time_s(&self, value: f64) -> f64 {
        let excess = (value - self.level) / self.scale;
        if excess < 0.0 {
            return self.interval_s * (value / self.level).max(0.0) * libm::exp(excess);
        }
        let log = if self.shape == 0.0 { excess } else { libm::log1p(self.shape * excess) / self.shape };
        // Beyond the end of a bounded tail there is no logarithm.
        if log.is_nan() { f64::INFINITY } else { self.interval_s * libm::exp(log) }
    }
}

/// The tails of all statistics, in the order of [`Scale::ALL`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tails(pub [Tail; Scale::ALL.len()]);

impl Tails {
    /// Check every number.
    ///
    /// # Errors
    /// As `Tail::validate`.
    pub fn validate(&self) -> Result<(), DetectorError> {
        self.0.iter().try_for_each(Tail::validate)
    }

    /// Thresholds of all statistics together for a mean time between false alarms, s.
    ///
    /// # Errors
    /// The time is not positive.
    pub fn thresholds(&self, mean_time_s: f64) -> Result<Thresholds, DetectorError> {
        positive("mean_time_s", mean_time_s)?;
        let each_s = mean_time_s * self.0.len() as f64;
        Ok(Thresholds { mean_time_s, levels: self.0.map(|tail| tail.threshold(each_s)) })
    }

    /// Mean time between samples without a leak whose statistics speak for one as much as these, s.
    pub(crate) fn mean_time_s(&self, statistics: &Statistics) -> f64 {
        let each_s = self.0.iter().zip(statistics).map(|(tail, value)| tail.mean_time_s(*value));
        each_s.fold(0.0, f64::max) / self.0.len() as f64
    }
}
