//! Exponentially weighted moving average, in units of its own standard deviation.
//!
//! `z_n = (1 - w) z_{n-1} + w x_n`, `Var z_n = (1 - w)^2 Var z_{n-1} + w^2`, the statistic is `z_n / sd(z_n)`.
//! With even samples the variance is `w/(2 - w) [1 - (1 - w)^(2n)]`: the exact limits, which are narrow at the start.
//! The asymptotic limits divide by `sqrt(w/(2 - w))` from the start. After an interval of `q` nominal ones the
//! weight is `1 - (1 - w)^q`, so that a gap forgets as much as the samples that are missing.
//!
//! Assumes independent samples of unit variance.
//!
//! Source: S. W. Roberts, Technometrics 1 (1959) 239; J. M. Lucas and M. S. Saccucci, Technometrics 32 (1990) 1.
use serde::{Deserialize, Serialize};

use super::{Side, Statistic};
use crate::DetectorError;

/// What the average is divided by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum EwmaLimits {
    /// Its standard deviation after as many samples as there were.
    #[default]
    Exact,
    /// Its standard deviation after many samples.
    Asymptotic,
}

/// Moving average with exponential weights.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ewma {
    weight: f64,
    side: Side,
    limits: EwmaLimits,
    average: f64,
    variance: f64,
}

impl Ewma {
    /// Weight of the newest sample, between 0 and 1.
    ///
    /// # Errors
    /// `weight` is not above 0 and at most 1.
    pub fn try_new(weight: f64, side: Side, limits: EwmaLimits) -> Result<Self, DetectorError> {
        if !(weight > 0.0 && weight <= 1.0) {
            return Err(DetectorError::Setting {
                setting: "weight",
                value: weight,
                bound: "above 0 and at most 1",
            });
        }
        Ok(Self { weight, side, limits, average: 0.0, variance: 0.0 })
    }

    /// Take a sample that comes `intervals` nominal intervals after the one before; the statistic after it.
    pub fn update_after(&mut self, value: f64, intervals: f64) -> f64 {
        if value.is_finite() && intervals > 0.0 {
            let kept = (1.0 - self.weight).powf(intervals);
            let weight = 1.0 - kept;
            self.average = kept * self.average + weight * value;
            self.variance = kept * kept * self.variance + weight * weight;
        }
        self.value()
    }

    /// The moving average itself, in standard deviations of a sample.
    pub fn average(&self) -> f64 {
        self.average
    }
}

impl Statistic for Ewma {
    type Sample = f64;

    fn update(&mut self, value: f64) -> f64 {
        self.update_after(value, 1.0)
    }

    fn value(&self) -> f64 {
        let variance = match self.limits {
            EwmaLimits::Exact => self.variance,
            EwmaLimits::Asymptotic => self.weight / (2.0 - self.weight),
        };
        if variance > 0.0 { self.side.of(self.average) / variance.sqrt() } else { 0.0 }
    }

    fn reset(&mut self) {
        self.average = 0.0;
        self.variance = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn exact_limits_follow_the_closed_form_of_the_variance() {
        let weight: f64 = 0.2;
        let mut statistic = Ewma::try_new(weight, Side::Above, EwmaLimits::Exact).unwrap();
        for n in 1..40 {
            let value = statistic.update(1.0);
            let forgotten = (1.0 - weight).powi(n);
            let variance = weight / (2.0 - weight) * (1.0 - forgotten * forgotten);
            assert_relative_eq!(value, (1.0 - forgotten) / variance.sqrt(), max_relative = 1e-12);
        }
    }

    #[test]
    fn a_gap_forgets_as_much_as_the_missing_samples() {
        let start = Ewma::try_new(0.1, Side::Both, EwmaLimits::Exact).unwrap();
        let mut gap = start;
        let mut even = start;
        for statistic in [&mut gap, &mut even] {
            statistic.update(-3.0);
        }
        gap.update_after(0.0, 4.0);
        (0..4).for_each(|_| {
            even.update(0.0);
        });
        assert_relative_eq!(gap.average(), even.average(), max_relative = 1e-14);
    }

    #[test]
    fn a_weight_of_one_is_shewharts_chart() {
        let mut statistic = Ewma::try_new(1.0, Side::Both, EwmaLimits::Exact).unwrap();
        assert_eq!([1.0, -4.0, 2.0].map(|value| statistic.update(value)), [1.0, 4.0, 2.0]);
    }
}
