//! What is told of a run over a fleet while it goes on.
use crate::report::number;
use std::fmt;

/// How far a run over a fleet is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FleetProgress {
    /// Cylinders that are done.
    pub done: usize,
    /// Cylinders there are.
    pub cylinders: usize,
    /// Rows read in a second, on average.
    pub rows_per_s: f64,
    /// Time left, s, by the bytes of the logs; `None` while no log is done.
    pub left_s: Option<f64>,
}

impl fmt::Display for FleetProgress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { done, cylinders, rows_per_s, .. } = self;
        write!(f, "{done} of {cylinders} cylinders, {} rows/s", number(*rows_per_s, 2))
    }
}
