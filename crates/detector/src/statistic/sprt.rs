//! Sequential probability ratio test: is there a step from the first sample on, or none?
//!
//! `L_n = L_{n-1} + ln f1(x_n)/f0(x_n)`; there is one at `L_n >= a`, none at `L_n <= -b`. For the error
//! probabilities `alpha` (step claimed, none there) and `beta` (step missed) Wald's bounds are
//! `a = ln((1 - beta)/alpha)`, `b = ln((1 - alpha)/beta)`; they ignore the overshoot and so keep below the stated
//! errors; [`crate::calibrate::sprt_bounds`] finds the bounds that have them.
//!
//! Assumes independent normal samples of unit variance. Of all tests with its errors it needs the fewest samples.
//!
//! Source: A. Wald, Ann. Math. Stat. 16 (1945) 117; A. Wald and J. Wolfowitz, Ann. Math. Stat. 19 (1948) 326.
use serde::{Deserialize, Serialize};

use super::{Statistic, log_likelihood_ratio};
use crate::{DetectorError, error::positive};

/// What the test says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum SprtDecision {
    /// Not yet anything.
    Undecided,
    /// There is a step.
    Change,
    /// There is none.
    NoChange,
}

/// Wald's test; once decided it stays so until reset.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sprt {
    shift: f64,
    upper: f64,
    lower: f64,
    sum: f64,
    samples: u64,
}

impl Sprt {
    /// For a step of `shift` standard deviations, decided at the log-likelihood ratios `upper` and `-lower`.
    ///
    /// # Errors
    /// `shift` is zero or not finite, or a bound is not positive.
    pub fn try_new(shift: f64, upper: f64, lower: f64) -> Result<Self, DetectorError> {
        if shift == 0.0 || !shift.is_finite() {
            return Err(DetectorError::Setting { setting: "shift", value: shift, bound: "finite, not zero" });
        }
        let (upper, lower) = (positive("upper", upper)?, positive("lower", lower)?);
        Ok(Self { shift, upper, lower, sum: 0.0, samples: 0 })
    }

    /// What follows from the samples so far.
    pub fn decision(&self) -> SprtDecision {
        if self.sum >= self.upper {
            SprtDecision::Change
        } else if self.sum <= -self.lower {
            SprtDecision::NoChange
        } else {
            SprtDecision::Undecided
        }
    }

    /// Number of samples used.
    pub fn samples(&self) -> u64 {
        self.samples
    }
}

impl Statistic for Sprt {
    type Sample = f64;

    fn update(&mut self, value: f64) -> f64 {
        if value.is_finite() && self.decision() == SprtDecision::Undecided {
            self.sum += log_likelihood_ratio(value, self.shift);
            self.samples += 1;
        }
        self.sum
    }

    fn value(&self) -> f64 {
        self.sum
    }

    fn reset(&mut self) {
        self.sum = 0.0;
        self.samples = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decision_stands_against_later_samples() {
        let mut test = Sprt::try_new(1.0, 4.0, 3.0).unwrap();
        test.update(5.0);
        assert_eq!(test.decision(), SprtDecision::Change);
        test.update(-100.0);
        assert_eq!((test.decision(), test.samples(), test.value()), (SprtDecision::Change, 1, 4.5));
        test.reset();
        test.update(-2.5);
        assert_eq!(test.decision(), SprtDecision::NoChange);
    }
}
