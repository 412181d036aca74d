//! Factors of a covariance, with every complaint that a matrix which is none deserves.
//!
//! A regular covariance is factored by elimination from the last state on. Where this leaves no more of a variance than
//! rounding, the matrix is singular and its order of elimination may be a bad one: a Cholesky factorisation of the
//! correlations with complete pivoting, stable for semi-definite matrices (Higham 2002, section 10.3), gives a root of as
//! many columns as the rank, whose rows are then orthogonalised.
use super::kernel::{axpy, column, column_mut, dot};
use crate::EstimatorError;
use alloc::vec::Vec;
use cylwatch_thermal::real::powi;

/// Relative difference of mirrored elements up to which a matrix counts as symmetric.
const SYMMETRY: f64 = 1e-9;

/// Correlation that may be too much, by rounding of what was handed in, in a singular covariance.
const ROUNDING: f64 = 1e-12;

/// Replace the column-major `p` (n, n) by the unit upper triangular `U` of `P = U diag(d) U^T` and write `d` (n).
///
/// Singular matrices and zero variances are factored. Thresholds are relative to the variances of the states
/// concerned, so that units do not matter. Allocates for singular matrices alone.
///
/// # Errors
/// `p` is not finite, not symmetric, or not positive semi-definite.
pub(crate) fn factor_udu(p: &mut [f64], d: &mut [f64]) -> Result<(), EstimatorError> {
    let n = d.len();
    symmetrise(p, n)?;
    if !eliminate(p, d) {
        // The lower triangle is still that of the covariance.
        for j in 0..n {
            (0..j).for_each(|i| p[j * n + i] = p[i * n + j]);
        }
        factor_singular(p, d)?;
    }
    for (j, u) in p.chunks_exact_mut(n.max(1)).enumerate() {
        u[j] = 1.0;
        u[j + 1..].fill(0.0);
    }
    Ok(())
}

/// Eliminate the states, last one first, in the strict upper triangle of `p` and in `d`; the rest of `p` stays.
///
/// Returns `false` if the matrix is singular up to rounding, apart from states of zero variance.
fn eliminate(p: &mut [f64], d: &mut [f64]) -> bool {
    let n = d.len();
    for (j, left) in d.iter_mut().enumerate() {
        *left = p[j * n + j];
    }
    for j in (0..n).rev() {
        let (before, rest) = p.split_at_mut(j * n);
        let (u, variance) = rest[..=j].split_at_mut(j);
        if variance[0] == 0.0 && u.iter().all(|u| *u == 0.0) {
            continue;
        }
        let left = d[j];
        if left <= n as f64 * f64::EPSILON * variance[0] {
            return false;
        }
        for (i, target) in before.chunks_exact_mut(n).enumerate() {
            let factor = u[i] / left;
            axpy(-factor, &u[..i], &mut target[..i]);
            d[i] -= factor * u[i];
        }
        u.iter_mut().for_each(|u| *u /= left);
    }
    true
}

/// Factors of a singular covariance, in the strict upper triangle of `p` and in `d`.
fn factor_singular(p: &mut [f64], d: &mut [f64]) -> Result<(), EstimatorError> {
    let n = d.len();
    let (mut root, rank) = pivoted_root(p, d)?;
    for j in (0..n).rev() {
        let (before, row) = root[..(j + 1) * n].split_at_mut(j * n);
        let row = &row[..rank];
        let left = dot(row, row);
        let negligible = powi(n as f64 * f64::EPSILON, 2) * p[j * n + j];
        let u = &mut column_mut(p, n, j)[..j];
        if left <= negligible {
            d[j] = 0.0;
            u.fill(0.0);
            continue;
        }
        d[j] = left;
        for (other, u) in before.chunks_exact_mut(n).zip(u) {
            *u = dot(row, &other[..rank]) / left;
            axpy(-*u, row, &mut other[..rank]);
        }
    }
    Ok(())
}

/// `W` of `P = W W^T`: its rows, of which the first `rank` elements count, as columns of length n. `work`: (n).
fn pivoted_root(p: &[f64], work: &mut [f64]) -> Result<(Vec<f64>, usize), EstimatorError> {
    let n = work.len();
    let sd: Vec<f64> = (0..n).map(|i| libm::sqrt(p[i * n + i].max(0.0))).collect();
    let refuse = |state: usize, left: f64| {
        let variance = p[state * n + state];
        Err(EstimatorError::CovarianceIndefinite { state, variance, left })
    };
    let mut correlation = vec![0.0; n * n];
    for (at, c) in correlation.iter_mut().enumerate() {
        let scale = sd[at % n] * sd[at / n];
        if scale > 0.0 {
            *c = p[at] / scale;
        } else if p[at] != 0.0 {
            let state = if sd[at % n] > 0.0 { at / n } else { at % n };
            return refuse(state, p[state * n + state]);
        }
    }
    let mut root = vec![0.0; n * n];
    for rank in 0..n {
        let largest =
            (0..n).fold(0, |a, b| if correlation[b * n + b] > correlation[a * n + a] { b } else { a });
        let pivot = correlation[largest * n + largest];
        if pivot <= n as f64 * f64::EPSILON {
            return match correlation.iter().position(|c| c.abs() > ROUNDING) {
                Some(at) => refuse(at / n, correlation[at / n * (n + 1)] * p[at / n * (n + 1)]),
                None => Ok((root, rank)),
            };
        }
        work.copy_from_slice(column(&correlation, n, largest));
        for (j, c) in correlation.chunks_exact_mut(n).enumerate() {
            root[j * n + rank] = sd[j] * work[j] / libm::sqrt(pivot);
            axpy(-work[j] / pivot, work, c);
        }
    }
    Ok((root, n))
}

/// Mean of upper and lower triangle in both, if they agree.
fn symmetrise(p: &mut [f64], n: usize) -> Result<(), EstimatorError> {
    if let Some(at) = p.iter().position(|value| !value.is_finite()) {
        return Err(EstimatorError::CovarianceNotFinite { row: at % n, column: at / n });
    }
    for j in 0..n {
        for i in 0..j {
            let (upper, lower) = (p[j * n + i], p[i * n + j]);
            let scale = libm::sqrt((p[i * n + i] * p[j * n + j]).abs());
            if (upper - lower).abs() > SYMMETRY * scale.max(upper.abs()) {
                return Err(EstimatorError::CovarianceNotSymmetric { row: i, column: j, upper, lower });
            }
            p[j * n + i] = 0.5 * (upper + lower);
            p[i * n + j] = p[j * n + i];
        }
    }
    Ok(())
}

/// Copy the upper triangle of a column-major matrix into its lower one.
pub(crate) fn mirror(p: &mut [f64], n: usize) {
    for j in 0..n {
        for i in 0..j {
            p[i * n + j] = p[j * n + i];
        }
    }
}
