//! Validation on readings that took no part in the fit.
use super::calibrated::calibrate;
use super::fit::{Fit, Selection};
use super::residuals::channel_residuals;
use super::{CalibrateError, Calibrated, Calibration, ParameterSpec, SearchStep};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// What is held out of the fit and scored afterwards.
#[derive(Clone, Debug, PartialEq)]
pub enum HoldOut {
    /// All readings later than this time, s, of every experiment.
    After {
        /// The time, s.
        time_s: f64,
    },
    /// Whole experiments, by their place in the list, from 0.
    Experiments(Vec<usize>),
}

/// How well held-out readings of a channel are predicted.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelScore {
    /// Source of the experiment.
    pub experiment: String,
    /// Name of the channel.
    pub channel: String,
    /// Root mean square error with the parameters as they were at the start, K or Pa.
    pub rms_before: f64,
    /// The same with the fitted parameters.
    pub rms_after: f64,
    /// Standard deviation of the sensor's noise, K or Pa, which no prediction can undercut.
    pub noise_sd: f64,
}

/// A calibration with its score on what was held out.
#[derive(Clone, Debug)]
pub struct Validation {
    /// The fit to the rest.
    pub calibrated: Calibrated,
    /// Scores of the held-out channels.
    pub scores: Vec<ChannelScore>,
}

impl HoldOut {
    fn selections(&self) -> (Selection, Selection) {
        match self {
            Self::After { time_s } => (Selection::Until(*time_s), Selection::After(*time_s)),
            Self::Experiments(these) => (Selection::Except(these.clone()), Selection::Only(these.clone())),
        }
    }

    fn describe(&self) -> String {
        match self {
            Self::After { time_s } => format!("everything after {time_s} s"),
            Self::Experiments(these) => format!("experiments {these:?}"),
        }
    }
}

impl Calibration {
    /// Fits the parameters to a part of the readings and scores them on the rest, before and after.
    ///
    /// # Errors
    /// [`CalibrateError::HoldOut`] if one of the parts is empty, and as [`Calibration::run`].
    pub fn validate(&self, hold_out: &HoldOut) -> Result<Validation, CalibrateError> {
        self.validate_watched(hold_out, &mut |_| (), &Arc::default())
    }

    /// [`Calibration::validate`], watched and stopped as by [`Calibration::run_watched`].
    ///
    /// # Errors
    /// Those of [`Calibration::validate`]; [`CalibrateError::Stopped`].
    pub fn validate_watched(
        &self,
        hold_out: &HoldOut,
        watch: &mut dyn FnMut(SearchStep),
        stop: &Arc<AtomicBool>,
    ) -> Result<Validation, CalibrateError> {
        let (fitted, scored) = hold_out.selections();
        let fit = self.part(hold_out, &fitted, "fit")?.stopped_by(stop);
        let calibrated = fit.unless_stopped(calibrate(&fit, watch))?;
        // Scoring needs readings, not as many as there are parameters or any excitation.
        let rest = self.part(hold_out, &scored, "score")?.stopped_by(stop);
        let start: Vec<f64> = rest.specs.iter().map(start_coordinate).collect();
        let residuals = |z: &[f64]| Ok(channel_residuals(&rest, &rest.unless_stopped(rest.evaluate(z))?));
        let (before, after) = (residuals(&start)?, residuals(&calibrated.solution.z)?);
        let sigmas = rest.cases.iter().flat_map(|case| &case.columns).map(|column| column.sigma);
        let scores = before
            .into_iter()
            .zip(after)
            .zip(sigmas)
            .map(|((before, after), noise_sd)| ChannelScore {
                experiment: before.experiment,
                channel: before.channel,
                rms_before: before.rms,
                rms_after: after.rms,
                noise_sd,
            })
            .collect();
        Ok(Validation { calibrated, scores })
    }

    fn part(
        &self,
        hold_out: &HoldOut,
        selection: &Selection,
        purpose: &'static str,
    ) -> Result<Fit, CalibrateError> {
        let fit =
            if purpose == "fit" { Fit::new(self, selection) } else { Fit::for_scoring(self, selection) }?;
        if fit.cases.is_empty() {
            return Err(CalibrateError::HoldOut { what: hold_out.describe(), purpose });
        }
        Ok(fit)
    }
}

fn start_coordinate(spec: &ParameterSpec) -> f64 {
    spec.coordinate(spec.start)
}
