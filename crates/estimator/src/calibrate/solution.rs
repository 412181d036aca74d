//! Where a search stands: coordinates, readings and their derivatives.
use nalgebra::DMatrix;

use super::CalibrateError;
use super::fit::{Evaluation, Fit};

/// Coordinates of the parameters and what the model reads there.
#[derive(Clone, Debug)]
pub(super) struct Solution {
    /// Coordinates.
    pub z: Vec<f64>,
    pub evaluation: Evaluation,
    /// Derivatives of the weighted readings, (readings, parameters).
    pub jacobian: DMatrix<f64>,
    /// Sum of squares, priors included.
    pub cost: f64,
    pub iterations: usize,
    pub held: Vec<bool>,
}

impl Solution {
    /// A start, without derivatives.
    pub(super) fn at(fit: &Fit, z: Vec<f64>, held: &[bool]) -> Result<Self, CalibrateError> {
        let evaluation = fit.evaluate(&z)?;
        let cost = cost(fit, &z, &evaluation);
        let jacobian = DMatrix::zeros(fit.samples(), z.len());
        Ok(Self { z, evaluation, jacobian, cost, iterations: 0, held: held.to_vec() })
    }
}

/// Sum of squares of readings and priors.
pub(super) fn cost(fit: &Fit, z: &[f64], evaluation: &Evaluation) -> f64 {
    let readings: f64 = evaluation.residuals.iter().map(|r| r * r).sum();
    let priors: f64 = fit
        .specs
        .iter()
        .zip(z)
        .filter_map(|(spec, z)| spec.prior_coordinate().map(|(mean, sd)| ((z - mean) / sd).powi(2)))
        .sum();
    readings + priors
}
