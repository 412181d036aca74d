//! Mean gas temperature from the shoulder alone.
use cylwatch_estimator::identify::published::{NUMERATOR_PER_S, POLE_PER_S, TransferFunction};
use cylwatch_estimator::thermal::units::ZERO_CELSIUS_K;
use serde::{Deserialize, Serialize};

use crate::{DetectorError, error::positive};

/// How the gas follows the shoulder.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum GasModel {
    /// At once.
    Shoulder,
    /// By a first-order transfer function of temperatures in °C.
    FirstOrder {
        /// Steady-state gain.
        gain: f64,
        /// Pole, 1/s.
        pole_per_s: f64,
        /// Gas temperature at the first reading, °C; `None`: settled at it.
        initial_degc: Option<f64>,
    },
}

impl GasModel {
    /// `0.003121/(s + 0.003021)`, the one of the paper, settled at its first reading.
    pub const PUBLISHED: Self =
        Self::FirstOrder { gain: NUMERATOR_PER_S / POLE_PER_S, pole_per_s: POLE_PER_S, initial_degc: None };

    /// # Errors
    /// Gain or pole are not positive.
    fn validate(self) -> Result<(), DetectorError> {
        if let Self::FirstOrder { gain, pole_per_s, .. } = self {
            positive("gain", gain)?;
            positive("pole_per_s", pole_per_s)?;
        }
        Ok(())
    }
}

/// The model and where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GasTemperature {
    model: GasModel,
    last: Option<Step>,
}

/// Last reading of the shoulder and the gas at it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Step {
    time_s: f64,
    shoulder_degc: f64,
    gas_degc: f64,
}

impl GasTemperature {
    /// No reading yet.
    ///
    /// # Errors
    /// Gain or pole are not positive.
    pub fn try_new(model: GasModel) -> Result<Self, DetectorError> {
        model.validate()?;
        Ok(Self { model, last: None })
    }

    /// Gas temperature, K, at a reading of the shoulder, K; `None` if the reading is not finite or not later than the one before.
    /// Between readings the shoulder counts as linear.
    pub fn step(&mut self, time_s: f64, shoulder_k: f64) -> Option<f64> {
        let later = self.last.is_none_or(|last| time_s > last.time_s);
        if !(later && time_s.is_finite() && shoulder_k.is_finite()) {
            return None;
        }
        let shoulder_degc = shoulder_k - ZERO_CELSIUS_K;
        let gas_degc = match self.model {
            GasModel::Shoulder => shoulder_degc,
            GasModel::FirstOrder { gain, pole_per_s, initial_degc } => {
                let function = TransferFunction::new(gain, pole_per_s);
                let mut function = match self.last {
                    Some(last) => resumed(function, last),
                    None => initial_degc.map_or(function, |degc| function.starting_at(degc)),
                };
                function.step(time_s, shoulder_degc)
            }
        };
        self.last = Some(Step { time_s, shoulder_degc, gas_degc });
        Some(gas_degc + ZERO_CELSIUS_K)
    }

    /// Forget all readings.
    pub fn reset(&mut self) {
        self.last = None;
    }
}

/// The function as it was after `last`: its whole state is its output and the last input.
fn resumed(function: TransferFunction, last: Step) -> TransferFunction {
    let mut function = function.starting_at(last.gas_degc);
    function.step(last.time_s, last.shoulder_degc);
    function
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resumed_at_every_reading_it_is_the_published_function_bit_for_bit() {
        let mut whole = TransferFunction::PUBLISHED;
        let mut stepped = GasTemperature::try_new(GasModel::PUBLISHED).unwrap();
        for n in 0..300 {
            let time_s = f64::from(n) * 17.0 + f64::from(n % 4);
            let shoulder_k = 263.15 + 40.0 * (time_s / 900.0).sin();
            let expected = whole.step(time_s, shoulder_k - ZERO_CELSIUS_K) + ZERO_CELSIUS_K;
            assert_eq!(stepped.step(time_s, shoulder_k), Some(expected));
        }
    }

    #[test]
    fn readings_that_are_missing_or_late_are_left_out() {
        let mut gas = GasTemperature::try_new(GasModel::PUBLISHED).unwrap();
        assert_eq!(gas.step(0.0, f64::NAN), None);
        assert!(gas.step(10.0, 280.0).is_some());
        let before = gas;
        assert_eq!((gas.step(10.0, 290.0), gas.step(20.0, f64::INFINITY)), (None, None));
        assert_eq!(gas, before);
    }

    #[test]
    fn a_pole_that_does_not_decay_is_refused() {
        let model = |gain, pole_per_s| GasModel::FirstOrder { gain, pole_per_s, initial_degc: None };
        assert!(GasTemperature::try_new(model(1.0, 0.0)).is_err());
        assert!(GasTemperature::try_new(model(f64::NAN, 0.003)).is_err());
    }
}
