//! `cylwatch inspection`: loss of pressure adjusted for temperature against the fill, from logs or single readings.
mod arguments;
mod log;
mod round;
mod single;

pub(super) use arguments::{InspectionArguments, without_fill_of_log};

use super::fill::FillSource;
use super::format::Format;
use super::input::Inputs;
use super::message::Messages;
use super::output::Target;
use super::selection::{self, USUAL_FILL_PA};
use super::views::Views;
use crate::detector::inspection::{Criterion, Instruments, Judgement, UncertainMass};
use crate::detector::prognosis::Contents;
use crate::estimator::sensor::Sensor;
use crate::report::inspection::{self as report, Inspected, Rules};
use crate::thermal::units::{Dimension, QUOTED_K};
use crate::thermal::vessel::{Fill, Vessel};
use anyhow::{Context, bail};
use arguments::ThermometerPlace;
use single::Look;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Exit codes: a cylinder is to be refilled; of some it cannot be told.
const REFILL: u8 = 1;
const CANNOT_BE_TOLD: u8 = 3;

/// What all cylinders of a run have in common.
struct Round<'a> {
    arguments: &'a InspectionArguments,
    inputs: &'a Inputs,
    messages: &'a Messages,
    vessel: Vessel,
    contents: Contents,
    criterion: Criterion,
    sensors: Option<Vec<Sensor>>,
}

/// Inspects and writes.
pub(super) fn run(arguments: InspectionArguments, messages: &Messages) -> anyhow::Result<ExitCode> {
    let look = Look::of(&arguments)?;
    if look.is_some() != arguments.logs.is_empty() {
        bail!("give logs, or --pressure-bar and --temperature-degc of one reading");
    }
    let paths: Vec<PathBuf> = arguments.logs.iter().map(PathBuf::from).collect();
    let read: Vec<&Path> = std::iter::once(Path::new(&arguments.vessel))
        .chain(paths.iter().map(PathBuf::as_path))
        .chain(arguments.sensors.sensors.as_deref())
        .collect();
    let data = Target::checked(arguments.data.output.as_deref(), &read)?;
    let views = Views::checked(&arguments.report.clone().into(), &read, &[&data])?;
    let inputs = Inputs::default();
    let vessel = inputs.vessel(&arguments.vessel, messages)?;
    let sensors = arguments.sensors.sensors.as_deref();
    let reference_k = arguments.given.si("reference", Dimension::Temperature)?.unwrap_or(QUOTED_K);
    let criterion = Criterion {
        loss_limit: arguments.loss_limit_percent / 100.0,
        certainty: arguments.certainty_percent / 100.0,
        reference_k,
    };
    let round = Round {
        sensors: sensors.map(|path| selection::read(&inputs, path)).transpose()?,
        contents: Contents::of(&vessel),
        vessel,
        criterion,
        arguments: &arguments,
        inputs: &inputs,
        messages,
    };
    let cylinders = match look {
        Some(look) => vec![round.of_look(String::new(), &look)?],
        None => round.of_paths(&paths)?,
    };
    let rules = Rules {
        vessel: round.vessel.name.clone(),
        criterion,
        inspection_months: arguments.inspection_months,
        gauge_months: arguments.gauge_months,
        gauge_compared: arguments.gauge_compared,
    };
    let (summary, provenance) = (report::summary(&rules, &cylinders), inputs.provenance());
    let words = summary.to_text();
    let text = match arguments.data.format_or_tables(false) {
        None => words.clone(),
        Some(Format::Csv) => report::table(&rules, &cylinders).to_csv(&provenance, &[]),
        Some(Format::Json) => {
            serde_json::to_string_pretty(&report::document(&rules, &cylinders, &provenance))? + "\n"
        }
    };
    let page = views.make_report(|| summary, inputs.sources(), &provenance)?;
    data.write(text.as_bytes())?;
    page.write()?;
    if arguments.data.format_or_tables(false).is_some() {
        messages.say(&words);
    }
    Ok(ExitCode::from(exit_code(&cylinders)))
}

fn exit_code(cylinders: &[Inspected]) -> u8 {
    let has = |judgement| cylinders.iter().any(|cylinder| cylinder.judgement() == judgement);
    match (has(Judgement::Refill), has(Judgement::CannotBeTold)) {
        (true, _) => REFILL,
        (false, true) => CANNOT_BE_TOLD,
        (false, false) => 0,
    }
}

impl Round<'_> {
    /// What the cylinders were filled with, by the options or by a fill of a row's own.
    fn filled(&self, own: Option<Fill>) -> anyhow::Result<UncertainMass> {
        const REMEDY: &str = "give --fill-pressure-bar and --fill-temperature-degc, or --fill-mass-kg";
        let fill = match (own, self.arguments.fill.source()?) {
            (Some(fill), _) | (None, FillSource::Given(fill)) => fill,
            (None, FillSource::FirstPressure) => {
                bail!("a loss counts from what the cylinder was filled with: {REMEDY}")
            }
        };
        if matches!(fill, Fill::Pressure { .. }) {
            bail!("a fill has a temperature: {REMEDY}; labels state 15 degc");
        }
        let commissioning = self.arguments.fill.commissioning(fill, &self.vessel, QUOTED_K, 0.0)?;
        let mass_kg = commissioning.mass_kg(&self.vessel, QUOTED_K)?;
        Ok(UncertainMass { mass_kg, sd_kg: commissioning.mass_sd * mass_kg })
    }

    /// What a person reads: a gauge of the class that is stated and the range for the fill, and typical thermometers.
    fn instruments(&self, filled: UncertainMass) -> anyhow::Result<Instruments> {
        let full_pa = self.contents.pressure_pa(filled.mass_kg, QUOTED_K).unwrap_or(USUAL_FILL_PA);
        let class = self.arguments.gauge_class_percent / 100.0;
        let thermometer = match self.arguments.thermometer {
            ThermometerPlace::Wall => "shoulder",
            ThermometerPlace::Air => "ambient",
        };
        Ok(Instruments {
            thermometer: Sensor::typical(thermometer)?,
            air: Sensor::typical("ambient")?,
            gauge: Sensor::typical_gauge("pressure", full_pa, class)?,
        })
    }

    /// All logs, folders of logs, and files of single readings. In a folder one that cannot be read does not end the others.
    fn of_paths(&self, paths: &[PathBuf]) -> anyhow::Result<Vec<Inspected>> {
        let mut cylinders = Vec::new();
        for path in paths {
            let shown = path.display();
            if !path.is_dir() {
                cylinders.extend(self.of_file(path)?);
                continue;
            }
            let entries = std::fs::read_dir(path).with_context(|| format!("{shown} cannot be read"))?;
            let files =
                entries.map(|entry| entry.map(|entry| entry.path())).collect::<std::io::Result<Vec<_>>>();
            let mut files = files.with_context(|| format!("{shown} cannot be read"))?;
            files.retain(|file| is_log(file));
            files.sort();
            if files.is_empty() {
                bail!("{shown} has no log: files that end in .csv, .csv.gz, .txt or .parquet");
            }
            for file in files {
                match self.of_file(&file) {
                    Ok(found) => cylinders.extend(found),
                    Err(error) => cylinders.push(Inspected::failed(name_of(&file), format!("{error:#}"))),
                }
            }
        }
        Ok(cylinders)
    }

    fn of_file(&self, path: &Path) -> anyhow::Result<Vec<Inspected>> {
        if round::is_round(path)? { self.of_round(path) } else { Ok(vec![self.of_log(path)?]) }
    }
}

/// Whether a file of a folder is a log, by its name.
pub(super) fn is_log(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let endings = [".csv", ".csv.gz", ".txt", ".txt.gz", ".parquet"];
    !name.starts_with('.') && path.is_file() && endings.iter().any(|ending| name.ends_with(ending))
}

/// What a file's cylinder is called.
fn name_of(path: &Path) -> String {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    name.split('.').next().unwrap_or_default().to_owned()
}
