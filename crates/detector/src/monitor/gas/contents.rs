//! Pressures of the present mass at fixed temperatures, cheaply: along a tangent that is renewed as the mass moves on.
use serde::{Deserialize, Serialize};

use crate::DetectorError;
use crate::prognosis::Contents;

/// Relative change of the mass after which the tangent is renewed.
const RENEWED_AFTER: f64 = 2e-4;

/// Pressure of a mass at one temperature.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Tangent {
    temperature_k: f64,
    mass_kg: f64,
    pressure_pa: f64,
    slope_pa_kg: f64,
}

impl Tangent {
    /// At a temperature, K; its first use computes it.
    pub(crate) fn at(temperature_k: f64) -> Self {
        Self { temperature_k, mass_kg: f64::NAN, pressure_pa: f64::NAN, slope_pa_kg: f64::NAN }
    }

    /// From now on at that temperature, K.
    pub(crate) fn move_to(&mut self, temperature_k: f64) {
        if temperature_k != self.temperature_k {
            *self = Self::at(temperature_k);
        }
    }

    /// Pressure of a mass, Pa; the error of the tangent is below 1e-6 of it.
    ///
    /// # Errors
    /// The mass does not fit the vessel.
    pub(crate) fn pressure_pa(&mut self, contents: &Contents, mass_kg: f64) -> Result<f64, DetectorError> {
        // Not a number at first.
        let near = (mass_kg - self.mass_kg).abs() <= RENEWED_AFTER * self.mass_kg;
        if !near {
            self.slope_pa_kg = contents.slope_pa_kg(mass_kg, self.temperature_k)?;
            self.pressure_pa = contents.pressure_pa(mass_kg, self.temperature_k)?;
            self.mass_kg = mass_kg;
        }
        Ok(self.pressure_pa + self.slope_pa_kg * (mass_kg - self.mass_kg))
    }

    /// Slope of the pressure in the mass, Pa/kg, where it was used last.
    pub(crate) fn slope_pa_kg(&self) -> f64 {
        self.slope_pa_kg
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimator::thermal::vessel::presets;
    use approx::assert_relative_eq;

    #[test]
    fn the_tangent_is_the_pressure_of_the_mass() {
        let contents = Contents::of(&presets::load("nitrogen-20l").unwrap());
        let mut tangent = Tangent::at(248.15);
        for step in 0..1000 {
            let mass_kg = 4.4 - 1e-4 * f64::from(step);
            let exact = contents.pressure_pa(mass_kg, 248.15).unwrap();
            assert_relative_eq!(tangent.pressure_pa(&contents, mass_kg).unwrap(), exact, max_relative = 1e-6);
        }
    }
}
