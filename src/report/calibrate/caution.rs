//! What to know before a calibrated vessel is used, in words.
use super::Study;
use crate::estimator::calibrate::{Combination, ParameterKind};

/// Ratio of residuals and noise from which on the model is said to miss something.
const MISSES: f64 = 2.0;
/// Movement by a finer wall, in standard deviations, with which an estimate leaves its interval of 95 %.
const COARSE_SD: f64 = 1.96;
/// The same as a part of what such parameters are usually off: smaller deviations do not matter.
const COARSE_PART: f64 = 0.1;
/// Share of the prior's variance from which on the logs say nothing of a parameter.
const UNLEARNT: f64 = 0.9;

/// Cautions of a calibration as sentences.
pub(crate) fn cautions(study: &Study) -> Vec<String> {
    let found = &study.calibrated.identifiability;
    let mut cautions: Vec<String> = found.inseparable.iter().map(inseparable).collect();
    cautions.extend(misfits(study));
    cautions.extend(coarse(study));
    let of_vessel = |kind: &ParameterKind| kind.sensor().is_none() && !kind.is_of_experiment();
    for line in
        study.lines().iter().filter(|line| of_vessel(&line.spec.kind) && 1.0 - line.learnt() > UNLEARNT)
    {
        cautions.push(format!("the logs say little of {}: its value is that of the prior", study.name(line)));
    }
    for score in study.scores.iter().filter(|score| score.rms_after > score.rms_before) {
        cautions.push(format!(
            "{} of {} is predicted worse than before: the fit does not hold for the held-out data",
            score.channel, score.experiment
        ));
    }
    cautions
}

fn inseparable(combination: &Combination) -> String {
    let names: Vec<String> = combination.names.iter().map(ParameterKind::name).collect();
    match &names[..] {
        [one] => format!(
            "the logs hardly show {one}: give it a prior, hold it, or record what it acts on (a larger or faster change of \
             the air, a pressure, a sensor nearer to it)"
        ),
        _ => format!(
            "the logs do not separate {}: together they are known to {:.1} times what such parameters are usually off; \
             give one a prior, hold it, or record an experiment that tells them apart",
            names.join(" and "),
            combination.deviation
        ),
    }
}

/// What a coarse wall does to the estimates.
fn coarse(study: &Study) -> Option<String> {
    let lines = study.lines();
    let shift = |line: &super::Line<'_>| study.mesh_shift_sd.get(line.place).copied().unwrap_or(0.0);
    let is_felt = |line: &&super::Line<'_>| {
        let (kind, found) = (&line.spec.kind, line.estimate);
        let usual = kind.usual_width(study.calibrated.is_of_pressure(found));
        // A contact contains half of the cell that it is on: it belongs to its mesh by nature.
        *kind != ParameterKind::ValveContact
            && shift(line).abs() * found.coordinate_sd() > COARSE_PART * usual
    };
    let moved: Vec<String> = lines
        .iter()
        .filter(|line| shift(line).abs() > COARSE_SD && is_felt(line))
        .map(|line| format!("{} by {:+.1}", study.name(line), shift(line)))
        .collect();
    (!moved.is_empty()).then(|| {
        format!(
            "the wall has few cells: with twice as many along it and through it these would leave their intervals, in standard \
             deviations: {}; give the vessel more cells",
            moved.join(", ")
        )
    })
}

fn misfits(study: &Study) -> impl Iterator<Item = String> + '_ {
    let missed = |channel: &&crate::estimator::calibrate::ChannelResiduals| channel.rms_over_noise > MISSES;
    study.calibrated.channels.iter().filter(missed).map(|channel| {
        format!(
            "{} of {} misses the model by {:.1} times its noise: something is not in the model; the intervals are \
             widened by up to {:.1}",
            channel.channel,
            channel.experiment,
            channel.rms_over_noise,
            channel.variance_factor.sqrt()
        )
    })
}
