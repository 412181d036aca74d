//! How rows are taken in.
use serde::{Deserialize, Serialize};

use crate::DetectorError;

/// How rows are taken in. SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct IntakeSettings {
    /// Allowed lateness, s: rows are held back so long and come out sorted; 0: each row at once.
    pub lateness_s: f64,
    /// Width of the bins in which rows are made one, s; 0: each row by itself.
    pub step_s: f64,
    /// Time without rows from which it is reported as a gap, s. The row after a gap is held back until a second one confirms it.
    pub gap_s: f64,
    /// Longest gap that is believed, s: a longer one is a jump of the clock.
    pub longest_gap_s: f64,
}

impl Default for IntakeSettings {
    /// Bins of a minute: the observer's errors and the thresholds against them know nothing shorter, and a minute costs what a row does.
    fn default() -> Self {
        Self { lateness_s: 0.0, step_s: 60.0, gap_s: 3600.0, longest_gap_s: 100.0 * 86_400.0 }
    }
}

impl IntakeSettings {
    /// Check every value.
    ///
    /// # Errors
    /// Names the setting, its value and the bound.
    pub(crate) fn validate(&self) -> Result<(), DetectorError> {
        let require = |ok: bool, setting: &'static str, value: f64, bound: &'static str| {
            if ok { Ok(()) } else { Err(DetectorError::Setting { setting, value, bound }) }
        };
        let not_negative = |value: f64| value >= 0.0 && value.is_finite();
        require(not_negative(self.lateness_s), "lateness_s", self.lateness_s, "finite and at least 0")?;
        require(not_negative(self.step_s), "step_s", self.step_s, "finite and at least 0")?;
        require(self.gap_s > 0.0 && self.gap_s.is_finite(), "gap_s", self.gap_s, "positive and finite")?;
        let enough = self.longest_gap_s > self.gap_s.max(self.lateness_s) && self.longest_gap_s.is_finite();
        require(enough, "longest_gap_s", self.longest_gap_s, "finite, above `gap_s` and `lateness_s`")
    }
}
