//! Noise of residuals, white or Ornstein-Uhlenbeck, and its exact whitening at uneven intervals.
//!
//! An Ornstein-Uhlenbeck process of standard deviation `sigma` and correlation time `tau`, sampled after the
//! interval `dt`, is `e_n = phi e_{n-1} + w_n` with `phi = exp(-dt/tau)` and `Var w_n = sigma^2 (1 - phi^2)`; at even
//! intervals an AR(1) process. So `w_n / sd(w_n)` is independent with unit variance whatever the intervals are.
//! The first sample has no predecessor: `phi = 0`. White noise is `tau = 0`.
//!
//! Source: G. E. Uhlenbeck and L. S. Ornstein, Phys. Rev. 36 (1930) 823; P. J. Brockwell and R. A. Davis, Time
//! Series: Theory and Methods, 1991.
use serde::{Deserialize, Serialize};

use super::Residual;
use crate::{DetectorError, error::positive};

/// Stationary noise of residuals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Noise {
    /// Standard deviation of a residual, in its unit.
    pub sd: f64,
    /// Correlation time, s; 0: white.
    pub correlation_time_s: f64,
}

impl Noise {
    /// Independent residuals.
    pub fn white(sd: f64) -> Self {
        Self { sd, correlation_time_s: 0.0 }
    }

    /// Residuals with the correlation `exp(-dt/correlation_time_s)`.
    pub fn ornstein_uhlenbeck(sd: f64, correlation_time_s: f64) -> Self {
        Self { sd, correlation_time_s }
    }

    /// AR(1) residuals of coefficient `phi` at even intervals.
    pub fn ar1(sd: f64, phi: f64, interval_s: f64) -> Self {
        Self { sd, correlation_time_s: if phi > 0.0 { -interval_s / phi.ln() } else { 0.0 } }
    }

    /// Correlation of two residuals so far apart.
    pub fn correlation(&self, interval_s: f64) -> f64 {
        if self.correlation_time_s > 0.0 { (-interval_s / self.correlation_time_s).exp() } else { 0.0 }
    }

    /// # Errors
    /// The standard deviation is not positive or the correlation time negative.
    pub fn validate(&self) -> Result<(), DetectorError> {
        positive("sd", self.sd)?;
        let value = self.correlation_time_s;
        if !(value >= 0.0 && value.is_finite()) {
            let bound = "finite and not negative";
            return Err(DetectorError::Setting { setting: "correlation_time_s", value, bound });
        }
        Ok(())
    }
}

/// What a whitened residual is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whitened {
    /// `w/sd(w)`: independent, unit variance.
    pub value: f64,
    /// Interval since the residual before, s; `None`: the first.
    pub interval_s: Option<f64>,
    /// Correlation with the residual before.
    pub phi: f64,
    /// `sd(w)`, in the unit of the residual.
    pub sd: f64,
}

/// Makes residuals independent and of unit variance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Whitener {
    noise: Noise,
    last: Option<Residual>,
}

impl Whitener {
    /// No residual seen yet.
    ///
    /// # Errors
    /// The noise is not valid.
    pub fn try_new(noise: Noise) -> Result<Self, DetectorError> {
        noise.validate()?;
        Ok(Self { noise, last: None })
    }

    /// Whiten the next residual; `None` if it is not finite or not later than the one before.
    pub fn whiten(&mut self, residual: Residual) -> Option<Whitened> {
        if !(residual.value.is_finite() && residual.time_s.is_finite()) {
            return None;
        }
        let interval_s = self.last.map(|last| residual.time_s - last.time_s);
        if interval_s.is_some_and(|interval_s| interval_s <= 0.0) {
            return None;
        }
        let phi = interval_s.map_or(0.0, |interval_s| self.noise.correlation(interval_s));
        let predicted = self.last.map_or(0.0, |last| phi * last.value);
        // 1 - phi^2 without cancellation when the interval is short against the correlation time.
        let left = match interval_s {
            Some(interval_s) if phi > 0.0 => -(-2.0 * interval_s / self.noise.correlation_time_s).exp_m1(),
            _ => 1.0,
        };
        let sd = self.noise.sd * left.sqrt();
        self.last = Some(residual);
        Some(Whitened { value: (residual.value - predicted) / sd, interval_s, phi, sd })
    }

    /// The noise it assumes.
    pub fn noise(&self) -> Noise {
        self.noise
    }

    /// Forget the last residual.
    pub fn reset(&mut self) {
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn whitened_squares_sum_to_the_quadratic_form_of_the_dense_covariance() {
        let noise = Noise::ornstein_uhlenbeck(0.3, 7.0);
        let time_s: [f64; 6] = [0.0, 0.5, 3.0, 3.1, 20.0, 21.0];
        let value = [0.1, -0.4, 0.2, 0.25, 0.6, -0.1];
        let covariance = DMatrix::from_fn(6, 6, |i, j| 0.09 * (-(time_s[i] - time_s[j]).abs() / 7.0).exp());
        let e = DVector::from_column_slice(&value);
        let expected = e.dot(&covariance.clone().cholesky().unwrap().solve(&e));
        let mut whitener = Whitener::try_new(noise).unwrap();
        let mut product = 1.0;
        let sum: f64 = (0..6)
            .map(|n| whitener.whiten(Residual { time_s: time_s[n], value: value[n] }).unwrap())
            .map(|whitened| {
                product *= whitened.sd * whitened.sd;
                whitened.value.powi(2)
            })
            .sum();
        assert_relative_eq!(sum, expected, max_relative = 1e-12);
        assert_relative_eq!(product, covariance.determinant(), max_relative = 1e-10);
    }

    #[test]
    fn residuals_that_do_not_come_later_are_left_out() {
        let mut whitener = Whitener::try_new(Noise::white(2.0)).unwrap();
        assert!(whitener.whiten(Residual { time_s: 1.0, value: 4.0 }).is_some_and(|w| w.value == 2.0));
        assert!(whitener.whiten(Residual { time_s: 1.0, value: 4.0 }).is_none());
        assert!(whitener.whiten(Residual { time_s: 2.0, value: f64::NAN }).is_none());
    }
}
