//! What the journal holds of a world.
use serde::{Deserialize, Serialize};

use super::score::Score;
use super::score::detection::LeakFacts;

/// Facts of a world and scores of its candidates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Entry {
    /// What is true of it; or why it could not be made.
    pub facts: Result<Facts, String>,
    /// Scores in the order of the task's candidates; or why there is none.
    pub scores: Vec<Result<Score, String>>,
}

/// What is true of a world, beside its request.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Facts {
    /// Rows.
    pub rows: u64,
    /// True time from the first row to the last one, s.
    pub length_s: f64,
    /// Its leak.
    pub leak: Option<LeakFacts>,
}
