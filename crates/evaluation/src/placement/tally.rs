//! Errors of runs, summed up, with intervals over seeds.
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;

use super::Achieved;
use crate::estimator::consistency::{Band, Coverage};

/// Resamples of the bootstrap: its ends move by about 1 % of themselves from seed to seed.
const RESAMPLES: usize = 2000;
/// Seed of the bootstrap.
const SEED: u64 = 95;

/// Errors of one quantity in one run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    count: f64,
    sum: f64,
    squares: f64,
    stated: f64,
    coverage: Coverage,
}

impl Tally {
    /// Add an error with its stated standard deviation; one that is not finite was none.
    pub(super) fn add(&mut self, error: f64, sd: f64) {
        if error.is_finite() && sd.is_finite() {
            self.count += 1.0;
            self.sum += error;
            self.squares += error * error;
            self.stated += sd;
            self.coverage.add(error, sd);
        }
    }

    fn merge(mut self, other: &Self) -> Self {
        self.count += other.count;
        self.sum += other.sum;
        self.squares += other.squares;
        self.stated += other.stated;
        self.coverage.merge(&other.coverage);
        self
    }

    fn rms(&self) -> f64 {
        (self.squares / self.count).sqrt()
    }

    /// Of all runs; `None` where there was no error.
    pub(super) fn achieved(runs: &[Self], predicted: Option<f64>) -> Option<Achieved> {
        let all = runs.iter().fold(Self::default(), |all, run| all.merge(run));
        if all.count == 0.0 {
            return None;
        }
        let mut rng = ChaCha12Rng::seed_from_u64(SEED);
        let resample = |_| {
            (0..runs.len())
                .fold(Self::default(), |drawn, _| drawn.merge(&runs[rng.random_range(0..runs.len())]))
        };
        let resamples: Vec<Self> = (0..RESAMPLES).map(resample).filter(|drawn| drawn.count > 0.0).collect();
        Some(Achieved {
            predicted,
            stated: all.stated / all.count,
            rms: all.rms(),
            interval: percentiles(resamples.iter().map(Self::rms).collect()),
            bias: all.sum / all.count,
            coverage: all.coverage.share(),
            coverage_interval: percentiles(resamples.iter().map(|drawn| drawn.coverage.share()).collect()),
        })
    }
}

/// The middle 95 %.
fn percentiles(mut values: Vec<f64>) -> Band {
    values.sort_by(f64::total_cmp);
    let at = |part: f64| {
        let place = (part * values.len() as f64) as usize;
        values.get(place.min(values.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
    };
    Band { low: at(0.025), high: at(0.975) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use rand_distr::{Distribution, StandardNormal};

    fn runs(count: usize, rng: &mut ChaCha12Rng) -> Vec<Tally> {
        let run = |_| {
            let mut tally = Tally::default();
            (0..4).for_each(|_| tally.add(StandardNormal.sample(rng), 1.0));
            tally
        };
        (0..count).map(run).collect()
    }

    #[test]
    fn the_bootstrap_interval_holds_the_true_rms_in_nineteen_of_twenty_studies() {
        let mut rng = ChaCha12Rng::seed_from_u64(1);
        let holds = (0..200)
            .filter(|_| Tally::achieved(&runs(50, &mut rng), None).unwrap().interval.contains(1.0))
            .count();
        assert!((180..=198).contains(&holds), "{holds} of 200");
    }

    #[test]
    fn bias_stated_and_coverage_are_those_of_all_times_and_no_number_is_no_error() {
        let mut tally = Tally::default();
        tally.add(3.0, 1.0);
        tally.add(-1.0, 2.0);
        tally.add(f64::NAN, 1.0);
        let achieved = Tally::achieved(&[tally], Some(2.0)).unwrap();
        assert_relative_eq!(achieved.rms, 5.0_f64.sqrt());
        assert_eq!((achieved.bias, achieved.stated, achieved.coverage), (1.0, 1.5, 0.5));
        assert_relative_eq!(achieved.ratio().unwrap(), 5.0_f64.sqrt() / 2.0);
        assert!(Tally::achieved(&[Tally::default()], None).is_none());
    }
}
