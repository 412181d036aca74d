//! A calibration as JSON.
use super::Study;
use crate::estimator::calibrate::{
    ApparentLeak, ChannelResiduals, ChannelScore, Combination, ParameterKind, Profile,
};
use crate::report::{Provenance, rounded};
use serde_json::{Value, json};

/// Significant digits of readings and residuals.
const DIGITS: usize = 8;

/// Everything as JSON, SI units.
pub(crate) fn document(study: &Study, date: &str, provenance: &Provenance) -> Value {
    let calibrated = &study.calibrated;
    let settings = &study.calibration.settings;
    json!({
        "provenance": provenance.to_json(),
        "date": date,
        "vessel": study.calibration.vessel.name,
        "logs": study.fitted_sources(),
        "circumstances": study.conditions,
        "settings": {
            "confidence": settings.confidence,
            "iterations": settings.iterations,
            "relative_tolerance": settings.simulation.relative_tolerance,
        },
        "parameters": parameters(study),
        "covariance": covariance(study),
        "inseparable": calibrated.identifiability.inseparable.iter().map(combination).collect::<Vec<_>>(),
        "worst_deviation": calibrated.identifiability.worst_deviation,
        "sum_of_squares": calibrated.sum_of_squares,
        "degrees_of_freedom": calibrated.degrees_of_freedom,
        "steps": calibrated.iterations,
        "channels": calibrated.channels.iter().map(|one| channel(study, one)).collect::<Vec<_>>(),
        "held_out": study.held_out.as_ref().map(|what| {
            json!({ "what": what, "scores": study.scores.iter().map(|one| score(study, one)).collect::<Vec<_>>() })
        }),
        "profiles": study.profiles.iter().map(|one| profile(study, one)).collect::<Vec<_>>(),
        "apparent_leaks": study.apparent_leaks.iter().map(leak).collect::<Vec<_>>(),
        "cautions": super::cautions(study),
    })
}

fn leak(found: &ApparentLeak) -> Value {
    json!({ "log": found.experiment, "rate_kg_s": found.rate_kg_s, "sd_kg_s": found.sd_kg_s })
}

fn parameters(study: &Study) -> Vec<Value> {
    let lines = study.lines();
    let fitted = study.fitted_lines();
    let one = |(line, fitted): (&super::Line<'_>, _)| {
        let mut value = json!(fitted);
        value["start"] = json!(line.spec.start);
        value["bounds"] = json!(line.spec.bounds());
        value["prior_share"] = json!(line.estimate.prior_share);
        value["mesh_shift_sd"] = json!(study.mesh_shift_sd.get(line.place));
        value
    };
    lines.iter().zip(fitted).map(one).collect()
}

fn covariance(study: &Study) -> Vec<Vec<f64>> {
    let places: Vec<usize> = study.lines().iter().map(|line| line.place).collect();
    let entry = |i: usize, j: usize| study.calibrated.covariance[(i, j)];
    places.iter().map(|&i| places.iter().map(|&j| entry(i, j)).collect()).collect()
}

fn combination(combination: &Combination) -> Value {
    let parts = combination.parts.iter().zip(&combination.names);
    let parts: Vec<Value> =
        parts.map(|((_, share), kind)| json!({ "parameter": kind.name(), "share": share })).collect();
    json!({ "parts": parts, "deviation": combination.deviation })
}

fn unit(study: &Study, experiment: &str, channel: &str) -> &'static str {
    if study.is_pressure(experiment, channel) { "Pa" } else { "K" }
}

fn channel(study: &Study, channel: &ChannelResiduals) -> Value {
    let tidy = |values: &[f64]| values.iter().map(|&value| rounded(value, DIGITS)).collect::<Vec<_>>();
    json!({
        "log": channel.experiment,
        "channel": channel.channel,
        "unit": unit(study, &channel.experiment, &channel.channel),
        "rms": channel.rms,
        "rms_over_noise": channel.rms_over_noise,
        "autocorrelation": channel.autocorrelation,
        "whiteness": channel.whiteness_p_value,
        "variance_factor": channel.variance_factor,
        "time_s": channel.time_s,
        "readings": tidy(&study.readings(channel)),
        "residuals": tidy(&channel.residuals),
    })
}

fn score(study: &Study, score: &ChannelScore) -> Value {
    json!({
        "log": score.experiment,
        "channel": score.channel,
        "unit": unit(study, &score.experiment, &score.channel),
        "rms_before": score.rms_before,
        "rms_after": score.rms_after,
        "noise": score.noise_sd,
    })
}

fn profile(study: &Study, profile: &Profile) -> Value {
    let kind: Option<&ParameterKind> =
        study.calibration.parameters.get(profile.parameter).map(|spec| &spec.kind);
    json!({
        "parameter": kind.map(ParameterKind::name),
        "low": profile.interval.0,
        "high": profile.interval.1,
        "closed": profile.closed,
        "points": profile.points,
    })
}
