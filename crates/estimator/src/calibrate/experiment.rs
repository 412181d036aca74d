//! A recorded log with the circumstances it was recorded under.
use cylwatch_thermal::scenario::Scenario;
use cylwatch_thermal::vessel::Vessel;

use super::CalibrateError;
use crate::log::Log;
use crate::sensor::Sensor;

/// A log and what happened while it was recorded.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Where the log comes from, e.g. its file.
    pub source: String,
    /// Vessel of this experiment; `None`: that of the calibration.
    pub vessel: Option<Vessel>,
    /// What happened to the vessel; its time is that of the log.
    pub scenario: Scenario,
    /// The readings.
    pub log: Log,
    /// Sensors whose channels are fitted, by name, with their noise; further channels of the log are not looked at.
    pub channels: Vec<Sensor>,
}

/// Spread over noise below which a channel does not move.
const EXCITATION_RATIO: f64 = 3.0;

/// Usable readings of one channel.
#[derive(Clone, Debug)]
pub(super) struct Column {
    /// Rows of the fit's times with a reading.
    pub rows: Vec<usize>,
    /// Readings at these rows, K or Pa.
    pub values: Vec<f64>,
    /// Standard deviation of the noise, K or Pa.
    pub sigma: f64,
}

impl Column {
    /// Mean and standard deviation.
    pub(super) fn moments(&self) -> (f64, f64) {
        let n = self.values.len() as f64;
        let mean = self.values.iter().sum::<f64>() / n;
        (mean, (self.values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n).sqrt())
    }
}

impl Experiment {
    pub(super) fn check_times(&self) -> Result<(), CalibrateError> {
        let times = &self.log.time_s;
        let duration_s = self.scenario.duration_s;
        for (row, &time_s) in times.iter().enumerate() {
            let later = row == 0 || time_s > times[row - 1];
            if !later || !(0.0..=duration_s).contains(&time_s) {
                let experiment = self.source.clone();
                return Err(CalibrateError::Time { experiment, row, time_s, duration_s });
            }
        }
        Ok(())
    }

    /// Usable readings of a sensor's channel in the rows `kept`.
    pub(super) fn column(&self, sensor: &Sensor, kept: &[usize]) -> Result<Column, CalibrateError> {
        let (experiment, channel) = (self.source.clone(), sensor.name.clone());
        let Some(index) = self.log.channels.iter().position(|known| known.name == sensor.name) else {
            let known = self.log.channels.iter().map(|channel| channel.name.clone()).collect();
            return Err(CalibrateError::ChannelUnknown { experiment, channel, known });
        };
        if self.log.channels[index].quantity != sensor.quantity() {
            return Err(CalibrateError::ChannelQuantity { experiment, channel });
        }
        let sigma = sensor.noise_variance().sqrt();
        if sigma.is_nan() || sigma <= 0.0 {
            return Err(CalibrateError::NoNoise { experiment, channel });
        }
        let reading = |row: usize| self.log.row(kept[row])[index];
        let (lowest, highest) = sensor.usable_range();
        let inside = |&row: &usize| (lowest..=highest).contains(&reading(row));
        let rows: Vec<usize> = (0..kept.len()).filter(inside).collect();
        let values: Vec<f64> = rows.iter().map(|&row| reading(row)).collect();
        match values[..] {
            [] => {
                let (low, high) = sensor.plausible();
                Err(CalibrateError::NoReadings { experiment, channel, low, high })
            }
            [value, ref others @ ..] if others.len() > 1 && others.iter().all(|other| *other == value) => {
                Err(CalibrateError::ConstantChannel { experiment, channel, value })
            }
            _ => Ok(Column { rows, values, sigma }),
        }
    }
}

/// Some channel must move.
pub(super) fn check_excitation<'a>(columns: impl Iterator<Item = &'a Column>) -> Result<(), CalibrateError> {
    let ratio = columns.map(|column| column.moments().1 / column.sigma).fold(0.0, f64::max);
    if ratio > EXCITATION_RATIO { Ok(()) } else { Err(CalibrateError::NoExcitation { ratio }) }
}
