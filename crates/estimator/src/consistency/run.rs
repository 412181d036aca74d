//! All statistics of one run, in fixed room.
use super::report::{ConsistencyReport, NisReport, OutputReport};
use super::{Coverage, NisAccumulator, Normality, Significance, Whiteness};
use crate::filter::{Innovation, Outcome};

/// Statistics of the innovations of one run, sample by sample.
#[derive(Clone, Debug, PartialEq)]
pub struct RunConsistency {
    total: NisAccumulator,
    outputs: Vec<Output>,
    normality: Normality,
    coverage: Vec<(String, Coverage)>,
}

#[derive(Clone, Debug, PartialEq)]
struct Output {
    name: String,
    nis: NisAccumulator,
    whiteness: Whiteness,
}

impl RunConsistency {
    /// Lags that are compared unless told otherwise, in samples.
    pub const LAGS: usize = 20;

    /// A run without samples, of outputs with these names, compared over up to `lags` samples.
    pub fn new<S: AsRef<str>>(outputs: &[S], lags: usize) -> Self {
        let output = |name: &S| Output {
            name: name.as_ref().to_owned(),
            nis: NisAccumulator::default(),
            whiteness: Whiteness::new(lags),
        };
        Self {
            total: NisAccumulator::default(),
            outputs: outputs.iter().map(output).collect(),
            normality: Normality::default(),
            coverage: Vec::new(),
        }
    }

    /// Add the innovation of an output at one sample: `nu` and its variance `s` before the gate, NaN where there was no
    /// reading. An output that the run does not have is left out.
    pub(crate) fn record(&mut self, output: usize, nu: f64, s: f64, accepted: bool) {
        let Some(output) = self.outputs.get_mut(output) else { return };
        let normalised = if s > 0.0 { nu / s.sqrt() } else { f64::NAN };
        self.total.add(nu, s, accepted);
        output.nis.add(nu, s, accepted);
        output.whiteness.push(normalised);
        self.normality.push(normalised);
    }

    /// Add a sample of a filter or of the observer.
    pub fn record_innovations(&mut self, innovations: &[Innovation]) {
        for (output, innovation) in innovations.iter().enumerate() {
            self.record(output, innovation.nu, innovation.s, innovation.outcome == Outcome::Accepted);
        }
    }

    /// Add an error against a known truth of the quantity of this name, with its stated standard deviation.
    pub fn record_error(&mut self, quantity: &str, error: f64, sd: f64) {
        let at = self.coverage.iter().position(|(name, _)| name == quantity).unwrap_or_else(|| {
            self.coverage.push((quantity.to_owned(), Coverage::default()));
            self.coverage.len() - 1
        });
        self.coverage[at].1.add(error, sd);
    }

    /// The statistics so far with what they say at a significance.
    pub fn report(&self, significance: Significance) -> ConsistencyReport {
        let output = |output: &Output| {
            let whiteness = &output.whiteness;
            let largest = whiteness.largest();
            let each = significance.shared_by(whiteness.lags());
            OutputReport {
                name: output.name.clone(),
                nis: NisReport::of(&output.nis, significance),
                largest_autocorrelation: largest,
                autocorrelation_bound: largest.and_then(|(lag, _)| whiteness.bound(lag, each)),
                whiteness: whiteness.finding(significance),
            }
        };
        ConsistencyReport {
            significance,
            nis: NisReport::of(&self.total, significance),
            outputs: self.outputs.iter().map(output).collect(),
            lilliefors: self.normality.test(),
            normality: self.normality.finding(significance),
            coverage: self.coverage.clone(),
        }
    }
}
