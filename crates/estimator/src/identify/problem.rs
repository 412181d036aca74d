//! The record in units of its own: times from the start in units of a time constant, columns in units of their spread.
//!
//! Every number of the estimation is then near one, and the result cannot depend on the units that the data came in.
use super::data::check_column;
use super::{Data, Hold, IdentifyError};
use crate::log::median_interval;

/// A gap of the input longer than this many median intervals is not bridged unless allowed.
const LONGEST_GAP_INTERVALS: f64 = 20.0;

/// A spread below this share of the mean is rounding.
const CONSTANT: f64 = 1e-12;

/// Units of the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Units {
    /// Start of the record, s.
    pub start_s: f64,
    /// Unit of time, s.
    pub time_s: f64,
    pub input: f64,
    pub output: f64,
}

/// The record in its own units.
#[derive(Clone, Debug)]
pub(super) struct Problem {
    pub units: Units,
    pub hold: Hold,
    /// Times and values of the input, none missing.
    pub input_time: Vec<f64>,
    pub u: Vec<f64>,
    /// Another input that the input is compared with, at the same times.
    pub second: Option<Vec<f64>>,
    /// Times and values of the output, none missing.
    pub output_time: Vec<f64>,
    pub y: Vec<f64>,
}

impl Problem {
    /// The usable part of the data.
    pub(super) fn new(
        data: &Data,
        second: Option<&[f64]>,
        longest_gap_s: Option<f64>,
        parameters: usize,
    ) -> Result<Self, IdentifyError> {
        let times = data.time_s();
        if let Some(second) = second {
            check_column("the second input", second, times.len())?;
        }
        let complete = |row: &usize| {
            data.input()[*row].is_finite() && second.is_none_or(|second| second[*row].is_finite())
        };
        let inputs: Vec<usize> = (0..times.len()).filter(complete).collect();
        let (Some(&first), Some(&last)) = (inputs.first(), inputs.last()) else {
            return Err(IdentifyError::TooFewSamples { samples: 0, parameters });
        };
        let rows: Vec<usize> = (first..=last).filter(|&row| data.output()[row].is_finite()).collect();
        if rows.len() <= parameters + 1 {
            return Err(IdentifyError::TooFewSamples { samples: rows.len(), parameters });
        }
        let of = |rows: &[usize], column: &[f64]| rows.iter().map(|&row| column[row]).collect::<Vec<f64>>();
        let mut problem = Self {
            units: Units { start_s: times[first], time_s: 1.0, input: 1.0, output: 1.0 },
            hold: data.hold(),
            input_time: inputs.iter().map(|&row| times[row] - times[first]).collect(),
            u: of(&inputs, data.input()),
            second: second.map(|second| of(&inputs, second)),
            output_time: rows.iter().map(|&row| times[row] - times[first]).collect(),
            y: of(&rows, data.output()),
        };
        problem.check_gaps(longest_gap_s)?;
        problem.take_units()?;
        Ok(problem)
    }

    fn check_gaps(&self, longest_gap_s: Option<f64>) -> Result<(), IdentifyError> {
        let limit_s = longest_gap_s.unwrap_or(LONGEST_GAP_INTERVALS * self.interval());
        match self.input_time.windows(2).find(|pair| pair[1] - pair[0] > limit_s) {
            Some(pair) => {
                let start_s = self.units.start_s;
                Err(IdentifyError::Gap { from_s: start_s + pair[0], to_s: start_s + pair[1], limit_s })
            }
            None => Ok(()),
        }
    }

    fn take_units(&mut self) -> Result<(), IdentifyError> {
        self.units.input = spread("the input", &self.u)?;
        self.units.output = spread("the output", &self.y)?;
        if let Some(second) = &mut self.second {
            spread("the second input", second)?;
            second.iter_mut().for_each(|value| *value /= self.units.input);
        }
        self.u.iter_mut().for_each(|value| *value /= self.units.input);
        self.y.iter_mut().for_each(|value| *value /= self.units.output);
        // Between the sampling interval and the record: nearer to what can be seen than either.
        self.rescale((self.interval() * self.duration()).sqrt());
        Ok(())
    }

    /// Another unit of time, as a multiple of the present one.
    pub(super) fn rescale(&mut self, factor: f64) {
        self.units.time_s *= factor;
        self.input_time.iter_mut().chain(&mut self.output_time).for_each(|time| *time /= factor);
    }

    /// Length of the record.
    pub(super) fn duration(&self) -> f64 {
        self.input_time.last().copied().unwrap_or(0.0)
    }

    /// Median interval of the input.
    pub(super) fn interval(&self) -> f64 {
        median_interval(&self.input_time).unwrap_or(0.0)
    }

    /// Number of output samples.
    pub(super) fn samples(&self) -> usize {
        self.y.len()
    }
}

/// Standard deviation of a column that must have one.
fn spread(column: &'static str, values: &[f64]) -> Result<f64, IdentifyError> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let spread = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n).sqrt();
    if spread > CONSTANT * mean.abs() {
        Ok(spread)
    } else {
        Err(IdentifyError::Constant { column, value: mean })
    }
}
