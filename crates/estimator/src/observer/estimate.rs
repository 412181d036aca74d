//! What the observer says after a sample.
use serde::{Deserialize, Serialize};

use super::belief::mixture;

/// How far an estimate can be relied on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quality {
    /// Every sensor was heard.
    Good,
    /// A sensor had no reading, or its reading was rejected.
    Degraded,
    /// No reading at all: the model alone.
    Predicted,
    /// Gas is or was just exchanged, or a reading was taken after many rejections: mass and gas temperature are free.
    Open,
    /// The estimate could not go on and began again from its prior.
    Restarted,
}

impl Quality {
    /// One word for a table.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Degraded => "degraded",
            Self::Predicted => "predicted",
            Self::Open => "open",
            Self::Restarted => "restarted",
        }
    }
}

/// Estimate after a sample. SI; `sd` is a standard deviation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Time, s.
    pub time_s: f64,
    /// Mean gas temperature, K.
    pub gas_mean_k: f64,
    /// Its sd, K.
    pub gas_mean_sd_k: f64,
    /// Gas mass, kg.
    pub mass_kg: f64,
    /// Its sd, kg.
    pub mass_sd_kg: f64,
    /// Leak rate, kg/s, by the middle one of the members that have one; NaN without such a member.
    pub leak_kg_s: f64,
    /// Its sd, kg/s.
    pub leak_sd_kg_s: f64,
    /// Pressure as read, Pa; NaN: missing.
    pub pressure_pa: f64,
    /// Pressure that the transmitter would show now with the reference mass, Pa: with the mass a day after commissioning or
    /// after the last exchange of gas, before that with the mass as estimated.
    pub pressure_expected_pa: f64,
    /// Pressure of the estimated mass settled at 15 °C, Pa.
    pub p15_pa: f64,
    /// How far to rely on it.
    pub quality: Quality,
}

impl Estimate {
    /// Mass and gas temperature where nobody knows whether it is this or the other: between the two, and no more certain than they are apart.
    pub fn or(self, other: Self) -> Self {
        let between = |one: (f64, f64), other: (f64, f64)| {
            let (mean, variance) = mixture(0.5, (one.0, one.1 * one.1), (other.0, other.1 * other.1));
            (mean, variance.sqrt())
        };
        let (mass_kg, mass_sd_kg) =
            between((self.mass_kg, self.mass_sd_kg), (other.mass_kg, other.mass_sd_kg));
        let (gas_mean_k, gas_mean_sd_k) =
            between((self.gas_mean_k, self.gas_mean_sd_k), (other.gas_mean_k, other.gas_mean_sd_k));
        Self { mass_kg, mass_sd_kg, gas_mean_k, gas_mean_sd_k, ..self }
    }
}

/// Leak rate in the eyes of one member.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Leak {
    /// Leak rate, kg/s.
    pub rate_kg_s: f64,
    /// Its standard deviation, kg/s.
    pub sd_kg_s: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Its standard deviation, kg.
    pub mass_sd_kg: f64,
    /// Covariance of mass and leak rate, kg²/s.
    pub covariance_kg2_s: f64,
    /// Whether it was out of the question at this sample and began anew from the freest member.
    pub begun_anew: bool,
}
