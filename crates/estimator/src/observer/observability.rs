//! What the data have and have not separated.
//!
//! The posterior covariance `P` is compared with the prior `P_0` in units of the prior: the eigenvectors of `P_0^-1/2 P P_0^-1/2` with
//! eigenvalues near one are the combinations of states about which the data have said nothing. They are what no amount of
//! further data of this kind will tell, e.g. a common offset of the temperature sensors against the mass.
use alloc::string::String;
use alloc::vec::Vec;
use core::iter;

use nalgebra::DMatrix;

use super::states::States;

/// Part of the prior variance that must be left for a combination to count as not learnt.
const UNLEARNT_PART: f64 = 0.5;
/// Correlation from which two states count as not separated.
const NOT_SEPARATED: f64 = 0.9;
/// Weight from which a state is named in a combination,
const MIN_WEIGHT: f64 = 0.2;
/// and the part of what is left of its variance that the combination makes, from which it is named too.
const MIN_EXPLAINED_PART: f64 = 0.25;

/// A combination of constants that the data have not determined.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    /// Part of its prior variance that is left.
    pub variance_left: f64,
    /// States with their weights in units of their prior standard deviations, the largest first; squares of all add up to one.
    pub terms: Vec<(String, f64)>,
}

/// Report of what can be told apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Observability {
    /// Each constant and the mass: name, and the part of its prior standard deviation that is left.
    pub learnt: Vec<(String, f64)>,
    /// Combinations that the data have not determined, the least determined first.
    pub undetermined: Vec<Combination>,
    /// Pairs with a correlation beyond 0.9: their sum or difference is known far better than each.
    pub inseparable: Vec<(String, String, f64)>,
}

impl Observability {
    pub(super) fn of(states: &States, prior: &DMatrix<f64>, posterior: &DMatrix<f64>) -> Self {
        let uncertain = |i: &usize| prior[(*i, *i)] > 0.0;
        let chosen: Vec<usize> =
            iter::once(states.mass).chain(states.constants()).filter(uncertain).collect();
        let k = chosen.len();
        let sd0 = |i: usize| libm::sqrt(prior[(chosen[i], chosen[i])]);
        let scaled = DMatrix::from_fn(k, k, |i, j| posterior[(chosen[i], chosen[j])] / (sd0(i) * sd0(j)));
        let name = |i: usize| states.names[chosen[i]].clone();
        let eigen = scaled.clone().symmetric_eigen();
        let mut undetermined: Vec<Combination> = (0..k)
            .filter(|&e| eigen.eigenvalues[e] > UNLEARNT_PART)
            .map(|e| {
                let mut terms: Vec<(String, f64)> = (0..k)
                    .map(|i| (i, eigen.eigenvectors[(i, e)]))
                    .filter(|&(i, weight)| {
                        let part = eigen.eigenvalues[e] * weight * weight;
                        weight.abs() > MIN_WEIGHT || part > MIN_EXPLAINED_PART * scaled[(i, i)]
                    })
                    .map(|(i, weight)| (name(i), weight))
                    .collect();
                terms.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
                Combination { variance_left: eigen.eigenvalues[e], terms }
            })
            .collect();
        undetermined.sort_by(|a, b| b.variance_left.total_cmp(&a.variance_left));
        let mut inseparable = Vec::new();
        for i in 0..k {
            for j in 0..i {
                let correlation = scaled[(i, j)] / libm::sqrt(scaled[(i, i)] * scaled[(j, j)]);
                if correlation.abs() > NOT_SEPARATED {
                    inseparable.push((name(j), name(i), correlation));
                }
            }
        }
        Self {
            learnt: (0..k).map(|i| (name(i), libm::sqrt(scaled[(i, i)]))).collect(),
            undetermined,
            inseparable,
        }
    }
}

/// Variance of a state given that every constant (from `leading` on) is what it is.
pub(super) fn given_constants(p: &DMatrix<f64>, state: usize, leading: usize) -> f64 {
    let constants: Vec<usize> = (leading..p.nrows()).filter(|&i| p[(i, i)] > 0.0).collect();
    let k = constants.len();
    let scale: Vec<f64> = constants.iter().map(|&i| libm::sqrt(p[(i, i)])).collect();
    let block = DMatrix::from_fn(k, k, |i, j| p[(constants[i], constants[j])] / (scale[i] * scale[j]));
    let cross = nalgebra::DVector::from_fn(k, |i, _| p[(state, constants[i])] / scale[i]);
    let explained = block.svd(true, true).solve(&cross, 1e-12).map_or(0.0, |weights| weights.dot(&cross));
    (p[(state, state)] - explained).max(0.0)
}
