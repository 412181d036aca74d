//! How often the stated band holds the truth.
use serde::Serialize;

use super::{Band, Significance};

/// Half width of a 95 % band in standard deviations.
const BAND_95: f64 = 1.959_963_984_540_054;

/// Share of samples whose 95 % band holds the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Coverage {
    /// Samples whose band holds the truth.
    pub inside: u64,
    /// Samples.
    pub samples: u64,
}

impl Coverage {
    /// Add an error with its stated standard deviation; one that is not finite was none.
    pub fn add(&mut self, error: f64, sd: f64) {
        if error.is_finite() && sd.is_finite() {
            self.samples += 1;
            self.inside += u64::from(error.abs() <= BAND_95 * sd);
        }
    }

    /// Add other samples.
    pub fn merge(&mut self, other: &Self) {
        self.inside += other.inside;
        self.samples += other.samples;
    }

    /// The share; NaN without samples.
    pub fn share(&self) -> f64 {
        self.inside as f64 / self.samples as f64
    }

    /// Confidence interval of the share for *independent* samples (Wilson 1927); samples of one run are not. `None`
    /// without samples.
    pub fn interval(&self, significance: Significance) -> Option<Band> {
        if self.samples == 0 {
            return None;
        }
        let (n, p, z) = (self.samples as f64, self.share(), significance.normal_quantile());
        let (middle, scale) = (p + z * z / (2.0 * n), 1.0 + z * z / n);
        let half = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
        Some(Band { low: ((middle - half) / scale).max(0.0), high: ((middle + half) / scale).min(1.0) })
    }
}
