//! Kalman filter with the gain of the steady state.
//!
//! The process is linearised once, at a given state and interval; [`steady_state`] gives covariance and gain. As long as
//! every sample is complete, passes the gate and comes after the same interval, a step costs one call of the process, the
//! outputs and a product with the gain: no covariance moves.
//!
//! A missing or rejected reading, or another interval, makes another gain right, and that until long after: the filter
//! then moves the covariance as the full filter does, from the steady state on, with the constant matrices, until it is
//! back there within a tolerance. So the gain is always that of the available readings and their history, and on a linear
//! process this is the Kalman filter started in the steady state.
use nalgebra::{DMatrix, DVector, Dyn};

use super::failure::{StepError, check_length, check_linearisation, check_output, check_sample, check_state};
use super::gate::{Gate, GateCount, GateSettings};
use super::kernel::{column, column_mut};
use super::report::StepReport;
use super::riccati::{SteadyState, steady_state};
use super::sequential::SequentialFilter;
use super::state_space::{Linearisation, StateSpace};
use super::ud::UdFactors;
use crate::EstimatorError;

mod update;

/// Where a [`Stationary`] filter is linearised, and when it uses its steady state.
#[derive(Clone, Debug, PartialEq)]
pub struct StationarySettings {
    /// Interval of the samples, s.
    pub interval_s: f64,
    /// Gate per output; `None` uses every reading.
    pub gate: Option<GateSettings>,
    /// The steady state is reached when no covariance differs by more than this share of the standard deviations.
    pub tolerance: f64,
}

impl StationarySettings {
    /// Samples every `interval_s`, s, no gate, tolerance 1e-9.
    pub fn new(interval_s: f64) -> Self {
        Self { interval_s, gate: None, tolerance: 1e-9 }
    }
}

/// Kalman filter with stationary gain.
#[derive(Clone, Debug)]
pub struct Stationary<M> {
    model: M,
    x: Vec<f64>,
    form: UdFactors<Dyn>,
    /// Whether the covariance is that of the steady state; `form` is then of no meaning.
    settled: bool,
    gate: Gate,
    counts: Vec<GateCount>,
    interval_s: f64,
    tolerance: f64,
    steady: SteadyState,
    fixed: Fixed,
    report: StepReport,
    work: Work,
}

/// The linearised process in its steady state.
#[derive(Clone, Debug)]
struct Fixed {
    linear: Linearisation,
    /// Gradients of the outputs, one per column: (n, outputs).
    h: DMatrix<f64>,
    r: DVector<f64>,
    /// Gain (n, outputs) and innovation variance of each output when those before it have been used.
    gain: DMatrix<f64>,
    s: DVector<f64>,
    predicted: UdFactors<Dyn>,
    updated: UdFactors<Dyn>,
}

/// Memory of a step.
#[derive(Clone, Debug)]
struct Work {
    predicted: Vec<f64>,
    moved: Vec<f64>,
    gain: Vec<f64>,
    /// Outputs at the prediction.
    y: Vec<f64>,
    /// Transition over another interval.
    linear: Linearisation,
    covariance: Vec<f64>,
}

/// Knowledge of a [`Stationary`] filter at one time.
#[derive(Clone, Debug)]
pub struct StationarySnapshot {
    /// State `x`: (n).
    pub x: Vec<f64>,
    /// History of each output at the gate.
    pub gate_counts: Vec<GateCount>,
    form: UdFactors<Dyn>,
    settled: bool,
}

impl Fixed {
    /// Linearise `model` at the state `point`, and find its steady state.
    fn build<M: StateSpace>(
        model: &mut M,
        point: &[f64],
        interval_s: f64,
    ) -> Result<(Self, SteadyState), StepError<M::Error>> {
        let (n, m, outputs) = (model.states(), model.leading(), model.outputs());
        let mut linear = Linearisation::zeros(n, m, model.noises());
        model.propagate(&mut point.to_vec(), interval_s, Some(&mut linear)).map_err(StepError::Model)?;
        check_linearisation(&linear)?;
        let (mut h, mut r) = (DMatrix::zeros(n, outputs), DVector::zeros(outputs));
        for j in 0..outputs {
            let h = column_mut(h.as_mut_slice(), n, j);
            let y = model.output(j, point, Some(h)).map_err(StepError::Model)?;
            r[j] = model.noise_variance(j, point);
            check_output(j, y, h, r[j])?;
        }
        let mut f = DMatrix::identity(n, n);
        f.rows_mut(0, m).copy_from(&linear.phi);
        let mut q = DMatrix::zeros(n, n);
        let noise = &linear.g * DMatrix::from_diagonal(&linear.q) * linear.g.transpose();
        q.view_mut((0, 0), (m, m)).copy_from(&noise);
        let steady = steady_state(&f, &h.transpose(), &q, &r)?;
        let predicted = UdFactors::from_covariance(&steady.predicted)?;
        let mut fixed = Self {
            gain: DMatrix::zeros(n, outputs),
            s: DVector::zeros(outputs),
            updated: predicted.clone(),
            predicted,
            linear,
            h,
            r,
        };
        for j in 0..outputs {
            let gain = column_mut(fixed.gain.as_mut_slice(), n, j);
            fixed.s[j] = fixed.updated.update(column(fixed.h.as_slice(), n, j), fixed.r[j], gain);
        }
        Ok((fixed, steady))
    }
}

impl<M: StateSpace> Stationary<M> {
    /// Filter of `model` that starts at the state `x` (n) with the covariance of the steady state, linearised at the
    /// state `point` (n).
    ///
    /// # Errors
    /// The process refuses or has no steady state, lengths differ, or the settings are out of range.
    pub fn try_new(
        mut model: M,
        x: &[f64],
        point: &[f64],
        settings: &StationarySettings,
    ) -> Result<Self, StepError<M::Error>> {
        let (n, outputs) = (model.states(), model.outputs());
        check_length(x.len(), n)?;
        check_length(point.len(), n)?;
        check_state(x)?;
        if !(settings.interval_s.is_finite() && settings.interval_s > 0.0) {
            return Err(EstimatorError::IntervalNotPositive { interval_s: settings.interval_s }.into());
        }
        let (fixed, steady) = Fixed::build(&mut model, point, settings.interval_s)?;
        let mut form = fixed.updated.clone();
        form.reserve(model.leading(), model.noises());
        Ok(Self {
            x: x.to_vec(),
            form,
            settled: true,
            gate: Gate::try_new(settings.gate)?,
            counts: vec![GateCount::default(); outputs],
            interval_s: settings.interval_s,
            tolerance: settings.tolerance,
            steady,
            report: StepReport::new(outputs),
            work: Work {
                predicted: vec![0.0; n],
                moved: vec![0.0; n],
                gain: vec![0.0; n],
                y: vec![0.0; outputs],
                linear: fixed.linear.clone(),
                covariance: vec![0.0; n * n],
            },
            fixed,
            model,
        })
    }

    /// State `x`: (n).
    pub fn state(&self) -> &[f64] {
        &self.x
    }

    /// The steady state.
    pub fn steady_state(&self) -> &SteadyState {
        &self.steady
    }

    /// Whether the covariance is that of the steady state.
    pub fn is_settled(&self) -> bool {
        self.settled
    }

    /// Covariance `P`: (n, n).
    pub fn covariance(&self) -> DMatrix<f64> {
        if self.settled { self.steady.updated.clone() } else { self.form.covariance() }
    }

    /// What the last step told about its readings.
    pub fn report(&self) -> &StepReport {
        &self.report
    }

    /// History of each output at the gate.
    pub fn gate_counts(&self) -> &[GateCount] {
        &self.counts
    }

    /// Advance by `dt_s`, s, and use the readings `z` (one per output, NaN where there is none).
    ///
    /// # Errors
    /// An argument, the process or an output is unusable; the filter is then as it was before.
    pub fn step(&mut self, dt_s: f64, z: &[f64]) -> Result<&StepReport, StepError<M::Error>> {
        check_sample(dt_s, z.len(), self.model.outputs())?;
        let regular = dt_s == self.interval_s;
        self.propagate(dt_s, regular)?;
        self.predict_outputs(z)?;
        if !(self.settled && regular && self.all_pass(z)) {
            self.move_covariance(dt_s, regular);
        }
        self.correct(z);
        if regular && !self.settled {
            self.settle();
        }
        Ok(&self.report)
    }
}

impl<M: StateSpace> SequentialFilter for Stationary<M> {
    type Snapshot = StationarySnapshot;
    type Error = M::Error;

    fn outputs(&self) -> usize {
        self.counts.len()
    }

    fn snapshot(&self) -> StationarySnapshot {
        let gate_counts = self.counts.clone();
        StationarySnapshot { x: self.x.clone(), gate_counts, form: self.form.clone(), settled: self.settled }
    }

    fn save(&self, snapshot: &mut StationarySnapshot) {
        snapshot.x.copy_from_slice(&self.x);
        snapshot.gate_counts.copy_from_slice(&self.counts);
        snapshot.form.copy_from(&self.form);
        snapshot.settled = self.settled;
    }

    fn restore(&mut self, snapshot: &StationarySnapshot) {
        self.x.copy_from_slice(&snapshot.x);
        self.counts.copy_from_slice(&snapshot.gate_counts);
        self.form.copy_from(&snapshot.form);
        self.settled = snapshot.settled;
    }

    fn step(&mut self, dt_s: f64, z: &[f64]) -> Result<&StepReport, StepError<M::Error>> {
        self.step(dt_s, z)
    }
}
