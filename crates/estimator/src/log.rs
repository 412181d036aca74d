//! Recorded readings: one row per time, any value may be missing.

use alloc::string::String;
use alloc::vec::Vec;
pub use cylwatch_thermal::sensor::Quantity;

/// One column of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name of the sensor, e.g. `shoulder`, `valve`, `wall_middle`, `ambient`, `pressure`, `gas_1`.
    pub name: String,
    /// What it measures.
    pub quantity: Quantity,
}

/// Rows of readings in memory.
///
/// # Shapes
/// `values`: `time_s.len() * channels.len()`, row by row; NaN is a missing value.
#[derive(Clone, Debug, Default)]
pub struct Log {
    /// Columns.
    pub channels: Vec<Channel>,
    /// Time of each row, s, increasing.
    pub time_s: Vec<f64>,
    /// Readings, SI.
    pub values: Vec<f64>,
}

impl Log {
    /// Readings of one row, in the order of the channels.
    pub fn row(&self, index: usize) -> &[f64] {
        let width = self.channels.len();
        &self.values[index * width..(index + 1) * width]
    }

    /// Rows with their times, s.
    pub fn rows(&self) -> impl Iterator<Item = (f64, &[f64])> {
        self.time_s.iter().enumerate().map(|(index, &time_s)| (time_s, self.row(index)))
    }
}

/// Median interval between times, in their unit; `None` with fewer than two.
#[cfg(feature = "design")]
pub(crate) fn median_interval(times: &[f64]) -> Option<f64> {
    let mut intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = intervals.len() / 2;
    (!intervals.is_empty()).then(|| *intervals.select_nth_unstable_by(middle, f64::total_cmp).1)
}
