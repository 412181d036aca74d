//! Run lengths by simulation, with the standard error of their mean.
use cylwatch_detector::statistic::Statistic;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// A mean over runs and its standard error.
#[derive(Clone, Copy, Debug)]
pub struct Mean {
    pub mean: f64,
    pub error: f64,
}

impl Mean {
    pub fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
        Self { mean, error: (variance / n).sqrt() }
    }

    /// Within four standard errors, and these small enough to see a relative error of `resolution`.
    pub fn agrees(&self, expected: f64, resolution: f64) -> bool {
        (self.mean - expected).abs() < 4.0 * self.error && 4.0 * self.error < resolution * expected
    }
}

/// Mean run length of a statistic to `threshold` on AR(1) samples of unit variance about `mean`, from the
/// stationary distribution.
pub fn run_length<S: Statistic<Sample = f64>>(
    new: impl Fn() -> S,
    threshold: f64,
    (mean, phi): (f64, f64),
    runs: usize,
    seed: u64,
) -> Mean {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let lengths: Vec<f64> = (0..runs)
        .map(|_| {
            let mut statistic = new();
            let mut e: f64 = random.sample(StandardNormal);
            let mut n = 1.0;
            while statistic.update(mean + e) < threshold {
                e = phi * e + (1.0 - phi * phi).sqrt() * random.sample::<f64, _>(StandardNormal);
                n += 1.0;
            }
            n
        })
        .collect();
    Mean::of(&lengths)
}
