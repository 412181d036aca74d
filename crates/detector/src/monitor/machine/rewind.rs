//! The way back: the observer as it was some rows ago, and the rows since.
//!
//! A jump is noticed when the observer has taken it in already. A snapshot for each row would cost as much as the row; one now and
//! then, and the rows since taken again, costs next to nothing as long as nothing jumps.
use serde::{Deserialize, Serialize};

use crate::DetectorError;
use crate::estimator::observer::{Observer, Snapshot};

/// Rows between two snapshots.
const ROWS: usize = 32;

/// A snapshot and the rows after it.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Rewind {
    snapshot: Option<Snapshot>,
    /// Time, s, and readings of each row, one after the other.
    rows: Vec<f64>,
}

impl Rewind {
    /// The observer has taken a row: to be called after it.
    pub fn taken(&mut self, observer: &Observer, time_s: f64, readings: &[f64]) {
        let width = readings.len() + 1;
        if self.snapshot.is_none() || self.rows.len() >= ROWS * width {
            self.begin(observer);
            return;
        }
        self.rows.push(time_s);
        self.rows.extend_from_slice(readings);
    }

    /// The present is the oldest there is to go back to.
    pub fn begin(&mut self, observer: &Observer) {
        self.snapshot = Some(observer.snapshot());
        self.rows.clear();
    }

    /// Let an observer be as it was after the last row that was taken; whether there is a way back.
    ///
    /// # Errors
    /// The observer's.
    pub fn restore(&self, observer: &mut Observer, sensors: usize) -> Result<bool, DetectorError> {
        let Some(snapshot) = &self.snapshot else { return Ok(false) };
        observer.restore(snapshot);
        for row in self.rows.chunks_exact(sensors + 1) {
            observer.step(row[0], &row[1..])?;
        }
        Ok(true)
    }
}
