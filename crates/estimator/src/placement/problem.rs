//! The steady state of a filter as a criterion.
use nalgebra::{DMatrix, DVector};

use super::objective::{Objective, Relaxed};
use crate::EstimatorError;
use crate::filter::steady_prediction;

/// Doublings of the sum of the gradient: `2^60` steps.
const DOUBLINGS: usize = 60;
/// Growth of the sum, relative, below which it has settled.
const SETTLED: f64 = 1e-14;

/// What a candidate reads: `y = h x + v`, `v ~ N(0, variance)`.
#[derive(Clone, Debug, PartialEq)]
pub struct CandidateOutput {
    /// Gradient of the reading: (n).
    pub gradient: DVector<f64>,
    /// Variance of its noise.
    pub variance: f64,
}

/// A linear process `x <- F x + w`, `w ~ N(0, Q)` with candidates for sensors, and the functional `c^T x` that is to be known
/// after each sample.
#[derive(Clone, Debug)]
pub struct LinearProblem {
    transition: DMatrix<f64>,
    process_noise: DMatrix<f64>,
    functional: DVector<f64>,
    candidates: Vec<CandidateOutput>,
}

/// Steady state at an information.
struct Steady {
    /// Covariance after an update: (n, n).
    updated: DMatrix<f64>,
    /// Error's transition from one update to the next, `(I - K H) F`: (n, n).
    error: DMatrix<f64>,
}

impl LinearProblem {
    /// A process with transition `f` (n, n) and noise `q` (n, n), its candidates, and a functional (n).
    ///
    /// # Errors
    /// Sizes differ, or a variance is not positive.
    pub fn new(
        f: DMatrix<f64>,
        q: DMatrix<f64>,
        functional: DVector<f64>,
        candidates: Vec<CandidateOutput>,
    ) -> Result<Self, EstimatorError> {
        let n = f.nrows();
        let lengths = [f.ncols(), q.nrows(), q.ncols(), functional.len()];
        let outputs = candidates.iter().map(|candidate| candidate.gradient.len());
        for length in lengths.into_iter().chain(outputs) {
            if length != n {
                return Err(EstimatorError::StateLength { length, states: n });
            }
        }
        let is_noise = |variance: f64| variance.is_finite() && variance > 0.0;
        if let Some(wrong) = candidates.iter().find(|candidate| !is_noise(candidate.variance)) {
            return Err(EstimatorError::NoiseNotPositive { variance: wrong.variance });
        }
        Ok(Self { transition: f, process_noise: q, functional, candidates })
    }

    /// The candidates.
    pub fn outputs(&self) -> &[CandidateOutput] {
        &self.candidates
    }

    /// Transition: (n, n).
    pub fn transition(&self) -> &DMatrix<f64> {
        &self.transition
    }

    /// Covariance of the process noise: (n, n).
    pub fn process_noise(&self) -> &DMatrix<f64> {
        &self.process_noise
    }

    /// The functional: (n).
    pub fn functional(&self) -> &DVector<f64> {
        &self.functional
    }

    /// Information of a sample of weighted candidates: (n, n).
    fn information(&self, weights: impl Iterator<Item = (usize, f64)>) -> DMatrix<f64> {
        let n = self.transition.nrows();
        let mut information = DMatrix::zeros(n, n);
        for (index, weight) in weights.filter(|(_, weight)| *weight > 0.0) {
            let CandidateOutput { gradient, variance } = &self.candidates[index];
            information.ger(weight / variance, gradient, gradient, 1.0);
        }
        information
    }

    /// Covariance before an update with all candidates: (n, n). No layout's is below it.
    ///
    /// # Errors
    /// Not even all of them see every state that moves.
    pub fn least_prediction(&self) -> Result<DMatrix<f64>, EstimatorError> {
        let all = self.information((0..self.candidates.len()).map(|index| (index, 1.0)));
        steady_prediction(&self.transition, &all, &self.process_noise)
    }

    fn steady(&self, information: &DMatrix<f64>) -> Option<Steady> {
        let predicted = steady_prediction(&self.transition, information, &self.process_noise).ok()?;
        let n = predicted.nrows();
        // (I + P G)^-1 is what an update leaves of an error.
        let left = (DMatrix::identity(n, n) + &predicted * information).lu();
        let (mut updated, error) = (left.solve(&predicted)?, left.solve(&self.transition)?);
        updated = 0.5 * (&updated + updated.transpose());
        Some(Steady { updated, error })
    }

    fn variance(&self, steady: &Steady) -> f64 {
        (self.functional.transpose() * &steady.updated * &self.functional)[(0, 0)]
    }
}

/// `sum_k (L^T)^k c c^T L^k` (n, n): how much each later error still counts.
fn remembered(error: &DMatrix<f64>, functional: &DVector<f64>) -> Option<DMatrix<f64>> {
    let (mut sum, mut power) = (functional * functional.transpose(), error.clone());
    for _ in 0..DOUBLINGS {
        let added = power.transpose() * &sum * &power;
        let (size, growth) = (sum.norm(), added.norm());
        if !growth.is_finite() {
            return None;
        }
        sum += added;
        if growth <= SETTLED * size {
            return Some(sum);
        }
        power = &power * &power;
    }
    None
}

impl Objective for LinearProblem {
    fn candidates(&self) -> usize {
        self.candidates.len()
    }

    fn value(&self, layout: &[usize]) -> f64 {
        let information = self.information(layout.iter().map(|index| (*index, 1.0)));
        self.steady(&information).map_or(f64::INFINITY, |steady| self.variance(&steady))
    }

    fn relaxed(&self, weights: &[f64]) -> Option<Relaxed> {
        let steady = self.steady(&self.information(weights.iter().copied().enumerate()))?;
        let weighed = remembered(&steady.error, &self.functional)?;
        let per_information = &steady.updated * weighed * &steady.updated;
        let slope = |of: &CandidateOutput| {
            -(of.gradient.transpose() * &per_information * &of.gradient)[(0, 0)] / of.variance
        };
        Some(Relaxed { value: self.variance(&steady), gradient: self.candidates.iter().map(slope).collect() })
    }
}
