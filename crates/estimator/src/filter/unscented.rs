//! Unscented Kalman filter on a [`StateSpace`]: means and covariances from sigma points, no gradients of outputs.
//!
//! Points `x` and `x +- sqrt(n + lambda) S_i` with `P = S S^T`, `lambda = alpha^2 (n + kappa) - n`; weights
//! `lambda / (n + lambda)` for the first (covariance: `+ 1 - alpha^2 + beta`), `1 / (2 (n + lambda))` for the others.
//! The default `alpha = 1, beta = kappa = 0` is the cubature rule: no weight is negative at any `n`.
//!
//! Process noise `G diag(q) G^T` is added after the transition and new points are drawn with it, without which the
//! filter would not be the Kalman filter on linear processes. State and outputs then form one joint Gaussian, which is
//! conditioned on one reading after the other. A covariance that is no longer positive semi-definite is an error.
//!
//! Source: Julier and Uhlmann 2004; Wan and van der Merwe 2000; Arasaratnam and Haykin 2009 (cubature).
use nalgebra::DMatrix;

use super::dense::symmetrise;
use super::factor::factor_root;
use super::failure::{StepError, check_length, check_sample, check_state};
use super::gate::{Gate, GateCount, GateSettings};
use super::kernel::{axpy, column};
use super::report::StepReport;
use super::sequential::SequentialFilter;
use super::state_space::{Linearisation, StateSpace};
use crate::EstimatorError;

mod update;

/// Options of an [`Unscented`] filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnscentedSettings {
    /// Spread of the points.
    pub alpha: f64,
    /// Weight of the middle point in covariances.
    pub beta: f64,
    /// Secondary spread.
    pub kappa: f64,
    /// Draw new points after each output, instead of one set for all outputs of a sample.
    pub redraw: bool,
    /// Gate per output; `None` uses every reading.
    pub gate: Option<GateSettings>,
}

impl Default for UnscentedSettings {
    fn default() -> Self {
        Self { alpha: 1.0, beta: 0.0, kappa: 0.0, redraw: false, gate: None }
    }
}

/// Spread of the points, and their weights in covariances; those in means add to one.
#[derive(Clone, Copy, Debug)]
struct Rule {
    spread: f64,
    weight: f64,
    middle_covariance: f64,
}

impl Rule {
    fn try_new(settings: &UnscentedSettings, n: usize) -> Result<Self, EstimatorError> {
        let UnscentedSettings { alpha, beta, kappa, .. } = *settings;
        let total = alpha * alpha * (n as f64 + kappa);
        if !(total.is_finite() && total > 0.0 && beta.is_finite()) {
            return Err(EstimatorError::SigmaPoints { alpha, beta, kappa });
        }
        let middle_covariance = (total - n as f64) / total + 1.0 - alpha * alpha + beta;
        Ok(Self { spread: total.sqrt(), weight: 0.5 / total, middle_covariance })
    }

    /// Weight of point `i` in covariances.
    fn covariance_weight(&self, i: usize) -> f64 {
        if i == 0 { self.middle_covariance } else { self.weight }
    }
}

/// Unscented Kalman filter; its covariance is dense.
#[derive(Clone, Debug)]
pub struct Unscented<M> {
    model: M,
    estimate: UnscentedSnapshot,
    gate: Gate,
    redraw: bool,
    rule: Rule,
    report: StepReport,
    work: Work,
}

/// Knowledge of an [`Unscented`] filter at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct UnscentedSnapshot {
    /// State `x`: (n).
    pub x: Vec<f64>,
    /// Covariance `P`: (n, n), column-major.
    pub p: Vec<f64>,
    /// Its square root `S`, upper triangular: (n, n), column-major.
    root: Vec<f64>,
    /// History of each output at the gate.
    pub gate_counts: Vec<GateCount>,
}

impl UnscentedSnapshot {
    fn copy_from(&mut self, other: &Self) {
        self.x.copy_from_slice(&other.x);
        self.p.copy_from_slice(&other.p);
        self.root.copy_from_slice(&other.root);
        self.gate_counts.copy_from_slice(&other.gate_counts);
    }

    /// Factor the covariance.
    fn refresh_root(&mut self, pivots: &mut [f64]) -> Result<(), EstimatorError> {
        symmetrise(&mut self.p, pivots.len());
        self.root.copy_from_slice(&self.p);
        factor_root(&mut self.root, pivots)
    }
}

/// Memory of a step.
#[derive(Clone, Debug)]
struct Work {
    /// The estimate in the making.
    next: UnscentedSnapshot,
    linear: Linearisation,
    /// Points: (n, 2n + 1).
    points: Vec<f64>,
    /// Values of the outputs at the points: (2n + 1) each.
    outputs: Vec<f64>,
    /// Mean of state and outputs: (n + outputs).
    mean: Vec<f64>,
    /// Joint covariance of state and outputs, and one column of it: (n + outputs, n + outputs).
    joint: Vec<f64>,
    column: Vec<f64>,
    /// Noise variances of the outputs.
    noise: Vec<f64>,
    pivots: Vec<f64>,
}

impl<M: StateSpace> Unscented<M> {
    /// Filter of `model` that starts at the state `x` (n) with the covariance `p` (n, n).
    ///
    /// # Errors
    /// Lengths differ, `p` is no covariance, or the settings are out of range.
    pub fn try_new(
        model: M,
        x: &[f64],
        p: &DMatrix<f64>,
        settings: &UnscentedSettings,
    ) -> Result<Self, EstimatorError> {
        let (n, outputs) = (model.states(), model.outputs());
        check_length(x.len(), n)?;
        check_length(p.nrows(), n)?;
        check_length(p.ncols(), n)?;
        check_state(x)?;
        let mut pivots = vec![0.0; n];
        let mut root = p.as_slice().to_vec();
        factor_root(&mut root, &mut pivots)?;
        let gate_counts = vec![GateCount::default(); outputs];
        let estimate = UnscentedSnapshot { x: x.to_vec(), p: p.as_slice().to_vec(), root, gate_counts };
        let work = Work {
            next: estimate.clone(),
            linear: Linearisation::zeros(n, model.leading(), model.noises()),
            points: vec![0.0; n * (2 * n + 1)],
            outputs: vec![0.0; outputs * (2 * n + 1)],
            mean: vec![0.0; n + outputs],
            joint: vec![0.0; (n + outputs) * (n + outputs)],
            column: vec![0.0; n + outputs],
            noise: vec![0.0; outputs],
            pivots,
        };
        Ok(Self {
            rule: Rule::try_new(settings, n)?,
            gate: Gate::try_new(settings.gate)?,
            redraw: settings.redraw,
            report: StepReport::new(outputs),
            model,
            estimate,
            work,
        })
    }

    /// State `x`: (n).
    pub fn state(&self) -> &[f64] {
        &self.estimate.x
    }

    /// Covariance `P`: (n, n).
    pub fn covariance(&self) -> DMatrix<f64> {
        DMatrix::from_column_slice(self.estimate.x.len(), self.estimate.x.len(), &self.estimate.p)
    }

    /// The process.
    pub fn model(&self) -> &M {
        &self.model
    }

    /// The process, e.g. to set its known inputs.
    pub fn model_mut(&mut self) -> &mut M {
        &mut self.model
    }

    /// What the last step told about its readings.
    pub fn report(&self) -> &StepReport {
        &self.report
    }

    /// History of each output at the gate.
    pub fn gate_counts(&self) -> &[GateCount] {
        &self.estimate.gate_counts
    }

    /// Advance by `dt_s`, s, and use the readings `z` (one per output, NaN where there is none).
    ///
    /// # Errors
    /// An argument, the process or an output is unusable, or a covariance is not positive semi-definite; the estimate
    /// is then as it was before.
    pub fn step(&mut self, dt_s: f64, z: &[f64]) -> Result<&StepReport, StepError<M::Error>> {
        check_sample(dt_s, z.len(), self.model.outputs())?;
        self.report.clear();
        self.work.next.copy_from(&self.estimate);
        if dt_s > 0.0 {
            self.predict(dt_s)?;
        }
        let last = z.iter().rposition(|z| z.is_finite()).map_or(0, |last| last + 1);
        if self.redraw {
            for j in (0..last).filter(|j| z[*j].is_finite()) {
                self.update(z, j..j + 1)?;
            }
        } else if last > 0 {
            self.update(z, 0..last)?;
        }
        self.estimate.copy_from(&self.work.next);
        Ok(&self.report)
    }

    /// Points of the estimate in the making.
    fn draw(&mut self) {
        let Work { next, points, .. } = &mut self.work;
        let n = next.x.len();
        for (i, point) in points.chunks_exact_mut(n.max(1)).enumerate() {
            point.copy_from_slice(&next.x);
            if i > 0 {
                let spread = if i > n { -self.rule.spread } else { self.rule.spread };
                axpy(spread, column(&next.root, n, (i - 1) % n), point);
            }
        }
    }
}

impl<M: StateSpace> SequentialFilter for Unscented<M> {
    type Snapshot = UnscentedSnapshot;
    type Error = M::Error;

    fn outputs(&self) -> usize {
        self.gate_counts().len()
    }

    fn snapshot(&self) -> UnscentedSnapshot {
        self.estimate.clone()
    }

    fn save(&self, snapshot: &mut UnscentedSnapshot) {
        snapshot.copy_from(&self.estimate);
    }

    fn restore(&mut self, snapshot: &UnscentedSnapshot) {
        self.estimate.copy_from(snapshot);
    }

    fn step(&mut self, dt_s: f64, z: &[f64]) -> Result<&StepReport, StepError<M::Error>> {
        self.step(dt_s, z)
    }
}

#[cfg(test)]
mod tests;
