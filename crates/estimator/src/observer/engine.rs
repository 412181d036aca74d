//! Which filter the members of the bank run.
//!
//! The policy around it is one and the same for all engines and lives in the [bank](crate::filter::Bank): gates, re-acquisition, events, bounds, slow
//! walks of the constants. An engine says how mean and covariance move in time and take a reading.
//!
//! | engine | what it does | what it costs |
//! |---|---|---|
//! | extended | linearises along the estimate; learns all that can be learnt | the default |
//! | unscented | linearises statistically over the spread of the estimate | some twelve times as much |
//! | stationary | constant gain; learns no constants | as much: no covariance moves, but the model's equations cost most |
//! | moving horizon | best trajectory through a window of samples, inside constraints | some 250 times as much |
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::cylinder::Cylinder;
use crate::EstimatorError;
use crate::filter::BankEngine;
use crate::filter::horizon::{Constraint, HorizonSettings, Loss};

/// Iterations of a window per sample at most. The next sample iterates the same trajectory again.
const ITERATIONS: usize = 2;
/// Least mass in a window, as a share of the highest.
const LEAST: f64 = 1e-6;

/// Filter that the observer runs. [`str::parse`] takes `ekf`, `ukf`, `stationary`, `mhe` and the words of files: `extended`,
/// `unscented`, `stationary`, `moving-horizon`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Engine {
    /// Extended Kalman filter in factorised form.
    #[default]
    Extended,
    /// Unscented Kalman filter with the same noise, in factorised form.
    Unscented,
    /// Extended Kalman filter with the gain of the steady state: by the discrete Riccati equation, at the state of commissioning,
    /// for the interval at which samples usually come.
    ///
    /// At a fixed state the constants (films, capacity, offsets, couplings, coefficients) cannot be told apart, so they stay
    /// at what is nominal or was learnt before, and what their uncertainty does to the estimate is part of its
    /// standard deviations. Start it with [`super::Learned`] constants, or those will be large.
    Stationary,
    /// Moving-horizon estimation on top of the extended Kalman filter.
    MovingHorizon(MovingHorizonSettings),
}

/// Window of [`Engine::MovingHorizon`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MovingHorizonSettings {
    /// Samples in the window.
    pub samples: usize,
    /// Residual, in standard deviations, from which a reading pulls no harder (Huber's loss); `None`: least squares.
    pub huber: Option<f64>,
    /// A leak rate is not negative.
    pub leak_not_negative: bool,
    /// Mass does not rise, but for an exchange of gas.
    pub mass_not_rising: bool,
}

impl Default for MovingHorizonSettings {
    fn default() -> Self {
        Self { samples: 20, huber: None, leak_not_negative: true, mass_not_rising: true }
    }
}

impl MovingHorizonSettings {
    fn horizon(&self) -> HorizonSettings {
        let loss = self.huber.map_or(Loss::Quadratic, |delta| Loss::Huber { delta });
        HorizonSettings {
            samples: self.samples,
            loss,
            iterations_max: ITERATIONS,
            ..HorizonSettings::default()
        }
    }

    /// Leak rate not negative, mass not rising from sample to sample, wall, valve and gas within the temperatures of the fluid's equation of
    /// state, mass between nothing and its highest density.
    fn constraints(&self, cylinder: &mut Cylinder) -> Vec<Constraint> {
        let highest_kg = cylinder.model().highest_mass_kg();
        let domain = cylinder.model().fluid().domain();
        let states = cylinder.state_map();
        let mut rows = vec![
            Constraint::at_least(states.mass, LEAST * highest_kg),
            Constraint::at_most(states.mass, highest_kg),
        ];
        for state in (0..states.wall).chain(states.valve).chain([states.gas]) {
            rows.push(Constraint::at_least(state, domain.lowest_temperature_k));
            rows.push(Constraint::at_most(state, domain.highest_temperature_k));
        }
        if self.leak_not_negative {
            rows.push(Constraint::at_least(states.leak, 0.0));
        }
        if self.mass_not_rising {
            rows.push(Constraint::step(&[(states.mass, 1.0)], 0.0));
        }
        rows
    }
}

impl Engine {
    pub(super) fn validate(&self) -> Result<(), EstimatorError> {
        match self {
            Self::MovingHorizon(settings) => settings.horizon().validate(),
            Self::Extended | Self::Unscented | Self::Stationary => Ok(()),
        }
    }

    /// The same for the bank, with what a cylinder cannot do as constraints.
    pub(super) fn of_bank(&self, cylinder: &mut Cylinder) -> BankEngine {
        match self {
            Self::Extended => BankEngine::Extended,
            Self::Unscented => BankEngine::Unscented,
            Self::Stationary => BankEngine::Stationary,
            Self::MovingHorizon(settings) => {
                BankEngine::MovingHorizon(settings.horizon(), settings.constraints(cylinder))
            }
        }
    }

    /// Whether a pass can be smoothed: its gains are those of its own covariance.
    pub fn can_be_smoothed(&self) -> bool {
        matches!(self, Self::Extended | Self::Unscented)
    }
}

impl FromStr for Engine {
    type Err = EstimatorError;

    fn from_str(word: &str) -> Result<Self, EstimatorError> {
        match word {
            "extended" | "ekf" => Ok(Self::Extended),
            "unscented" | "ukf" => Ok(Self::Unscented),
            "stationary" => Ok(Self::Stationary),
            "moving-horizon" | "mhe" => Ok(Self::MovingHorizon(MovingHorizonSettings::default())),
            _ => Err(EstimatorError::EngineUnknown { word: word.to_owned() }),
        }
    }
}

#[cfg(test)]
mod horizon_tests;
#[cfg(test)]
mod stationary_tests;
#[cfg(test)]
mod unscented_tests;
