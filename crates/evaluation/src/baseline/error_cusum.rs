//! The textbook's cumulative sum on the error, as if errors were independent: what correlation costs is seen on it.
//!
//! `S <- max(0, S + (e - mean)/sd - k)` with `k = 1/2`, for a step of one standard deviation. Mean and standard deviation are known, or
//! those of the first days.
//!
//! Source: E. S. Page, Biometrika 41 (1954) 100.
use super::{PressureError, Reading};

/// Reference value `k`, standard deviations.
const REFERENCE: f64 = 0.5;

/// Cumulative sum of an error, in its standard deviations.
#[derive(Clone, Debug)]
pub struct ErrorCusum {
    error: PressureError,
    learnt_s: f64,
    start_s: Option<f64>,
    /// Number of errors learnt from, their mean, and the sum of squares about it.
    sums: (f64, f64, f64),
    /// Mean and standard deviation, Pa, once they are known.
    scale_pa: Option<(f64, f64)>,
    sum: f64,
}

impl ErrorCusum {
    /// Of an error whose mean and standard deviation without a leak, Pa, are known.
    pub fn known(error: PressureError, mean_pa: f64, sd_pa: f64) -> Self {
        Self { scale_pa: Some((mean_pa, sd_pa)), ..Self::learning(error, 0.0) }
    }

    /// Of an error whose mean and standard deviation are those of its first `learnt_s`, s.
    pub fn learning(error: PressureError, learnt_s: f64) -> Self {
        Self { error, learnt_s, start_s: None, sums: (0.0, 0.0, 0.0), scale_pa: None, sum: 0.0 }
    }

    /// Take a reading; the sum after it, minus infinity while it learns.
    pub fn update(&mut self, reading: Reading) -> f64 {
        let error_pa = self.error.step(reading);
        let Some((mean_pa, sd_pa)) = self.scale_pa else {
            if let Some(error_pa) = error_pa {
                self.learn(reading.time_s, error_pa);
            }
            return f64::NEG_INFINITY;
        };
        if let Some(error_pa) = error_pa {
            self.sum = (self.sum + (error_pa - mean_pa) / sd_pa - REFERENCE).max(0.0);
        }
        self.sum
    }

    fn learn(&mut self, time_s: f64, error_pa: f64) {
        let start_s = *self.start_s.get_or_insert(time_s);
        let (n, mean, squares) = (self.sums.0 + 1.0, self.sums.1, self.sums.2);
        let off = error_pa - mean;
        let mean = mean + off / n;
        self.sums = (n, mean, squares + off * (error_pa - mean));
        let sd = (self.sums.2 / (n - 1.0)).sqrt();
        // An error that does not vary has no standard deviation yet.
        if time_s - start_s >= self.learnt_s && sd > 0.0 {
            self.scale_pa = Some((mean, sd));
        }
    }
}
