//! Covariance of the parameters.
//!
//! White errors of a least-squares method: `sigma^2 (sum z z^T)^-1` with `sigma^2 = sum e^2/(N - d)`. Otherwise the sandwich
//! `M^-1 V M^-T` with the long-run covariance `V` of the terms `z_k e_k`, by overlapping batches: a mean over batches of
//! length `L` of the outer products of their sums is the Bartlett window of width `L`. Twice the window `L` less the window `L/2` is
//! flat up to the lag `L/2`, which removes the bias of the former.
//!
//! Source: Ljung 1999 (section 9.2), Newey and West 1987, Politis and Romano 1995.
use nalgebra::{DMatrix, DVector};

use super::equations::{Equations, invert};

/// Covariance for white errors.
pub(super) fn white(equations: &Equations) -> Option<DMatrix<f64>> {
    let (parameters, samples) = equations.instruments.shape();
    let variance = equations.sse / (samples - parameters) as f64;
    let inverse = invert(&(&equations.instruments * equations.instruments.transpose()))?;
    valid(inverse * variance)
}

/// Covariance for errors correlated over about `memory` samples.
pub(super) fn sandwich(equations: &Equations, memory: f64) -> Option<DMatrix<f64>> {
    let (parameters, samples) = equations.instruments.shape();
    let mut terms = equations.instruments.clone();
    for (mut column, error) in terms.column_iter_mut().zip(equations.errors.iter()) {
        column *= *error;
    }
    let mean = terms.column_mean();
    terms.column_iter_mut().for_each(|mut column| column -= &mean);
    let width = ((4.0 * memory).ceil() as usize + 2).min(samples / 4).max(2);
    let (wide, narrow) = (batches(&terms, width), batches(&terms, width / 2));
    let flat = &wide * 2.0 - narrow;
    let degrees = samples as f64 / (samples - parameters) as f64;
    let bread = invert(&equations.matrix)?;
    let of = |meat: &DMatrix<f64>| valid(&bread * meat * bread.transpose() * degrees);
    of(&flat).or_else(|| of(&wide))
}

/// Sum over all overlapping batches, those over the ends included, of the outer product of their sums, over their length.
fn batches(terms: &DMatrix<f64>, length: usize) -> DMatrix<f64> {
    let (parameters, samples) = terms.shape();
    let length = length.max(1);
    let mut total = DMatrix::zeros(parameters, parameters);
    let mut sum = DVector::zeros(parameters);
    for end in 0..samples + length - 1 {
        if end < samples {
            sum += terms.column(end);
        }
        if end >= length {
            sum -= terms.column(end - length);
        }
        total.ger(1.0 / length as f64, &sum, &sum, 1.0);
    }
    total
}

fn valid(covariance: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let symmetric = (&covariance + covariance.transpose()) * 0.5;
    let good = symmetric.diagonal().iter().all(|variance| variance.is_finite() && *variance >= 0.0);
    good.then_some(symmetric)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn overlapping_batches_are_the_bartlett_window() {
        let values = [0.3, -1.2, 0.7, 2.0, -0.4, 0.1, 1.1];
        let terms = DMatrix::from_row_slice(1, 7, &values);
        for length in [1, 2, 3, 5] {
            let mut window = 0.0;
            for (i, a) in values.iter().enumerate() {
                for (j, b) in values.iter().enumerate() {
                    window += a * b * f64::max(0.0, 1.0 - i.abs_diff(j) as f64 / length as f64);
                }
            }
            assert_relative_eq!(batches(&terms, length)[0], window, max_relative = 1e-13);
        }
    }
}
