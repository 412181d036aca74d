//! Which combinations of parameters the logs cannot separate.
//!
//! The information of readings and priors is taken in the parameters' usual widths, `W = S (J^T J + prior) S`. An
//! eigenvector of `W` with eigenvalue `lambda` is a combination that the logs determine to `lambda^(-1/2)` widths.
//! What the error of a difference adds to its eigenvalue, `sum_i (v_i S_i e_i |J_i|)^2`, is subtracted first: a combination
//! that only the solver's error tells apart is not told apart.
use std::fmt;

use nalgebra::DMatrix;

use super::fit::Fit;
use super::sensitivity::relative_error;
use super::solution::Solution;
use super::uncertainty::{of_free, prior_information};
use super::{CalibrateError, ParameterKind};

/// Components of an eigenvector below this share of its largest one are left out of its name.
const COMPONENT_SHARE: f64 = 0.25;

/// Smallest eigenvalue: beyond so many widths nothing is known at all.
const LEAST_INFORMATION: f64 = 1e-12;

/// A combination that the logs leave uncertain.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    /// Parameters that take part, by their place in the list, with their share, the largest one ±1. Changes in these
    /// proportions of the parameters' usual widths, all at once, hardly change the readings.
    pub parts: Vec<(usize, f64)>,
    /// Names of these parameters.
    pub names: Vec<ParameterKind>,
    /// Standard deviation of the combination in usual widths.
    pub deviation: f64,
}

/// How well the logs tell the parameters apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Identifiability {
    /// Combinations that the logs cannot separate, the worst one first; a single parameter is one that they hardly show.
    pub inseparable: Vec<Combination>,
    /// Standard deviation of the worst combination in usual widths.
    pub worst_deviation: f64,
}

impl fmt::Display for Combination {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, ((_, share), name)) in self.parts.iter().zip(&self.names).enumerate() {
            let sign = match (place, *share < 0.0) {
                (0, _) => "",
                (_, true) => " against ",
                (_, false) => " with ",
            };
            write!(f, "{sign}{name}")?;
        }
        Ok(())
    }
}

/// Combinations at a solution.
pub(super) fn identifiability(fit: &Fit, solution: &Solution) -> Identifiability {
    let free: Vec<usize> = (0..fit.specs.len()).filter(|&i| !solution.held[i]).collect();
    let width: Vec<f64> = free.iter().map(|&i| usual_width(fit, i)).collect();
    let information =
        of_free(&(solution.jacobian.tr_mul(&solution.jacobian) + prior_information(fit)), &free);
    let scaled = DMatrix::from_fn(free.len(), free.len(), |i, j| information[(i, j)] * width[i] * width[j]);
    let error: Vec<f64> = free
        .iter()
        .zip(&width)
        .map(|(&i, width)| relative_error(fit, i) * solution.jacobian.column(i).norm() * width)
        .collect();
    let eigen = scaled.symmetric_eigen();
    let mut all: Vec<Combination> = (0..free.len())
        .map(|k| {
            let vector: Vec<f64> = eigen.eigenvectors.column(k).iter().copied().collect();
            let noise: f64 = vector.iter().zip(&error).map(|(v, e)| (v * e).powi(2)).sum();
            let information = (eigen.eigenvalues[k] - noise).max(LEAST_INFORMATION);
            combination(fit, &free, &vector, information.sqrt().recip())
        })
        .collect();
    all.sort_by(|a, b| b.deviation.total_cmp(&a.deviation));
    let worst_deviation = all.first().map_or(0.0, |worst| worst.deviation);
    let inseparable =
        all.into_iter().filter(|combination| combination.deviation > fit.settings.separable_within).collect();
    Identifiability { inseparable, worst_deviation }
}

/// The worst combination must be known to some extent.
pub(super) fn check_determined(fit: &Fit, found: &Identifiability) -> Result<(), CalibrateError> {
    match found.inseparable.first() {
        Some(worst) if worst.deviation > fit.settings.undetermined_beyond => {
            Err(CalibrateError::Undetermined { combination: worst.to_string(), deviation: worst.deviation })
        }
        _ => Ok(()),
    }
}

/// Usual width of a parameter in the coordinate of the search.
pub(super) fn usual_width(fit: &Fit, parameter: usize) -> f64 {
    let kind = &fit.specs[parameter].kind;
    kind.usual_width(fit.cases.iter().any(|case| case.base.is_of_pressure(kind)))
}

fn combination(fit: &Fit, free: &[usize], vector: &[f64], deviation: f64) -> Combination {
    let largest = vector.iter().copied().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    let mut parts: Vec<(usize, f64)> = free
        .iter()
        .zip(vector)
        .map(|(&i, v)| (i, v / largest))
        .filter(|(_, share)| share.abs() >= COMPONENT_SHARE)
        .collect();
    parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let names = parts.iter().map(|&(i, _)| fit.specs[i].kind.clone()).collect();
    Combination { parts, names, deviation }
}
