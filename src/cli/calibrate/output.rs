//! What a calibration writes, or hands to a caller.
use super::arguments::CalibrationFormat;
use super::recording::AMBIENT;
use super::{Finished, Options, vessel_file};
use crate::cli::host::Outcome;
use crate::cli::input::{Inputs, shown};
use crate::cli::message::Messages;
use crate::cli::output::{Target, remarks};
use crate::cli::views::Views;
use crate::estimator::calibrate::ParameterKind;
use crate::estimator::sensor::SensorsSpec;
use crate::report::calibrate as report;
use crate::report::calibrate::Study;
use crate::report::figure::Picture;
use crate::report::{Input, Provenance, Report};
use serde_json::Value;

impl Options {
    pub(super) fn write(
        &self,
        finished: &Finished,
        inputs: &Inputs,
        messages: &Messages,
    ) -> anyhow::Result<()> {
        let provenance = inputs.provenance();
        let study = &finished.study;
        // Everything is made before any file appears.
        let vessel = self.vessel_text(finished, inputs, &provenance)?;
        let views = self.views.make(
            || report::figure(study),
            |picture| full_report(study, picture),
            inputs.sources(),
            &provenance,
        )?;
        let of_sensors = self.sensors_file.as_ref();
        let of_sensors = of_sensors.map(|target| anyhow::Ok((target, sensors_text(finished, &provenance)?)));
        let of_vessel = self.vessel_file.as_ref().map(|target| (target, vessel));
        for (target, text) in of_vessel.into_iter().chain(of_sensors.transpose()?) {
            target.write(text.as_bytes())?;
        }
        views.write()?;
        self.write_summary(study, &provenance, messages)?;
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

    fn write_summary(
        &self,
        study: &Study,
        provenance: &Provenance,
        messages: &Messages,
    ) -> anyhow::Result<()> {
        let words = report::summary(study).to_text();
        let data = match (self.format, &self.vessel_file) {
            (CalibrationFormat::Json, _) => {
                serde_json::to_string_pretty(&self.document(study, provenance))? + "\n"
            }
            (CalibrationFormat::Csv, _) => report::table(study).to_csv(provenance, &remarks(&words)),
            (CalibrationFormat::Text, Some(Target::Stdout)) => {
                messages.say(&words);
                return Ok(());
            }
            (CalibrationFormat::Text, _) => return Target::Stdout.write(words.as_bytes()),
        };
        Target::Stdout.write(data.as_bytes())?;
        messages.say(&words);
        Ok(())
    }

    /// The same for a caller.
    pub(super) fn outcome(
        &self,
        finished: &Finished,
        inputs: &Inputs,
        messages: &Messages,
    ) -> anyhow::Result<Outcome> {
        let provenance = inputs.provenance();
        let study = &finished.study;
        let views = Views::kept();
        let made = views.make(
            || report::figure(study),
            |picture| full_report(study, picture),
            inputs.sources(),
            &provenance,
        )?;
        let sensors = sensors_text(finished, &provenance).unwrap_or_else(|error| {
            messages.caution(&format!("the fitted sensors cannot be written: {error:#}"));
            String::new()
        });
        Ok(Outcome {
            vessel: self.vessel_text(finished, inputs, &provenance)?,
            sensors,
            ..Outcome::of(
                report::table(study),
                self.document(study, &provenance),
                made.kept.unwrap_or_default(),
                provenance,
            )
        })
    }

    fn document(&self, study: &Study, provenance: &Provenance) -> Value {
        report::document(study, &self.date, provenance)
    }

    /// The calibrated vessel as a file.
    fn vessel_text(
        &self,
        finished: &Finished,
        inputs: &Inputs,
        provenance: &Provenance,
    ) -> anyhow::Result<String> {
        let Finished { start, study, .. } = finished;
        let logs = self.logs.iter().map(|log| (shown(log), inputs.record_of(log)));
        let logs: Vec<(String, Input)> = logs.filter_map(|(name, input)| Some((name, input?))).collect();
        let record = vessel_file::record(study, &start.origin, &logs, &self.date);
        vessel_file::text(study, &start.specification, record, provenance)
    }
}

fn full_report(study: &Study, picture: Picture) -> Report {
    report::summary(study).cautions(report::cautions(study)).picture(picture, report::CAPTION)
}

/// The fitted sensors as a file.
fn sensors_text(finished: &Finished, provenance: &Provenance) -> anyhow::Result<String> {
    let Finished { study, sensors, .. } = finished;
    let sensors = sensors.clone().unwrap_or_else(|| typical_sensors(study));
    vessel_file::sensors(study, &sensors, provenance)
}

/// Typical sensors on the fitted channels, and on the air where the log has it.
fn typical_sensors(study: &Study) -> SensorsSpec {
    let experiment = &study.calibration.experiments[study.main_experiment()];
    let is_of_air = |line: &report::Line<'_>| line.spec.kind == ParameterKind::AirOffset;
    let has_air = study.lines().iter().any(is_of_air);
    let of_log = experiment.channels.iter().map(|sensor| sensor.name.as_str());
    SensorsSpec::typical(&of_log.chain(has_air.then_some(AMBIENT)).collect::<Vec<_>>())
}
