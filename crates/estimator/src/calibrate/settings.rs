//! Settings of a calibration.
use cylwatch_thermal::simulate::SimulationSettings;

use super::CalibrateError;

/// How parameters are sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibrationSettings {
    /// Settings of the simulation; its error should be far below the sensors' noise over the root of their number.
    pub simulation: SimulationSettings,
    /// Steps after which the search is given up.
    pub iterations: usize,
    /// The search ends where a step is shorter than this many standard deviations of the estimate in every direction.
    pub tolerance_sd: f64,
    /// Probability with which an interval holds the truth.
    pub confidence: f64,
    /// A combination of parameters is named as not separable when the log leaves it more uncertain than this many times
    /// the parameters' usual widths ([`super::ParameterKind::usual_width`]).
    pub separable_within: f64,
    /// The log is refused where it leaves a combination more uncertain than this many times the usual widths.
    pub undetermined_beyond: f64,
}

impl Default for CalibrationSettings {
    fn default() -> Self {
        Self {
            simulation: SimulationSettings { relative_tolerance: 1e-9, ..SimulationSettings::default() },
            iterations: 40,
            tolerance_sd: 0.02,
            confidence: 0.95,
            separable_within: 1.0,
            undetermined_beyond: 10.0,
        }
    }
}

impl CalibrationSettings {
    /// Checks the settings.
    ///
    /// # Errors
    /// [`CalibrateError::Setting`] with the first value outside its range, or that of the simulation.
    pub fn validate(&self) -> Result<(), CalibrateError> {
        self.simulation.validate().map_err(|source| CalibrateError::Settings { source })?;
        let check = |name: &'static str, value: f64, (low, high): (f64, f64)| {
            if value > low && value < high {
                Ok(())
            } else {
                Err(CalibrateError::Setting { name, value, low, high })
            }
        };
        check("iterations", self.iterations as f64, (0.0, 1e6))?;
        check("tolerance_sd", self.tolerance_sd, (0.0, 1.0))?;
        check("confidence", self.confidence, (0.0, 1.0))?;
        check("separable_within", self.separable_within, (0.0, f64::INFINITY))?;
        check("undetermined_beyond", self.undetermined_beyond, (0.0, f64::INFINITY))
    }

    /// Normal quantile of half the confidence interval.
    pub(super) fn quantile(&self) -> f64 {
        use statrs::distribution::{ContinuousCDF, Normal};
        Normal::standard().inverse_cdf(0.5 + 0.5 * self.confidence)
    }
}
