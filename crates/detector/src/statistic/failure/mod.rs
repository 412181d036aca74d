//! Generalised likelihood ratio of a failure in the innovations of a Kalman filter (Willsky and Jones).
//!
//! The filter assumes `x_k = Phi x_{k-1} + w`, `z_k = H x_k + v`. A failure of size `theta` from the onset `nu` on adds
//! a direction `f` to the state once (step) or per second (ramp), or `b` to the readings (offset). By linearity
//! state minus estimate changes by `theta d`, the innovation by `theta g`, with the signature
//!
//! `d- = Phi d + input`, `g = H d- + b`, `d = d- - K g`,
//!
//! where the input of a ramp over `dt` is `(Phi f + f) dt/2`: exact where `Phi f = f`, as for a mass that nothing
//! but the failure changes. With the innovation covariance `S`, `A = sum g' S^-1 g`, `B = sum g' S^-1 nu`:
//! `theta = B/A`, `Var theta = 1/A`, `log-likelihood ratio = B^2/(2A)`, maximised over onsets on an
//! [`OnsetGrid`](super::OnsetGrid). The filter never knew of the failure; its estimate is put right by adding
//! `theta d`, its covariance by adding `d d'/A`.
//!
//! Assumes a linear (or linearised) filter with white Gaussian innovations of covariance `S`, one failure at a time.
//! Memory is `O(n log window)` for `n` states, time per step `O(n^2 log window)`.
//!
//! Source: A. S. Willsky and H. L. Jones, IEEE Trans. Autom. Control 21 (1976) 108.
mod hypothesis;
#[cfg(test)]
mod tests;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use self::hypothesis::{FailureOnset, Signatures};
use super::{OnsetGrid, Side};
use crate::DetectorError;

/// What fails, per unit of size.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Failure {
    /// The state changes steadily by this much per second: a leak is a ramp of mass.
    StateRamp(Vec<f64>),
    /// The state jumps by this much between two samples: a sudden loss or a refill.
    StateStep(Vec<f64>),
    /// The readings are off by this much: an offset of a sensor.
    OutputOffset(Vec<f64>),
}

/// What the filter did with one sample. Outputs without a reading are left out of all four.
///
/// # Shapes
/// `n` states, `m` readings of this sample (may differ from sample to sample, and be 0).
#[derive(Clone, Copy, Debug)]
pub struct FilterStep<'a> {
    /// Time of the sample, s.
    pub time_s: f64,
    /// Time since the sample before, s.
    pub interval_s: f64,
    /// Transition from the sample before, `Phi`: (n, n).
    pub transition: &'a DMatrix<f64>,
    /// Output matrix `H`: (m, n).
    pub output: &'a DMatrix<f64>,
    /// Gain `K`: (n, m).
    pub gain: &'a DMatrix<f64>,
    /// Innovation `nu`: m.
    pub innovation: &'a DVector<f64>,
    /// Covariance of the innovation, `S`: (m, m).
    pub innovation_covariance: &'a DMatrix<f64>,
    /// Which outputs the readings are, numbered as in [`Failure::OutputOffset`]: m.
    pub outputs: &'a [usize],
}

/// The failure that explains the innovations best, and what it has done to the estimate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailureFinding {
    /// Onset, s: for a step or an offset the first sample after it.
    pub onset_s: f64,
    /// Size `theta`, in units of the direction of the failure.
    pub size: f64,
    /// Variance of the size for this onset.
    pub size_variance: f64,
    /// Logarithm of the likelihood ratio against no failure.
    pub log_likelihood_ratio: f64,
    /// Error of the estimate per unit of size, `d`: add `size * deviation` to the estimate, and
    /// `size_variance * deviation deviation'` to its covariance.
    pub deviation: Vec<f64>,
}

impl FailureFinding {
    /// What must be added to the estimate of the state.
    pub fn state_correction(&self) -> Vec<f64> {
        self.deviation.iter().map(|deviation| self.size * deviation).collect()
    }
}

/// Likelihood ratio of one kind of failure; the statistic is the maximal log-likelihood ratio.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailureGlr {
    failure: Failure,
    states: usize,
    side: Side,
    onsets: OnsetGrid<FailureOnset>,
    value: f64,
    signatures: Signatures,
}

impl FailureGlr {
    /// A failure of a filter with `states` states, with onsets up to at least `window` samples ago, `per_octave`
    /// per doubling of age.
    ///
    /// # Errors
    /// A direction does not have `states` elements, is zero or not finite, or the grid is empty.
    pub fn try_new(
        failure: Failure,
        states: usize,
        side: Side,
        window: usize,
        per_octave: usize,
    ) -> Result<Self, DetectorError> {
        let (Failure::StateRamp(direction)
        | Failure::StateStep(direction)
        | Failure::OutputOffset(direction)) = &failure;
        let length_fits = matches!(failure, Failure::OutputOffset(_)) || direction.len() == states;
        if !length_fits {
            return Err(shape("direction", (direction.len(), 1), (states, 1)));
        }
        let largest = direction.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        if !(largest > 0.0 && direction.iter().all(|x| x.is_finite())) {
            let bound = "finite, not all zero";
            return Err(DetectorError::Setting { setting: "direction", value: largest, bound });
        }
        if window == 0 || per_octave < 2 {
            let value = window.min(per_octave) as f64;
            let bound = "at least 1 sample with 2 onsets per octave";
            return Err(DetectorError::Setting { setting: "window", value, bound });
        }
        let onsets = OnsetGrid::new(window, per_octave);
        Ok(Self { failure, states, side, onsets, value: 0.0, signatures: Signatures::new(states) })
    }

    /// Take what the filter did with a sample; the statistic after it.
    ///
    /// # Errors
    /// Matrices do not fit each other or the failure, an innovation is not finite, or its covariance is not
    /// positive definite; the statistic is then as before.
    pub fn update(&mut self, step: &FilterStep) -> Result<f64, DetectorError> {
        self.check(step)?;
        let covariance =
            step.innovation_covariance.clone().cholesky().ok_or(DetectorError::InnovationCovariance)?;
        let fresh = self.begin_onset(step);
        let innovation = self.signatures.add(&self.failure, step, &covariance, fresh);
        self.value = 0.0;
        for onset in self.onsets.iter_mut() {
            let signature = self.signatures.signature(onset.column, innovation.len());
            onset.add(self.side, signature, innovation.as_slice());
            self.value = self.value.max(onset.log_likelihood_ratio);
        }
        Ok(self.value)
    }

    /// The statistic after the last sample.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// The most likely failure; `None` as long as nothing speaks for one.
    pub fn finding(&self) -> Option<FailureFinding> {
        let best = self.onsets.best().filter(|best| best.log_likelihood_ratio > 0.0)?;
        Some(FailureFinding {
            onset_s: best.onset_s,
            size: best.correlation / best.information,
            size_variance: best.information.recip(),
            log_likelihood_ratio: best.log_likelihood_ratio,
            deviation: self.signatures.deviation(best.column).to_vec(),
        })
    }

    /// What is looked for.
    pub fn failure(&self) -> &Failure {
        &self.failure
    }

    /// Forget all samples, as after the estimate was put right.
    pub fn reset(&mut self) {
        self.onsets.clear();
        self.signatures.clear();
        self.value = 0.0;
    }

    /// The failure may have begun just before this sample, a ramp at the sample before: the column of its signature.
    fn begin_onset(&mut self, step: &FilterStep) -> Option<usize> {
        let ramp = matches!(self.failure, Failure::StateRamp(_));
        if ramp && step.interval_s <= 0.0 {
            return None;
        }
        let onset_s = if ramp { step.time_s - step.interval_s } else { step.time_s };
        let column = self.signatures.begin();
        let signatures = &mut self.signatures;
        self.onsets.push(FailureOnset::at(onset_s, column), |left| signatures.end(left.column));
        Some(column)
    }

    fn check(&self, step: &FilterStep) -> Result<(), DetectorError> {
        let (n, m) = (self.states, step.innovation.len());
        let matrices = [
            ("transition", step.transition, (n, n)),
            ("output", step.output, (m, n)),
            ("gain", step.gain, (n, m)),
            ("innovation_covariance", step.innovation_covariance, (m, m)),
        ];
        for (name, matrix, expected) in matrices {
            if matrix.shape() != expected {
                return Err(shape(name, matrix.shape(), expected));
            }
        }
        let outputs = if let Failure::OutputOffset(direction) = &self.failure { direction.len() } else { 0 };
        let named = step.outputs.iter().all(|output| outputs == 0 || *output < outputs);
        if step.outputs.len() != m || !named {
            return Err(shape("outputs", (step.outputs.len(), 1), (m, 1)));
        }
        match step.innovation.iter().position(|nu| !nu.is_finite()) {
            Some(output) => Err(DetectorError::InnovationNotFinite { output }),
            None => Ok(()),
        }
    }
}

fn shape(matrix: &'static str, found: (usize, usize), expected: (usize, usize)) -> DetectorError {
    let ((rows, columns), (expected_rows, expected_columns)) = (found, expected);
    DetectorError::Shape { matrix, rows, columns, expected_rows, expected_columns }
}
