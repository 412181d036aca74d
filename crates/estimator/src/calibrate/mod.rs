//! Calibration: physical parameters of a vessel, its exposure and its sensors from recorded logs.
//!
//! Weighted least squares on the simulation, with the sensors' models applied to it:
//!
//! `sum_k [(y_k - y(theta, t_k)) / sigma_k]^2 + sum_i [(z_i - m_i) / s_i]^2  ->  min`
//!
//! with readings `y_k` of all channels of all experiments, the standard deviations `sigma_k` of the sensors' noise, and
//! priors `N(m_i, s_i^2)` as further residuals. A positive parameter is sought as `z = ln theta`, others as
//! themselves; bounds are kept by projection. The search is Gauss-Newton with damping; it ends where a
//! step would be a small share of a standard deviation in every direction.
//!
//! Sensitivities are exact: those of the course by the tangent equations of the simulation with its exact Jacobian, those
//! to numbers of the sensors from the readings of one course, in which all but a lag are linear.
//!
//! The covariance is the sandwich `A^-1 (sum_c f_c J_c^T J_c + prior) A^-1` with one factor per channel `f_c >= 1`: the
//! mean square of its weighted residuals times their integrated autocorrelation time, 1 for white residuals
//! of the stated noise. A model that does not fit to the noise thus gets wider intervals, never narrower ones.
//!
//! The air is an input, and what its thermometer reads too much is a parameter like others ([`ParameterKind::AirOffset`]): without it all offsets
//! are stated as if the air were exact. What the cells of the wall do to the estimates is said beside them
//! ([`Calibrated::mesh_shift_sd`]).
//!
//! Source: Ljung 1999 (sections 9 and 10), Seber and Wild 1989 (sections 5.9 and 14), Raue et al. 2009 for the profile.
mod apparent_leak;
mod apply;
mod calibrated;
mod error;
mod experiment;
mod fit;
mod identifiability;
mod mesh;
mod name;
mod parameter;
mod profile;
mod residuals;
mod sensitivity;
mod settings;
mod solution;
mod solve;
mod specification;
mod uncertainty;
mod validation;

pub use apparent_leak::ApparentLeak;
pub use calibrated::{Calibrated, Estimate};
pub use error::CalibrateError;
pub use experiment::Experiment;
pub use identifiability::{Combination, Identifiability};
pub use name::ParameterNameError;
pub use parameter::{ParameterKind, ParameterSpec, Prior, Scope};
pub use profile::Profile;
pub use residuals::ChannelResiduals;
pub use settings::CalibrationSettings;
pub use solve::SearchStep;
pub use validation::{ChannelScore, HoldOut, Validation};

use cylwatch_thermal::vessel::Vessel;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// What is to be calibrated, from what.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// Vessel of all experiments that do not have one of their own.
    pub vessel: Vessel,
    /// What was recorded, and under which circumstances.
    pub experiments: Vec<Experiment>,
    /// What is unknown; everything else is as vessel, scenarios and sensors say.
    pub parameters: Vec<ParameterSpec>,
    /// How it is sought.
    pub settings: CalibrationSettings,
}

impl Calibration {
    /// [`Calibration::run`], telling each step of the search to `watch`, until `stop` is set. What is computed of the result later
    /// ends with `stop`, too.
    ///
    /// # Errors
    /// Those of [`Calibration::run`]; [`CalibrateError::Stopped`].
    pub fn run_watched(
        &self,
        watch: &mut dyn FnMut(SearchStep),
        stop: &Arc<AtomicBool>,
    ) -> Result<Calibrated, CalibrateError> {
        let fit = fit::Fit::new(self, &fit::Selection::Everything)?.stopped_by(stop);
        fit.unless_stopped(calibrated::calibrate(&fit, watch))
    }

    /// Fits the parameters to all experiments.
    ///
    /// # Errors
    /// See [`CalibrateError`]: a log that cannot be used, a parameter that it does not determine or that runs to a bound.
    pub fn run(&self) -> Result<Calibrated, CalibrateError> {
        self.run_watched(&mut |_| (), &Arc::default())
    }
}
