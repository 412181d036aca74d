//! The calibrated vessel, and its sensors, as files.
use crate::estimator::sensor::SensorsSpec;
use crate::report::calibrate::Study;
use crate::report::{Input, Provenance, number, rounded};
use crate::thermal::vessel::VesselSpec;
use crate::thermal::vessel::spec::{CalibrationSpec, FittedSpec, OriginSpec, PriorSpec};

/// Significant digits of fitted values.
const DIGITS: usize = 6;
/// Those of a number that was converted to SI.
const CONVERTED_DIGITS: usize = 12;

/// Where the fitted values come from.
pub(super) fn record(study: &Study, vessel: &Input, logs: &[(String, Input)], date: &str) -> CalibrationSpec {
    let origin =
        |name: &str, input: &Input| OriginSpec { name: name.to_owned(), sha256: input.sha256.clone() };
    let fitted: Vec<&str> = study.fitted_sources();
    let took_part = |(name, _): &&(String, Input)| fitted.contains(&name.as_str());
    CalibrationSpec {
        date: date.to_owned(),
        program: format!("cylwatch {}", Provenance::VERSION),
        settings: study.settings_text(),
        confidence: study.calibration.settings.confidence,
        vessel: origin(&vessel.name, vessel),
        log: logs.iter().filter(took_part).map(|(name, input)| origin(name, input)).collect(),
        fitted: study.fitted_lines().into_iter().map(tidy).collect(),
    }
}

/// The file.
pub(super) fn text(
    study: &Study,
    specification: &VesselSpec,
    record: CalibrationSpec,
    provenance: &Provenance,
) -> anyhow::Result<String> {
    let place = study.main_experiment();
    let mut specification = study.calibrated.applied_to_specification(place, specification)?;
    specification.calibration = Some(record);
    Ok(file(&specification.to_toml()?, CONVERTED_DIGITS, provenance))
}

/// The file of the fitted sensors.
pub(super) fn sensors(
    study: &Study,
    sensors: &SensorsSpec,
    provenance: &Provenance,
) -> anyhow::Result<String> {
    let sensors = study.calibrated.applied_to_sensors(study.main_experiment(), sensors);
    sensors.build()?;
    Ok(file(&sensors.to_toml()?, DIGITS, provenance))
}

/// A document with its provenance, numbers without more digits than they have.
fn file(document: &str, digits: usize, provenance: &Provenance) -> String {
    let tidy = |line: &str| {
        let parsed = line.split_once(" = ").and_then(|(key, text)| Some((key, text.parse::<f64>().ok()?)));
        match parsed {
            Some((key, value)) if line.contains('.') => format!("{key} = {}\n", number(value, digits)),
            _ => format!("{line}\n"),
        }
    };
    provenance.comment_lines() + "\n" + &document.lines().map(tidy).collect::<String>()
}

fn tidy(line: FittedSpec) -> FittedSpec {
    let [value, sd, low, high] = [line.value, line.sd, line.low, line.high].map(|x| rounded(x, DIGITS));
    let prior = line
        .prior
        .map(|prior| PriorSpec { mean: rounded(prior.mean, DIGITS), sd: rounded(prior.sd, DIGITS) });
    FittedSpec { value, sd, low, high, prior, ..line }
}
