//! Who hears the innovations of a run, e.g. to sum up a statistic of a leak.
use crate::estimator::observer::Innovation;

/// Which run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunId {
    /// Seed of the truth.
    pub seed: u64,
    /// Index of the layout.
    pub layout: usize,
}

/// Hears every row of one run; each run has its own.
pub trait Listener: Send {
    /// Innovations of the first member after a row at a time, s: one for each sensor of the layout, in its order, before the gates.
    fn hear(&mut self, time_s: f64, innovations: &[Innovation]);
}

impl Listener for () {
    fn hear(&mut self, _: f64, _: &[Innovation]) {}
}

/// Keeps the innovations of the rows from a time on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recorder {
    /// First time that is kept, s.
    pub from_s: f64,
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Innovations of each of these rows.
    pub innovations: Vec<Vec<Innovation>>,
}

impl Recorder {
    /// Keeps what comes from a time on, s.
    pub fn from(from_s: f64) -> Self {
        Self { from_s, ..Self::default() }
    }
}

impl Listener for Recorder {
    fn hear(&mut self, time_s: f64, innovations: &[Innovation]) {
        if time_s >= self.from_s {
            self.time_s.push(time_s);
            self.innovations.push(innovations.to_vec());
        }
    }
}
