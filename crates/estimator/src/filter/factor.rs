//! Factors of a covariance, with every complaint that a matrix which is none deserves.
use super::kernel::axpy;
use crate::EstimatorError;

/// Relative difference of mirrored elements up to which a matrix counts as symmetric.
const SYMMETRY: f64 = 1e-9;

/// Share of a variance that may be missing, by rounding of what was handed in, in a singular covariance.
const ROUNDING: f64 = 1e-12;

/// Replace the column-major `p` (n, n) by the unit upper triangular `U` of `P = U diag(d) U^T` and write `d` (n).
///
/// Singular matrices and zero variances are factored. Thresholds are relative to the variances of the states
/// concerned, so that units do not matter.
///
/// # Errors
/// `p` is not finite, not symmetric, or not positive semi-definite.
pub(crate) fn factor_udu(p: &mut [f64], d: &mut [f64]) -> Result<(), EstimatorError> {
    let n = d.len();
    symmetrise(p, n)?;
    for (j, variance) in d.iter_mut().enumerate() {
        *variance = p[j * n + j];
    }
    for j in (0..n).rev() {
        let (before, rest) = p.split_at_mut(j * n);
        let (u, diagonal) = rest[..n].split_at_mut(j);
        d[j] = pivot(j, diagonal[0], u, d)?;
        diagonal[0] = 1.0;
        diagonal[1..].fill(0.0);
        if d[j] == 0.0 {
            u.fill(0.0);
            continue;
        }
        for (i, target) in before.chunks_exact_mut(n).enumerate() {
            axpy(-u[i] / d[j], &u[..=i], &mut target[..=i]);
        }
        u.iter_mut().for_each(|u| *u /= d[j]);
    }
    Ok(())
}

/// The pivot of column `j`, whose remaining covariances are `u`; `variance[..=j]` are the states' own variances.
///
/// Where `n` epsilon of the variance is left or less, the rest is rounding: zero, if the covariances agree.
fn pivot(j: usize, left: f64, u: &[f64], variance: &[f64]) -> Result<f64, EstimatorError> {
    if left > variance.len() as f64 * f64::EPSILON * variance[j] {
        return Ok(left);
    }
    let excess = u.iter().zip(variance).any(|(&c, &v)| c * c > ROUNDING * variance[j] * v);
    if left < -ROUNDING * variance[j] || excess {
        return Err(EstimatorError::CovarianceIndefinite { state: j, variance: variance[j], left });
    }
    Ok(0.0)
}

/// Mean of upper and lower triangle in the upper one, if they agree.
fn symmetrise(p: &mut [f64], n: usize) -> Result<(), EstimatorError> {
    if let Some(at) = p.iter().position(|value| !value.is_finite()) {
        return Err(EstimatorError::CovarianceNotFinite { row: at % n, column: at / n });
    }
    for j in 0..n {
        for i in 0..j {
            let (upper, lower) = (p[j * n + i], p[i * n + j]);
            let scale = (p[i * n + i] * p[j * n + j]).abs().sqrt();
            if (upper - lower).abs() > SYMMETRY * scale.max(upper.abs()) {
                return Err(EstimatorError::CovarianceNotSymmetric { row: i, column: j, upper, lower });
            }
            p[j * n + i] = 0.5 * (upper + lower);
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
