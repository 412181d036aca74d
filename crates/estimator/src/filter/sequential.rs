//! What the filters have in common for those that run them over samples.
use super::failure::StepError;
use super::form::CovarianceForm;
use super::gate::GateCount;
use super::kalman::ExtendedKalman;
use super::report::StepReport;
use super::state_space::StateSpace;

/// A filter that takes one sample after the other and can return to an earlier time.
pub trait SequentialFilter {
    /// All that the filter knows at one time.
    type Snapshot: Clone;
    /// Error of its process.
    type Error;

    /// Number of outputs.
    fn outputs(&self) -> usize;

    /// Take a snapshot.
    fn snapshot(&self) -> Self::Snapshot;

    /// Take a snapshot into the memory of an earlier one, without allocating.
    fn save(&self, snapshot: &mut Self::Snapshot);

    /// Return to a snapshot.
    fn restore(&mut self, snapshot: &Self::Snapshot);

    /// Advance by `dt_s`, s, and use the readings `z` (one per output, NaN where there is none).
    ///
    /// # Errors
    /// The step cannot be taken; the filter is then as it was before.
    fn step(&mut self, dt_s: f64, z: &[f64]) -> Result<&StepReport, StepError<Self::Error>>;
}

/// Knowledge of an [`ExtendedKalman`] filter at one time.
#[derive(Clone, Debug)]
pub struct KalmanSnapshot<F> {
    /// State `x`: (n).
    pub x: Vec<f64>,
    /// Covariance `P`.
    pub form: F,
    /// History of each output at the gate.
    pub gate_counts: Vec<GateCount>,
}

impl<M: StateSpace, F: CovarianceForm> SequentialFilter for ExtendedKalman<M, F> {
    type Snapshot = KalmanSnapshot<F>;
    type Error = M::Error;

    fn outputs(&self) -> usize {
        self.gate_counts().len()
    }

    fn snapshot(&self) -> KalmanSnapshot<F> {
        let gate_counts = self.gate_counts().to_vec();
        KalmanSnapshot { x: self.state().to_vec(), form: self.form().clone(), gate_counts }
    }

    fn save(&self, snapshot: &mut KalmanSnapshot<F>) {
        snapshot.x.copy_from_slice(self.state());
        snapshot.form.copy_from(self.form());
        snapshot.gate_counts.copy_from_slice(self.gate_counts());
    }

    fn restore(&mut self, snapshot: &KalmanSnapshot<F>) {
        self.state_mut().copy_from_slice(&snapshot.x);
        self.form_mut().copy_from(&snapshot.form);
        self.gate_counts_mut().copy_from_slice(&snapshot.gate_counts);
    }

    fn step(&mut self, dt_s: f64, z: &[f64]) -> Result<&StepReport, StepError<M::Error>> {
        self.step(dt_s, z)
    }
}
