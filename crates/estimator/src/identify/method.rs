//! How a model is identified.
use serde::{Deserialize, Serialize};

use super::IdentifyError;

/// Stochastic model of the true input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InputModel {
    /// Random walk: steps of a variance proportional to the interval.
    #[default]
    RandomWalk,
    /// Integrated random walk: a smooth course, whose slope is a random walk.
    IntegratedRandomWalk,
}

/// Method of identification.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Least squares of the simulation's errors.
    OutputError,
    /// Simplified refined instrumental variables (SRIVC).
    RefinedInstruments,
    /// Least squares with the bias of white sensor noise taken off.
    BiasCompensated {
        /// Variance of the input sensor's noise, in the input's unit squared.
        input_variance: f64,
        /// Variance of the output sensor's noise, in the output's unit squared.
        output_variance: f64,
    },
    /// Refined instrumental variables with the bias of white input noise taken off. The output's noise need not be known: the model's
    /// response, which the instruments come from, does not hold it.
    CompensatedInstruments {
        /// Variance of the input sensor's noise, in the input's unit squared.
        input_variance: f64,
    },
    /// Instrumental variables from a second sensor of the input.
    SecondSensor {
        /// Its samples, at the times of the data; NaN is a missing value.
        input: Vec<f64>,
    },
    /// Maximum likelihood of both sensors' readings.
    MaximumLikelihood {
        /// Variance of the input sensor's noise, in the input's unit squared.
        input_variance: f64,
        /// Variance of the output sensor's noise, in the output's unit squared.
        output_variance: f64,
        /// Model of the true input.
        #[serde(rename = "course")]
        input_model: InputModel,
    },
}

/// First model of the iterations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StartMethod {
    /// Least squares through state-variable filters.
    StateVariableFilter,
    /// The same, then a few steps of instrumental variables as far as they lower the errors.
    #[default]
    InstrumentalVariables,
}

/// How the errors' correlation enters the covariance of output error and refined instruments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ErrorModel {
    /// Not at all: errors are white.
    White,
    /// Their correlation is estimated.
    Coloured,
    /// Estimated if a test at 1 % rejects that they are white.
    #[default]
    Judged,
}

/// Settings of an identification.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Most iterations.
    pub iterations: usize,
    /// Relative step at which an iteration ends.
    pub tolerance: f64,
    /// First model.
    pub start: StartMethod,
    /// Errors' correlation.
    pub errors: ErrorModel,
    /// Longest gap of the input that is bridged, s; 20 median intervals if there is none.
    pub longest_gap_s: Option<f64>,
    /// Largest lag of the residual analysis, samples.
    pub lags: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            iterations: 200,
            tolerance: 1e-12,
            start: StartMethod::default(),
            errors: ErrorModel::default(),
            longest_gap_s: None,
            lags: 25,
        }
    }
}

impl Settings {
    pub(super) fn validate(&self) -> Result<(), IdentifyError> {
        let within = |name, value: f64, ok: bool, bound| {
            if ok { Ok(()) } else { Err(IdentifyError::Setting { name, value, bound }) }
        };
        within("iterations", self.iterations as f64, self.iterations > 0, "at least 1")?;
        within("tolerance", self.tolerance, self.tolerance > 0.0 && self.tolerance < 1.0, "between 0 and 1")?;
        within("lags", self.lags as f64, self.lags > 0, "at least 1")?;
        let gap_s = self.longest_gap_s.unwrap_or(1.0);
        within("longest_gap_s", gap_s, gap_s > 0.0, "above 0 s")
    }
}

impl Method {
    pub(super) fn validate(&self) -> Result<(), IdentifyError> {
        let (input, output, least) = match *self {
            Self::BiasCompensated { input_variance, output_variance } => {
                (input_variance, output_variance, 0.0)
            }
            Self::MaximumLikelihood { input_variance, output_variance, .. } => {
                (input_variance, output_variance, f64::MIN_POSITIVE)
            }
            _ => return Ok(()),
        };
        let bound = if least > 0.0 { "above zero" } else { "at least zero" };
        for (name, value) in [("input_variance", input), ("output_variance", output)] {
            if !value.is_finite() || value < least {
                return Err(IdentifyError::Setting { name, value, bound });
            }
        }
        Ok(())
    }

    /// Samples of a second sensor.
    pub(super) fn second(&self) -> Option<&[f64]> {
        match self {
            Self::SecondSensor { input } => Some(input),
            _ => None,
        }
    }
}
