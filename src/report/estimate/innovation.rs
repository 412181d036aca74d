//! Statistics of the innovations, sensor by sensor, and what they say of the filter.
//!
//! Sizes and whiteness are those of [`RunConsistency`], in fixed room. This observer states its noise too large on purpose, since
//! the errors of its model are not white; so its innovations are smaller than stated and correlated, and a mean of
//! their squares above 1 is a warning.
use crate::estimator::consistency::{ConsistencyReport, RunConsistency, Significance};
use crate::estimator::observer::{Innovation, Outcome};

/// Counts and statistics of the innovations of a run.
#[derive(Clone, Debug)]
pub(crate) struct Innovations {
    counts: Vec<Counts>,
    consistency: RunConsistency,
}

/// What became of the readings of a sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    /// Readings that were used, also those that were taken after too many refusals.
    pub used: u64,
    /// Readings that were refused.
    pub rejected: u64,
    /// Rows without a reading.
    pub missing: u64,
}

impl Innovations {
    /// For sensors of these names.
    pub(crate) fn new(names: &[String]) -> Self {
        let consistency = RunConsistency::new(names, RunConsistency::LAGS);
        Self { counts: vec![Counts::default(); names.len()], consistency }
    }

    /// Counts the innovations of a row.
    pub(crate) fn push(&mut self, innovations: &[Innovation]) {
        for (counts, innovation) in self.counts.iter_mut().zip(innovations) {
            match innovation.outcome {
                Outcome::Missing => counts.missing += 1,
                Outcome::Rejected => counts.rejected += 1,
                Outcome::Accepted | Outcome::Reacquired => counts.used += 1,
            }
        }
        self.consistency.record_innovations(innovations);
    }

    /// Counts in the order of the sensors.
    pub(crate) fn counts(&self) -> &[Counts] {
        &self.counts
    }

    /// Sizes and whiteness with what they say, at one in a hundred.
    pub(crate) fn report(&self) -> ConsistencyReport {
        self.consistency.report(Significance::ONE_PERCENT)
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

    #[test]
    fn readings_are_counted_by_what_became_of_them_and_judged_before_their_gate() {
        let mut all = Innovations::new(&["shoulder".to_owned()]);
        let outcomes = [Outcome::Accepted, Outcome::Rejected, Outcome::Missing, Outcome::Reacquired];
        for (nu, outcome) in [2.0, 6.0, f64::NAN, -4.0].into_iter().zip(outcomes) {
            all.push(&[Innovation { nu, s: if nu.is_nan() { nu } else { 4.0 }, outcome }]);
        }
        assert_eq!(all.counts(), [Counts { used: 2, rejected: 1, missing: 1 }]);
        // (1 + 9 + 4) / 3 of all, 1 of the one that its gate passed.
        let nis = all.report().outputs[0].nis;
        assert_relative_eq!(nis.mean, 14.0 / 3.0);
        assert_relative_eq!(nis.mean_accepted, 1.0);
    }
}
