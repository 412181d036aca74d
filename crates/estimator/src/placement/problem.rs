//! The steady state of a filter as a criterion.
use nalgebra::{DMatrix, DVector};

use super::objective::{Objective, Relaxed};
use crate::EstimatorError;
use crate::filter::steady_prediction;

/// Doublings of the sum of the gradient: `2^60` steps.
const DOUBLINGS: usize = 60;
/// What a sample may change of a steady state, relative.
const SOLVED: f64 = 1e-6;
/// Samples after which a variance that still grows is not seen: a day of minutes.
const DAY_SAMPLES: usize = 1440;
/// Return of a state towards itself within a sample that is none.
const CONSTANT_TOLERANCE: f64 = 1e-9;
/// Variance of a state from which on it may be one that nobody sees: states are of a size near one.
const UNOBSERVED_VARIANCE: f64 = 10.0;
/// Doublings of samples after which an error is forgotten, eight years of minutes, and what may be left of its variance.
const FORGETTING_DOUBLINGS: usize = 22;
const REMAINING_VARIANCE: f64 = 1e-3;
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
pub(super) struct Steady {
    /// Covariance after an update: (n, n).
    pub updated: DMatrix<f64>,
    /// What an update leaves of an error, `I - K H`: (n, n).
    pub left: DMatrix<f64>,
    /// Error's transition from one update to the next, `(I - K H) F`: (n, n).
    pub error: DMatrix<f64>,
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

    /// Parts that fit each other.
    pub(super) fn of_parts(
        transition: DMatrix<f64>,
        process_noise: DMatrix<f64>,
        functional: DVector<f64>,
        candidates: Vec<CandidateOutput>,
    ) -> Self {
        Self { transition, process_noise, functional, candidates }
    }

    /// By how much of itself the variance of each state that does not return by itself grows with all candidates read, in as many samples as have gone
    /// since a start at nothing: near zero where they see it, one where they do not and it walks.
    pub(super) fn growth(&self) -> Vec<f64> {
        let n = self.transition.nrows();
        let information = self.information_of_all();
        let mut p = DMatrix::zeros(n, n);
        let mut halfway = DVector::zeros(n);
        for sample in 0..2 * DAY_SAMPLES {
            if sample == DAY_SAMPLES {
                halfway = p.diagonal();
            }
            p = &self.transition * &p * self.transition.transpose() + &self.process_noise;
            if let Some(left) = (DMatrix::identity(n, n) + &p * &information).try_inverse() {
                p = left * p;
            }
            p = 0.5 * (&p + p.transpose());
        }
        let stays = |state: usize| self.transition[(state, state)] > 1.0 - CONSTANT_TOLERANCE;
        (0..n).map(|i| if stays(i) { p[(i, i)] / halfway[i] - 1.0 } else { 0.0 }).collect()
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

    /// Information of a sample of all candidates: (n, n).
    pub(super) fn information_of_all(&self) -> DMatrix<f64> {
        self.information((0..self.candidates.len()).map(|index| (index, 1.0)))
    }

    /// Covariance before an update with all candidates: (n, n). No layout's is below it.
    ///
    /// # Errors
    /// Not even all of them see every state that moves.
    pub(crate) fn least_prediction(&self) -> Result<DMatrix<f64>, EstimatorError> {
        steady_prediction(&self.transition, &self.information_of_all(), &self.process_noise)
    }

    pub(super) fn steady(&self, information: &DMatrix<f64>) -> Option<Steady> {
        let predicted = steady_prediction(&self.transition, information, &self.process_noise).ok()?;
        let n = predicted.nrows();
        // (I + P G)^-1 is what an update leaves of an error.
        let left = (DMatrix::identity(n, n) + &predicted * information).try_inverse()?;
        let (mut updated, error) = (&left * &predicted, &left * &self.transition);
        updated = 0.5 * (&updated + updated.transpose());
        self.stands(information, &predicted, &updated).then_some(Steady { updated, left, error })
    }

    /// Whether a sample leads from the covariance after an update back to that before it.
    fn stands(&self, information: &DMatrix<f64>, predicted: &DMatrix<f64>, updated: &DMatrix<f64>) -> bool {
        // What is not seen grows so slowly that rounding can end the doubling.
        let next = &self.transition * updated * self.transition.transpose() + &self.process_noise;
        (next - predicted).norm() <= SOLVED * predicted.norm()
            && updated.diagonal().min() >= 0.0
            && (updated.diagonal().max() < UNOBSERVED_VARIANCE || self.forgets(information, predicted))
    }

    /// Whether the filter forgets an error of the size of its own covariance: one that nobody sees stays for ever.
    fn forgets(&self, information: &DMatrix<f64>, predicted: &DMatrix<f64>) -> bool {
        let n = predicted.nrows();
        let left = (DMatrix::identity(n, n) + predicted * information).try_inverse();
        let Some(mut power) = left.map(|left| left * &self.transition) else { return false };
        for _ in 0..FORGETTING_DOUBLINGS {
            power = &power * &power;
        }
        (&power * predicted * power.transpose()).norm() <= REMAINING_VARIANCE * predicted.norm()
    }

    /// Variance of the functional after an update with a layout, reading by reading.
    fn settled_variance(&self, layout: &[usize]) -> Option<f64> {
        let information = self.information(layout.iter().map(|index| (*index, 1.0)));
        let predicted = steady_prediction(&self.transition, &information, &self.process_noise).ok()?;
        let mut updated = predicted.clone();
        for index in layout {
            let CandidateOutput { gradient, variance } = &self.candidates[*index];
            let cross = &updated * gradient;
            updated.ger(-1.0 / (gradient.dot(&cross) + variance), &cross, &cross, 1.0);
        }
        self.stands(&information, &predicted, &updated)
            .then(|| self.functional.dot(&(&updated * &self.functional)))
    }

    pub(super) fn variance(&self, steady: &Steady) -> f64 {
        (self.functional.transpose() * &steady.updated * &self.functional)[(0, 0)]
    }
}

/// `sum_k (L^T)^k c c^T L^k` (n, n): how much each later error still counts.
pub(super) fn remembered(error: &DMatrix<f64>, functional: &DVector<f64>) -> Option<DMatrix<f64>> {
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
        self.settled_variance(layout).unwrap_or(f64::INFINITY)
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
