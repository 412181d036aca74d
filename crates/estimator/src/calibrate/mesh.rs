//! What the mesh does to the estimates.
//!
//! A coarse wall spreads the heat of valve and neck over too much steel, and the fit lets a coupling or a contact make up for it. With
//! readings `y_fine` of a wall of twice as many cells the minimum moves, to first order, by
//! `dz = -A^-1 J^T (y_fine - y) / sigma` with `A = J^T J + prior`: a Gauss-Newton step for the finer model.
use nalgebra::DVector;

use super::Calibrated;
use super::uncertainty::{of_free, prior_information};
use crate::least_squares::solve;

/// Cells that each cell becomes, along the wall and through it.
const REFINEMENT: usize = 2;

impl Calibrated {
    /// How far each parameter would move with twice as many wall cells along and through the wall, in its standard deviations;
    /// `None` where nothing is finer, or the finer wall cannot be simulated. Takes a simulation of all experiments.
    pub fn mesh_shift_sd(&self) -> Option<Vec<f64>> {
        let (fit, solution) = (&self.fit, &self.solution);
        if fit.cases.iter().all(|case| case.base.vessel.geometry.lumped) {
            return None;
        }
        let mut fine = fit.clone();
        for case in &mut fine.cases {
            case.base.vessel.geometry = case.base.vessel.geometry.refined(REFINEMENT);
        }
        let finer = fine.evaluate(&solution.z).ok()?;
        let change = DVector::from_iterator(
            finer.residuals.len(),
            finer.residuals.iter().zip(&solution.evaluation.residuals).map(|(fine, coarse)| fine - coarse),
        );
        let free: Vec<usize> = (0..fit.specs.len()).filter(|&i| !solution.held[i]).collect();
        let information = solution.jacobian.tr_mul(&solution.jacobian) + prior_information(fit);
        let rhs = solution.jacobian.tr_mul(&change);
        let step = solve(&of_free(&information, &free), &DVector::from_fn(free.len(), |i, _| rhs[free[i]]))?;
        let mut shift = vec![0.0; fit.specs.len()];
        for (&i, step) in free.iter().zip(step.iter()) {
            shift[i] = step / self.estimates[i].coordinate_sd();
        }
        Some(shift)
    }
}
