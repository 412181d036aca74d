//! Extended Kalman filter on a [`StateSpace`] with any [`CovarianceForm`].
//!
//! Prediction: `x <- f(x, dt)`, `P <- F P F^T + G diag(q) G^T`. Update: all outputs are linearised at the prediction
//! and then taken one by one, which equals the vector update, as their noises are independent:
//! `nu = z_j - h_j(x-) - H_j (x - x-)`, `S = H_j P H_j^T + R_j`, `K = P H_j^T / S`, `x <- x + K nu`.
//! The order of the outputs matters to the gate alone.
//!
//! Options: a [gate](GateSettings) per output; iteration of the linearisation (iterated extended Kalman filter, the
//! Gauss-Newton method for the mode of the posterior, Bell and Cathey 1993); consider states (Schmidt 1966) with
//! forced zero gain: if `c` is the dropped part of the optimal gain, `P <- P_optimal + S c c^T`.
use super::failure::{StepError, check_length, check_linearisation, check_sample, check_state};
use super::form::CovarianceForm;
use super::gate::{Gate, GateCount, GateSettings};
use super::report::StepReport;
use super::state_space::{Linearisation, StateSpace};
use crate::EstimatorError;

mod update;

/// Options of an [`ExtendedKalman`] filter. The default is plain: no gate, no iteration, every state estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct KalmanSettings {
    /// Gate per output; `None` uses every reading.
    pub gate: Option<GateSettings>,
    /// Largest number of relinearisations of an update; 0 is the extended Kalman filter.
    pub iterations: usize,
    /// An iteration ends when no state moves by more than this share of its standard deviation.
    pub tolerance: f64,
    /// States that are uncertain but never corrected.
    pub consider: Vec<usize>,
}

impl Default for KalmanSettings {
    fn default() -> Self {
        Self { gate: None, iterations: 0, tolerance: 1e-6, consider: Vec::new() }
    }
}

/// Extended Kalman filter.
#[derive(Clone, Debug)]
pub struct ExtendedKalman<M, F> {
    model: M,
    x: Vec<f64>,
    form: F,
    gate: Gate,
    counts: Vec<GateCount>,
    iterations: usize,
    tolerance: f64,
    consider: Vec<usize>,
    report: StepReport,
    work: Work<F>,
}

/// Memory of a step. What it holds afterwards describes the step.
#[derive(Clone, Debug)]
pub(super) struct Work<F> {
    /// Interval of the last step, s.
    pub dt_s: f64,
    /// Transition of the last step, if its interval was not zero.
    pub linear: Linearisation,
    /// Outputs at the point of linearisation, their gradients (n each) and noise variances.
    y: Vec<f64>,
    pub h: Vec<f64>,
    r: Vec<f64>,
    /// Gain (n), innovation and its variance of each output that was used.
    pub gain: Vec<f64>,
    pub innovation: Vec<f64>,
    pub variance: Vec<f64>,
    /// Prediction, point of linearisation, and scratch: (n) each.
    predicted: Vec<f64>,
    point: Vec<f64>,
    scratch: Vec<f64>,
    /// Predicted covariance, for another iteration.
    form: F,
}

impl<F: CovarianceForm> Work<F> {
    fn new(n: usize, outputs: usize, linear: Linearisation, form: &F) -> Self {
        Self {
            dt_s: 0.0,
            linear,
            y: vec![0.0; outputs],
            h: vec![0.0; outputs * n],
            r: vec![0.0; outputs],
            gain: vec![0.0; outputs * n],
            innovation: vec![0.0; outputs],
            variance: vec![0.0; outputs],
            predicted: vec![0.0; n],
            point: vec![0.0; n],
            scratch: vec![0.0; n],
            form: form.clone(),
        }
    }
}

impl<M: StateSpace, F: CovarianceForm> ExtendedKalman<M, F> {
    /// Filter of `model` that starts at the state `x` (n) with the covariance `form`.
    ///
    /// # Errors
    /// Lengths differ, the gate's probability is not between 0 and 1, or a consider state does not exist.
    pub fn try_new(
        model: M,
        x: &[f64],
        mut form: F,
        settings: &KalmanSettings,
    ) -> Result<Self, EstimatorError> {
        let (n, outputs) = (model.states(), model.outputs());
        check_length(x.len(), n)?;
        check_length(form.states(), n)?;
        check_state(x)?;
        if let Some(&state) = settings.consider.iter().find(|state| **state >= n) {
            return Err(EstimatorError::StateUnknown { state, states: n });
        }
        form.reserve(model.leading(), model.noises());
        let linear = Linearisation::zeros(n, model.leading(), model.noises());
        Ok(Self {
            x: x.to_vec(),
            gate: Gate::try_new(settings.gate)?,
            counts: vec![GateCount::default(); outputs],
            iterations: settings.iterations,
            tolerance: settings.tolerance,
            consider: settings.consider.clone(),
            report: StepReport::new(outputs),
            work: Work::new(n, outputs, linear, &form),
            model,
            form,
        })
    }

    /// State `x`: (n).
    pub fn state(&self) -> &[f64] {
        &self.x
    }

    /// State `x`, to be changed from outside.
    pub fn state_mut(&mut self) -> &mut [f64] {
        &mut self.x
    }

    /// Covariance `P`.
    pub fn form(&self) -> &F {
        &self.form
    }

    /// Covariance `P`, to be changed from outside.
    pub fn form_mut(&mut self) -> &mut F {
        &mut self.form
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
        &self.counts
    }

    pub(super) fn gate_counts_mut(&mut self) -> &mut [GateCount] {
        &mut self.counts
    }

    pub(super) fn work(&self) -> &Work<F> {
        &self.work
    }

    pub(super) fn has_consider_states(&self) -> bool {
        !self.consider.is_empty()
    }

    /// Advance by `dt_s`, s, and use the readings `z` (one per output, NaN where there is none).
    ///
    /// # Errors
    /// An argument, the process or an output is unusable; the filter is then as it was before.
    pub fn step(&mut self, dt_s: f64, z: &[f64]) -> Result<&StepReport, StepError<M::Error>> {
        check_sample(dt_s, z.len(), self.model.outputs())?;
        self.propagate(dt_s)?;
        self.work.point.copy_from_slice(&self.work.predicted);
        self.linearise(z, true)?;
        self.commit_prediction(dt_s);
        self.assimilate(z)?;
        Ok(&self.report)
    }

    /// Advance by `dt_s`, s, without readings.
    ///
    /// # Errors
    /// The interval is negative or the process refuses; the filter is then as it was before.
    pub fn predict(&mut self, dt_s: f64) -> Result<(), StepError<M::Error>> {
        check_sample(dt_s, 0, 0)?;
        self.propagate(dt_s)?;
        self.commit_prediction(dt_s);
        Ok(())
    }

    /// Use the readings `z` (one per output, NaN where there is none) at the present time.
    ///
    /// # Errors
    /// An output is unusable; the filter is then as it was before.
    pub fn update(&mut self, z: &[f64]) -> Result<&StepReport, StepError<M::Error>> {
        self.step(0.0, z)
    }

    /// Predicted state and transition, not yet those of the filter.
    fn propagate(&mut self, dt_s: f64) -> Result<(), StepError<M::Error>> {
        let work = &mut self.work;
        work.predicted.copy_from_slice(&self.x);
        if dt_s > 0.0 {
            let linear = Some(&mut work.linear);
            self.model.propagate(&mut work.predicted, dt_s, linear).map_err(StepError::Model)?;
            check_state(&work.predicted)?;
            check_linearisation(&work.linear)?;
        }
        Ok(())
    }

    /// From here on the filter is at the new time.
    fn commit_prediction(&mut self, dt_s: f64) {
        if dt_s > 0.0 {
            self.form.predict(&self.work.linear);
        }
        self.x.copy_from_slice(&self.work.predicted);
        self.work.dt_s = dt_s;
        self.report.clear();
    }
}

#[cfg(test)]
mod tests;
