//! Which filter a member of the bank runs: how its mean and covariance move in time and take a reading.
//!
//! The policy around it is one and the same for all engines and lives in [`super::member`]: gates, re-acquisition, events, bounds,
//! slow walks of the constants.
//!
//! * extended: linearised along the estimate; the default;
//! * [`unscented`]: linearised statistically, over the spread of the estimate.
mod unscented;

use serde::{Deserialize, Serialize};

use super::cylinder::Cylinder;
use crate::filter::StateSpace;
pub(super) use unscented::SigmaPoints;

/// Filter that the observer runs. The words for [`str::parse`] and in files: `extended` or `ekf`, `unscented` or `ukf`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Engine {
    /// Extended Kalman filter in factorised form: fast, and learns all that can be learnt.
    #[default]
    Extended,
    /// Unscented Kalman filter with the same noise, also in factorised form: about forty times the cost; it needs no
    /// gradients to be right over the spread of the estimate.
    Unscented,
}

impl std::str::FromStr for Engine {
    type Err = crate::EstimatorError;

    fn from_str(word: &str) -> Result<Self, Self::Err> {
        match word {
            "extended" | "ekf" => Ok(Self::Extended),
            "unscented" | "ukf" => Ok(Self::Unscented),
            _ => Err(crate::EstimatorError::EngineUnknown { word: word.to_owned() }),
        }
    }
}

/// An engine with its memory of the past beside mean and covariance.
#[derive(Clone, Debug)]
pub(super) enum Mechanism {
    Extended,
    Unscented,
}

impl Mechanism {
    pub fn new(engine: Engine) -> Self {
        match engine {
            Engine::Extended => Self::Extended,
            Engine::Unscented => Self::Unscented,
        }
    }
}

/// A reading as an engine predicts it; the gradient is written beside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Predicted {
    /// Mean.
    pub value: f64,
    /// Variance of what the gradient does not say: the sensor's noise, and curvature over the spread of the estimate.
    pub r: f64,
}

/// Noise sources of a time update with an engine.
pub(super) fn noises(engine: Engine, cylinder: &Cylinder) -> usize {
    match engine {
        Engine::Unscented => SigmaPoints::noises(cylinder),
        _ => cylinder.noises(),
    }
}
