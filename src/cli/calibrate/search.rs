//! The fit itself, beside the caller who may end it, with what is computed of its result.
use super::parameters::Subject;
use super::{Case, Options, Start, Validation};
use crate::cli::beside::until_stopped;
use crate::cli::input::Inputs;
use crate::cli::message::Messages;
use crate::cli::progress::Progress;
use crate::estimator::calibrate::{
    ApparentLeak, CalibrateError, Calibrated, Calibration, ChannelScore, HoldOut, Profile, SearchStep,
};
use crate::report::calibrate as report;
use crate::report::calibrate::Study;
use crate::thermal::vessel::Vessel;
use anyhow::anyhow;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// A first step of the search from which on it is said how long all of them take.
const SLOW: Duration = Duration::from_secs(1);
/// Steps of most searches. The first one has no trial before it, the others have: they take up to twice as long.
const USUAL_STEPS: [f64; 2] = [4.0, 10.0];

/// How long a calibration takes whose search took so long to begin.
fn pace(first_step: Duration) -> String {
    let [few, many] = USUAL_STEPS;
    let step_s = first_step.as_secs_f64();
    let words = |time_s: f64| match time_s {
        ..90.0 => format!("{:.0} s", time_s.ceil()),
        _ => format!("{:.0} min", (time_s / 60.0).ceil()),
    };
    format!(
        "a search takes {few} to {many} steps, here {} to {}; fewer cells of the vessel, fewer rows or a shorter log make it faster",
        words(few * step_s),
        words(2.0 * many * step_s)
    )
}

/// What is fitted, with what is asked of the result.
struct Search {
    calibration: Calibration,
    hold_out: Option<HoldOut>,
    /// Places of the parameters whose profile is wanted.
    profiles: Vec<usize>,
}

/// What was found.
struct Found {
    calibrated: Calibrated,
    scores: Vec<ChannelScore>,
    profiles: Vec<Profile>,
    mesh_shift_sd: Vec<f64>,
    apparent_leaks: Vec<ApparentLeak>,
}

impl Search {
    /// Fits, scores the held-out data, and computes profiles, until `stop` is set.
    fn found(
        &self,
        stop: &Arc<AtomicBool>,
        progress: &Progress,
        messages: &Messages,
    ) -> anyhow::Result<Found> {
        let began = Instant::now();
        let mut watch = |step: SearchStep| {
            let SearchStep { number, distance_sd } = step;
            if number == 1 && began.elapsed() > SLOW {
                progress.suspended(|| messages.say(&pace(began.elapsed())));
            }
            progress.say(&format!("step {number}: {distance_sd:.2} standard deviations from the minimum"));
        };
        let (calibrated, scores) = match &self.hold_out {
            None => (self.calibration.run_watched(&mut watch, stop).map_err(explained)?, Vec::new()),
            Some(hold_out) => {
                let validation = self.calibration.validate_watched(hold_out, &mut watch, stop);
                let validation = validation.map_err(explained)?;
                (validation.calibrated, validation.scores)
            }
        };
        progress.say("profiles");
        let profiles = self.profiles.iter().map(|&place| calibrated.profile(place));
        let profiles = profiles.collect::<Result<_, _>>()?;
        progress.say("a finer wall");
        let mesh_shift_sd = calibrated.mesh_shift_sd().unwrap_or_default();
        let apparent_leaks = calibrated.apparent_leaks();
        Ok(Found { calibrated, scores, profiles, mesh_shift_sd, apparent_leaks })
    }
}

impl Case {
    fn subject<'a>(&'a self, main: &'a Vessel) -> Subject<'a> {
        Subject {
            vessel: self.vessel.as_ref().unwrap_or(main),
            recording: &self.recording,
            conditions: &self.conditions,
            is_main: self.vessel.is_none(),
        }
    }
}

impl Options {
    /// Fits, scores the held-out data, and computes profiles.
    pub(super) fn study(
        &self,
        start: &Start,
        cases: Vec<Case>,
        inputs: &Inputs,
        messages: &Messages,
    ) -> anyhow::Result<Study> {
        let subjects: Vec<Subject<'_>> = cases.iter().map(|case| case.subject(&start.vessel)).collect();
        let parameters = self.parameters.parameters(&subjects)?;
        let profiles = self.parameters.profiles(&parameters)?;
        let (hold_out, held_out) = self.hold_out(&cases).unzip();
        let conditions = cases.iter().map(|case| case.conditions.words.clone()).collect();
        let calibration = Calibration {
            vessel: start.vessel.clone(),
            experiments: cases.into_iter().map(Case::experiment).collect(),
            parameters,
            settings: self.settings,
        };
        let search = Search { calibration, hold_out, profiles };
        let progress = Progress::open_ended(messages, "calibrating");
        let found = until_stopped(inputs, |stop| search.found(stop, &progress, messages));
        drop(progress);
        let Found { calibrated, scores, profiles, mesh_shift_sd, apparent_leaks } = found?;
        Ok(Study {
            calibration: search.calibration,
            calibrated,
            conditions,
            scores,
            held_out,
            profiles,
            mesh_shift_sd,
            apparent_leaks,
        })
    }

    fn hold_out(&self, cases: &[Case]) -> Option<(HoldOut, String)> {
        match self.validation? {
            Validation::Fraction(fraction) => {
                let recording = &cases.first()?.recording;
                let first_s = recording.log.time_s.first().copied().unwrap_or(0.0);
                let time_s = recording.end_s() - fraction * (recording.end_s() - first_s);
                Some((
                    HoldOut::After { time_s },
                    format!("last {} % of {}", 100.0 * fraction, recording.name),
                ))
            }
            Validation::LastLog => {
                let last = cases.len() - 1;
                Some((HoldOut::Experiments(vec![last]), cases[last].recording.name.clone()))
            }
        }
    }
}

/// An error of a fit, with the option that helps where parameters cannot be told apart.
fn explained(error: CalibrateError) -> anyhow::Error {
    let CalibrateError::Undetermined { combination, .. } = &error else { return error.into() };
    let names: Vec<&str> =
        combination.split_whitespace().filter(|word| !matches!(*word, "with" | "against")).collect();
    anyhow!("{error}; {}", report::remedy(&names))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn how_long_it_takes_is_said_in_seconds_and_minutes() {
        assert!(pace(Duration::from_secs(3)).contains("takes 4 to 10 steps, here 12 s to 60 s;"));
        assert!(pace(Duration::from_secs(30)).contains("here 2 min to 10 min;"));
    }
}
