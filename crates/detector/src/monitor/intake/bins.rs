//! Rows that lie closer together than a step made one: per sensor the median of three readings or more, the mean of two.
//!
//! Bins lie on a fixed grid of the internal time, `floor(t/step)`, so that rows at the step or slower pass as they are, and where the
//! log begins changes nothing. A bin is handed out when a row of another one comes; a row at once while the rows before came at the step
//! or slower.
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use super::row::Row;

/// Rows in a bin at most; a fuller one is handed out early.
const ROWS_AT_MOST: usize = 256;
/// Part of the step that makes an interval one of slow rows: stamps jitter.
const SLOW: f64 = 0.9;

/// The bin that is being filled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Bins {
    step_s: f64,
    filling: Vec<Row>,
    /// Time of the last row where it was handed out at once, s.
    passed_s: Option<f64>,
}

impl Bins {
    /// Bins of a width, s; 0: none.
    pub(super) fn new(step_s: f64) -> Self {
        Self { step_s, filling: Vec::new(), passed_s: None }
    }

    /// Take a row: what is complete now is added to `done`.
    pub(super) fn take(&mut self, row: Row, done: &mut Vec<Row>) {
        let bin = |time_s: f64| libm::floor(time_s / self.step_s);
        let another = self.filling.last().is_some_and(|last| bin(last.time_s) != bin(row.time_s));
        let alone_s = match &self.filling[..] {
            [] => self.passed_s,
            [one] => Some(one.time_s),
            _ => None,
        };
        if another || self.filling.len() == ROWS_AT_MOST {
            done.extend(self.close());
        }
        let slow = alone_s.is_some_and(|alone_s| row.time_s - alone_s >= SLOW * self.step_s);
        if slow || self.step_s == 0.0 {
            done.extend(self.close());
            self.passed_s = Some(row.time_s);
            done.push(row);
        } else {
            self.passed_s = None;
            self.filling.push(row);
        }
    }

    /// The bin as it is, if there is anything in it.
    pub(super) fn close(&mut self) -> Option<Row> {
        let mut rows = core::mem::take(&mut self.filling);
        let mut one = rows.pop()?;
        if rows.is_empty() {
            return Some(one);
        }
        let mut values = Vec::with_capacity(rows.len() + 1);
        for (sensor, reading) in one.readings.iter_mut().enumerate() {
            values.clear();
            let others = rows.iter().map(|row| row.readings[sensor]);
            values.extend(others.chain([*reading]).filter(|value| !value.is_nan()));
            *reading = middle(&mut values);
        }
        Some(one)
    }

    /// Rows in the bin.
    pub(super) fn held(&self) -> usize {
        self.filling.len()
    }
}

/// Median, the mean of the two in the middle of an even number; infinite ones count only where there are no others. NaN of none.
fn middle(values: &mut Vec<f64>) -> f64 {
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
