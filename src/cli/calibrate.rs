//! `cylwatch calibrate`: physical parameters of a vessel from logs, as a new vessel file.
use super::fill::GivenFill;
use super::host::Outcome;
use super::input::Inputs;
use super::message::Messages;
use super::options::LogArguments;
use super::output::Target;
use super::selection;
use super::views::Views;
use crate::estimator::calibrate::{CalibrationSettings, Experiment};
use crate::estimator::sensor::SensorsSpec;
use crate::report::Input;
use crate::report::calibrate as report;
use crate::report::calibrate::Study;
use crate::report::simulation;
use crate::thermal::model::with_real_gas_coefficients;
use crate::thermal::vessel::{Vessel, VesselSpec};
use anyhow::{Context, bail};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

mod air;
mod arguments;
mod conditions;
mod date;
mod options;
mod output;
mod parameters;
mod quantities;
mod recording;
mod search;
mod vessel_file;

pub(super) use arguments::CalibrateArguments;
use arguments::CalibrationFormat;
use conditions::{Conditions, Exposure};
use parameters::{ParameterArguments, ParameterChoice};
use quantities::Quantities;
use recording::{Reading, Recording};

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

/// A finished calibration.
struct Finished {
    start: Start,
    study: Study,
    /// Sensors as a file says them.
    sensors: Option<SensorsSpec>,
}

/// Calibrates and writes.
pub(super) fn run(arguments: CalibrateArguments, messages: &Messages) -> anyhow::Result<()> {
    let options = Options::checked(arguments)?;
    let inputs = Inputs::default();
    let finished = options.finished(&inputs, messages)?;
    options.write(&finished, &inputs, messages)
}

/// The same for a caller: nothing is written.
pub(super) fn kept(
    arguments: CalibrateArguments,
    inputs: &Inputs,
    messages: &Messages,
) -> anyhow::Result<Outcome> {
    let options = Options::checked(arguments)?;
    let finished = options.finished(inputs, messages)?;
    options.outcome(&finished, inputs, messages)
}

impl Options {
    /// Reads, fits, and says what to know.
    fn finished(&self, inputs: &Inputs, messages: &Messages) -> anyhow::Result<Finished> {
        let (specification, vessel, origin) = inputs.vessel_specification(&self.vessel, messages)?;
        let start = Start { specification, vessel, origin };
        let Cases { cases, sensors } = self.cases(&start.vessel, inputs, messages)?;
        let study = self.study(&start, cases, inputs, messages)?;
        for caution in report::cautions(&study) {
            messages.caution(&caution);
        }
        Ok(Finished { start, study, sensors })
    }

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
