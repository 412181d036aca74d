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
use alloc::borrow::ToOwned;
use core::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::EstimatorError;
#[cfg(feature = "design")]
use crate::filter::horizon::{HorizonSettings, Loss};

/// Iterations of a window per sample at most. The next sample iterates the same trajectory again.
#[cfg(feature = "design")]
const ITERATIONS: usize = 2;

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
    #[cfg(feature = "design")]
    MovingHorizon(MovingHorizonSettings),
}

/// Window of [`Engine::MovingHorizon`].
#[cfg(feature = "design")]
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

#[cfg(feature = "design")]
impl Default for MovingHorizonSettings {
    fn default() -> Self {
        Self { samples: 20, huber: None, leak_not_negative: true, mass_not_rising: true }
    }
}

#[cfg(feature = "design")]
impl MovingHorizonSettings {
    pub(super) fn horizon(&self) -> HorizonSettings {
        let loss = self.huber.map_or(Loss::Quadratic, |delta| Loss::Huber { delta });
        HorizonSettings {
            samples: self.samples,
            loss,
            iterations_max: ITERATIONS,
            ..HorizonSettings::default()
        }
    }
}

impl Engine {
    pub(super) fn validate(&self) -> Result<(), EstimatorError> {
        match self {
            #[cfg(feature = "design")]
            Self::MovingHorizon(settings) => settings.horizon().validate(),
            _ if cfg!(feature = "design") || *self == Self::Extended => Ok(()),
            _ => Err(EstimatorError::EngineMissing),
        }
    }

    /// Whether a pass can be smoothed: its gains are those of its own covariance.
    pub(crate) fn can_be_smoothed(&self) -> bool {
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
            #[cfg(feature = "design")]
            "moving-horizon" | "mhe" => Ok(Self::MovingHorizon(MovingHorizonSettings::default())),
            _ => Err(EstimatorError::EngineUnknown { word: word.to_owned() }),
        }
    }
}
