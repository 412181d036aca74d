//! `cylwatch identify`: a transfer function from one column of a log to another.
use super::beside::until_stopped;
use super::format::Format;
use super::host::Outcome;
use super::input::{Inputs, shown};
use super::message::Messages;
use super::options::LogArguments;
use super::output::{Target, remarks};
use super::progress::Progress;
use super::result::{Contents, Destination};
use super::views::Views;
use crate::estimator::identify::{Data, Method, Settings, Structure, identify_until};
use crate::report::identify as report;
use crate::report::identify::{Signal, Study};
use anyhow::{Context, bail};
use serde_json::{Value, json};
use std::path::Path;

mod arguments;
mod choice;
mod quantities;
mod record;

pub(super) use arguments::IdentifyArguments;
use choice::{Choice, Validation};
use quantities::Quantities;
use record::Record;

/// Validated options.
struct Options {
    log: String,
    columns: Vec<String>,
    choice: Choice,
    quantities: Quantities,
    structure: Structure,
    settings: Settings,
    validation: Option<Validation>,
    reading: LogArguments,
    data: Target,
    format: Option<Format>,
    views: Views,
}

/// Identifies and writes.
pub(super) fn run(arguments: IdentifyArguments, messages: &Messages) -> anyhow::Result<()> {
    let options = Options::checked(arguments)?;
    let inputs = Inputs::default();
    let (study, request) = options.finished(&inputs, messages)?;
    with_contents(&study, &request, |contents| {
        let destination = Destination { data: &options.data, format: options.format, views: &options.views };
        destination.write(contents, &inputs, &inputs.provenance(), messages)
    })
}

/// The same for a caller: nothing is written.
pub(super) fn kept(
    arguments: IdentifyArguments,
    inputs: &Inputs,
    messages: &Messages,
) -> anyhow::Result<Outcome> {
    let options = Options::checked(arguments)?;
    let (study, request) = options.finished(inputs, messages)?;
    with_contents(&study, &request, |contents| {
        contents.kept(report::table(&study), inputs, inputs.provenance())
    })
}

/// What a study consists of, for whoever takes it.
fn with_contents<T>(study: &Study, request: &Value, take: impl FnOnce(Contents<'_>) -> T) -> T {
    let summary = report::summary(study);
    let remarks = remarks(&summary.to_text());
    take(Contents {
        summary,
        csv: &|provenance| report::table(study).to_csv(provenance, &remarks),
        json: &|provenance| report::document(study, request, provenance),
        picture: &|| report::figure(study),
        report: &|picture, summary| {
            summary.cautions(report::cautions(study)).picture(picture, report::CAPTION)
        },
    })
}

impl Options {
    /// Reads, identifies, and says what to know. Also returns the request.
    fn finished(&self, inputs: &Inputs, messages: &Messages) -> anyhow::Result<(Study, Value)> {
        let record = self.read(&self.log, inputs, messages)?;
        let (study, request) = self.study(record, inputs, messages)?;
        for caution in report::cautions(&study) {
            messages.caution(&caution);
        }
        Ok((study, request))
    }

    fn checked(arguments: IdentifyArguments) -> anyhow::Result<Self> {
        let choice = Choice::checked(&arguments)?;
        let validation = arguments.validate.as_deref().map(Validation::checked).transpose()?;
        let mut inputs = vec![Path::new(&arguments.log)];
        if let Some(Validation::Log(log)) = &validation {
            if log == "-" && arguments.log == "-" {
                bail!("stdin can be one of the logs, not both: give the other one as a file");
            }
            inputs.push(Path::new(log));
        }
        let data = Target::checked(arguments.out.as_deref(), &inputs)?;
        let views = Views::checked(&arguments.views, &inputs, &[&data])?;
        let for_people = arguments.format.is_none() && matches!(data, Target::Stdout);
        let structure = arguments.structure(&arguments.quantities)?;
        Ok(Self {
            columns: [&arguments.input, &arguments.output]
                .into_iter()
                .chain(&arguments.second)
                .map(|name| record::base_name(name))
                .collect(),
            structure,
            settings: arguments.settings(&arguments.quantities)?,
            format: (!for_people)
                .then(|| arguments.format.unwrap_or_else(|| Format::of(arguments.out.as_deref()))),
            log: arguments.log,
            quantities: arguments.quantities,
            reading: arguments.reading,
            choice,
            validation,
            data,
            views,
        })
    }

    /// Reads the columns of a log.
    fn read(&self, name: &str, inputs: &Inputs, messages: &Messages) -> anyhow::Result<Record> {
        let mut log = inputs.log(name, &self.reading.options(self.columns.clone()))?;
        let progress = Progress::new(messages);
        let read = Record::read(&mut log, &self.columns, |fraction| progress.show(name, fraction));
        drop(progress);
        // What was strange about the log may explain an error.
        for caution in log.reader.cautions() {
            messages.caution(&caution.to_string());
        }
        inputs.record_log(&log);
        read
    }

    /// Identifies, and compares with the published model and on what was held out. Also returns the request.
    fn study(&self, record: Record, inputs: &Inputs, messages: &Messages) -> anyhow::Result<(Study, Value)> {
        let name = shown(&self.log);
        let (record, held_out) = match &self.validation {
            None => (record, None),
            Some(Validation::Fraction(fraction)) => {
                let (before, after) = record.split(*fraction)?;
                (before, Some((format!("last {} % of {name}", 100.0 * fraction), after)))
            }
            Some(Validation::Log(log)) => (record, Some((shown(log), self.read(log, inputs, messages)?))),
        };
        let held_out = held_out.map(|(name, other)| Ok::<_, anyhow::Error>((name, self.data(&other)?)));
        let held_out = held_out.transpose()?;
        let method = self.choice.method(&record, &self.quantities)?;
        let data = self.data(&record)?;
        let signals = self.signals(&record);
        let between = format!("from {} to {}", signals.0.name, signals.1.name);
        let progress = Progress::open_ended(messages, "identifying");
        let identified = until_stopped(inputs, |stop| {
            let found = identify_until(&data, &self.structure, &method, &self.settings, stop);
            found.with_context(|| format!("{name}, {between}"))
        });
        drop(progress);
        let identified = identified?;
        let request = self.request(&method);
        let words = self.choice.description(&self.structure);
        let study = Study::new(signals, words, identified, (name, data), held_out, self.settings.lags)
            .context("held-out data")?;
        Ok((study, request))
    }

    fn data(&self, record: &Record) -> anyhow::Result<Data> {
        let column = |at: usize| record.columns[at].values.clone();
        Ok(Data::try_new(record.time_s.clone(), column(0), column(1), self.choice.hold)?)
    }

    fn signals(&self, record: &Record) -> (Signal, Signal) {
        (record.columns[0].signal.clone(), record.columns[1].signal.clone())
    }

    /// The request as JSON; a second sensor is named, its values are left out.
    fn request(&self, method: &Method) -> Value {
        let method = match method {
            Method::SecondSensor { .. } => json!({ "second_sensor": { "input": self.columns.get(2) } }),
            method => json!(method),
        };
        json!({
            "structure": self.structure,
            "method": method,
            "hold": self.choice.hold,
            "settings": self.settings,
        })
    }
}
