//! Whether the smallest leak that is predicted is the smallest that is found.
//!
//! The best statistic of a leak of known onset sums the innovations of the ordinary observer with the weights of its signature
//! ([`Response::weights`]). In the world that the prediction supposes it has the variance one without a leak, and a leak of rate `r` moves it by
//! `r sqrt(J)`. Elsewhere both differ: with the standard deviation `s` over tight runs, and a leak that moves it by `a r sqrt(J)`, a threshold
//! that keeps the rate of false alarms lies `b s` above its mean, and the smallest leak is `s / a` times the predicted one.
//!
//! Every seed is run twice, tight and with one leak, so that `a` has no noise of its own.
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal};

use super::matched::constants_known;
use super::{Claim, ConfirmSettings, Confirmation, InnovationSink, matched, mismatched};
use crate::EvaluationError;
use crate::estimator::observer::{Innovation, ObserverSettings};
use crate::estimator::placement::cylinder::{InstrumentedCylinder, Quantity};
use crate::estimator::placement::search::SearchControl;
use crate::estimator::placement::{DetectionSettings, Disturbance};
use crate::world::SteadyLeak;

/// A leak before each layout.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Detected {
    /// Indices of its candidates.
    pub layout: Vec<usize>,
    /// Smallest leak by prediction, kg/s.
    pub predicted_kg_s: f64,
    /// Smallest leak as the runs have it, kg/s.
    pub achieved_kg_s: f64,
    /// Standard deviation of the statistic over tight runs; 1 is predicted.
    pub sd: f64,
    /// Its mean over them, in predicted standard deviations; 0 is predicted.
    pub mean: f64,
    /// Mean change by the leak, in parts of the predicted one.
    pub answer: f64,
    /// Leak of the runs, kg/s.
    pub leak_kg_s: f64,
    /// Share of its runs beyond the threshold.
    pub found: f64,
    /// Share that is predicted.
    pub found_predicted: f64,
    /// Share of the tight runs beyond the threshold.
    pub false_alarms: f64,
    /// Runs with it, and as many without.
    pub seeds: u64,
}

/// Sum of a run.
#[derive(Debug)]
struct Statistic<'a> {
    weights: &'a [nalgebra::DVector<f64>],
    onset_s: f64,
    interval_s: f64,
    sum: f64,
}

impl InnovationSink for Statistic<'_> {
    fn record(&mut self, time_s: f64, innovations: &[Innovation]) {
        let row = ((time_s - self.onset_s) / self.interval_s).round();
        if row < 0.0 {
            return;
        }
        let Some(weights) = self.weights.get(row as usize) else { return };
        let known = weights.iter().zip(innovations).filter(|(_, innovation)| innovation.nu.is_finite());
        self.sum += known.map(|(weight, innovation)| weight * innovation.nu).sum::<f64>();
    }
}

/// What is predicted of a layout.
struct Prediction {
    weights: Vec<nalgebra::DVector<f64>>,
    smallest_kg_s: f64,
}

/// In the observer's own world: as [`matched()`]. The leak begins after the burn-in and is the smallest of the first layout.
///
/// # Errors
/// As [`matched()`]; or the member has no leak rate.
pub fn detected_matched(
    claim: &Claim<'_>,
    settings: &ConfirmSettings,
    detection: &DetectionSettings,
    control: &SearchControl,
) -> Result<Vec<Detected>, EvaluationError> {
    let (candidates, known) = constants_known(claim.candidates, claim.settings);
    let cylinder =
        InstrumentedCylinder::new(claim.vessel, &candidates, &known, claim.member, claim.conditions)?;
    detected(claim, settings, detection, &cylinder, &|claim, settings, predictions| {
        matched(claim, settings, control, &|id| statistic(claim, settings, &predictions[id.layout])).map(sums)
    })
}

/// In drawn cylinders in railway weather: as [`mismatched()`], with the claim's member alone. The prediction is the one at rest.
///
/// # Errors
/// As [`mismatched()`]; or the member has no leak rate.
pub fn detected_mismatched(
    claim: &Claim<'_>,
    settings: &ConfirmSettings,
    detection: &DetectionSettings,
    control: &SearchControl,
) -> Result<Vec<Detected>, EvaluationError> {
    let alone = ObserverSettings { bank: vec![*claim.member], ..claim.settings.clone() };
    let claim = Claim { settings: &alone, ..*claim };
    let cylinder = InstrumentedCylinder::new(
        claim.vessel,
        claim.candidates,
        claim.settings,
        claim.member,
        claim.conditions,
    )?;
    detected(&claim, settings, detection, &cylinder, &|claim, settings, predictions| {
        mismatched(claim, settings, control, &|id| statistic(claim, settings, &predictions[id.layout]))
            .map(sums)
    })
}

fn statistic<'a>(claim: &Claim<'_>, settings: &ConfirmSettings, prediction: &'a Prediction) -> Statistic<'a> {
    Statistic {
        weights: &prediction.weights,
        onset_s: settings.burn_in_s,
        interval_s: claim.conditions.interval_s,
        sum: 0.0,
    }
}

/// The sum of each run, layout by layout.
fn sums(confirmation: Confirmation<Statistic<'_>>) -> Vec<Vec<f64>> {
    let mut sums = vec![Vec::new(); confirmation.layouts.len()];
    confirmation.runs.iter().for_each(|run| sums[run.id.layout].push(run.sink.sum));
    sums
}

/// Runs of all seeds: sums of each layout.
type Runs<'a> =
    dyn Fn(&Claim<'_>, &ConfirmSettings, &[Prediction]) -> Result<Vec<Vec<f64>>, EvaluationError> + 'a;

fn detected(
    claim: &Claim<'_>,
    settings: &ConfirmSettings,
    detection: &DetectionSettings,
    cylinder: &InstrumentedCylinder,
    runs: &Runs<'_>,
) -> Result<Vec<Detected>, EvaluationError> {
    let samples = detection.samples(claim.conditions.interval_s);
    let problem = cylinder.problem(Quantity::LeakRate)?;
    let predict = |layout: &Vec<usize>| {
        let response = cylinder.response(&problem, layout, &[Disturbance::Leak])?;
        let smallest_kg_s = detection.smallest(response.information(samples)[(0, 0)]);
        Ok(Prediction { weights: response.weights(0, samples), smallest_kg_s })
    };
    let predictions: Vec<Prediction> =
        claim.layouts.iter().map(predict).collect::<Result<_, EvaluationError>>()?;
    let Some(first) = predictions.first() else { return Ok(Vec::new()) };
    let leak = SteadyLeak { rate_kg_s: first.smallest_kg_s, onset_s: settings.burn_in_s };
    let long =
        ConfirmSettings { duration_s: settings.burn_in_s + detection.within_s, leak: None, ..*settings };
    let tight = runs(claim, &long, &predictions)?;
    let leaking = runs(claim, &ConfirmSettings { leak: Some(leak), ..long }, &predictions)?;
    let normal = Normal::standard();
    let of_layout = |(index, prediction): (usize, &Prediction)| {
        // A search that is stopped leaves the seeds that both have.
        let seeds = tight[index].len().min(leaking[index].len());
        let (tight, leaking) = (&tight[index][..seeds], &leaking[index][..seeds]);
        let count = seeds as f64;
        let mean = tight.iter().sum::<f64>() / count;
        let sd = (tight.iter().map(|sum| (sum - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
        let predicted = detection.needed_sd() * leak.rate_kg_s / prediction.smallest_kg_s;
        let moved = leaking.iter().zip(tight).map(|(with, without)| with - without).sum::<f64>() / count;
        let beyond =
            |sums: &[f64]| sums.iter().filter(|sum| **sum > detection.threshold_sd).count() as f64 / count;
        let answer = moved / predicted;
        Detected {
            layout: claim.layouts[index].clone(),
            predicted_kg_s: prediction.smallest_kg_s,
            achieved_kg_s: prediction.smallest_kg_s * sd / answer,
            sd,
            mean,
            answer,
            leak_kg_s: leak.rate_kg_s,
            found: beyond(leaking),
            found_predicted: normal.cdf(predicted - detection.threshold_sd),
            false_alarms: beyond(tight),
            seeds: seeds as u64,
        }
    };
    Ok(predictions.iter().enumerate().map(of_layout).collect())
}
