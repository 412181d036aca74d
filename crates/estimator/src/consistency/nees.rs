//! Normalised estimation errors squared over an ensemble of runs, at fixed times.
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::{Band, Finding, Significance};
use crate::EstimatorError;

/// `e^T P^-1 e`, chi-square with as many degrees of freedom as `e` is long if `e ~ N(0, P)`.
///
/// Errors and covariance are scaled by the standard deviations first, so that units do not matter.
///
/// # Shapes
/// `error`: (k); `covariance`: (k, k). To judge functionals `W x` of a state, hand in `W e` and `W P W^T`.
///
/// # Errors
/// The lengths differ, or the covariance is not positive definite: leave out what is known exactly.
pub fn normalised_error_squared(error: &[f64], covariance: &DMatrix<f64>) -> Result<f64, EstimatorError> {
    let k = error.len();
    if covariance.shape() != (k, k) {
        return Err(EstimatorError::StateLength { length: k, states: covariance.nrows() });
    }
    let sd = covariance.diagonal().map(f64::sqrt);
    if let Some(state) = sd.iter().position(|sd| sd.is_nan() || *sd <= 0.0) {
        return Err(EstimatorError::CovarianceSingular { state });
    }
    let correlation = covariance.map_with_location(|i, j, p| p / (sd[i] * sd[j]));
    let scaled = DVector::from_fn(k, |i, _| error[i] / sd[i]);
    let factor = correlation.cholesky().ok_or(EstimatorError::CovarianceSingular { state: k - 1 })?;
    Ok(scaled.dot(&factor.solve(&scaled)))
}

/// Sums of `e^T P^-1 e` over independent runs, one for each of some fixed times.
#[derive(Clone, Debug, PartialEq)]
pub struct EnsembleNees {
    dof: usize,
    at: Vec<Sum>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Sum {
    time_s: f64,
    sum: f64,
    runs: u64,
}

/// The ensemble at one time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NeesAt {
    /// Time, s.
    pub time_s: f64,
    /// Number of runs.
    pub runs: u64,
    /// Mean of `e^T P^-1 e` per degree of freedom, 1 for a correct filter; NaN without runs.
    pub mean: f64,
    /// Band of that mean; `None` without runs.
    pub band: Option<Band>,
}

/// The ensemble at all times.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NeesJudgement {
    /// Each time, with a band so wide that all of them together call a correct filter wrong with the given significance.
    pub times: Vec<NeesAt>,
    /// The worst that any time says.
    pub finding: Finding,
}

impl EnsembleNees {
    /// An ensemble without runs, for errors of length `dof` at the given times, s.
    pub fn new(times_s: &[f64], dof: usize) -> Self {
        let at = times_s.iter().map(|&time_s| Sum { time_s, sum: 0.0, runs: 0 }).collect();
        Self { dof, at }
    }

    /// Add the error of one run at the time of index `index`.
    ///
    /// # Errors
    /// There is no such time, or as [`normalised_error_squared`].
    pub fn add(
        &mut self,
        index: usize,
        error: &[f64],
        covariance: &DMatrix<f64>,
    ) -> Result<(), EstimatorError> {
        if error.len() != self.dof {
            return Err(EstimatorError::StateLength { length: error.len(), states: self.dof });
        }
        let times = self.at.len();
        let at = self.at.get_mut(index).ok_or(EstimatorError::TimeUnknown { index, times })?;
        at.sum += normalised_error_squared(error, covariance)?;
        at.runs += 1;
        Ok(())
    }

    /// The times one by one, each with the band of its own test.
    pub fn times(&self, significance: Significance) -> Vec<NeesAt> {
        let summary = |at: &Sum| {
            let dof = at.runs * self.dof as u64;
            NeesAt {
                time_s: at.time_s,
                runs: at.runs,
                mean: at.sum / dof as f64,
                band: Band::of_mean_square(dof, significance),
            }
        };
        self.at.iter().map(summary).collect()
    }

    /// All times together: a correct filter is called wrong with no more than the given significance.
    pub fn judge(&self, significance: Significance) -> NeesJudgement {
        let times = self.times(significance.shared_by(self.at.len()));
        let farthest = times.iter().filter_map(|at| at.band.map(|band| (at.mean, band))).max_by(|a, b| {
            let beyond = |(mean, band): &(f64, Band)| (mean - band.high).max(band.low - mean);
            beyond(a).total_cmp(&beyond(b))
        });
        let finding = farthest.map_or(Finding::TooFew, |(mean, band)| Finding::of_mean_square(mean, band));
        NeesJudgement { times, finding }
    }
}
