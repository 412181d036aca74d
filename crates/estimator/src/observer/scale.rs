//! How much gas a cylinder holds, and at what pressure, against the one that settings in kilograms and pascals are stated for.
//!
//! Settings that depend on the amount of gas (walks of the mass, leak rates) and on its pressure (model error of the pressure)
//! are stated for nitrogen of 200 bar at 15 °C in 20 L. For another fill they are parts of it: masses are multiplied by the
//! ratio of the masses, pressures by the ratio of the settled pressures at 15 °C.
//!
//! Assumption: what the reduced model gets wrong is a part of the pressure. An error of the gas temperature of 1 K is one, since
//! `dp/dT` at constant density is nearly proportional to `p`: 0.99 bar/K in nitrogen of 200 bar, 0.0035 `p`/K in an ideal gas.
use super::Commissioning;
use super::settings::{LeakHypothesis, ModelError, ObserverSettings, Walk};
use crate::EstimatorError;
use crate::thermal::vessel::Vessel;
use cylwatch_thermal::units::QUOTED_K;

/// Mass, kg, that settings are stated for, that of the built-in `nitrogen-20l`, full, and its pressure at 15 °C in the volume of the
/// empty vessel, Pa.
const REFERENCE_KG: f64 = 4.477_064_224_284;
const REFERENCE_PA: f64 = 200.695_061_065_238e5;

/// Ratios of a fill to the reference: 1 for `nitrogen-20l` at 200 bar and 15 °C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    /// Of the masses.
    pub mass: f64,
    /// Of the pressures at 15 °C.
    pub pressure: f64,
}

impl Scale {
    /// Of what is known of a vessel at the first sample.
    ///
    /// # Errors
    /// The fill is no mass.
    pub(crate) fn of(vessel: &Vessel, commissioning: &Commissioning) -> Result<Self, EstimatorError> {
        let mass_kg = commissioning.mass_kg(vessel, QUOTED_K)?;
        let density_kg_m3 = mass_kg / vessel.volume.volume_m3;
        let pressure_pa = vessel.fluid.pressure_pa(density_kg_m3, QUOTED_K);
        Ok(Self { mass: mass_kg / REFERENCE_KG, pressure: pressure_pa / REFERENCE_PA })
    }

    /// Settings for this fill.
    pub(crate) fn applied(self, settings: &ObserverSettings) -> ObserverSettings {
        let Self { mass, pressure } = self;
        let error = &settings.model_error;
        let bank = settings.bank.iter().map(|member| LeakHypothesis {
            mass_walk_kg_per_sqrt_s: mass * member.mass_walk_kg_per_sqrt_s,
            rate: Walk {
                prior_sd: mass * member.rate.prior_sd,
                per_sqrt_s: mass * member.rate.per_sqrt_s,
                memory_s: member.rate.memory_s,
            },
            caution_pa_k: pressure * member.caution_pa_k,
            ..*member
        });
        ObserverSettings {
            bank: bank.collect(),
            free_mass_sd_kg: mass * settings.free_mass_sd_kg,
            any_leak_sd_kg_s: mass * settings.any_leak_sd_kg_s,
            model_error: ModelError {
                pressure_pa: pressure * error.pressure_pa,
                pressure_per_wall_k: pressure * error.pressure_per_wall_k,
                ..*error
            },
            ..settings.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thermal::vessel::Fill;
    use crate::thermal::vessel::presets;
    use approx::assert_relative_eq;

    fn nitrogen() -> Vessel {
        presets::load("nitrogen-20l").unwrap()
    }

    #[test]
    fn the_settings_are_stated_for_the_full_cylinder_of_20_litres() {
        let scale = Scale::of(&nitrogen(), &Commissioning::filled(200e5, 288.15)).unwrap();
        assert_relative_eq!(scale.mass, 1.0, max_relative = 1e-6);
        assert_relative_eq!(scale.pressure, 1.0, max_relative = 1e-6);
    }

    #[test]
    fn half_the_gas_walks_half_as_far_under_less_than_half_of_the_pressure() {
        let half = Commissioning {
            fill: Fill::Mass { mass_kg: 0.5 * REFERENCE_KG },
            ..Commissioning::filled(200e5, 288.15)
        };
        let scale = Scale::of(&nitrogen(), &half).unwrap();
        assert_relative_eq!(scale.mass, 0.5, max_relative = 1e-12);
        // The compressibility factor at 15 degC is below 1 at 100 bar and 1.05 at 200 bar.
        assert!((0.46..0.48).contains(&scale.pressure), "{}", scale.pressure);
        let (full, less) = (ObserverSettings::default(), scale.applied(&ObserverSettings::default()));
        for (a, b) in full.bank.iter().zip(&less.bank) {
            assert_relative_eq!(b.mass_walk_kg_per_sqrt_s, 0.5 * a.mass_walk_kg_per_sqrt_s);
            assert_relative_eq!(b.rate.per_sqrt_s, 0.5 * a.rate.per_sqrt_s);
        }
        let error_pa = scale.pressure * full.model_error.pressure_pa;
        assert_relative_eq!(less.model_error.pressure_pa, error_pa);
        assert_eq!(less.model_error.surface_k, full.model_error.surface_k);
    }
}
