//! Covariance of the parameters.
//!
//! With instruments `z` and the matrix `M` of the equations, the error of the parameters is `M^-1 sum z_k e_k`. White errors of a
//! least-squares method: `sigma^2 (sum z z^T)^-1` with `sigma^2 = sum e^2/(N - d)`. Otherwise `M^-1 V M^-T` with
//! `V = sum_l w(l) r_e(l) sum_k z_k z_(k+l)^T`, for stationary errors of the autocovariance `r_e`. The window `w` is one up to
//! the lag `L/2` and falls to zero at `L`: no bias from lags that matter, no noise from those that do not. Long windows are summed
//! at lags that lie ever wider apart, by the trapezoidal rule.
//!
//! Source: Ljung 1999 (section 9.2), Politis and Romano 1995 (the window).
use nalgebra::DMatrix;

use super::equations::Equations;
use crate::least_squares::invert;

/// Window in multiples of the errors' memory.
const WINDOW: f64 = 6.0;
/// Lags that are all summed; beyond them each is this share further than the last.
const ALL_LAGS: usize = 24;
const WIDENING: f64 = 0.08;

/// Covariance for white errors.
pub(super) fn white(equations: &Equations) -> Option<DMatrix<f64>> {
    let (parameters, samples) = equations.instruments.shape();
    let variance = equations.sse / (samples - parameters) as f64;
    let inverse = invert(&(&equations.instruments * equations.instruments.transpose()))?;
    valid(inverse * variance)
}

/// Covariance for errors correlated over about `memory` samples.
pub(super) fn coloured(equations: &Equations, memory: f64) -> Option<DMatrix<f64>> {
    let (parameters, samples) = equations.instruments.shape();
    let width = ((WINDOW * memory).ceil() as usize + 2).min(samples / 4).max(1);
    let bread = invert(&equations.matrix)?;
    let degrees = samples as f64 / (samples - parameters) as f64;
    let of = |flat: f64, lags: &[(usize, f64)]| {
        let meat = long_run(equations, width, flat, lags);
        valid(&bread * meat * bread.transpose() * degrees)
    };
    let (some, every) = (lags(width), || (0..width).map(|lag| (lag, 1.0)).collect::<Vec<_>>());
    // The flat window may make a variance negative, and so may lags far apart if errors alternate; a triangle over every lag
    // never does.
    of(0.5, &some).or_else(|| of(0.0, &some)).or_else(|| of(0.0, &every()))
}

/// `V`, with a window that is flat over a share of its width.
fn long_run(equations: &Equations, width: usize, flat: f64, lags: &[(usize, f64)]) -> DMatrix<f64> {
    let (z, e) = (&equations.instruments, &equations.errors);
    let (parameters, samples) = z.shape();
    let mut sum = DMatrix::zeros(parameters, parameters);
    for &(lag, weight) in lags {
        let share = lag as f64 / width as f64;
        let window = if share <= flat { 1.0 } else { (1.0 - share) / (1.0 - flat) };
        let overlap = samples - lag;
        let covariance = e.rows(0, overlap).dot(&e.rows(lag, overlap)) / samples as f64;
        let product = z.columns(0, overlap) * z.columns(lag, overlap).transpose();
        let both = if lag == 0 { product } else { &product + product.transpose() };
        sum += both * (weight * window * covariance);
    }
    sum
}

/// Lags below a width with the number of lags that each stands for.
fn lags(width: usize) -> Vec<(usize, f64)> {
    let mut lags: Vec<usize> = (0..width.min(ALL_LAGS)).collect();
    while let Some(&last) = lags.last().filter(|last| **last >= ALL_LAGS - 1) {
        let next = last + 1 + (last as f64 * WIDENING) as usize;
        if next >= width {
            break;
        }
        lags.push(next);
    }
    let last = lags.len() - 1;
    let apart = |i: usize| (lags[i] - lags[i - 1]) as f64;
    // Each lag of the dense part stands for itself; beyond, half way to either neighbour.
    let weight = |i: usize| match i {
        0 => 1.0,
        _ if i < last => 0.5 * (apart(i) + apart(i + 1)),
        // The window ends at zero.
        _ => 0.5 * (apart(i) + (width - lags[i]) as f64),
    };
    (0..=last).map(|i| (lags[i], weight(i))).collect()
}

fn valid(covariance: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let symmetric = (&covariance + covariance.transpose()) * 0.5;
    let good = symmetric.diagonal().iter().all(|variance| variance.is_finite() && *variance >= 0.0);
    good.then_some(symmetric)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::DVector;

    use super::*;

    fn equations(samples: usize) -> Equations {
        let wave = |k: usize, rate: f64| (k as f64 * rate).sin();
        let instruments = DMatrix::from_fn(2, samples, |i, k| if i == 0 { 1.0 } else { wave(k, 0.05) });
        let errors = DVector::from_fn(samples, |k, _| wave(k, 1.7) + 0.5 * wave(k, 0.3));
        let matrix = &instruments * instruments.transpose();
        Equations { rhs: &instruments * &errors, sse: errors.norm_squared(), matrix, instruments, errors }
    }

    #[test]
    fn errors_that_alternate_with_a_period_have_a_variance_too() {
        let square = |k: usize| ((k * 7 % 5) as f64 - 2.0) + 0.5 * ((k * 11 % 7) as f64 - 3.0);
        let instruments = DMatrix::from_fn(2, 400, |i, k| if i == 0 { 1.0 } else { (k / 40 % 5) as f64 });
        let errors = DVector::from_fn(400, |k, _| square(k));
        let matrix = &instruments * instruments.transpose();
        let equations = Equations {
            rhs: &instruments * &errors,
            sse: errors.norm_squared(),
            matrix,
            instruments,
            errors,
        };
        for memory in [1.0, 5.0, 20.0, 60.0] {
            assert!(coloured(&equations, memory).is_some(), "{memory}");
        }
    }

    #[test]
    fn the_sum_over_lags_is_the_dense_double_sum() {
        let (equations, width) = (equations(60), 20);
        let (z, e) = (&equations.instruments, &equations.errors);
        let covariance = |lag: usize| (0..60 - lag).map(|k| e[k] * e[k + lag]).sum::<f64>() / 60.0;
        let mut dense = DMatrix::zeros(2, 2);
        for k in 0..60_usize {
            for l in 0..60_usize {
                let lag = k.abs_diff(l);
                let window = (2.0 * (1.0 - lag as f64 / width as f64)).clamp(0.0, 1.0);
                dense += z.column(k) * z.column(l).transpose() * (window * covariance(lag));
            }
        }
        assert_relative_eq!(
            long_run(&equations, width, 0.5, &lags(width)),
            dense,
            epsilon = 1e-10 * dense.amax()
        );
    }

    #[test]
    fn lags_far_apart_stand_for_all_lags_of_a_window() {
        for width in [1, 2, 24, 25, 26, 100, 5000] {
            let total: f64 = lags(width).iter().map(|(_, weight)| weight).sum();
            assert!((total - width as f64).abs() <= 0.5 * (1.0 + 0.08 * width as f64), "{width}: {total}");
        }
        // Of a decaying exponential the sum is known.
        let sum: f64 = lags(3000).iter().map(|(lag, weight)| weight * (-(*lag as f64) / 300.0).exp()).sum();
        let known = (1.0 - (-10.0_f64).exp()) / (1.0 - (-1.0_f64 / 300.0).exp());
        assert_relative_eq!(sum, known, max_relative = 2e-3);
    }

    #[test]
    fn uncorrelated_errors_have_the_white_covariance() {
        let mut equations = equations(4000);
        let mut state = 7_u64;
        equations.errors = DVector::from_fn(4000, |_, _| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            if state >> 63 == 0 { 1.0 } else { -1.0 }
        });
        equations.sse = 4000.0;
        let (white, coloured) = (white(&equations).unwrap(), coloured(&equations, 1.0).unwrap());
        assert_relative_eq!(white[(0, 0)], coloured[(0, 0)], max_relative = 0.1);
        assert_relative_eq!(white[(1, 1)], coloured[(1, 1)], max_relative = 0.1);
    }
}
