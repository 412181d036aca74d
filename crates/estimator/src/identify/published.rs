//! The transfer function that the paper publishes, from the shoulder's temperature to the mean gas temperature, and the
//! pressure that it expects.
//!
//! `G(s) = 0.003121/(s + 0.003021)`, identified with MATLAB's `tfest` from scenarios 1 and 2; temperatures in °C. The steady-state gain
//! of 1.033 is no physical one: at rest both temperatures are equal. The expected pressure rises by 0.8457 bar per °C of the gas;
//! that is the slope of nitrogen filled to 175 bar at 15 °C, not to 200 bar.
//!
//! Source: Bücking, Pfaff, Dirksmeier (sections 4 and 5).

use super::Model;

/// Numerator of the published transfer function, 1/s.
pub(crate) const NUMERATOR_PER_S: f64 = 0.003121;
/// Its pole, 1/s.
pub const POLE_PER_S: f64 = 0.003021;
/// Published slope of the pressure, Pa/K.
pub(crate) const SLOPE_PA_K: f64 = 0.8457e5;

/// The published model, °C to °C.
pub fn model() -> Model {
    Model { num: vec![NUMERATOR_PER_S], den: vec![1.0, POLE_PER_S], dead_time_s: 0.0, offset: 0.0 }
}

/// A first-order transfer function as it runs on a vehicle, reading by reading: `dT/dt = pole (gain u - T)` in °C, exact for a
/// reading that is linear between samples.
#[derive(Clone, Copy, Debug)]
pub struct TransferFunction {
    gain: f64,
    pole_per_s: f64,
    gas_degc: f64,
    /// Time, s, and input, °C, of the last sample.
    before: Option<(f64, f64)>,
}

impl TransferFunction {
    /// The one that the paper publishes.
    pub const PUBLISHED: Self = Self::new(NUMERATOR_PER_S / POLE_PER_S, POLE_PER_S);

    /// Of a gain and a pole, 1/s. It starts settled at its first reading.
    pub const fn new(gain: f64, pole_per_s: f64) -> Self {
        Self { gain, pole_per_s, gas_degc: f64::NAN, before: None }
    }

    /// The same, starting at a gas temperature, °C. Zero gives the transient at the start of the paper's figure 2.
    pub(crate) const fn starting_at(self, gas_degc: f64) -> Self {
        Self { gas_degc, ..self }
    }

    /// Mean gas temperature, °C, after a reading of the shoulder, °C.
    pub fn step(&mut self, time_s: f64, input_degc: f64) -> f64 {
        let gain = self.gain;
        self.gas_degc = match self.before {
            None if self.gas_degc.is_nan() => gain * input_degc,
            None => self.gas_degc,
            Some((before_s, before_degc)) => {
                let dt = time_s - before_s;
                let decay = (-self.pole_per_s * dt).exp();
                let late = (1.0 - (1.0 - decay) / (self.pole_per_s * dt)) * gain;
                decay * self.gas_degc + gain * (1.0 - decay) * before_degc + late * (input_degc - before_degc)
            }
        };
        self.before = Some((time_s, input_degc));
        self.gas_degc
    }
}

/// Pressure and temperature of the gas when the cylinder was filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filling {
    /// Pressure, Pa.
    pub pressure_pa: f64,
    /// Gas temperature, K.
    pub temperature_k: f64,
}

impl Filling {
    /// Expected pressure, Pa, at a gas temperature, K, by the published slope.
    pub fn published_pressure_pa(&self, gas_k: f64) -> f64 {
        self.pressure_pa + SLOPE_PA_K * (gas_k - self.temperature_k)
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::identify::{Hold, InitialState};
    use crate::thermal::fluid::Fluid;
    use crate::thermal::units::ZERO_CELSIUS_K;

    const FIFTEEN_K: f64 = ZERO_CELSIUS_K + 15.0;

    /// Expected pressure, Pa, at a gas temperature, K, by the equation of state at constant density.
    fn real_gas_pressure_pa(filling: &Filling, fluid: &Fluid, gas_k: f64) -> f64 {
        let density_kg_m3 =
            fluid.density_from_pressure_temperature(filling.pressure_pa, filling.temperature_k).unwrap();
        fluid.check(density_kg_m3, gas_k).unwrap();
        fluid.pressure_pa(density_kg_m3, gas_k)
    }

    #[test]
    fn gain_and_time_constant_are_the_papers() {
        assert_relative_eq!(model().gain(), 1.0331, max_relative = 2e-5);
        assert_relative_eq!(-1.0 / model().poles_per_s()[0].re, 331.0, max_relative = 1e-4);
    }

    #[test]
    fn reading_by_reading_equals_the_simulation_at_once() {
        let time_s: Vec<f64> = (0..200).map(|k| f64::from(k) * 30.0 + f64::from(k % 3)).collect();
        let shoulder: Vec<f64> = time_s.iter().map(|t| 21.0 - 46.0 * (1.0 - (-t / 700.0).exp())).collect();
        let starts = [
            (TransferFunction::PUBLISHED, InitialState::Settled),
            (TransferFunction::PUBLISHED.starting_at(0.0), InitialState::Zero),
            (TransferFunction::PUBLISHED.starting_at(21.0), InitialState::Given(vec![21.0])),
        ];
        for (mut filter, initial) in starts {
            let at_once = model().simulate(&time_s, &shoulder, Hold::First, &initial).unwrap();
            for ((t, u), expected) in time_s.iter().zip(&shoulder).zip(at_once) {
                assert_relative_eq!(filter.step(*t, *u), expected, epsilon = 1e-10);
            }
        }
    }

    #[test]
    fn a_zero_state_at_room_temperature_ends_a_transient_of_21_k_in_331_s() {
        let mut filter = TransferFunction::PUBLISHED.starting_at(0.0);
        filter.step(0.0, 21.0);
        let after = filter.step(331.0, 21.0);
        assert_relative_eq!(after, 21.0 * 1.0331 * (1.0 - (-1.0_f64).exp()), max_relative = 1e-3);
    }

    #[test]
    fn a_tight_cylinder_of_200_bar_reads_160_bar_at_minus_25_degc() {
        // CoolProp 8.0 (HEOS nitrogen): 160.09 bar at -25 °C, 244.4 bar at 60 °C.
        let filling = Filling { pressure_pa: 200e5, temperature_k: FIFTEEN_K };
        let nitrogen = Fluid::named("nitrogen").unwrap();
        let at = |degc: f64| real_gas_pressure_pa(&filling, &nitrogen, ZERO_CELSIUS_K + degc);
        assert!((at(-25.0) - 160.09e5).abs() < 0.006e5, "{} Pa", at(-25.0));
        assert!((at(60.0) - 244.4e5).abs() < 0.06e5, "{} Pa", at(60.0));
        assert_relative_eq!(at(15.0), 200e5, max_relative = 1e-9);
        assert_relative_eq!(
            filling.published_pressure_pa(ZERO_CELSIUS_K + 25.0),
            208.457e5,
            max_relative = 1e-12
        );
    }

    #[test]
    fn the_published_slope_is_that_of_a_filling_to_175_bar() {
        let nitrogen = Fluid::named("nitrogen").unwrap();
        let slope = |pressure_pa: f64| {
            let filling = Filling { pressure_pa, temperature_k: FIFTEEN_K };
            let at = |kelvin: f64| real_gas_pressure_pa(&filling, &nitrogen, FIFTEEN_K + kelvin);
            0.5 * (at(1.0) - at(-1.0))
        };
        assert_relative_eq!(slope(175.25e5), SLOPE_PA_K, max_relative = 1e-4);
        assert_relative_eq!(slope(200e5), 0.992e5, max_relative = 6e-4);
    }
}
