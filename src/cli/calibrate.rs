//! `cylwatch calibrate`: physical parameters of a vessel from logs, as a new vessel file.
use super::fill::GivenFill;
use super::input::{Inputs, shown};
use super::message::Messages;
use super::options::LogArguments;
use super::output::Target;
use super::progress::Progress;
use super::selection;
use super::views::Views;
use crate::estimator::calibrate::{
    CalibrateError, Calibration, CalibrationSettings, Experiment, HoldOut, ParameterKind, SearchStep,
};
use crate::estimator::sensor::SensorsSpec;
use crate::report::Input;
use crate::report::calibrate as report;
use crate::report::calibrate::Study;
use crate::report::simulation;
use crate::thermal::model::with_real_gas_coefficients;
use crate::thermal::vessel::{Vessel, VesselSpec};
use anyhow::{Context, anyhow, bail};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

mod air;
mod arguments;
mod conditions;
mod date;
mod options;
mod parameters;
mod quantities;
mod recording;
mod vessel_file;

pub(super) use arguments::CalibrateArguments;
use arguments::CalibrationFormat;
use conditions::{Conditions, Exposure};
use parameters::{ParameterArguments, ParameterChoice, Subject};
use quantities::Quantities;
use recording::{AMBIENT, Reading, Recording};

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

/// Validated options.
struct Options {
    vessel: String,
    /// Logs that are fitted, then the one that is held out.
    logs: Vec<String>,
    /// Scenario of each log; none: its own air.
    scenarios: BTreeMap<String, String>,
    /// Vessels of logs that are not of the main one.
    vessels: BTreeMap<String, String>,
    reading: LogArguments,
    sensors: Option<PathBuf>,
    parameters: ParameterChoice,
    validation: Option<Validation>,
    settings: CalibrationSettings,
    quantities: Quantities,
    fill: GivenFill,
    date: String,
    vessel_file: Option<Target>,
    sensors_file: Option<Target>,
    format: CalibrationFormat,
    views: Views,
}

/// What is held out.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Validation {
    /// The last part of the only log, between 0 and 1.
    Fraction(f64),
    /// The last log of the list.
    LastLog,
}

/// The vessel that is calibrated.
struct Start {
    specification: VesselSpec,
    vessel: Vessel,
    origin: Input,
}

/// Logs with vessels and circumstances, in the order of the options.
struct Cases {
    cases: Vec<Case>,
    /// Sensors as a file says them.
    sensors: Option<SensorsSpec>,
}

/// A log with its vessel and circumstances.
struct Case {
    vessel: Option<Vessel>,
    recording: Recording,
    conditions: Conditions,
}

/// Calibrates and writes.
pub(super) fn run(arguments: CalibrateArguments, messages: &Messages) -> anyhow::Result<()> {
    let options = Options::checked(arguments)?;
    let inputs = Inputs::default();
    let (specification, vessel, origin) = inputs.vessel_specification(&options.vessel, messages)?;
    let start = Start { specification, vessel, origin };
    let Cases { cases, sensors } = options.cases(&start.vessel, &inputs, messages)?;
    let study = options.study(&start, cases, messages)?;
    for caution in report::cautions(&study) {
        messages.caution(&caution);
    }
    options.write(&start, &study, sensors, &inputs, messages)
}

impl Options {
    /// Reads all logs with their vessels and scenarios.
    fn cases(&self, main: &Vessel, inputs: &Inputs, messages: &Messages) -> anyhow::Result<Cases> {
        let read = self.sensors.as_deref().map(|path| selection::read_specification(inputs, path));
        let (specification, sensors) = read.transpose()?.unzip();
        let reading = Reading { inputs, reading: &self.reading, sensors: sensors.as_deref(), messages };
        let exposure =
            Exposure { quantities: &self.quantities, fill: &self.fill, source: self.fill.source()? };
        let case = |log: &String| -> anyhow::Result<Case> {
            let vessel = self.vessels.get(log).map(|name| inputs.vessel(name, messages)).transpose()?;
            let of_log = vessel.as_ref().unwrap_or(main);
            let recording = reading.read(log, of_log)?;
            let (recording, conditions) = match self.scenarios.get(log) {
                Some(scenario) => {
                    let scenario = inputs.scenario(scenario)?;
                    let (scenario, converted) = with_real_gas_coefficients(of_log, &scenario)?;
                    converted.iter().for_each(|one| messages.say(&simulation::conversion(one)));
                    let conditions = exposure.of_scenario(&recording, scenario, of_log)?;
                    (recording, conditions)
                }
                None => {
                    let recording = recording.beginning_at_zero();
                    let conditions = exposure.of_log(&recording, of_log)?;
                    (recording, conditions)
                }
            };
            messages.say(&conditions.words);
            conditions.doubts.iter().for_each(|doubt| messages.caution(doubt));
            Ok(Case { vessel, recording, conditions })
        };
        let cases = self.logs.iter().map(case).collect::<anyhow::Result<_>>()?;
        Ok(Cases { cases, sensors: specification })
    }

    /// Fits, scores the held-out data, and computes profiles.
    fn study(&self, start: &Start, cases: Vec<Case>, messages: &Messages) -> anyhow::Result<Study> {
        let subjects: Vec<Subject<'_>> = cases
            .iter()
            .map(|case| Subject {
                vessel: case.vessel.as_ref().unwrap_or(&start.vessel),
                recording: &case.recording,
                conditions: &case.conditions,
                is_main: case.vessel.is_none(),
            })
            .collect();
        let parameters = self.parameters.parameters(&subjects)?;
        let profiles = self.parameters.profiles(&parameters)?;
        let held_out = self.hold_out(&cases);
        let conditions = cases.iter().map(|case| case.conditions.words.clone()).collect();
        let calibration = Calibration {
            vessel: start.vessel.clone(),
            experiments: cases.into_iter().map(Case::experiment).collect(),
            parameters,
            settings: self.settings,
        };
        let progress = Progress::open_ended(messages, "calibrating");
        let began = Instant::now();
        let mut watch = |step: SearchStep| {
            let SearchStep { number, distance_sd } = step;
            if number == 1 && began.elapsed() > SLOW {
                progress.suspended(|| messages.say(&pace(began.elapsed())));
            }
            progress.say(&format!("step {number}: {distance_sd:.2} standard deviations from the minimum"));
        };
        let (calibrated, scores) = match &held_out {
            None => (calibration.run_watched(&mut watch).map_err(explained)?, Vec::new()),
            Some((hold_out, _)) => {
                let validation = calibration.validate_watched(hold_out, &mut watch).map_err(explained)?;
                (validation.calibrated, validation.scores)
            }
        };
        progress.say("profiles");
        let profiles =
            profiles.into_iter().map(|place| calibrated.profile(place)).collect::<Result<_, _>>()?;
        progress.say("a finer wall");
        let mesh_shift_sd = calibrated.mesh_shift_sd().unwrap_or_default();
        let apparent_leaks = calibrated.apparent_leaks();
        drop(progress);
        let held_out = held_out.map(|(_, words)| words);
        Ok(Study {
            calibration,
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

    fn write(
        &self,
        start: &Start,
        study: &Study,
        sensors: Option<SensorsSpec>,
        inputs: &Inputs,
        messages: &Messages,
    ) -> anyhow::Result<()> {
        let provenance = inputs.provenance();
        let summary = report::summary(study);
        let words = summary.to_text();
        // Everything is made before any file appears.
        let logs = self.logs.iter().map(|log| (shown(log), inputs.record_of(log)));
        let logs: Vec<(String, Input)> = logs.filter_map(|(name, input)| Some((name, input?))).collect();
        let record = vessel_file::record(study, &start.origin, &logs, &self.date);
        let vessel = vessel_file::text(study, &start.specification, record, &provenance)?;
        let picture = || report::figure(study);
        let with = |picture| summary.cautions(report::cautions(study)).picture(picture, report::CAPTION);
        let views = self.views.make(picture, with, inputs.sources(), &provenance)?;
        let of_sensors = self.sensors_file.as_ref().map(|target| {
            let sensors = sensors.unwrap_or_else(|| typical_sensors(study));
            anyhow::Ok((target, vessel_file::sensors(study, &sensors, &provenance)?))
        });
        let of_vessel = self.vessel_file.as_ref().map(|target| (target, vessel));
        for (target, text) in of_vessel.into_iter().chain(of_sensors.transpose()?) {
            target.write(text.as_bytes())?;
        }
        views.write()?;
        match (self.format, &self.vessel_file) {
            (CalibrationFormat::Json, _) => {
                let document = report::document(study, &self.date, &provenance);
                Target::Stdout.write((serde_json::to_string_pretty(&document)? + "\n").as_bytes())?;
                messages.say(&words);
            }
            (CalibrationFormat::Text, Some(Target::Stdout)) => messages.say(&words),
            (CalibrationFormat::Text, _) => Target::Stdout.write(words.as_bytes())?,
        }
        for target in [&self.vessel_file, &self.sensors_file] {
            if let Some(Target::File(path)) = target {
                messages.say(&format!("wrote {}", path.display()));
            }
        }
        if self.vessel_file.is_none() {
            messages.say("no vessel file is written: -o NEW.toml writes one");
        }
        Ok(())
    }
}

/// Typical sensors on the fitted channels, and on the air where the log has it.
fn typical_sensors(study: &Study) -> SensorsSpec {
    let experiment = &study.calibration.experiments[study.main_experiment()];
    let is_of_air = |line: &report::Line<'_>| line.spec.kind == ParameterKind::AirOffset;
    let has_air = study.lines().iter().any(is_of_air);
    let of_log = experiment.channels.iter().map(|sensor| sensor.name.as_str());
    SensorsSpec::typical(&of_log.chain(has_air.then_some(AMBIENT)).collect::<Vec<_>>())
}

impl Case {
    fn experiment(self) -> Experiment {
        Experiment {
            source: self.recording.name,
            vessel: self.vessel,
            scenario: self.conditions.scenario,
            log: self.recording.log,
            channels: self.recording.sensors,
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
