//! `cylwatch fleet`: many cylinders on all cores, each as by `cylwatch monitor`.
//!
//! Memory does not grow with the logs: each is streamed, and of a cylinder its row stays. Results do not depend on the number of threads: every cylinder is
//! computed by one of them, and what is written is sorted.
mod arguments;
mod folder;
mod job;
mod logs;
mod record;
mod results;
mod vessels;

pub(super) use arguments::{FleetArguments, without_single_runs};

use super::input::Inputs;
use super::interrupt;
use super::message::Messages;
use super::output::command_line_without;
use super::progress::Progress;
use crate::detector::monitor::Outcome;
use crate::log::LogOptions;
use crate::report::fleet::{Cylinder, Fault, report, sort_by_urgency};
use crate::report::{Input, number};
use anyhow::{Context, bail};
use arguments::TableFormat;
use folder::Folder;
use job::{Done, Fleet, Job};
use logs::Found;
use rayon::prelude::*;
use results::Results;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Instant;
use vessels::Vessels;

/// Monitors the fleet and writes.
pub(super) fn run(arguments: FleetArguments, messages: &Messages) -> anyhow::Result<ExitCode> {
    let command = command_line_without("--threads");
    let inputs = Inputs::of_command(command.clone());
    let vessels = Vessels::read(&arguments, &inputs, messages)?;
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = arguments.threads {
        builder = builder.num_threads(threads);
    }
    let pool = builder.build().context("the threads cannot be started: choose fewer with --threads")?;
    let others: Vec<_> =
        arguments.vessels.iter().map(|path| path.as_path()).chain([arguments.output.as_path()]).collect();
    let options = LogOptions { any_order: true, ..arguments.reading.options(Vec::new()) };
    let mut found = pool.install(|| logs::find(&arguments.logs, &others, &options))?;
    let folder = Folder::make(&arguments.output, arguments.rows)?;
    interrupt::listen(|| {})?;
    let mut cylinders = unmatched(&arguments, &vessels, &mut found);
    let hashes = hashes(&vessels, &inputs)?;
    let jobs: Vec<Job<'_>> = found
        .logs
        .iter()
        .filter_map(|(name, logs)| Some(Job { name, logs, assigned: vessels.of(name)? }))
        .collect();
    if jobs.is_empty() {
        let first = found.faults.first().map(Fault::words).unwrap_or_default();
        bail!("none of the logs belongs to a cylinder with a vessel; the first reason is {first}");
    }
    let fleet = Fleet { arguments: &arguments, folder: &folder, command: &command, hashes: &hashes };
    let done = pool.install(|| all(&fleet, &jobs, messages))?;
    let finished = done.iter().flatten().count();
    if finished < jobs.len() {
        messages.say(&format!(
            "stopped by a signal: {finished} of {} cylinders are done; the same command does the rest",
            jobs.len()
        ));
        return Ok(ExitCode::from(interrupt::CODE as u8));
    }
    for Done { cylinder, fault, .. } in done.into_iter().flatten() {
        found.faults.extend(fault);
        cylinders.push(cylinder);
    }
    found.faults.sort();
    sort_by_urgency(&mut cylinders);
    let provenance = inputs.provenance();
    let results = Results { cylinders: &cylinders, faults: &found.faults, provenance: &provenance };
    results.write(&folder, arguments.format.unwrap_or(TableFormat::USUAL))?;
    messages
        .say(&report(&cylinders, &found.faults, &folder.file("page.html").display().to_string()).to_text());
    exit_code(&cylinders, &found.faults)
}

/// Cylinders of which nothing can be said because they have a log and no vessel, or a vessel and no log.
fn unmatched(arguments: &FleetArguments, vessels: &Vessels, found: &mut Found) -> Vec<Cylinder> {
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
    let cylinders = missing.iter().map(blank).collect();
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
fn all(fleet: &Fleet<'_>, jobs: &[Job<'_>], messages: &Messages) -> anyhow::Result<Vec<Option<Done>>> {
    let bytes = |job: &Job<'_>| -> u64 {
        job.logs.files.iter().filter_map(|file| file.metadata().ok()).map(|found| found.len()).sum()
    };
    let progress = Progress::of_bytes(messages, jobs.iter().map(bytes).sum());
    let (count, rows, began) = (AtomicUsize::new(0), AtomicU64::new(0), Instant::now());
    jobs.par_iter()
        .with_max_len(1)
        .map(|job| {
            let done = fleet.done(job)?;
            if let Some(done) = &done {
                let found = done.cylinder.found.as_ref().filter(|_| !done.was_known);
                let new = found.map_or(0, |found| found.rows);
                let so_far = rows.fetch_add(new, Ordering::Relaxed) + new;
                let number_done = count.fetch_add(1, Ordering::Relaxed) + 1;
                let rate = so_far as f64 / began.elapsed().as_secs_f64().max(1e-3);
                let words = format!("{number_done} of {} cylinders, {} rows/s", jobs.len(), number(rate, 2));
                progress.advance(bytes(job), words);
            }
            Ok(done)
        })
        .collect()
}

/// The worst of the fleet.
fn exit_code(cylinders: &[Cylinder], faults: &[Fault]) -> anyhow::Result<ExitCode> {
    let outcomes: Vec<Option<Outcome>> =
        cylinders.iter().map(|one| one.found.as_ref().map(|found| found.outcome)).collect();
    if outcomes.iter().all(Option::is_none) {
        let first = faults.first().map(Fault::words).unwrap_or_default();
        bail!("none of the {} cylinders could be read; the first reason is {first}", cylinders.len());
    }
    let has = |outcome| outcomes.contains(&Some(outcome));
    let worst =
        match (has(Outcome::Loss), has(Outcome::Unknown) || outcomes.contains(&None) || !faults.is_empty()) {
            (true, _) => Outcome::Loss,
            (false, true) => Outcome::Unknown,
            (false, false) => Outcome::NoLoss,
        };
    Ok(ExitCode::from(worst.exit_code()))
}
