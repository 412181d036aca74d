//! What the truths claim about themselves, held against the laws that are stated for them.
mod cylinder;
mod file;
mod generated;
mod happenings;
mod random;
mod readings;
mod weather;

/// Largest distance between the distribution of values and the uniform one between two bounds, times the
/// root of their number (Kolmogorov's statistic).
fn distance_from_uniform(values: &[f64], (low, high): (f64, f64)) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    let n = values.len() as f64;
    let distance = |(index, value): (usize, &f64)| {
        let share = (value - low) / (high - low);
        (share - index as f64 / n).abs().max(((index + 1) as f64 / n - share).abs())
    };
    values.iter().enumerate().map(distance).fold(0.0, f64::max) * n.sqrt()
}

/// Values inside two bounds, filling them, and as evenly spread as one set in ten thousand is not.
fn assert_uniform(what: &str, values: &[f64], bounds: (f64, f64)) {
    let (low, high) = bounds;
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert!(least >= low && most <= high, "{what}: {least} to {most} outside {low} to {high}");
    let distance = distance_from_uniform(values, bounds);
    // Kolmogorov: a uniform sample exceeds 2.23 with probability 2 exp(-2 * 2.23^2) = 1e-4.
    assert!(distance < 2.23, "{what}: Kolmogorov's statistic {distance:.2}, {least} to {most}");
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Mean of the product of deviations from the means.
fn covariance(a: &[f64], b: &[f64]) -> f64 {
    let (mean_a, mean_b) = (mean(a), mean(b));
    a.iter().zip(b).map(|(a, b)| (a - mean_a) * (b - mean_b)).sum::<f64>() / a.len() as f64
}

fn sd(values: &[f64]) -> f64 {
    covariance(values, values).sqrt()
}
