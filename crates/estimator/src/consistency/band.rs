//! Quantiles, and the band in which a mean of chi-square variables lies.
use serde::{Deserialize, Serialize};
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal};

use crate::EstimatorError;

/// Probability with which a correct filter is called wrong.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
pub struct Significance(f64);

impl Significance {
    /// One in a hundred.
    pub const ONE_PERCENT: Self = Self(0.01);
    /// One in twenty.
    pub const FIVE_PERCENT: Self = Self(0.05);

    /// A probability between 0 and 1, both excluded.
    ///
    /// # Errors
    /// It is none.
    pub fn try_new(probability: f64) -> Result<Self, EstimatorError> {
        if probability > 0.0 && probability < 1.0 {
            Ok(Self(probability))
        } else {
            Err(EstimatorError::Significance { probability })
        }
    }

    /// The probability.
    pub(crate) fn probability(self) -> f64 {
        self.0
    }

    /// What each of `tests` may use up so that all of them together call a correct filter wrong no more often than this
    /// (Bonferroni).
    pub(crate) fn shared_by(self, tests: usize) -> Self {
        Self(self.0 / tests.max(1) as f64)
    }

    /// Half width of the band of a standard normal variable.
    pub(crate) fn normal_quantile(self) -> f64 {
        Normal::standard().inverse_cdf(1.0 - 0.5 * self.0)
    }
}

/// Values that a correct filter gives, but for the significance, half of which lies on either side.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Band {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Band {
    /// Band of the mean of chi-square variables per degree of freedom, with `dof` degrees in all: `chi^2_dof(p) / dof`.
    /// `None` without any degree of freedom.
    pub(crate) fn of_mean_square(dof: u64, significance: Significance) -> Option<Self> {
        let chi_square = ChiSquared::new(dof as f64).ok()?;
        let half = 0.5 * significance.probability();
        let quantile = |p: f64| chi_square.inverse_cdf(p) / dof as f64;
        Some(Self { low: quantile(half), high: quantile(1.0 - half) })
    }

    /// Whether a value lies in the band.
    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}
