//! `e = p_expected(T_gas) - p`, reading by reading.
use serde::{Deserialize, Serialize};

use super::{Expectation, Filling, GasModel, GasTemperature, Law, Reading};
use crate::DetectorError;

/// The error of the pressure; positive: pressure is missing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PressureError {
    expectation: Expectation,
    gas: GasTemperature,
    last_s: Option<f64>,
}

impl PressureError {
    /// Of an expectation at a gas temperature.
    ///
    /// # Errors
    /// Gain or pole of the model are not positive.
    pub fn try_new(expectation: Expectation, model: GasModel) -> Result<Self, DetectorError> {
        Ok(Self { expectation, gas: GasTemperature::try_new(model)?, last_s: None })
    }

    /// The paper's: its function of the shoulder, its slope of the pressure.
    ///
    /// # Errors
    /// The filling is not positive.
    pub fn published(filling: Filling) -> Result<Self, DetectorError> {
        Self::try_new(Expectation::try_new(Law::Published, filling)?, GasModel::PUBLISHED)
    }

    /// The next reading's, Pa; `None` if the pressure or a needed temperature is missing, or if it is not later.
    pub fn step(&mut self, reading: Reading) -> Option<f64> {
        let gas_k = self.gas.step(reading.time_s, reading.shoulder_k);
        let later = self.last_s.is_none_or(|last_s| reading.time_s > last_s);
        if !(later && reading.time_s.is_finite() && reading.pressure_pa.is_finite()) {
            return None;
        }
        let error_pa = self.expectation.pressure_pa(gas_k)? - reading.pressure_pa;
        self.last_s = Some(reading.time_s);
        Some(error_pa)
    }

    /// Forget all readings.
    pub fn reset(&mut self) {
        self.gas.reset();
        self.last_s = None;
    }
}
