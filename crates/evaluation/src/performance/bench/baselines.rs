//! The detectors of [`crate::baseline`] as candidates.
//!
//! | name | expected pressure | gas | zero | hold |
//! |---|---|---|---|---|
//! | paper | as published | as published | none | 10 min |
//! | paper refitted | real gas | gain 1, pole 0.002988/s | first 4 d, at most half of learning | 60 min |
//! | textbook CUSUM | real gas | as refitted | mean and standard deviation of the same time | none |
//! | ideal gas | `p_fill T/T_fill` | shoulder | none | 10 min |
//! | pressure switch | constant | none | none | none |
use super::Plan;
use super::candidate::{Candidate, Contender};
use crate::baseline::{ErrorCusum, PressureError, Threshold};
use crate::{EvaluationError, error::positive};

/// Unit of errors of the pressure.
const PASCAL: &str = "Pa";
/// How long the refitted detectors learn their error at most, s, and which part of the time that there is for learning.
const LEARNT_S: f64 = 4.0 * 86_400.0;
const LEARNT_PART: f64 = 0.5;
/// Debouncing of the refitted detector, s: best for leaks that are to be found within a day.
const HOLD_S: f64 = 3600.0;
/// Limit of the switch, Pa.
const SWITCH_PA: f64 = 160e5;

/// The paper's detector as published and refitted, a textbook's cumulative sum, an ideal gas, a pressure switch.
///
/// # Errors
/// The learning of the plan is not positive.
pub fn baselines(plan: &Plan) -> Result<Vec<Candidate>, EvaluationError> {
    let zero_s = LEARNT_S.min(LEARNT_PART * positive("learning_s", plan.learning_s)?);
    let refitted = PressureError::refitted("nitrogen", Plan::FILLING)?;
    let held = Threshold::new(refitted.clone()).held_for(HOLD_S).zeroed_over(zero_s);
    Ok(vec![
        of("paper", PASCAL, Threshold::published(Plan::FILLING)),
        of("paper refitted", PASCAL, held),
        of("textbook CUSUM", "sd", ErrorCusum::learning(refitted, zero_s)),
        of("ideal gas", PASCAL, Threshold::ideal_gas(Plan::FILLING)),
        of("pressure switch", PASCAL, Threshold::raw_switch(SWITCH_PA)),
    ])
}

fn of(name: &str, unit: &'static str, fresh: impl Contender + Clone + Send + Sync + 'static) -> Candidate {
    Candidate::new(name, unit, move || Ok(fresh.clone()))
}
