//! Where the innovations of a run go, e.g. to sum up a statistic of a leak.
use crate::estimator::observer::Innovation;

/// Which run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunId {
    /// Seed of the truth.
    pub seed: u64,
    /// Index of the layout.
    pub layout: usize,
}

/// Takes the innovations of every row of one run; each run has its own.
pub trait InnovationSink: Send {
    /// Innovations of the first member after a row at a time, s: one for each sensor of the layout, in its order, before the gates.
    fn record(&mut self, time_s: f64, innovations: &[Innovation]);
}

impl InnovationSink for () {
    fn record(&mut self, _: f64, _: &[Innovation]) {}
}
