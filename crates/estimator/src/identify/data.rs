//! Samples of one input and one output.
use serde::{Deserialize, Serialize};

use super::IdentifyError;

/// How the input runs between its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hold {
    /// Constant from a sample to the next one.
    Zero,
    /// Straight from sample to sample.
    First,
}

/// A record of one input and one output, at regular or irregular times; NaN is a missing value.
///
/// The record lasts from the first to the last sample of the input, which is held over its missing values. Output samples
/// outside it are left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    time_s: Vec<f64>,
    input: Vec<f64>,
    output: Vec<f64>,
    hold: Hold,
}

impl Data {
    /// Columns of one length: time, s, input and output.
    ///
    /// # Errors
    /// Lengths differ, times do not increase, or a value is infinite.
    pub fn try_new(
        time_s: Vec<f64>,
        input: Vec<f64>,
        output: Vec<f64>,
        hold: Hold,
    ) -> Result<Self, IdentifyError> {
        check_times(&time_s)?;
        check_column("the input", &input, time_s.len())?;
        check_column("the output", &output, time_s.len())?;
        Ok(Self { time_s, input, output, hold })
    }

    /// Times, s.
    pub fn time_s(&self) -> &[f64] {
        &self.time_s
    }

    /// Input samples.
    pub fn input(&self) -> &[f64] {
        &self.input
    }

    /// Output samples.
    pub fn output(&self) -> &[f64] {
        &self.output
    }

    /// How the input runs between its samples.
    pub fn hold(&self) -> Hold {
        self.hold
    }

    /// The same record with the columns' roles exchanged.
    pub(super) fn swapped(&self) -> Self {
        Self { input: self.output.clone(), output: self.input.clone(), ..self.clone() }
    }
}

fn check_times(time_s: &[f64]) -> Result<(), IdentifyError> {
    let mut before_s = f64::NEG_INFINITY;
    for (row, &time_s) in time_s.iter().enumerate() {
        if !time_s.is_finite() || time_s <= before_s {
            return Err(IdentifyError::TimeOrder { row, time_s, before_s });
        }
        before_s = time_s;
    }
    Ok(())
}

/// A column must be as long as the times and hold no infinities.
pub(super) fn check_column(column: &'static str, values: &[f64], times: usize) -> Result<(), IdentifyError> {
    if values.len() != times {
        return Err(IdentifyError::Length { column, length: values.len(), times });
    }
    match values.iter().position(|value| value.is_infinite()) {
        Some(row) => Err(IdentifyError::Infinite { column, row }),
        None => Ok(()),
    }
}
