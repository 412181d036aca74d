//! Gate of an output: a reading too far from its prediction is not used.
//!
//! A reading with the innovation `nu` of variance `S` passes if `nu^2 <= limit S`. After so many rejections in a row the filter is
//! taken to be wrong, not the sensor: the next reading is used whatever its innovation.
use serde::{Deserialize, Serialize};

/// What became of a reading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Outcome {
    /// It was used.
    Accepted,
    /// Its gate refused it.
    Rejected,
    /// It was used after too many rejections in a row: the estimate was opened for it.
    Reacquired,
    /// There was none.
    #[default]
    Missing,
}

/// Innovation of one output, before its gate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Innovation {
    /// Reading minus prediction, in the unit of the output.
    pub nu: f64,
    /// Its predicted variance, in the square of that unit.
    pub s: f64,
    /// What became of the reading.
    pub outcome: Outcome,
}

impl Innovation {
    /// No reading.
    pub const MISSING: Self = Self { nu: f64::NAN, s: f64::NAN, outcome: Outcome::Missing };
}

/// Which innovations pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    /// Largest `nu^2/S` that passes.
    pub limit: f64,
    /// Rejections in a row of one output, after which its next reading is used.
    pub rejections_in_a_row: u32,
}

impl Default for Gate {
    /// Five standard deviations, ten rejections.
    fn default() -> Self {
        Self { limit: 25.0, rejections_in_a_row: 10 }
    }
}

impl Gate {
    /// What becomes of a reading with the innovation `nu` of variance `s`, and the count of rejections in a row after it.
    pub(crate) fn judge(self, (nu, s): (f64, f64), rejected: &mut u32) -> Outcome {
        let outcome = match () {
            () if nu * nu > self.limit * s && *rejected < self.rejections_in_a_row => Outcome::Rejected,
            () if nu * nu > self.limit * s => Outcome::Reacquired,
            () => Outcome::Accepted,
        };
        *rejected = if outcome == Outcome::Rejected { *rejected + 1 } else { 0 };
        outcome
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_output_rejected_too_often_is_used_again() {
        let (gate, mut rejected) = (Gate { limit: 9.0, rejections_in_a_row: 3 }, 0);
        let mut judge = |nu: f64| gate.judge((nu, 4.0), &mut rejected);
        assert_eq!(
            [judge(6.0), judge(-6.1), judge(5.0)],
            [Outcome::Accepted, Outcome::Rejected, Outcome::Accepted]
        );
        let beyond = [7.0; 5].map(judge);
        assert_eq!(beyond[..3], [Outcome::Rejected; 3]);
        assert_eq!(beyond[3..], [Outcome::Reacquired, Outcome::Rejected]);
    }
}
