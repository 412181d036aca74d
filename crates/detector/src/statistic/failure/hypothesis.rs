//! One onset of a failure: its signature, carried from sample to sample.
use nalgebra::{Cholesky, DMatrix, DVector, DVectorView, DVectorViewMut, Dyn};
use serde::{Deserialize, Serialize};

use super::{Failure, FailureFinding, FilterStep};
use crate::DetectorError;
use crate::statistic::{OnsetHypothesis, Side};

/// `S = L L'` and `L^-1 nu` of a sample.
pub(super) struct Whitening {
    factor: Cholesky<f64, Dyn>,
    innovation: DVector<f64>,
}

impl Whitening {
    pub fn try_new(step: &FilterStep) -> Result<Self, DetectorError> {
        let factor =
            step.innovation_covariance.clone().cholesky().ok_or(DetectorError::InnovationCovariance)?;
        let mut innovation = step.innovation.clone();
        // The factor of a positive definite matrix has no zero on its diagonal.
        let _ = factor.l_dirty().solve_lower_triangular_mut(&mut innovation);
        Ok(Self { factor, innovation })
    }
}

/// A failure of unit size that began at `onset_s`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct FailureOnset {
    onset_s: f64,
    /// `d`, after the last sample.
    deviation: Vec<f64>,
    /// `A`.
    information: f64,
    /// `B`.
    correlation: f64,
    pub log_likelihood_ratio: f64,
    begun: bool,
    /// `d-` and `g` of the sample that is being taken.
    #[serde(skip)]
    predicted: Vec<f64>,
    #[serde(skip)]
    signature: Vec<f64>,
}

impl FailureOnset {
    /// Start anew with a failure that begins at `onset_s`.
    pub fn begin(&mut self, onset_s: f64, states: usize) {
        self.onset_s = onset_s;
        self.deviation.clear();
        self.deviation.resize(states, 0.0);
        self.information = 0.0;
        self.correlation = 0.0;
        self.log_likelihood_ratio = 0.0;
        self.begun = false;
    }

    pub fn add(&mut self, failure: &Failure, side: Side, step: &FilterStep, whitening: &Whitening) {
        self.predict(failure, step);
        self.sign(failure, step);
        self.deviation.copy_from_slice(&self.predicted);
        let (n, m) = (self.deviation.len(), self.signature.len());
        let mut signature = DVectorViewMut::from_slice(&mut self.signature, m);
        let mut deviation = DVectorViewMut::from_slice(&mut self.deviation, n);
        deviation.gemv(-1.0, step.gain, &signature, 1.0);
        let _ = whitening.factor.l_dirty().solve_lower_triangular_mut(&mut signature);
        self.information += signature.norm_squared();
        self.correlation += signature.dot(&whitening.innovation);
        let towards = match side {
            Side::Above => self.correlation.max(0.0),
            Side::Below => self.correlation.min(0.0),
            Side::Both => self.correlation,
        };
        let unseen = self.information <= 0.0;
        self.log_likelihood_ratio = if unseen { 0.0 } else { 0.5 * towards * towards / self.information };
    }

    /// `d- = Phi d + input`.
    fn predict(&mut self, failure: &Failure, step: &FilterStep) {
        let n = self.deviation.len();
        let half_s = 0.5 * step.interval_s;
        if let Failure::StateRamp(direction) = failure {
            add_scaled(&mut self.deviation, half_s, direction);
        }
        self.predicted.resize(n, 0.0);
        multiply(step.transition, &self.deviation, &mut self.predicted);
        match failure {
            Failure::StateRamp(direction) => add_scaled(&mut self.predicted, half_s, direction),
            Failure::StateStep(direction) if !self.begun => add_scaled(&mut self.predicted, 1.0, direction),
            Failure::StateStep(_) | Failure::OutputOffset(_) => {}
        }
        self.begun = true;
    }

    /// `g = H d- + b`.
    fn sign(&mut self, failure: &Failure, step: &FilterStep) {
        self.signature.resize(step.innovation.len(), 0.0);
        multiply(step.output, &self.predicted, &mut self.signature);
        if let Failure::OutputOffset(offset) = failure {
            for (signature, output) in self.signature.iter_mut().zip(step.outputs) {
                *signature += offset[*output];
            }
        }
    }

    pub fn finding(&self) -> FailureFinding {
        FailureFinding {
            onset_s: self.onset_s,
            size: self.correlation / self.information,
            size_variance: self.information.recip(),
            log_likelihood_ratio: self.log_likelihood_ratio,
            deviation: self.deviation.clone(),
        }
    }
}

impl OnsetHypothesis for FailureOnset {
    fn evidence(&self) -> f64 {
        self.log_likelihood_ratio
    }
}

fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

/// `y = A x`.
fn multiply(a: &DMatrix<f64>, x: &[f64], y: &mut [f64]) {
    let (rows, columns) = a.shape();
    DVectorViewMut::from_slice(y, rows).gemv(1.0, a, &DVectorView::from_slice(x, columns), 0.0);
}
