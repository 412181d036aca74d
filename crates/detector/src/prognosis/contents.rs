//! Mass and pressure of the gas in a vessel that is everywhere at one temperature.
//!
//! `m = rho(p, T) V(T, p)`: the volume gives way to temperature and pressure. The inverse, pressure of a mass, is found by going round:
//! density of the volume at the last pressure, pressure of that density.
use crate::units::QUOTED_K;
use cylwatch_estimator::thermal::fluid::Fluid;
use cylwatch_estimator::thermal::vessel::{InnerVolume, Vessel};

use crate::DetectorError;

/// Loss of pressure, corrected for temperature, at which ISO 14520 has an inert gas container refilled or replaced.
pub const ISO_14520_LOSS: f64 = 0.05;

/// Step of a mass for the slope of its pressure, relative.
const STEP: f64 = 1e-4;

/// Gas and volume.
#[derive(Clone, Debug)]
pub struct Contents {
    fluid: Fluid,
    volume: InnerVolume,
}

impl Contents {
    /// Of a vessel.
    pub fn of(vessel: &Vessel) -> Self {
        Self { fluid: vessel.fluid.clone(), volume: vessel.volume }
    }

    /// Mass, kg, at a pressure, Pa, and temperature, K.
    ///
    /// # Errors
    /// The state is outside the gas's domain.
    pub fn mass_kg(&self, pressure_pa: f64, temperature_k: f64) -> Result<f64, DetectorError> {
        let density_kg_m3 = self.fluid.density_from_pressure_temperature(pressure_pa, temperature_k)?;
        Ok(density_kg_m3 * self.volume.volume_m3(temperature_k, pressure_pa))
    }

    /// Pressure, Pa, of a mass, kg, at a temperature, K.
    ///
    /// # Errors
    /// The mass does not fit the vessel, or its state is outside the gas's domain.
    pub fn pressure_pa(&self, mass_kg: f64, temperature_k: f64) -> Result<f64, DetectorError> {
        let volume_m3 = self.volume.volume_m3;
        crate::error::positive("mass_kg", mass_kg)?;
        let mut pressure_pa = self.volume.reference_pressure_pa;
        // The volume hardly depends on the pressure: each round gains four digits and more.
        for _ in 0..30 {
            let density_kg_m3 = mass_kg / self.volume.volume_m3(temperature_k, pressure_pa);
            self.fluid.check(density_kg_m3, temperature_k)?;
            let next_pa = self.fluid.pressure_pa(density_kg_m3, temperature_k);
            let step_pa = next_pa - pressure_pa;
            pressure_pa = next_pa;
            if step_pa.abs() <= 1e-13 * pressure_pa {
                return Ok(pressure_pa);
            }
        }
        Err(DetectorError::NoPressure { mass_kg, temperature_k, volume_m3 })
    }

    /// Slope of the pressure in the mass at a temperature, K, Pa/kg.
    ///
    /// # Errors
    /// As of [`Contents::pressure_pa`].
    pub fn slope_pa_kg(&self, mass_kg: f64, temperature_k: f64) -> Result<f64, DetectorError> {
        let above_pa = self.pressure_pa(mass_kg * (1.0 + STEP), temperature_k)?;
        let below_pa = self.pressure_pa(mass_kg * (1.0 - STEP), temperature_k)?;
        Ok((above_pa - below_pa) / (2.0 * STEP * mass_kg))
    }

    /// Mass, kg, at which the pressure at 15 °C has fallen by `share` of that of a full cylinder, e.g.
    /// [`ISO_14520_LOSS`].
    ///
    /// # Errors
    /// `share` is not between 0 and 1; a state is outside the gas's domain.
    pub(crate) fn limit_after_loss_kg(&self, full_kg: f64, share: f64) -> Result<f64, DetectorError> {
        if !(share > 0.0 && share < 1.0) {
            return Err(DetectorError::Setting { setting: "share", value: share, bound: "between 0 and 1" });
        }
        self.mass_kg((1.0 - share) * self.pressure_pa(full_kg, QUOTED_K)?, QUOTED_K)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn rigid() -> Contents {
        let volume = InnerVolume {
            volume_m3: 0.02,
            thermal_expansion_per_k: 0.0,
            pressure_expansion_per_pa: 0.0,
            reference_temperature_k: 288.15,
            reference_pressure_pa: 1e5,
        };
        Contents { fluid: Fluid::named("nitrogen").unwrap(), volume }
    }

    #[test]
    fn masses_of_a_rigid_bottle_are_those_of_coolprop() {
        // CoolProp 8.0: 223.187 kg/m3 at 200 bar, 15 degC; 5 % of the pressure are 4.35 % of the mass, 160 bar 18.0 %.
        let full_kg = rigid().mass_kg(200e5, 288.15).unwrap();
        assert_relative_eq!(full_kg, 4.46374, max_relative = 1e-5);
        let five_kg = rigid().limit_after_loss_kg(full_kg, ISO_14520_LOSS).unwrap();
        assert!((1.0 - five_kg / full_kg - 0.0435).abs() < 5e-5, "{five_kg} kg");
        let low_kg = rigid().mass_kg(160e5, 288.15).unwrap();
        assert!((1.0 - low_kg / full_kg - 0.180).abs() < 5e-4, "{low_kg} kg");
    }

    #[test]
    fn a_tight_cylinder_of_180_bar_falls_below_160_bar_at_minus_8_degc() {
        let mass_kg = rigid().mass_kg(180e5, 288.15).unwrap();
        let at = |degc: f64| rigid().pressure_pa(mass_kg, 273.15 + degc).unwrap();
        assert!(at(-7.7) > 160e5 && at(-8.0) < 160e5, "{} {}", at(-7.7), at(-8.0));
    }

    #[test]
    fn pressure_of_the_mass_of_a_pressure_is_the_pressure() {
        let volume = InnerVolume {
            thermal_expansion_per_k: 3.5e-5,
            pressure_expansion_per_pa: 1.5e-10,
            ..rigid().volume
        };
        let contents = Contents { fluid: Fluid::named("nitrogen").unwrap(), volume };
        for (pressure_pa, kelvin) in [(1e5, 230.0), (160e5, 248.15), (200e5, 288.15), (300e5, 330.0)] {
            let mass_kg = contents.mass_kg(pressure_pa, kelvin).unwrap();
            assert_relative_eq!(
                contents.pressure_pa(mass_kg, kelvin).unwrap(),
                pressure_pa,
                max_relative = 1e-8
            );
        }
        assert!(contents.pressure_pa(-1.0, 280.0).is_err() && contents.pressure_pa(f64::NAN, 280.0).is_err());
        assert!(contents.pressure_pa(100.0, 280.0).is_err());
        assert!(contents.limit_after_loss_kg(4.0, 0.0).is_err());
    }
}
