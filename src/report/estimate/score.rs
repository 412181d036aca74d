//! How near the estimates are to a truth that the log knows.
use crate::estimator::observer::Estimate;
use crate::log::Truth;

/// Differences of estimate and truth, as sums.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spread {
    count: u64,
    sum: f64,
    squares: f64,
    largest: f64,
    /// How often the truth lay within two standard deviations.
    covered: u64,
}

impl Spread {
    /// Counts a difference where both are known; `sd` is what the estimate says of itself.
    fn push(&mut self, difference: f64, sd: f64) {
        if !difference.is_finite() {
            return;
        }
        self.count += 1;
        self.sum += difference;
        self.squares += difference * difference;
        self.largest = self.largest.max(difference.abs());
        self.covered += u64::from(difference.abs() <= 2.0 * sd);
    }

    /// Rows that count.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// Mean difference; NaN without rows.
    pub(crate) fn mean(&self) -> f64 {
        self.sum / self.count as f64
    }

    /// Root of the mean square; NaN without rows.
    pub(crate) fn rms(&self) -> f64 {
        (self.squares / self.count as f64).sqrt()
    }

    /// Largest difference in size.
    pub(crate) fn largest(&self) -> f64 {
        self.largest
    }

    /// Share of rows where the truth lay within two standard deviations; 0.954 of a normal distribution do.
    pub(crate) fn covered(&self) -> f64 {
        self.covered as f64 / self.count as f64
    }
}

/// Estimates against the truth, row by row. SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Score {
    /// Mean gas temperature, K.
    pub gas_mean_k: Spread,
    /// Gas mass, kg.
    pub mass_kg: Spread,
    /// Leak rate, kg/s.
    pub leak_kg_s: Spread,
}

impl Score {
    /// Counts a row.
    pub(crate) fn push(&mut self, estimate: &Estimate, truth: &Truth) {
        self.gas_mean_k.push(estimate.gas_mean_k - truth.gas_mean_k, estimate.gas_mean_sd_k);
        self.mass_kg.push(estimate.mass_kg - truth.mass_kg, estimate.mass_sd_kg);
        self.leak_kg_s.push(estimate.leak_kg_s - truth.outflow_kg_s, estimate.leak_sd_kg_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_spread_of_three_four_and_nothing_is_that_of_three_and_four() {
        let mut spread = Spread::default();
        for (difference, sd) in [(3.0, 1.0), (f64::NAN, 1.0), (-4.0, 2.0)] {
            spread.push(difference, sd);
        }
        assert_eq!((spread.count(), spread.mean(), spread.largest(), spread.covered()), (2, -0.5, 4.0, 0.5));
        assert_relative_eq!(spread.rms(), 12.5_f64.sqrt());
    }
}
