//! One onset: its sums, updated sample by sample.
use serde::{Deserialize, Serialize};

use super::{Finding, OnsetHypothesis, Refined, Shape};
use crate::statistic::{Side, Whitened};

/// A change that began at `onset_s`. Sums relative to their own onset, so that nothing cancels after years.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Onset {
    pub onset_s: f64,
    /// `A = sum g^2`.
    information: f64,
    /// `B = sum g w`.
    correlation: f64,
    /// `C = sum g c`.
    cross: f64,
    /// `D = sum c^2`.
    onset_information: f64,
    /// `E = sum c w`.
    onset_correlation: f64,
    pub log_likelihood_ratio: f64,
}

impl Onset {
    pub fn at(onset_s: f64) -> Self {
        Self {
            onset_s,
            information: 0.0,
            correlation: 0.0,
            cross: 0.0,
            onset_information: 0.0,
            onset_correlation: 0.0,
            log_likelihood_ratio: 0.0,
        }
    }

    /// Take the sample at `time_s`.
    pub fn add(&mut self, shape: Shape, side: Side, time_s: f64, whitened: &Whitened) {
        let since_s = time_s - self.onset_s;
        let before_s = since_s - whitened.interval_s.unwrap_or(f64::INFINITY);
        let phi = whitened.phi;
        match shape {
            Shape::Step => {
                let before = if before_s >= 0.0 { phi } else { 0.0 };
                self.sum((1.0 - before) / whitened.sd, whitened.value);
            }
            Shape::Ramp => {
                // The kink itself is left out: it tells of shifts within one sample only.
                let slope = -(1.0 - phi) / whitened.sd;
                let signature = (since_s - phi * before_s.max(0.0)) / whitened.sd;
                self.sum(signature, whitened.value);
                self.cross += signature * slope;
                self.onset_information += slope * slope;
                self.onset_correlation += slope * whitened.value;
            }
        }
        let towards = match side {
            Side::Above => self.correlation.max(0.0),
            Side::Below => self.correlation.min(0.0),
            Side::Both => self.correlation,
        };
        self.log_likelihood_ratio = 0.5 * towards * towards / self.information;
    }

    fn sum(&mut self, signature: f64, value: f64) {
        self.information += signature * signature;
        self.correlation += signature * value;
    }

    pub fn finding(&self, shape: Shape) -> Finding {
        Finding {
            onset_s: self.onset_s,
            size: self.correlation / self.information,
            size_sd: self.information.sqrt().recip(),
            refined: if shape == Shape::Ramp { self.refined() } else { None },
            log_likelihood_ratio: self.log_likelihood_ratio,
        }
    }

    /// One Gauss-Newton step from the grid point in size and onset.
    fn refined(&self) -> Option<Refined> {
        let (a, c, d) = (self.information, self.cross, self.onset_information);
        let determinant = a * d - c * c;
        // After one sample size and onset are one and the same: nothing but rounding is left.
        if determinant <= 1e-9 * a * d {
            return None;
        }
        let size = (d * self.correlation - c * self.onset_correlation) / determinant;
        let shift = (a * self.onset_correlation - c * self.correlation) / determinant;
        let onset_sd_s = (a / determinant).sqrt() / size.abs();
        let size_sd = (d / determinant).sqrt();
        Some(Refined { onset_s: self.onset_s + shift / size, onset_sd_s, size, size_sd })
    }
}

impl OnsetHypothesis for Onset {
    fn evidence(&self) -> f64 {
        self.log_likelihood_ratio
    }
}
