//! What a filter's step tells about its readings.
use super::gate::Outcome;

/// One output in one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutputReport {
    /// Innovation `nu`, reading minus prediction given the outputs used before it; zero if there was no reading.
    pub innovation: f64,
    /// Its variance `S` before the gate, zero if there was no reading.
    pub variance: f64,
    /// What became of the reading.
    pub outcome: Outcome,
}

/// All outputs in one step. With sequential updates the innovations of one step are uncorrelated, so that the sums
/// have chi-square distributions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// By output.
    pub outputs: Vec<OutputReport>,
    /// Normalised innovation squared, the sum of `nu^2/S` over all readings, before the gate.
    pub nis: f64,
    /// Number of readings: degrees of freedom of `nis`.
    pub dof: usize,
    /// The same sum over the accepted readings alone: the gate has cut its tail.
    pub nis_accepted: f64,
    /// Number of accepted readings.
    pub dof_accepted: usize,
    /// Relinearisations of the update beyond the first.
    pub iterations: usize,
    /// Whether the iterated update converged; if not, the update linearised at the prediction was taken.
    pub converged: bool,
}

impl StepReport {
    pub(crate) fn new(outputs: usize) -> Self {
        Self { outputs: vec![OutputReport::default(); outputs], converged: true, ..Self::default() }
    }

    /// Forget the last step.
    pub(crate) fn clear(&mut self) {
        self.outputs.fill(OutputReport::default());
        (self.nis, self.nis_accepted) = (0.0, 0.0);
        (self.dof, self.dof_accepted) = (0, 0);
        (self.iterations, self.converged) = (0, true);
    }

    /// Enter a reading.
    pub(crate) fn enter(&mut self, output: usize, innovation: f64, variance: f64, outcome: Outcome) {
        self.outputs[output] = OutputReport { innovation, variance, outcome };
        let squared = innovation * innovation / variance;
        self.nis += squared;
        self.dof += 1;
        if outcome == Outcome::Accepted {
            self.nis_accepted += squared;
            self.dof_accepted += 1;
        }
    }
}
