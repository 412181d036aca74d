//! Rows that lie closer together than a step made one: per sensor the median of three readings or more, the mean of two.
//!
//! Bins lie on a fixed grid of the internal time, `floor(t/step)`, so that rows at the step or slower pass as they are, and where the
//! log begins changes nothing. A bin is handed out when a row of another one comes; a row at once while the rows before came at the step
//! or slower.
use alloc::collections::VecDeque;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use super::row::{Readings, Row};
use crate::DetectorError;
use crate::monitor::restored::{self, Restored};

/// Rows in a bin at most; a fuller one is handed out early.
const ROWS_AT_MOST: usize = 256;
/// Part of the step that makes an interval one of slow rows: stamps jitter.
const SLOW: f64 = 0.9;

/// The bin that is being filled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Bins {
    step_s: f64,
    /// Time and stamp of the last row in it, s; none: it is empty.
    last_s: Option<(f64, f64)>,
    rows: usize,
    /// Readings of its rows, sensor by sensor.
    readings: Vec<Vec<f64>>,
    /// Time of the last row where it was handed out at once, s.
    passed_s: Option<f64>,
}

impl Bins {
    /// Checks one that was saved.
    pub(super) fn validate(&self, step_s: f64, of: &Restored) -> Result<(), DetectorError> {
        restored::require(self.step_s == step_s, "intake.bins.step_s", self.step_s, "that of the settings")?;
        restored::at_most(ROWS_AT_MOST, "intake.bins.rows", self.rows)?;
        of.each("intake.bins.readings", self.readings.len())?;
        for readings in &self.readings {
            let count = readings.len();
            let full = count == self.rows;
            restored::require(full, "intake.bins.readings", count as f64, "one for each row")?;
        }
        let open = self.last_s.is_some() == (self.rows > 0);
        restored::require(open, "intake.bins.rows", self.rows as f64, "0 where there is no last one")?;
        of.any_time("intake.bins.last_s", self.last_s.map(|(time_s, _)| time_s))?;
        of.any_time("intake.bins.passed_s", self.passed_s)
    }

    /// Bins of a width, s; 0: none.
    pub(super) fn new(step_s: f64, sensors: usize) -> Self {
        Self { step_s, last_s: None, rows: 0, readings: vec![Vec::new(); sensors], passed_s: None }
    }

    /// Memory for a full bin.
    pub(super) fn make_room(&mut self) {
        let room = if self.step_s > 0.0 { ROWS_AT_MOST } else { 0 };
        self.readings.iter_mut().for_each(|readings| readings.reserve(room.saturating_sub(readings.len())));
    }

    /// Take a row: what is complete now is added to `done`.
    pub(super) fn take(&mut self, row: Row, done: &mut VecDeque<Row>) {
        let bin = |time_s: f64| libm::floor(time_s / self.step_s);
        let another = self.last_s.is_some_and(|(last_s, _)| bin(last_s) != bin(row.time_s));
        let alone_s = match (self.rows, self.last_s) {
            (0, _) => self.passed_s,
            (1, Some((last_s, _))) => Some(last_s),
            _ => None,
        };
        if another || self.rows == ROWS_AT_MOST {
            done.extend(self.close());
        }
        let slow = alone_s.is_some_and(|alone_s| row.time_s - alone_s >= SLOW * self.step_s);
        if slow || self.step_s == 0.0 {
            done.extend(self.close());
            self.passed_s = Some(row.time_s);
            done.push_back(row);
        } else {
            self.passed_s = None;
            self.last_s = Some((row.time_s, row.stamp_s));
            self.rows += 1;
            self.readings.iter_mut().zip(row.readings).for_each(|(to, reading)| to.push(reading));
        }
    }

    /// The bin as it is, if there is anything in it.
    pub(super) fn close(&mut self) -> Option<Row> {
        let (time_s, stamp_s) = self.last_s.take()?;
        let alone = core::mem::take(&mut self.rows) == 1;
        let of_sensor = |values: &mut Vec<f64>| {
            let reading = if alone { values[0] } else { middle(values) };
            values.clear();
            reading
        };
        let readings: Readings = self.readings.iter_mut().map(of_sensor).collect();
        Some(Row { time_s, stamp_s, readings })
    }

    /// Rows in the bin.
    pub(super) fn held(&self) -> usize {
        self.rows
    }
}

/// Median, the mean of the two in the middle of an even number; NaN counts for nothing, and infinite ones only where there are no others. NaN of none.
fn middle(values: &mut Vec<f64>) -> f64 {
    values.retain(|value| !value.is_nan());
    if values.iter().any(|value| value.is_finite()) {
        values.retain(|value| value.is_finite());
    }
    values.sort_unstable_by(f64::total_cmp);
    let n = values.len();
    match n {
        0 => f64::NAN,
        _ if n % 2 == 1 => values[n / 2],
        _ if values[n / 2 - 1] == values[n / 2] => values[n / 2],
        _ => 0.5 * values[n / 2 - 1] + 0.5 * values[n / 2],
    }
}
