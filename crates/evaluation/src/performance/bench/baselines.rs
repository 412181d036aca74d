//! The detectors of [`crate::detector::baseline`] as candidates.
//!
//! | name | expected pressure | gas | zero | hold |
//! |---|---|---|---|---|
//! | paper | as published | as published | none | 10 min |
//! | paper refitted | real gas | gain 1, pole 0.002988/s | first 4 d, at most half of learning | 60 min |
//! | textbook CUSUM | real gas | as refitted | mean and standard deviation of the same time | none |
//! | ideal gas | `p_fill T/T_fill` | shoulder | none | 10 min |
//! | pressure switch | constant | none | none | none |
use crate::estimator::identify::published::Filling;

use super::Plan;
use super::candidate::{Candidate, Contender, Readings, of_statistic};
use crate::detector::baseline::{
    ErrorCusum, Expectation, GasModel, Law, PressureError, Threshold, ThresholdSettings,
};
use crate::detector::statistic::Statistic;
use crate::{EvaluationError, error::positive};

/// Unit of errors of the pressure.
const PASCAL: &str = "Pa";
/// Pole of the transfer function refitted to simulated cylinders, 1/s.
const REFITTED_POLE_PER_S: f64 = 0.002_988;
/// How long the refitted detectors learn their error at most, s, and which part of the time that there is for learning.
const LEARNT_S: f64 = 4.0 * 86_400.0;
const LEARNT_PART: f64 = 0.5;
/// Debouncing of the refitted detector, s: best for leaks that are to be found within a day.
const HOLD_S: f64 = 3600.0;
/// Reference value of the cumulative sum, standard deviations.
const REFERENCE: f64 = 0.5;
/// Limit of the switch, Pa.
const SWITCH_PA: f64 = 160e5;

/// The paper's detector as published and refitted, a textbook's cumulative sum, an ideal gas, a pressure switch.
///
/// # Errors
/// The learning of the plan is not positive.
pub fn baselines(plan: &Plan) -> Result<Vec<Candidate>, EvaluationError> {
    let zero_s = LEARNT_S.min(LEARNT_PART * positive("learning_s", plan.learning_s)?);
    let refitted = refitted_error(Plan::FILLING)?;
    let settings = ThresholdSettings { hold_s: HOLD_S, zero_s, ..ThresholdSettings::default() };
    Ok(vec![
        of_statistic("paper", PASCAL, Threshold::published(Plan::FILLING)?),
        of_statistic("paper refitted", PASCAL, Threshold::try_new(refitted.clone(), settings)?),
        textbook_cusum(refitted, zero_s),
        of_statistic("ideal gas", PASCAL, Threshold::ideal_gas(Plan::FILLING)?),
        of_statistic("pressure switch", PASCAL, Threshold::raw_switch(SWITCH_PA)?),
    ])
}

/// The paper's error with a gain of 1, a refitted pole and the equation of state.
fn refitted_error(filling: Filling) -> Result<PressureError, EvaluationError> {
    let expectation = Expectation::try_new(Law::RealGas { gas: "nitrogen".into() }, filling)?;
    let model = GasModel::FirstOrder { gain: 1.0, pole_per_s: REFITTED_POLE_PER_S, initial_degc: None };
    Ok(PressureError::try_new(expectation, model)?)
}

/// A cumulative sum of an error whose mean and standard deviation it takes from the first `learnt_s`.
pub fn textbook_cusum(error: PressureError, learnt_s: f64) -> Candidate {
    Candidate::new("textbook CUSUM", "sd", move || {
        Ok(Textbook { error: error.clone(), learnt_s, start_s: None, sums: (0.0, 0.0, 0.0), cusum: None })
    })
}

struct Textbook {
    error: PressureError,
    learnt_s: f64,
    start_s: Option<f64>,
    /// Number, mean, and sum of squares about it.
    sums: (f64, f64, f64),
    cusum: Option<ErrorCusum>,
}

impl Contender for Textbook {
    fn step(&mut self, readings: &Readings) -> Result<f64, EvaluationError> {
        if let Some(cusum) = &mut self.cusum {
            return Ok(cusum.update(readings.seen()));
        }
        let Some(error_pa) = self.error.step(readings.seen()) else { return Ok(f64::NEG_INFINITY) };
        let start_s = *self.start_s.get_or_insert(readings.time_s);
        let (n, mean, squares) = (self.sums.0 + 1.0, self.sums.1, self.sums.2);
        let off = error_pa - mean;
        let mean = mean + off / n;
        self.sums = (n, mean, squares + off * (error_pa - mean));
        if readings.time_s - start_s >= self.learnt_s {
            let sd = (self.sums.2 / (n - 1.0)).sqrt();
            self.cusum = Some(ErrorCusum::try_new(self.error.clone(), (mean, sd), REFERENCE)?);
        }
        Ok(f64::NEG_INFINITY)
    }
}
