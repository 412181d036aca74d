//! The onsets of a failure: their signatures, carried from sample to sample side by side.
use nalgebra::{Cholesky, DMatrix, DMatrixView, DMatrixViewMut, DVector, Dyn};
use serde::{Deserialize, Serialize};

use super::{Failure, FilterStep};
use crate::statistic::{OnsetHypothesis, Side};

/// A failure of unit size that began at `onset_s`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct FailureOnset {
    pub onset_s: f64,
    /// Its column among the [`Signatures`].
    pub column: usize,
    /// `A`.
    pub information: f64,
    /// `B`.
    pub correlation: f64,
    pub log_likelihood_ratio: f64,
}

impl FailureOnset {
    pub fn at(onset_s: f64, column: usize) -> Self {
        Self { onset_s, column, information: 0.0, correlation: 0.0, log_likelihood_ratio: 0.0 }
    }

    /// Take the whitened signature of a sample and the whitened innovation.
    pub fn add(&mut self, side: Side, signature: &[f64], innovation: &[f64]) {
        self.information += signature.iter().map(|g| g * g).sum::<f64>();
        self.correlation += signature.iter().zip(innovation).map(|(g, nu)| g * nu).sum::<f64>();
        let towards = match side {
            Side::Above => self.correlation.max(0.0),
            Side::Below => self.correlation.min(0.0),
            Side::Both => self.correlation,
        };
        let unseen = self.information <= 0.0;
        self.log_likelihood_ratio = if unseen { 0.0 } else { 0.5 * towards * towards / self.information };
    }
}

impl OnsetHypothesis for FailureOnset {
    fn evidence(&self) -> f64 {
        self.log_likelihood_ratio
    }
}

/// `d` of all onsets as the columns of one matrix, so that a sample costs a few matrix products.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Signatures {
    states: usize,
    /// `d` after the last sample, column by column.
    deviation: Vec<f64>,
    /// Columns that no onset has.
    free: Vec<usize>,
    /// `d-` and `g` of the sample that is being taken.
    #[serde(skip)]
    predicted: Vec<f64>,
    #[serde(skip)]
    signature: Vec<f64>,
}

impl Signatures {
    pub fn new(states: usize) -> Self {
        let none = Vec::new;
        Self { states, deviation: none(), free: Vec::new(), predicted: none(), signature: none() }
    }

    /// A column of zeros.
    pub fn begin(&mut self) -> usize {
        let states = self.states;
        let column = self.free.pop().unwrap_or_else(|| {
            let columns = self.deviation.len() / states.max(1);
            self.deviation.resize((columns + 1) * states, 0.0);
            columns
        });
        self.deviation[column * states..][..states].fill(0.0);
        column
    }

    /// The column is free again.
    pub fn end(&mut self, column: usize) {
        self.free.push(column);
    }

    pub fn clear(&mut self) {
        self.deviation.clear();
        self.free.clear();
    }

    /// `d` of a column.
    pub fn deviation(&self, column: usize) -> &[f64] {
        &self.deviation[column * self.states..][..self.states]
    }

    /// Carry all columns over a sample; `fresh` is the one that begins with it. Gives the whitened innovation.
    pub fn add(
        &mut self,
        failure: &Failure,
        step: &FilterStep,
        covariance: &Cholesky<f64, Dyn>,
        fresh: Option<usize>,
    ) -> DVector<f64> {
        self.predict(failure, step, fresh);
        self.sign(failure, step);
        let (n, m) = (self.states, step.innovation.len());
        let columns = self.predicted.len() / n;
        self.deviation.copy_from_slice(&self.predicted);
        let mut signature = DMatrixViewMut::from_slice(&mut self.signature, m, columns);
        DMatrixViewMut::from_slice(&mut self.deviation, n, columns).gemm(-1.0, step.gain, &signature, 1.0);
        // The factor of a positive definite matrix has no zero on its diagonal: both are solved.
        let lower = covariance.l_dirty();
        let mut innovation = step.innovation.clone();
        let _ = lower.solve_lower_triangular_mut(&mut innovation);
        let _ = lower.solve_lower_triangular_mut(&mut signature);
        innovation
    }

    /// The whitened signature of a column at the last sample.
    pub fn signature(&self, column: usize, outputs: usize) -> &[f64] {
        &self.signature[column * outputs..][..outputs]
    }

    /// `d- = Phi d + input`.
    fn predict(&mut self, failure: &Failure, step: &FilterStep, fresh: Option<usize>) {
        let n = self.states;
        let half_s = 0.5 * step.interval_s;
        if let Failure::StateRamp(direction) = failure {
            self.deviation.chunks_mut(n).for_each(|d| add_scaled(d, half_s, direction));
        }
        self.predicted.resize(self.deviation.len(), 0.0);
        multiply(step.transition, &self.deviation, &mut self.predicted);
        match (failure, fresh) {
            (Failure::StateRamp(direction), _) => {
                self.predicted.chunks_mut(n).for_each(|d| add_scaled(d, half_s, direction));
            }
            (Failure::StateStep(direction), Some(column)) => {
                add_scaled(&mut self.predicted[column * n..][..n], 1.0, direction);
            }
            (Failure::StateStep(_), None) | (Failure::OutputOffset(_), _) => {}
        }
    }

    /// `g = H d- + b`.
    fn sign(&mut self, failure: &Failure, step: &FilterStep) {
        let m = step.innovation.len();
        self.signature.resize(m * (self.predicted.len() / self.states), 0.0);
        if m == 0 {
            return;
        }
        multiply(step.output, &self.predicted, &mut self.signature);
        if let Failure::OutputOffset(offset) = failure {
            for signature in self.signature.chunks_mut(m) {
                for (signature, output) in signature.iter_mut().zip(step.outputs) {
                    *signature += offset[*output];
                }
            }
        }
    }
}

fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

/// `Y = A X`, `X` and `Y` column by column.
fn multiply(a: &DMatrix<f64>, x: &[f64], y: &mut [f64]) {
    let (rows, inner) = a.shape();
    let columns = x.len() / inner;
    let x = DMatrixView::from_slice(x, inner, columns);
    DMatrixViewMut::from_slice(y, rows, columns).gemm(1.0, a, &x, 0.0);
}
