//! Moments of the noise processes against their closed forms.
//!
//! Bounds are five standard errors of the estimate for the sample size at hand, so that a right process fails one
//! seed in a million and a process that is off by a few percent fails at once.
use super::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const N: usize = 40_000;

fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn mean(x: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = x.len() as f64;
    x.sum::<f64>() / n
}

/// Autocovariance at a lag of a process with mean 0.
fn autocovariance(x: &[f64], lag: usize) -> f64 {
    mean(x.iter().zip(&x[lag..]).map(|(a, b)| a * b))
}

/// Standard error of an autocovariance estimate of a Gaussian process with autocovariance `c`, by Bartlett's formula
/// `var = sum_m (c(m)^2 + c(m + lag) c(m - lag)) / n`.
fn standard_error(c: impl Fn(i64) -> f64, lag: i64, n: usize) -> f64 {
    let sum: f64 = (-4_000..=4_000).map(|m| c(m) * c(m) + c(m + lag) * c(m - lag)).sum();
    (sum / n as f64).sqrt()
}

fn assert_within(found: f64, expected: f64, error: f64) {
    assert!((found - expected).abs() < 5.0 * error, "{found} is not {expected} within 5 x {error}");
}

#[test]
fn white_noise_has_its_variance_and_no_autocorrelation() {
    let noise = WhiteNoise { sd: 0.05 };
    let mut rng = rng(1);
    let x: Vec<f64> = (0..N).map(|_| noise.next(&mut rng)).collect();
    let c = |m: i64| if m == 0 { 0.0025 } else { 0.0 };
    for lag in [0, 1, 2, 10] {
        assert_within(autocovariance(&x, lag as usize), c(lag), standard_error(c, lag, N));
    }
    assert_within(mean(x.into_iter()), 0.0, 0.05 / (N as f64).sqrt());
}

#[test]
fn gauss_markov_noise_has_the_autocovariance_of_its_differential_equation() {
    let (sd, time_s, dt_s) = (0.4, 120.0, 10.0);
    let mut noise = GaussMarkov::new(sd, time_s);
    let mut rng = rng(2);
    let x: Vec<f64> = (0..N).map(|_| noise.next(dt_s, &mut rng)).collect();
    let c = |m: i64| sd * sd * (-(m.abs() as f64) * dt_s / time_s).exp();
    for lag in [0, 1, 6, 12, 36] {
        assert_within(autocovariance(&x, lag as usize), c(lag), standard_error(c, lag, N));
    }
}

/// Irregular steps: the whitened increments must be standard normal and independent of the value before, and the
/// variance stationary. A discretisation of first order, `a = 1 - dt/T`, fails by far at these steps.
#[test]
fn gauss_markov_noise_is_stationary_under_irregular_steps() {
    let (sd, time_s) = (0.4, 100.0_f64);
    let mut noise = GaussMarkov::new(sd, time_s);
    let (mut rng, mut steps) = (rng(3), rng(4));
    let mut before = noise.next(0.0, &mut rng);
    let (mut squares, mut whitened, mut crossed) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..N {
        let dt_s = steps.random_range(1.0..400.0);
        let value = noise.next(dt_s, &mut rng);
        // Conditional law of the Ornstein-Uhlenbeck process (Uhlenbeck and Ornstein 1930).
        let mean = before * (-dt_s / time_s).exp();
        let sd_given = sd * (1.0 - (-2.0 * dt_s / time_s).exp()).sqrt();
        let n = (value - mean) / sd_given;
        whitened.push(n * n);
        crossed.push(n * before / sd);
        squares.push(value * value);
        before = value;
    }
    let root = (N as f64).sqrt();
    assert_within(mean(whitened.into_iter()), 1.0, 2.0_f64.sqrt() / root);
    assert_within(mean(crossed.into_iter()), 0.0, 1.0 / root);
    // Mean of exp(-2 dt / T) over the steps is below 0.13: at most (1 + 0.13)/(1 - 0.13) times the white noise's error.
    assert_within(mean(squares.into_iter()), sd * sd, 1.15 * sd * sd * 2.0_f64.sqrt() / root);
}

#[test]
fn the_first_value_of_gauss_markov_noise_is_stationary() {
    let mut rng = rng(5);
    let squares: Vec<f64> = (0..N).map(|_| GaussMarkov::new(2.0, 60.0).next(0.0, &mut rng).powi(2)).collect();
    assert_within(mean(squares.into_iter()), 4.0, 4.0 * (2.0 / N as f64).sqrt());
}

#[test]
fn a_random_walk_has_the_covariance_of_brownian_motion() {
    let (q, walks) = (0.3, 20_000);
    // Irregular steps to 1, 7, 7.5, 60 s.
    let steps = [1.0, 6.0, 0.5, 52.5];
    let times = [1.0, 7.0, 7.5, 60.0];
    let mut rng = rng(6);
    let paths: Vec<Vec<f64>> = (0..walks)
        .map(|_| {
            let mut walk = RandomWalk::new(q);
            steps.iter().map(|&dt| walk.next(dt, &mut rng)).collect()
        })
        .collect();
    for i in 0..4 {
        for j in 0..=i {
            let (s, t): (f64, f64) = (times[j], times[i]);
            let covariance = q * q * s.min(t);
            let found = mean(paths.iter().map(|path| path[i] * path[j]));
            // Variance of a product of Gaussians: c_ii c_jj + c_ij^2.
            let error = ((q.powi(4) * s * t + covariance * covariance) / walks as f64).sqrt();
            assert_within(found, covariance, error);
        }
    }
}

#[test]
fn noise_without_size_is_nothing() {
    let mut rng = rng(7);
    assert_eq!(WhiteNoise { sd: 0.0 }.next(&mut rng), 0.0);
    let mut none = GaussMarkov::new(0.0, 0.0);
    assert_eq!([none.next(0.0, &mut rng), none.next(3.0, &mut rng)], [0.0, 0.0]);
    assert_eq!(RandomWalk::new(0.0).next(3.0, &mut rng), 0.0);
}
