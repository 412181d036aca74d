//! Shiryaev-Roberts: likelihood of a step, summed over all onsets instead of maximised.
//!
//! `R_n = (1 + R_{n-1}) f1(x_n)/f0(x_n)`, alarm at `R_n >= A`. The statistic is `ln R`; the state is `ln(1 + R)`,
//! finite from the start and without overflow: `ln R_n = ln(1 + R_{n-1}) + llr(x_n)`.
//!
//! Assumes independent normal samples of unit variance and a step of known size. `R_n - n` is a martingale without
//! a change, so the mean time between false alarms is `E R_T >= A`. Of all procedures with that mean time it has the
//! shortest mean delay for a change long after the start, averaged over its onset.
//!
//! Source: A. N. Shiryaev, Theory Probab. Appl. 8 (1963) 22; S. W. Roberts, Technometrics 8 (1966) 411;
//! M. Pollak and A. G. Tartakovsky, Statistica Sinica 19 (2009) 1729.
use serde::{Deserialize, Serialize};

use super::{Statistic, log_likelihood_ratio};
use crate::DetectorError;

/// Logarithm of the Shiryaev-Roberts statistic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShiryaevRoberts {
    shift: f64,
    /// `ln(1 + R)`.
    log_one_plus: f64,
}

impl ShiryaevRoberts {
    /// Step to be found, in standard deviations; negative for a decrease.
    ///
    /// # Errors
    /// `shift` is zero or not finite.
    pub fn try_new(shift: f64) -> Result<Self, DetectorError> {
        if shift == 0.0 || !shift.is_finite() {
            return Err(DetectorError::Setting { setting: "shift", value: shift, bound: "finite, not zero" });
        }
        Ok(Self { shift, log_one_plus: 0.0 })
    }
}

/// `ln(1 + e^x)` without overflow.
pub(crate) fn softplus(x: f64) -> f64 {
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}

impl Statistic for ShiryaevRoberts {
    type Sample = f64;

    fn update(&mut self, value: f64) -> f64 {
        if value.is_finite() {
            let log_r = self.log_one_plus + log_likelihood_ratio(value, self.shift);
            self.log_one_plus = softplus(log_r);
            return log_r;
        }
        self.value()
    }

    /// Minus infinity before the first sample.
    fn value(&self) -> f64 {
        self.log_one_plus + (-(-self.log_one_plus).exp_m1()).ln()
    }

    fn reset(&mut self) {
        self.log_one_plus = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn it_is_the_sum_of_the_likelihood_ratios_over_all_onsets() {
        let (shift, values) = (0.8, [0.3, -1.2, 2.0, 0.7, -0.1, 1.9]);
        let mut statistic = ShiryaevRoberts::try_new(shift).unwrap();
        for n in 1..=values.len() {
            let sum: f64 = (0..n)
                .map(|k| {
                    values[k..n].iter().map(|x| (shift * x - 0.5 * shift * shift).exp()).product::<f64>()
                })
                .sum();
            assert_relative_eq!(statistic.update(values[n - 1]), sum.ln(), max_relative = 1e-12);
            assert_relative_eq!(statistic.value(), sum.ln(), max_relative = 1e-12);
        }
    }

    #[test]
    fn a_million_samples_after_a_step_do_not_overflow() {
        let mut statistic = ShiryaevRoberts::try_new(1.0).unwrap();
        (0..1_000_000).for_each(|_| {
            statistic.update(5.0);
        });
        assert_relative_eq!(statistic.value(), 4.5e6, max_relative = 1e-6);
    }
}
