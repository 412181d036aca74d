//! What the rows since the start leave behind beside the state, in memory that does not grow.
use crate::detector::monitor::{Outcome, Output};
use crate::log::Sampling;
use crate::report::fleet::Trace;

/// What was seen of rows; a state has none of it.
#[derive(Default)]
pub(super) struct Seen {
    pub sampling: Sampling,
    /// Course of the pressure at 15 °C.
    pub trace: Trace,
    /// Whether gas was lost in any of them.
    pub loss_found: bool,
}

impl Seen {
    /// Takes in the time of a row, s.
    pub(super) fn row(&mut self, time_s: f64) {
        self.sampling.push(time_s);
    }

    /// Takes in an output.
    pub(super) fn output(&mut self, output: &Output) {
        self.trace.push(output.stamp_s, output.estimate.p15_pa);
        self.loss_found |= output.decision.outcome == Outcome::Loss;
    }
}
