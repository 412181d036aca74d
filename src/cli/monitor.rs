//! `cylwatch monitor`: the monitor on a log, row by row: verdict, events, alarms, a state to go on from.
use super::fill::{self, FillSource, GivenFill};
use super::format::Format;
use super::host;
use super::input::{Inputs, LogInput};
use super::interrupt;
use super::message::Messages;
use super::output::Target;
use super::progress::Progress;
use super::selection::{self, Selection};
use super::start;
use super::views::{RenderedViews, Views};
use crate::detector::monitor::Outcome;
use crate::log::{LogError, LogOptions, Row};
use anyhow::{Context, bail};
use std::path::Path;
use std::process::ExitCode;

mod announced;
mod arguments;
mod context;
mod course;
mod engine;
mod events;
mod options;
mod order;
mod reading;
mod resume;
mod rows;
mod session;
mod state;
mod steps;

use announced::Announced;
pub(super) use arguments::{CylinderArguments, MonitorArguments};
#[cfg(feature = "serve")]
pub(super) use course::ALARM;
pub(super) use course::Course;
pub use course::Told;
pub(super) use engine::compiled;
pub(super) use options::{Options, Places};
#[cfg(feature = "serve")]
pub(super) use steps::NotResumed;
pub use steps::RowsWanted;
pub(crate) use steps::Steps;

use context::RunContext;
use engine::Engine;
use events::Console;
use order::Order;
use resume::RunStart;
use session::{Finished, Session};

/// Monitors row by row and writes.
pub(super) fn run(arguments: MonitorArguments, messages: &Messages) -> anyhow::Result<ExitCode> {
    let options = Options::checked(arguments)?;
    if options.state.is_some() && !options.is_live {
        // What is done until then stays in the state.
        interrupt::listen(|| {})?;
    }
    let progress = Progress::new(messages);
    let finished = watch(&options, &Inputs::default(), None, (messages, &progress))?;
    drop(progress);
    let outcome = match &finished.summary {
        Some(summary) => {
            messages.say(&crate::report::monitor::summary(summary).to_text());
            summary.outcome()
        }
        None => {
            messages.say("no verdict yet: all rows wait in the state for late ones");
            Outcome::Unknown
        }
    };
    finished.written.map(|()| ExitCode::from(outcome.exit_code()))
}

/// The same for a caller: nothing is written.
pub(super) fn kept(
    arguments: MonitorArguments,
    inputs: &Inputs,
    messages: &Messages,
) -> anyhow::Result<host::Outcome> {
    let options = Options::checked(arguments)?.kept()?;
    let finished = watch(&options, inputs, None, (messages, &Progress::new(messages)))?;
    finished.written?;
    let summary = finished.summary.context("a log that was read without an error has a row")?;
    let document = crate::report::monitor::document(&summary);
    let report = finished.report.unwrap_or_else(|| crate::report::monitor::summary(&summary));
    Ok(host::Outcome {
        zone: finished.zone,
        events: finished.events,
        verdict: summary.last.decision.verdict.as_str(),
        exit_code: summary.outcome().exit_code(),
        ..host::Outcome::of(finished.rows.unwrap_or_default(), document, report, inputs.provenance())
    })
}

/// Monitors one log, as `monitor` does and `fleet` for each cylinder: the summary, and what could not be written at the end. `course`
/// takes what happens on the way.
pub(super) fn watch(
    options: &Options,
    inputs: &Inputs,
    course: Option<&mut Course>,
    (messages, progress): (&Messages, &Progress),
) -> anyhow::Result<Finished> {
    let beginning = RunStart::find(options, inputs, messages)?;
    let sensors = options.sensors.as_deref().map(|path| selection::read(inputs, path)).transpose()?;
    let names = sensors.iter().flatten().map(|sensor| sensor.name.clone()).collect();
    let log_options = LogOptions {
        origin: beginning.origin()?,
        any_order: true,
        cylinder: options.spooled.as_ref().map(|spooled| spooled.cylinder.clone()),
        ..options.reading.options(names)
    };
    let mut log = match &options.spooled {
        Some(spooled) => inputs.spooled_log(spooled, &log_options)?,
        None => inputs.live_log(&options.log, &log_options)?,
    };
    let selection = Selection::new(&mut log.reader, sensors, &beginning.vessel, &[], messages);
    let console = Console { messages, progress };
    let outcome = selection
        .and_then(|selection| monitor((options, inputs), beginning, selection, &mut log, course, &console));
    for caution in log.reader.cautions() {
        messages.caution(&caution.to_string());
    }
    outcome
}

/// Runs the monitor over the log. Without a state nothing is left behind if it fails; with one, what was done before a
/// bad row stays.
fn monitor(
    (options, inputs): (&Options, &Inputs),
    beginning: RunStart,
    mut selection: Selection,
    log: &mut LogInput,
    course: Option<&mut Course>,
    console: &Console<'_>,
) -> anyhow::Result<Finished> {
    let Console { messages, progress } = *console;
    let (engine, identity) = match &beginning.state {
        None => {
            let engine = Engine::cold(options, inputs, &beginning, &mut selection, log, messages)?;
            (engine, beginning.identity(options, &selection.sensors))
        }
        Some(state) => {
            selection.know_the_fill(state.full_pa, state.stated, &mut log.reader)?;
            let identity = beginning.identity(options, &selection.sensors);
            let path = options.state.as_deref().unwrap_or(Path::new("the state"));
            state.check(&identity).map_err(|reason| resume::refused(path, &reason))?;
            session::check_clock(options, state, log)?;
            let engine = Engine::restored(options, &beginning, &selection, state)?;
            (engine, identity.after(&state.identity))
        }
    };
    if let Some(commissioned) = &beginning.commissioned {
        commissioned.cautions(engine.full_pa).iter().for_each(|caution| messages.caution(caution));
    }
    let title = format!("{} \u{2013} {}", beginning.vessel.name, selection.names().join(", "));
    let first = engine.first.clone();
    let context = RunContext { options, inputs, selection: &selection, messages, identity };
    let mut session = Session::begin(context, &beginning, engine, log, course)?;
    session.acknowledge(progress)?;
    if let Err(error) = read(&mut session, &first, options, log, progress) {
        session.abandon(inputs, log, &error)?;
        return Err(error);
    }
    if interrupt::has_come() {
        messages.say(match options.state {
            Some(_) => "stopped by a signal; the state is saved",
            None => "stopped by a signal",
        });
    }
    session.finish(title, log, progress)
}

/// Takes in all rows.
fn read(
    session: &mut Session,
    first: &[Row],
    options: &Options,
    log: &mut LogInput,
    progress: &Progress,
) -> anyhow::Result<()> {
    let mut order = Order::new(options.lateness_s);
    for row in first {
        order.check(row.time_s, log.reader.place(row))?;
        session.push(row, log, progress)?;
    }
    loop {
        progress.show(&options.log, log.fraction());
        if interrupt::has_come() && !options.is_live {
            return Ok(());
        }
        let row = match log.reader.next_row() {
            Ok(Some(row)) => row,
            Ok(None) => return Ok(()),
            // A signal came before the first row: what the state says still stands.
            Err(LogError::NoRows { .. }) if interrupt::has_come() => return Ok(()),
            Err(error) => return Err(error.into()),
        };
        let row = row.clone();
        order.check(row.time_s, log.reader.place(&row))?;
        session.push(&row, log, progress)?;
    }
}
