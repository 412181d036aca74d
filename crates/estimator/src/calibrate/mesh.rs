//! What the mesh does to the estimates.
//!
//! A coarse wall spreads the heat of valve and neck over too much steel, and the fit lets a coupling or a contact make up for it. With
//! readings `y_fine` of a wall of twice as many cells the minimum moves, to first order, by
//! `dz = -A^-1 J^T (y_fine - y) / sigma` with `A = J^T J + prior`: a Gauss-Newton step for the finer model.
use nalgebra::DVector;

use super::Calibrated;
use super::uncertainty::first_order_step;

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
        let step = first_order_step(fit, solution, &solution.jacobian.tr_mul(&change))?;
        Some(
            step.iter()
                .zip(&self.estimates)
                .map(|(step, estimate)| step / estimate.coordinate_sd())
                .collect(),
        )
    }
}
