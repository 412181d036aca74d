//! Run length of the window-limited likelihood ratio, approximately.
//!
//! Maxima of the normalised field `Z(n, k)` over time `n` and onset `k` above `b` (log-likelihood ratio `b^2/2`) come in
//! clusters; their rate per sample is, summed over the ages `l = n - k`,
//!
//! `(phi(b)/b) sum_l F_n(l) F_k(l)`,
//!
//! where `F` is the probability that a point of the field is the summit of its cluster along one direction:
//! `(x^2/2) nu(x)` along a random walk of standard deviation `x` per sample in units of the log-likelihood ratio (time;
//! the sample that an onset gains or loses), `2 Phi(u/2) - 1` along a smooth course of curvature `u^2` (the rest of a
//! ramp changes smoothly with its onset). For both at once, `F = F1 + F2 - F1 F2`, within 7 % of a simulation of the
//! local field. For a step in white noise this is the formula of Siegmund and Venkatraman on a window; for others
//! it is derived in the same way. Either sign doubles the rate.
//!
//! Assumes noise known and samples at even intervals. Against simulation (steps in white noise, ramps in white and
//! Ornstein-Uhlenbeck noise, mean run lengths from 1000 samples): within 20 %, mostly 10 %. A step in correlated noise is
//! a jump of one sample and a weak drift, whose onsets do not lie along a walk: the sum is half the true mean time at a
//! correlation of 0.9. Such a threshold is refused here; [`super::calibrate_threshold`] finds it.
//!
//! Source: D. Siegmund and E. S. Venkatraman, Ann. Stat. 23 (1995) 255; D. Siegmund and B. Yakir, The Statistics of Gene
//! Mapping, 2007; smooth fields: S. O. Rice, Bell Syst. Tech. J. 24 (1945) 46.
use serde::{Deserialize, Serialize};

use super::approximation::discreteness;
use super::solve::threshold_for;
use super::{Change, normal_density, normal_probability};
use crate::DetectorError;
use crate::statistic::{Noise, Shape, Side};

/// Largest correlation of neighbouring samples for a step.
const STEP_CORRELATION: f64 = 0.15;

/// A likelihood ratio with its threshold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GlrChart {
    /// Course of the change.
    pub shape: Shape,
    /// Sign of the change.
    pub side: Side,
    /// Noise of the residuals.
    pub noise: Noise,
    /// Interval of the samples, s.
    pub interval_s: f64,
    /// Oldest onset, samples.
    pub window: usize,
    /// Threshold of the log-likelihood ratio.
    pub threshold: f64,
}

impl GlrChart {
    /// The same chart with so many samples between false alarms on average; its own threshold does not matter.
    ///
    /// # Errors
    /// Noise or interval are not valid, the window is empty, a step is looked for in correlated noise, or the run length
    /// is below about 10.
    pub fn for_arl(self, arl: f64) -> Result<Self, DetectorError> {
        self.noise.validate()?;
        crate::error::positive("interval_s", self.interval_s)?;
        if self.window == 0 {
            return Err(DetectorError::Setting { setting: "window", value: 0.0, bound: "at least 1" });
        }
        let correlation = self.noise.correlation(self.interval_s);
        if self.shape == Shape::Step && correlation > STEP_CORRELATION {
            return Err(DetectorError::Setting {
                setting: "correlation of neighbouring samples",
                value: correlation,
                bound: "at most 0.15 for a step; calibrate its threshold by simulation",
            });
        }
        let chart = |threshold: f64| Self { threshold, ..self };
        Ok(chart(threshold_for(arl, 0.5, 300.0, |threshold| chart(threshold).arl())?))
    }

    /// Mean number of samples between false alarms.
    ///
    /// # Validity
    /// Thresholds from about 5 on.
    pub fn arl(&self) -> f64 {
        let b = (2.0 * self.threshold).sqrt();
        let signs = if self.side == Side::Both { 2.0 } else { 1.0 };
        b / (signs * normal_density(b) * self.summits(b))
    }

    /// Mean delay, s, of a change of its own shape.
    ///
    /// The maximum over size and onset runs ahead of the information `J`, the overshoot behind: a ramp is found at
    /// `J = threshold - 1.5` and half an interval later, a step of `d` standard deviations at
    /// `J = threshold - 2.4 + 1.55 d`. The three numbers are fitted to simulated delays.
    ///
    /// # Validity
    /// Ramps of white or Ornstein-Uhlenbeck noise, steps of 0.3 to 1.5 standard deviations in white noise, found within
    /// the window, at thresholds of about 11: 6 % of simulated delays.
    pub fn delay_s(&self, change: Change) -> f64 {
        let (ahead, later_s) = match change {
            Change::Ramp(_) => (1.5, 0.5 * self.interval_s),
            Change::Step(size) => (2.4 - 1.55 * (size / self.noise.sd).abs(), 0.0),
        };
        let needed = (self.threshold - ahead).max(0.0);
        change.time_to_information(self.noise, self.interval_s, needed) + later_s
    }

    /// `sum_l F_n(l) F_k(l)`.
    fn summits(&self, b: f64) -> f64 {
        let phi = self.noise.correlation(self.interval_s);
        let later = 1.0 - phi;
        // Sums over the samples after the first one, in units of the standard deviation of an innovation.
        let (mut rest, mut cross, mut curvature) = (0.0, 0.0, 0.0);
        let mut sum = 0.0;
        for l in 0..self.window {
            let (signature, slope) = match (self.shape, l) {
                (_, 0) => (1.0, 0.0),
                (Shape::Step, _) => (later, 0.0),
                (Shape::Ramp, _) => (1.0 + later * l as f64, later),
            };
            if l > 0 {
                rest += signature * signature;
                cross += signature * slope;
                curvature += slope * slope;
            }
            let information = 1.0 + rest;
            let newest = b * signature / information.sqrt();
            let oldest = b / information.sqrt();
            let bent = if rest > 0.0 { (curvature - cross * cross / rest).max(0.0) } else { 0.0 };
            let smooth = 2.0 * normal_probability(0.5 * b * (bent / information).sqrt()) - 1.0;
            let rough = walk_summit(oldest);
            sum += walk_summit(newest) * (rough + smooth - rough * smooth);
        }
        sum
    }
}

/// Probability that a point is the summit of a random walk with drift away from it to both sides.
fn walk_summit(x: f64) -> f64 {
    0.5 * x * x * discreteness(x)
}
