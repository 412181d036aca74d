//! A calibration in tables for people.
use super::{Line, Study};
use crate::estimator::calibrate::{ChannelResiduals, ChannelScore};
use crate::report::{Report, number};
use crate::thermal::units::BAR_PA;

/// Digits of values that people compare.
const DIGITS: usize = 4;

/// The study in words and tables.
pub(crate) fn summary(study: &Study) -> Report {
    let calibrated = &study.calibrated;
    let percent = format!("{} % low", 100.0 * study.calibration.settings.confidence);
    let high = percent.replace("low", "high");
    let header = ["parameter", "start", "estimate", &percent, &high, "unit", "from the logs"];
    let rows: Vec<Vec<String>> = study.lines().iter().map(|line| parameter(study, line)).collect();
    let report = Report::new(format!(
        "{}: {} parameters from {} readings of {}, {} steps",
        study.calibration.vessel.name,
        study.lines().len(),
        calibrated.channels.iter().map(|channel| channel.residuals.len()).sum::<usize>(),
        study.fitted_sources().join(", "),
        calibrated.iterations
    ));
    let header_of_residuals =
        ["log", "channel", "readings", "rms", "unit", "rms / noise", "correlation", "white with", "widened"];
    let of_channels = calibrated.channels.iter().map(|channel| residuals(study, channel)).collect();
    let report = report.rows("", &header, rows);
    held_out(study, profiles(study, report).rows("", &header_of_residuals, of_channels))
}

fn parameter(study: &Study, line: &Line<'_>) -> Vec<String> {
    let (estimate, factor) = (line.estimate, line.factor);
    let (low, high) = estimate.interval;
    let mut cells = vec![study.name(line)];
    cells.extend([line.spec.start, estimate.value, low, high].map(|value| rounded(value / factor)));
    cells.push(line.unit.to_owned());
    cells.push(format!("{:.0} %", 100.0 * line.learnt()));
    cells
}

/// Four decimals of what is about one, as many digits of what is large.
fn rounded(value: f64) -> String {
    if value.abs() < 10.0 { format!("{:.4}", value + 0.0) } else { number(value, DIGITS + 1) }
}

fn profiles(study: &Study, report: Report) -> Report {
    let lines = study.lines();
    let row = |profile: &crate::estimator::calibrate::Profile| {
        let line = lines.iter().find(|line| line.place == profile.parameter)?;
        let end = |value: f64, closed: bool| {
            let value = rounded(value / line.factor);
            if closed { value } else { format!("{value} (bound)") }
        };
        let mut cells = vec![study.name(line)];
        cells.push(end(profile.interval.0, profile.closed.0));
        cells.push(end(profile.interval.1, profile.closed.1));
        cells.push(line.unit.to_owned());
        Some(cells)
    };
    let rows: Vec<Vec<String>> = study.profiles.iter().filter_map(row).collect();
    report.rows("", &["profile likelihood of", "low", "high", "unit"], rows)
}

fn residuals(study: &Study, channel: &ChannelResiduals) -> Vec<String> {
    let (unit, factor) = unit(study, &channel.experiment, &channel.channel);
    let largest = channel.autocorrelation.iter().copied();
    let largest = largest.fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    let mut cells = vec![channel.experiment.clone(), channel.channel.clone()];
    cells.push(channel.residuals.len().to_string());
    cells.push(number(channel.rms / factor, 3));
    cells.push(unit.to_owned());
    cells.push(format!("{:.2}", channel.rms_over_noise));
    cells.push(format!("{largest:+.2}"));
    cells.push(channel.whiteness_p_value.map_or_else(String::new, probability));
    cells.push(format!("{:.1}", channel.variance_factor.sqrt()));
    cells
}

/// A probability, as far as it matters.
fn probability(value: f64) -> String {
    if value < 0.001 { "0.000".to_owned() } else { format!("{value:.3}") }
}

fn held_out(study: &Study, report: Report) -> Report {
    let Some(what) = &study.held_out else { return report };
    let row = |score: &ChannelScore| {
        let (unit, factor) = unit(study, &score.experiment, &score.channel);
        let mut cells = vec![score.channel.clone()];
        cells.extend([score.rms_before, score.rms_after, score.noise_sd].map(|rms| number(rms / factor, 3)));
        cells.push(unit.to_owned());
        cells.push(format!("{:.1}", score.rms_before / score.rms_after));
        cells
    };
    let rows: Vec<Vec<String>> = study.scores.iter().map(row).collect();
    let header = ["held out", "rms before", "rms after", "noise", "unit", "better by"];
    report.explained_rows("", &header, rows, format!("held out: {what}"))
}

/// Unit of a channel's differences for people, and what it is in SI.
pub(super) fn unit(study: &Study, experiment: &str, channel: &str) -> (&'static str, f64) {
    if study.is_pressure(experiment, channel) { ("bar", BAR_PA) } else { ("K", 1.0) }
}
