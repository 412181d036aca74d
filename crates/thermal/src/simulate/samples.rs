//! The output samples of a run: at multiples of the sample time, and at the end.
use crate::model::Output;
use crate::scenario::Scenario;

/// The samples taken so far.
pub struct Samples {
    interval_s: f64,
    duration_s: f64,
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Air temperatures, K.
    pub ambient_k: Vec<f64>,
    /// Everything else.
    pub outputs: Vec<Output>,
}

impl Samples {
    /// None yet.
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            interval_s: scenario.sample_time_s,
            duration_s: scenario.duration_s,
            time_s: Vec::new(),
            ambient_k: Vec::new(),
            outputs: Vec::new(),
        }
    }

    /// Time of the next sample if it lies before `until` (or at it when `inclusive`), s. The end is always a sample.
    pub fn next_time(&self, until: f64, inclusive: bool) -> Option<f64> {
        if self.time_s.last().is_some_and(|&last| last >= self.duration_s) {
            return None;
        }
        let t = (self.time_s.len() as f64 * self.interval_s).min(self.duration_s);
        (t < until || (inclusive && t <= until)).then_some(t)
    }

    /// Add a sample.
    pub fn push(&mut self, time_s: f64, ambient_k: f64, output: Output) {
        self.time_s.push(time_s);
        self.ambient_k.push(ambient_k);
        self.outputs.push(output);
    }
}
