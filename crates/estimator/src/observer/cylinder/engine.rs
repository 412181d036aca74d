//! The engine of the bank, with what a cylinder cannot do as constraints of the moving horizon.
use super::Cylinder;
use crate::filter::BankEngine;
#[cfg(feature = "design")]
use crate::filter::horizon::Constraint;
use crate::observer::engine::Engine;
#[cfg(feature = "design")]
use crate::observer::engine::MovingHorizonSettings;

/// Least mass in a window, as a share of the highest.
#[cfg(feature = "design")]
const MIN_MASS_SHARE: f64 = 1e-6;

impl Cylinder {
    /// The engine of the settings.
    pub(in crate::observer) fn bank_engine(&self) -> BankEngine {
        match self.settings.engine {
            Engine::Extended => BankEngine::Extended,
            Engine::Unscented => BankEngine::Unscented,
            Engine::Stationary => BankEngine::Stationary,
            #[cfg(feature = "design")]
            Engine::MovingHorizon(settings) => {
                BankEngine::MovingHorizon(settings.horizon(), self.constraints(&settings))
            }
        }
    }

    /// Leak rate not negative, mass not rising from sample to sample, wall, valve and gas within the temperatures of the fluid's equation of
    /// state, mass between nothing and its highest density.
    #[cfg(feature = "design")]
    fn constraints(&self, settings: &MovingHorizonSettings) -> Vec<Constraint> {
        let highest_kg = self.model.highest_mass_kg();
        let domain = self.model.fluid().domain();
        let states = &self.states;
        let mut rows = vec![
            Constraint::at_least(states.mass, MIN_MASS_SHARE * highest_kg),
            Constraint::at_most(states.mass, highest_kg),
        ];
        for state in (0..states.wall).chain(states.valve).chain([states.gas]) {
            rows.push(Constraint::at_least(state, domain.lowest_temperature_k));
            rows.push(Constraint::at_most(state, domain.highest_temperature_k));
        }
        if settings.leak_not_negative {
            rows.push(Constraint::at_least(states.leak, 0.0));
        }
        if settings.mass_not_rising {
            rows.push(Constraint::step(&[(states.mass, 1.0)], 0.0));
        }
        rows
    }
}

#[cfg(test)]
mod horizon_tests;
#[cfg(test)]
mod stationary_tests;
#[cfg(test)]
mod unscented_tests;
