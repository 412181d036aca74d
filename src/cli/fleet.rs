//! `cylwatch fleet`: many cylinders on all cores, each as by `cylwatch monitor`.
//!
//! Memory does not grow with the logs: each is streamed, the rows of a log of several cylinders wait in files, and of a cylinder its row
//! stays. Results do not depend on the number of threads: every cylinder is computed by one of them, and what is written is sorted.
mod arguments;
mod columns;
mod folder;
mod job;
mod kept;
mod logs;
mod plan;
mod record;
mod results;
mod run;
mod tally;
mod vessels;

pub(super) use arguments::{FleetArguments, without_single_runs};
#[cfg(feature = "serve")]
pub(super) use folder::{locked, stem};
pub use kept::FleetOutcome;
pub(super) use kept::kept;
#[cfg(feature = "serve")]
pub(super) use logs::{files, name_of};
#[cfg(feature = "serve")]
pub(super) use run::LAST_EVENTS;
#[cfg(feature = "serve")]
pub(super) use vessels::{as_columns, vessel_beside};

use super::input::Inputs;
use super::interrupt;
use super::message::Messages;
use super::output::command_line_without;
use super::progress::Progress;
use crate::detector::monitor::Outcome;
use crate::log::{LogError, LogOptions};
use crate::report::fleet::{Cylinder, Fault, report, sort_by_urgency};
use crate::report::{Input, Provenance};
use anyhow::{Context, bail};
use arguments::TableFormat;
use folder::Folder;
use job::{Done, Fleet};
use logs::Found;
use plan::Changes;
use rayon::prelude::*;
use record::Record;
use results::Results;
use run::Job;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::process::ExitCode;
use std::sync::Arc;
use tally::Tally;
use vessels::Vessels;

/// Tells whether a run is to end.
type Stop = Arc<dyn Fn() -> bool + Send + Sync>;

/// A run that came to its end.
struct Fleeted {
    /// Cylinders, the most urgent first.
    cylinders: Vec<Cylinder>,
    /// What could not be read, sorted.
    faults: Vec<Fault>,
    folder: Folder,
    provenance: Provenance,
}

/// Monitors the fleet and writes.
pub(super) fn run(arguments: FleetArguments, messages: &Messages) -> anyhow::Result<ExitCode> {
    interrupt::listen(|| {})?;
    let command = command_line_without("--threads");
    let (stop, tally): (Stop, _) = (Arc::new(interrupt::has_come), Tally::default());
    let done = match monitored(&arguments, &command, (stop, &tally), messages) {
        Err(error) if interrupt::has_come() && is_stopped(&error) => {
            messages.say(&format!("{error:#}"));
            return Ok(ExitCode::from(interrupt::CODE as u8));
        }
        done => done?,
    };
    let page = done.folder.file("page.html").display().to_string();
    messages.say(&report(&done.cylinders, &done.faults, &page).to_text());
    done.exit_code().map(ExitCode::from)
}

/// Whether a run ended because it was to.
fn is_stopped(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| matches!(cause.downcast_ref(), Some(LogError::Stopped { .. })))
}

/// Monitors the fleet and writes tables and page.
fn monitored(
    arguments: &FleetArguments,
    command: &str,
    (stop, tally): (Stop, &Tally),
    messages: &Messages,
) -> anyhow::Result<Fleeted> {
    let inputs = Inputs::of_command(command.to_owned());
    let vessels = Vessels::read(arguments, &inputs, messages)?;
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = arguments.threads {
        builder = builder.num_threads(threads);
    }
    let pool = builder.build().context("the threads cannot be started: choose fewer with --threads")?;
    let others: Vec<_> =
        arguments.vessels.iter().map(|path| path.as_path()).chain([arguments.output.as_path()]).collect();
    let options = LogOptions { any_order: true, ..arguments.reading.options(Vec::new()) };
    let files = logs::files(&arguments.logs, &others)?;
    let folder = Folder::make(&arguments.output, arguments.rows)?;
    let reading = Progress::open_ended(messages, "reading whose the logs are");
    let mut found = pool.install(|| logs::find(files, &options, &folder, &*stop))?;
    drop(reading);
    let mut cylinders = unmatched(arguments, &vessels, &mut found, &folder);
    let hashes = hashes(&vessels, &inputs)?;
    let jobs: Vec<Job<'_>> = found
        .logs
        .iter()
        .filter_map(|(name, logs)| Some(Job { name, logs, assigned: vessels.of(name)? }))
        .collect();
    if jobs.is_empty() && !cylinders.iter().any(|one| one.found.is_some()) {
        let first = found.faults.first().map(Fault::words).unwrap_or_default();
        bail!("none of the logs belongs to a cylinder with a vessel; the first reason is {first}");
    }
    let (hashes, columns, changes) = (&hashes, &found.columns, Changes::default());
    let fleet = Fleet { arguments, folder: &folder, command, hashes, columns, changes, stop };
    let done = pool.install(|| all(&fleet, &jobs, tally, messages))?;
    let finished = done.iter().flatten().count();
    if finished < jobs.len() {
        let at =
            format!("{finished} of {} cylinders are done and the same command does the rest", jobs.len());
        return Err(LogError::Stopped { at }.into());
    }
    for Done { cylinder, fault, .. } in done.into_iter().flatten() {
        found.faults.extend(fault);
        cylinders.push(cylinder);
    }
    found.faults.sort();
    sort_by_urgency(&mut cylinders);
    let done = Fleeted { cylinders, faults: found.faults, folder, provenance: inputs.provenance() };
    done.write(arguments.format.unwrap_or(TableFormat::USUAL))?;
    Ok(done)
}

/// Cylinders of which nothing can be said because they have a log and no vessel, or a vessel and no log.
/// Where the run goes on, one without a new log is as it was.
fn unmatched(
    arguments: &FleetArguments,
    vessels: &Vessels,
    found: &mut Found,
    folder: &Folder,
) -> Vec<Cylinder> {
    let file = arguments.vessels.as_deref().unwrap_or(std::path::Path::new("")).display().to_string();
    let mut missing = Vec::new();
    for (name, logs) in found.logs.iter().filter(|(name, _)| vessels.of(name).is_none()) {
        missing.push((
            String::new(),
            Fault {
                cylinder: name.clone(),
                file: logs.files[0].display().to_string(),
                line: None,
                reason: format!("cylinder {name} is not in {file}"),
                remedy: "add a row with its vessel".to_owned(),
            },
        ));
    }
    for (name, assigned) in vessels.names().filter(|(name, _)| !found.logs.contains_key(*name)) {
        missing.push((
            assigned.vessel.clone(),
            Fault {
                cylinder: name.clone(),
                file: file.clone(),
                line: assigned.line,
                reason: format!("cylinder {name} has no log in {}", arguments.logs.display()),
                remedy: "add its log, or leave the row out".to_owned(),
            },
        ));
    }
    let blank = |(vessel, fault): &(String, Fault)| Cylinder {
        name: fault.cylinder.clone(),
        vessel: vessel.clone(),
        logs: Vec::new(),
        found: None,
        fault: fault.words(),
        cautions: Vec::new(),
        events: 0,
        last_events: Vec::new(),
    };
    let known = |fault: &Fault| {
        let record = Record::recovered(&folder.files(&fault.cylinder)).filter(|_| arguments.go_on);
        record.map(|record| record.cylinder)
    };
    let cylinders =
        missing.iter().map(|unmatched| known(&unmatched.1).unwrap_or_else(|| blank(unmatched))).collect();
    found.faults.extend(missing.into_iter().map(|(_, fault)| fault));
    cylinders
}

/// SHA-256 of vessels, sensors and the like, by the names they were given.
fn hashes(vessels: &Vessels, inputs: &Inputs) -> anyhow::Result<BTreeMap<String, String>> {
    let all: Vec<_> = match vessels {
        Vessels::Alike(assigned) => vec![&**assigned],
        Vessels::Named(named) => named.values().collect(),
    };
    let mut hashes = BTreeMap::new();
    for assigned in all {
        let preset = format!("preset {}", assigned.vessel);
        let vessel = inputs.record_of(&assigned.vessel).or_else(|| inputs.record_of(&preset));
        hashes.extend(vessel.map(|input| (assigned.vessel.clone(), input.sha256)));
        for file in assigned.arguments.files() {
            let name = file.to_string_lossy().into_owned();
            if let Entry::Vacant(vacant) = hashes.entry(name) {
                let bytes =
                    std::fs::read(file).with_context(|| format!("{} cannot be read", file.display()))?;
                let input = Input::of(vacant.key().clone(), &bytes);
                vacant.insert(input.sha256.clone());
                inputs.record(input);
            }
        }
    }
    Ok(hashes)
}

/// Does all cylinders, in their order; `None`: a signal came first.
fn all(
    fleet: &Fleet<'_>,
    jobs: &[Job<'_>],
    tally: &Tally,
    messages: &Messages,
) -> anyhow::Result<Vec<Option<Done>>> {
    let bytes = |job: &Job<'_>| -> u64 {
        job.logs.files.iter().filter_map(|file| file.metadata().ok()).map(|found| found.len()).sum()
    };
    let all = jobs.iter().map(bytes).sum();
    let progress = Progress::of_bytes(messages, all);
    tally.begin(jobs.len(), all);
    jobs.par_iter()
        .with_max_len(1)
        .map(|job| {
            let done = fleet.done(job)?;
            if let Some(done) = &done {
                let bytes = bytes(job);
                tally.add(bytes, done.new_rows);
                progress.advance(bytes, tally.so_far().map(|so_far| so_far.to_string()).unwrap_or_default());
            }
            Ok(done)
        })
        .collect()
}

impl Fleeted {
    fn results(&self) -> Results<'_> {
        Results { cylinders: &self.cylinders, faults: &self.faults, provenance: &self.provenance }
    }

    fn write(&self, format: TableFormat) -> anyhow::Result<()> {
        self.results().write(&self.folder, format)?;
        self.folder.tidy();
        Ok(())
    }

    /// The worst of the fleet.
    fn exit_code(&self) -> anyhow::Result<u8> {
        let Self { cylinders, faults, .. } = self;
        let outcomes: Vec<Option<Outcome>> =
            cylinders.iter().map(|one| one.found.as_ref().map(|found| found.outcome)).collect();
        if outcomes.iter().all(Option::is_none) {
            let first = faults.first().map(Fault::words).unwrap_or_default();
            bail!("none of the {} cylinders could be read; the first reason is {first}", cylinders.len());
        }
        let has = |outcome| outcomes.contains(&Some(outcome));
        let is_unknown = has(Outcome::Unknown) || outcomes.contains(&None) || !faults.is_empty();
        let worst = match (has(Outcome::Loss), is_unknown) {
            (true, _) => Outcome::Loss,
            (false, true) => Outcome::Unknown,
            (false, false) => Outcome::NoLoss,
        };
        Ok(worst.exit_code())
    }
}
