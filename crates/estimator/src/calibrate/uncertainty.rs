//! Covariance of the estimates.
use nalgebra::{DMatrix, DVector};

use super::fit::Fit;
use super::residuals::ChannelResiduals;
use super::solution::Solution;
use crate::least_squares::{invert, solve};

/// Information of the readings, `J^T J`, and the same with a factor on each channel.
pub(super) fn information(
    fit: &Fit,
    solution: &Solution,
    channels: &[ChannelResiduals],
) -> (DMatrix<f64>, DMatrix<f64>) {
    let parameters = fit.specs.len();
    let mut plain = DMatrix::zeros(parameters, parameters);
    let mut scattered = plain.clone();
    let mut first = 0;
    for channel in channels {
        let block = solution.jacobian.rows(first, channel.residuals.len());
        let part = block.tr_mul(&block);
        scattered += &part * channel.variance_factor;
        plain += part;
        first += channel.residuals.len();
    }
    (plain, scattered)
}

/// Information of the priors.
pub(super) fn prior_information(fit: &Fit) -> DMatrix<f64> {
    let of_prior =
        |spec: &super::ParameterSpec| spec.prior_coordinate().map_or(0.0, |(_, sd)| 1.0 / (sd * sd));
    DMatrix::from_diagonal(&DVector::from_iterator(fit.specs.len(), fit.specs.iter().map(of_prior)))
}

/// Where the minimum is from here, to first order, in the search's coordinates: `A^-1 rhs` with `A = J^T J + prior`; zero for held
/// parameters. `None` if `A` is singular.
pub(super) fn first_order_step(fit: &Fit, solution: &Solution, rhs: &DVector<f64>) -> Option<DVector<f64>> {
    let free: Vec<usize> = (0..fit.specs.len()).filter(|&i| !solution.held[i]).collect();
    let information = solution.jacobian.tr_mul(&solution.jacobian) + prior_information(fit);
    let found = solve(&of_free(&information, &free), &DVector::from_fn(free.len(), |i, _| rhs[free[i]]))?;
    let mut step = DVector::zeros(fit.specs.len());
    free.iter().zip(found.iter()).for_each(|(&i, found)| step[i] = *found);
    Some(step)
}

/// Rows and columns of the parameters that are free.
pub(super) fn of_free(matrix: &DMatrix<f64>, free: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(free.len(), free.len(), |i, j| matrix[(free[i], free[j])])
}

/// `A^-1 (sum_c f_c J_c^T J_c + prior) A^-1` of the free parameters in the search's coordinates; zero for held ones.
/// `None` if `A` is singular.
pub(super) fn covariance(
    fit: &Fit,
    solution: &Solution,
    channels: &[ChannelResiduals],
) -> Option<DMatrix<f64>> {
    let (plain, scattered) = information(fit, solution, channels);
    let prior = prior_information(fit);
    let free: Vec<usize> = (0..fit.specs.len()).filter(|&i| !solution.held[i]).collect();
    let inverse = invert(&of_free(&(&plain + &prior), &free))?;
    let sandwich = &inverse * of_free(&(scattered + prior), &free) * &inverse;
    let mut covariance = DMatrix::zeros(fit.specs.len(), fit.specs.len());
    for (row, &i) in free.iter().enumerate() {
        for (column, &j) in free.iter().enumerate() {
            covariance[(i, j)] = sandwich[(row, column)];
        }
    }
    covariance.diagonal().iter().all(|variance| *variance >= 0.0).then_some(covariance)
}
