//! How near an estimator comes to a bound.
use serde::Serialize;

use crate::EstimatorError;
use crate::consistency::{Band, Significance};

/// Smallest possible standard deviation over the one achieved, with a confidence interval.
///
/// 1: nothing can be better. Above 1: chance, a biased estimator, or a bound that errs to the high side.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Efficiency {
    /// `sqrt(bound / MSE)`.
    pub ratio: f64,
    /// Ends of its confidence interval.
    pub interval: Band,
    /// Number of runs.
    pub runs: usize,
}

impl Efficiency {
    /// Over a stretch of time: the bounds' sum over its samples, and for each independent run the sum of its squared errors.
    /// Errors within a run may depend on each other; the interval comes from the spread between runs (normal).
    ///
    /// # Errors
    /// There are fewer than two runs, or the errors are all zero or not finite.
    pub fn over_time(
        bounds: f64,
        squared_errors: &[f64],
        significance: Significance,
    ) -> Result<Self, EstimatorError> {
        let runs = squared_errors.len();
        let mean = squared_errors.iter().sum::<f64>() / runs as f64;
        if runs < 2 || !mean.is_finite() || mean <= 0.0 {
            return Err(EstimatorError::NoErrors { runs });
        }
        let spread = squared_errors.iter().map(|sum| (sum - mean).powi(2)).sum::<f64>() / (runs - 1) as f64;
        let half = significance.normal_quantile() * (spread / runs as f64).sqrt();
        let end = |mean: f64| (bounds / mean.max(0.0)).sqrt();
        Ok(Self { ratio: end(mean), interval: Band { low: end(mean + half), high: end(mean - half) }, runs })
    }
}
