//! Mean time between false alarms from a count, with its confidence interval.
//!
//! Alarms of a detector that starts anew after each are nearly a Poisson process (a rare event of a process with short
//! memory). For `n` alarms in the time `T` the exact interval of the mean time is
//! `2T/chi2(1 - a/2; 2n + 2)` to `2T/chi2(a/2; 2n)`, endless above if there was none.
//!
//! Source: F. Garwood, Biometrika 28 (1936) 437.
use serde::{Deserialize, Serialize};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::ResidualSource;

/// Alarms counted without a change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FalseAlarms {
    /// Number of alarms.
    pub alarms: u64,
    /// Samples that were judged.
    pub samples: f64,
}

impl FalseAlarms {
    /// Mean number of samples between alarms; infinite if there was none.
    pub fn mean(&self) -> f64 {
        self.samples / self.alarms as f64
    }

    /// Lower and upper bound of the mean at a confidence level below 1, such as 0.95.
    pub fn interval(&self, level: f64) -> (f64, f64) {
        let tail = 0.5 * (1.0 - level.clamp(0.0, 1.0 - 1e-12));
        let quantile = |freedom: u64, probability: f64| {
            let chi_square =
                ChiSquared::new(freedom as f64).expect("a positive number of degrees of freedom");
            chi_square.inverse_cdf(probability)
        };
        let low = 2.0 * self.samples / quantile(2 * self.alarms + 2, 1.0 - tail);
        let high = match self.alarms {
            0 => f64::INFINITY,
            alarms => 2.0 * self.samples / quantile(2 * alarms, tail),
        };
        (low, high)
    }
}

/// Alarms at `threshold` over so many samples. Detector and source start anew after each alarm, so that the mean is that
/// of the time to a first alarm also for residuals that remember the last one.
pub fn count_alarms<S: ResidualSource, D: FnMut(S::Sample) -> f64>(
    source: &mut S,
    detector: impl Fn() -> D,
    threshold: f64,
    samples: u64,
) -> FalseAlarms {
    let mut running = detector();
    let mut alarms = 0;
    source.begin(0);
    for _ in 0..samples {
        if running(source.next_residual()) >= threshold {
            alarms += 1;
            source.begin(alarms);
            running = detector();
        }
    }
    FalseAlarms { alarms, samples: samples as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_interval_is_garwoods() {
        // Tables of the Poisson distribution: 10 events, 95 %: 4.795 to 18.39; none: 0 to 3.689.
        let (low, high) = FalseAlarms { alarms: 10, samples: 1000.0 }.interval(0.95);
        assert_relative_eq!(low, 1000.0 / 18.390, max_relative = 1e-4);
        assert_relative_eq!(high, 1000.0 / 4.7954, max_relative = 1e-4);
        let (low, high) = FalseAlarms { alarms: 0, samples: 1000.0 }.interval(0.95);
        assert_relative_eq!(low, 1000.0 / 3.6889, max_relative = 1e-4);
        assert_eq!(high, f64::INFINITY);
    }
}
