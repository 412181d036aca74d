//! `cylwatch estimate`: the observer on a log, row by row.
use super::fill::{self, FillSource, GivenFill};
use super::format::Format;
use super::host::Outcome;
use super::input::{Inputs, LogInput};
use super::message::Messages;
use super::options::LogArguments;
use super::output::{Target, check_distinct};
use super::progress::Progress;
use super::selection::{self, Selection};
use super::start;
use super::views::Views;
use crate::estimator::log::Quantity;
use crate::estimator::observer::{Engine, Learned, Observer, ObserverSettings};
use crate::estimator::sensor::Sensor;
use crate::log::Row;
use crate::report::estimate as report;
use crate::report::number;
use crate::thermal::units::{DAY_S, YEAR_S};
use crate::thermal::vessel::Vessel;
use anyhow::{Context, bail};
use serde_json::json;
use std::path::PathBuf;

mod arguments;
mod pass;
mod rows;
mod slope;
mod steps;

pub(super) use arguments::EstimateArguments;
use pass::Pass;
use rows::{Finished, Rows};
use slope::Slope;
pub(crate) use steps::Steps;

/// Validated options.
struct Options {
    vessel: String,
    log: String,
    data: Target,
    format: Format,
    views: Views,
    reading: LogArguments,
    sensors: Option<PathBuf>,
    fill: GivenFill,
    source: FillSource,
    engine: Engine,
    smooth: bool,
    learned_in: Option<PathBuf>,
    learned_out: Option<Target>,
}

/// Estimates row by row and writes.
pub(super) fn run(arguments: EstimateArguments, messages: &Messages) -> anyhow::Result<()> {
    let options = Options::checked(arguments)?;
    let finished = ran(&options, &Inputs::default(), messages)?;
    messages.say(&report::summary(&finished.summary).to_text());
    Ok(())
}

/// The same for a caller: nothing is written.
pub(super) fn kept(
    arguments: EstimateArguments,
    inputs: &Inputs,
    messages: &Messages,
) -> anyhow::Result<Outcome> {
    let options = Options { data: Target::Memory, views: Views::kept(), ..Options::checked(arguments)? };
    let finished = ran(&options, inputs, messages)?;
    let summary = report::document(&finished.summary);
    let report = finished.report.unwrap_or_else(|| report::summary(&finished.summary));
    let rows = finished.rows.unwrap_or_default();
    Ok(Outcome { zone: finished.zone, ..Outcome::of(rows, summary, report, inputs.provenance()) })
}

/// Opens the log and runs the observer over it.
fn ran(options: &Options, inputs: &Inputs, messages: &Messages) -> anyhow::Result<Finished> {
    let vessel = inputs.vessel(&options.vessel, messages)?;
    let sensors = options.sensors.as_deref().map(|path| selection::read(inputs, path)).transpose()?;
    let learned =
        options.learned_in.as_deref().map(|path| start::learned(inputs, path, &vessel)).transpose()?;
    let names = sensors.iter().flatten().map(|sensor| sensor.name.clone()).collect();
    let mut log = inputs.log(&options.log, &options.reading.options(names))?;
    let outcome = estimate(options, inputs, &vessel, sensors, learned, &mut log, messages);
    // What was strange about the log may explain an error.
    for caution in log.reader.cautions() {
        messages.caution(&caution.to_string());
    }
    let finished = outcome?;
    for doubt in report::doubts(&finished.summary) {
        messages.caution(&doubt);
    }
    Ok(finished)
}

impl Options {
    fn checked(arguments: EstimateArguments) -> anyhow::Result<Self> {
        let EstimateArguments { inputs: places, fill, filter, smooth, reading, learned_in, .. } = arguments;
        let sensors = arguments.sensors.sensors;
        let mut inputs = places.paths()?;
        inputs.extend([sensors.as_deref(), learned_in.as_deref()].into_iter().flatten());
        let data = Target::checked(arguments.data.output.as_deref(), &inputs)?;
        let learned_out = arguments.learned_out.as_deref();
        let learned_out = learned_out.map(|path| Target::checked(Some(path), &inputs)).transpose()?;
        let others: Vec<&Target> = [Some(&data), learned_out.as_ref()].into_iter().flatten().collect();
        let views = Views::checked(&arguments.views, &inputs, &others)?;
        check_distinct(&[("--output", Some(&data)), ("--learned-out", learned_out.as_ref())])?;
        let (source, engine) = (fill.source()?, filter.engine()?);
        Ok(Self {
            vessel: places.vessel,
            log: places.log,
            data,
            format: arguments.data.format(),
            views,
            reading,
            sensors,
            fill,
            source,
            engine,
            smooth,
            learned_in,
            learned_out,
        })
    }
}

/// Runs the observer over the log; nothing is left behind if it fails.
fn estimate(
    options: &Options,
    inputs: &Inputs,
    vessel: &Vessel,
    sensors: Option<Vec<Sensor>>,
    learned: Option<Learned>,
    log: &mut LogInput,
    messages: &Messages,
) -> anyhow::Result<Finished> {
    let (selection, first, observer) = begun(options, vessel, sensors, learned, log, messages)?;
    let title = format!("{} \u{2013} {}", vessel.name, selection.names().join(", "));
    let progress = Progress::new(messages);
    let mut rows = Rows::begin(observer, &selection, options, inputs, log)?;
    for row in &first {
        rows.push(row, &log.reader).with_context(|| log.reader.place(row))?;
    }
    loop {
        progress.show(&options.log, log.fraction());
        let Some(row) = log.reader.next_row()? else { break };
        let row = row.clone();
        rows.push(&row, &log.reader).with_context(|| log.reader.place(&row))?;
    }
    drop(progress);
    rows.finish(title, inputs, log, options)
}

/// The observer that a log begins with, its sensors, and the rows that were read to find the fill.
fn begun(
    options: &Options,
    vessel: &Vessel,
    sensors: Option<Vec<Sensor>>,
    learned: Option<Learned>,
    log: &mut LogInput,
    messages: &Messages,
) -> anyhow::Result<(Selection, Vec<Row>, Observer)> {
    let mut selection = Selection::new(&mut log.reader, sensors, vessel, &[], messages)?;
    let (first, fill) = start::first_rows(&mut log.reader, &mut selection, options.source, vessel)?;
    let first_k = selection.mean_temperature_k(first.first());
    let begin = || first.last().map_or_else(String::new, |row| log.reader.place(row));
    let commissioning = options.fill.commissioning(fill, vessel, first_k, selection.pressure_offset_sd_pa());
    let commissioning = commissioning.with_context(begin)?;
    let settings = ObserverSettings { engine: options.engine, ..ObserverSettings::default() };
    let settings = fill::settings(settings, options.fill.is_settled());
    let mut observer = Observer::new(vessel, &selection.sensors, &commissioning, &settings)?;
    if let (Some(row), Some(channel)) = (first.last(), selection.first_of(Quantity::Pressure)) {
        let mass_kg = commissioning.mass_kg(vessel, first_k)?;
        let fill_pa = observer.cylinder().model().settled_pressure_pa(mass_kg, first_k)?;
        if let Some(doubt) =
            fill::misfit(mass_kg, first_k, fill_pa, row.readings[channel]).with_context(begin)?
        {
            messages.caution(&format!("{}: {doubt}", begin()));
        }
    }
    if let Some(learned) = learned {
        observer = observer.with_learned(learned)?;
    }
    Ok((selection, first, observer))
}

/// Longest time between two rows, s: a year. The model goes through all of it, and nothing is left to be known then.
const LONGEST_GAP_S: f64 = YEAR_S;

/// A row must not come later after the one before it, whose time is NaN for the first row.
fn check_gap(last_s: f64, time_s: f64) -> anyhow::Result<()> {
    let gap_s = time_s - last_s;
    if gap_s > LONGEST_GAP_S {
        bail!(
            "time {} s is {} d after the row before it, and no estimate goes on for more than {} d: check its unit, or begin anew there",
            number(time_s, 10),
            number(gap_s / DAY_S, 3),
            number(LONGEST_GAP_S / DAY_S, 3)
        );
    }
    Ok(())
}
