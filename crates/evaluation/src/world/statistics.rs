//! Statistics that drawn laws are tested with: bounds that a right law exceeds once in some ten thousand tests.
use statrs::distribution::{ContinuousCDF, Normal};

/// Kolmogorov's bound on `sqrt(n) D` at a probability of 1e-4.
const KOLMOGOROV: f64 = 2.23;

/// A law on an interval.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Law {
    Uniform(f64, f64),
    /// Even by the logarithm.
    Logarithmic(f64, f64),
    /// Normal with a mean and a standard deviation.
    Normal(f64, f64),
}

impl Law {
    fn probability_below(self, x: f64) -> f64 {
        match self {
            Self::Uniform(low, high) => ((x - low) / (high - low)).clamp(0.0, 1.0),
            Self::Logarithmic(low, high) => ((x / low).ln() / (high / low).ln()).clamp(0.0, 1.0),
            Self::Normal(mean, sd) => Normal::standard().cdf((x - mean) / sd),
        }
    }

    fn holds(self, x: f64) -> bool {
        match self {
            Self::Uniform(low, high) | Self::Logarithmic(low, high) => {
                let edge = 1e-9 * (high.abs() + low.abs());
                (low - edge..=high + edge).contains(&x)
            }
            Self::Normal(..) => x.is_finite(),
        }
    }
}

/// Values that are independent have a law: none is outside of it, and Kolmogorov's distance is one that the law has.
#[track_caller]
pub(crate) fn assert_law(what: &str, values: &[f64], law: Law) {
    assert!(values.len() >= 100, "{what}: {} values are too few", values.len());
    let outside = values.iter().find(|&&x| !law.holds(x));
    assert!(outside.is_none(), "{what}: {outside:?} is outside of {law:?}");
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let distance = sorted
        .iter()
        .enumerate()
        .map(|(k, &x)| {
            let p = law.probability_below(x);
            (p - k as f64 / n).abs().max(((k + 1) as f64 / n - p).abs())
        })
        .fold(0.0, f64::max);
    assert!(n.sqrt() * distance < KOLMOGOROV, "{what}: distance {distance} of {n} from {law:?}");
}

/// A share of independent trials is a probability's, by the normal bound.
#[track_caller]
pub(crate) fn assert_share(what: &str, hits: usize, trials: usize, probability: f64) {
    let sd = (probability * (1.0 - probability) * trials as f64).sqrt();
    let off = hits as f64 - probability * trials as f64;
    assert!(off.abs() < 4.0 * sd, "{what}: {hits} of {trials} are not {probability}");
}

/// Counts of equally likely kinds: Pearson's statistic against its normal bound.
#[track_caller]
pub(crate) fn assert_equal_counts(what: &str, counts: &[usize]) {
    let expected = counts.iter().sum::<usize>() as f64 / counts.len() as f64;
    let pearson: f64 = counts.iter().map(|&count| (count as f64 - expected).powi(2) / expected).sum();
    let freedom = (counts.len() - 1) as f64;
    // Wilson and Hilferty: the cube root is normal.
    let normal =
        ((pearson / freedom).cbrt() - (1.0 - 2.0 / (9.0 * freedom))) / (2.0 / (9.0 * freedom)).sqrt();
    assert!(normal < 3.9, "{what}: {counts:?}");
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

pub(crate) fn sd(values: &[f64]) -> f64 {
    let m = mean(values);
    (values.iter().map(|x| (x - m).powi(2)).sum::<f64>() / (values.len() - 1) as f64).sqrt()
}
