//! Statistics of the innovations, sensor by sensor.
//!
//! With `z = nu / sqrt(S)` of an accepted reading: NIS per reading `mean(z^2)` (1 for a filter whose noise is what it
//! says; this observer states its noise too large on purpose and stays below), and the autocorrelation of `z` from one
//! row to the next, which is 0 for white innovations and near 1 for slow model errors.
use crate::estimator::observer::{Innovation, Outcome};

/// Sums over the innovations of every sensor.
#[derive(Clone, Debug)]
pub struct Innovations {
    sensors: Vec<Sums>,
}

#[derive(Clone, Copy, Debug)]
struct Sums {
    accepted: u64,
    rejected: u64,
    missing: u64,
    /// Innovations in the sums below.
    count: u64,
    sum: f64,
    squares: f64,
    /// Products of neighbours and their number.
    products: f64,
    pairs: u64,
    last: f64,
}

/// Statistics of one sensor's innovations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorStatistics {
    /// Readings that were used, also those that were taken after too many refusals.
    pub accepted: u64,
    /// Readings that were refused.
    pub rejected: u64,
    /// Rows without a reading.
    pub missing: u64,
    /// Mean of the squared normalised innovations; NaN without a used reading.
    pub nis: f64,
    /// Autocorrelation of the normalised innovations from row to row; NaN below two rows.
    pub autocorrelation: f64,
}

impl Innovations {
    /// For so many sensors.
    pub fn new(sensors: usize) -> Self {
        let none = Sums {
            accepted: 0,
            rejected: 0,
            missing: 0,
            count: 0,
            sum: 0.0,
            squares: 0.0,
            products: 0.0,
            pairs: 0,
            last: f64::NAN,
        };
        Self { sensors: vec![none; sensors] }
    }

    /// Counts the innovations of a row.
    pub fn push(&mut self, innovations: &[Innovation]) {
        for (sums, innovation) in self.sensors.iter_mut().zip(innovations) {
            match innovation.outcome {
                Outcome::Missing => sums.missing += 1,
                Outcome::Rejected => sums.rejected += 1,
                Outcome::Accepted | Outcome::Reacquired => sums.accepted += 1,
            }
            if innovation.outcome != Outcome::Accepted {
                sums.last = f64::NAN;
                continue;
            }
            let z = normalised(innovation);
            sums.count += 1;
            sums.sum += z;
            sums.squares += z * z;
            if !sums.last.is_nan() {
                sums.products += z * sums.last;
                sums.pairs += 1;
            }
            sums.last = z;
        }
    }

    /// Statistics in the order of the sensors.
    pub fn statistics(&self) -> Vec<SensorStatistics> {
        let of = |sums: &Sums| {
            let count = sums.count as f64;
            let (mean, square) = (sums.sum / count, sums.squares / count);
            let variance = square - mean * mean;
            SensorStatistics {
                accepted: sums.accepted,
                rejected: sums.rejected,
                missing: sums.missing,
                nis: square,
                autocorrelation: (sums.products / sums.pairs as f64 - mean * mean) / variance,
            }
        };
        self.sensors.iter().map(of).collect()
    }
}

/// Innovation in its own standard deviations; NaN where there is none.
pub(super) fn normalised(innovation: &Innovation) -> f64 {
    innovation.nu / innovation.s.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn of(values: impl Iterator<Item = f64>) -> SensorStatistics {
        let mut all = Innovations::new(1);
        for nu in values {
            all.push(&[Innovation { nu, s: 4.0, outcome: Outcome::Accepted }]);
        }
        all.statistics()[0]
    }

    #[test]
    fn alternating_innovations_are_anticorrelated_and_constant_drift_correlated() {
        let alternating = of((0..10_000).map(|k| if k % 2 == 0 { 2.0 } else { -2.0 }));
        assert_relative_eq!(alternating.nis, 1.0);
        assert_relative_eq!(alternating.autocorrelation, -1.0, epsilon = 1e-6);
        // A sine of period n has the autocorrelation cos(2 pi / n).
        let step = std::f64::consts::TAU / 100.0;
        let slow = of((0..100_000).map(|k| (f64::from(k) * step).sin()));
        assert_relative_eq!(slow.autocorrelation, step.cos(), epsilon = 1e-4);
        assert_relative_eq!(slow.nis, 0.125, epsilon = 1e-9);
    }

    #[test]
    fn refused_and_missing_readings_are_counted_and_break_the_chain() {
        let mut all = Innovations::new(1);
        let rejected = Innovation { nu: 1e3, s: 1.0, outcome: Outcome::Rejected };
        for innovation in [Innovation::MISSING, rejected] {
            all.push(&[Innovation { nu: 1.0, s: 1.0, outcome: Outcome::Accepted }]);
            all.push(&[innovation]);
        }
        let found = all.statistics()[0];
        assert_eq!((found.accepted, found.rejected, found.missing, found.nis), (2, 1, 1, 1.0));
        assert!(found.autocorrelation.is_nan());
    }
}
