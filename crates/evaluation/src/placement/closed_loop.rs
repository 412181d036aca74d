//! Whether the best layouts achieve what is predicted, in the observer's own world and in others.
use cylwatch_thermal::units::DAY_S;
use std::sync::atomic::Ordering;

use serde::{Deserialize, Serialize};

use super::{
    Claim, ConfirmSettings, Confirmed, Detected, calm, detected_matched, detected_mismatched, matched,
    mismatched,
};
use crate::EvaluationError;
use crate::estimator::placement::search::SearchControl;
use crate::estimator::placement::study::{LAYOUTS_EVALUATED, Placement, Study};

/// Length of a mismatched run, and what of it the observer learns in, s.
const MISMATCHED_S: f64 = 8.0 * DAY_S;
const LEARNING_S: f64 = 5.0 * DAY_S;

/// How layouts are confirmed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ClosedLoopSettings {
    /// Runs in the observer's own world; 0: no confirmation.
    pub matched: u64,
    /// Runs in drawn cylinders in railway weather; 0: none.
    pub mismatched: u64,
    /// First seed of both.
    pub first_seed: u64,
}

impl Default for ClosedLoopSettings {
    /// None.
    fn default() -> Self {
        Self { matched: 0, mismatched: 0, first_seed: 1 }
    }
}

/// What layouts achieve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClosedLoop {
    /// Errors in the observer's own world, a calm one: see [`calm`].
    pub matched: Vec<Confirmed>,
    /// Smallest leak there.
    pub matched_leaks: Vec<Detected>,
    /// Errors in drawn cylinders in railway weather.
    pub mismatched: Vec<Confirmed>,
    /// Smallest leak there.
    pub mismatched_leaks: Vec<Detected>,
    /// It was stopped before its end.
    pub partial: bool,
}

/// What the best layouts of most sensors of a study achieve; `None`: no runs are asked for, or the study was stopped.
///
/// # Errors
/// As [`confirm`].
pub fn confirm_study(
    placement: &Placement,
    study: &Study,
    settings: &ClosedLoopSettings,
    control: &SearchControl,
) -> Result<Option<ClosedLoop>, EvaluationError> {
    match study.numbers.last() {
        Some(most) if !study.partial && settings.matched + settings.mismatched > 0 => {
            let best = most.layouts.iter().take(LAYOUTS_EVALUATED).map(|layout| layout.sensors.clone());
            confirm(placement, &best.collect::<Vec<_>>(), settings, control).map(Some)
        }
        _ => Ok(None),
    }
}

/// What layouts achieve over runs from seeds. The first member of the bank is confirmed by its errors, the one whose innovations tell a
/// leak by the smallest leak.
///
/// # Errors
/// As [`matched`] and [`mismatched`].
pub fn confirm(
    placement: &Placement,
    layouts: &[Vec<usize>],
    settings: &ClosedLoopSettings,
    control: &SearchControl,
) -> Result<ClosedLoop, EvaluationError> {
    let ClosedLoopSettings { matched: own, mismatched: drawn, first_seed } = *settings;
    let (candidates, steady) = (placement.candidates().sensors(), placement.steady().settings());
    let quiet = calm(&steady.observer, &steady.conditions);
    let at_quiet = steady.conditions.at_typical_difference(placement.vessel(), &quiet)?;
    let (first, slow) = placement.steady().members();
    let claim = |quiet_world: bool, member| Claim {
        vessel: placement.vessel(),
        candidates: &candidates,
        settings: if quiet_world { &quiet } else { &steady.observer },
        member,
        conditions: if quiet_world { &at_quiet } else { &steady.conditions },
        layouts,
    };
    let of_seeds = |seeds| ConfirmSettings { first_seed, seeds, ..ConfirmSettings::default() };
    let mut found = ClosedLoop {
        matched: Vec::new(),
        matched_leaks: Vec::new(),
        mismatched: Vec::new(),
        mismatched_leaks: Vec::new(),
        partial: false,
    };
    if own > 0 {
        found.matched = matched(&claim(true, first), &of_seeds(own), control, &|_| ())?.layouts;
        let detection = &steady.detection;
        found.matched_leaks = detected_matched(&claim(true, slow), &of_seeds(own), detection, control)?;
    }
    if drawn > 0 {
        let settings = ConfirmSettings { duration_s: MISMATCHED_S, ..of_seeds(drawn) };
        found.mismatched = mismatched(&claim(false, first), &settings, control, &|_| ())?.layouts;
        let settings = ConfirmSettings { burn_in_s: LEARNING_S, ..settings };
        found.mismatched_leaks =
            detected_mismatched(&claim(false, slow), &settings, &steady.detection, control)?;
    }
    found.partial = control.stop.load(Ordering::Relaxed);
    Ok(found)
}
