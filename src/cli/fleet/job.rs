//! One cylinder: monitored as by `cylwatch monitor`, or known from an earlier run.
use super::arguments::FleetArguments;
use super::folder::{Files, Folder};
use super::logs::{Logs, Naming};
use super::record::{Record, VERSION};
use super::vessels::Assigned;
use crate::cli::input::Inputs;
use crate::cli::interrupt;
use crate::cli::message::Messages;
use crate::cli::monitor::{Course, Options, Places, watch};
use crate::cli::output::Target;
use crate::cli::progress::Progress;
use crate::cli::views::Views;
use crate::report::fleet::{Cylinder, Fault, Finding, Source};
use crate::report::{Input, Provenance};
use anyhow::Context;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, UNIX_EPOCH};

/// Events that a cylinder's row keeps.
const LAST_EVENTS: usize = 5;

/// What all cylinders of a run have in common.
pub(super) struct Fleet<'a> {
    /// Arguments.
    pub arguments: &'a FleetArguments,
    /// Where results go.
    pub folder: &'a Folder,
    /// Command line that outputs name.
    pub command: &'a str,
    /// SHA-256 of vessels, sensors and the like, by their names.
    pub hashes: &'a BTreeMap<String, String>,
}

/// A cylinder that is to be done.
pub(super) struct Job<'a> {
    /// Its name.
    pub name: &'a str,
    /// Vessel and options.
    pub assigned: &'a Assigned,
    /// Its logs.
    pub logs: &'a Logs,
}

/// What became of a cylinder.
pub(super) struct Done {
    /// Its row.
    pub cylinder: Cylinder,
    /// What could not be read.
    pub fault: Option<Fault>,
    /// Whether an earlier run had done it.
    pub was_known: bool,
}

/// What a cylinder comes to before it is put on record.
#[derive(Default)]
struct Run {
    logs: Vec<Source>,
    found: Option<Finding>,
    course: Course,
    cautions: Vec<String>,
}

impl Fleet<'_> {
    /// Does a cylinder; `None`: a signal came first.
    ///
    /// # Errors
    /// The output folder cannot be written.
    pub(super) fn done(&self, job: &Job<'_>) -> anyhow::Result<Option<Done>> {
        if interrupt::has_come() {
            return Ok(None);
        }
        let files = self.folder.files(job.name);
        let key = self.key(job);
        if let Some(record) = Record::read(&files.record).filter(|record| record.key == key)
            && files.state.is_file()
            && (!self.arguments.rows || files.rows.is_file())
        {
            return Ok(Some(Done { cylinder: record.cylinder, fault: None, was_known: true }));
        }
        for path in [&files.record, &files.state, &files.rows] {
            remove(path)?;
        }
        let mut run = Run::default();
        let outcome = job.logs.files.iter().try_for_each(|file| self.log(job, file, &files, &mut run));
        if interrupt::has_come() {
            return Ok(None);
        }
        let last = job.logs.files.last().map(|file| file.display().to_string()).unwrap_or_default();
        let fault = match (outcome, &run.found) {
            (Ok(()), Some(_)) => None,
            (Ok(()), None) => Some(Fault::of(job.name, &last, NO_VERDICT)),
            (Err((file, error)), _) => {
                remove(&files.state)?;
                remove(&files.rows)?;
                run.found = None;
                Some(Fault::of(job.name, &file, &format!("{error:#}")))
            }
        };
        let Run { logs, found, course, cautions } = run;
        let told = if fault.is_none() { course.told } else { Vec::new() };
        let first = told.len().saturating_sub(LAST_EVENTS);
        let cylinder = Cylinder {
            name: job.name.to_owned(),
            vessel: job.assigned.vessel.clone(),
            logs,
            found,
            fault: fault.as_ref().map_or(String::new(), Fault::words),
            cautions,
            events: told.len(),
            last_events: told[first..].iter().map(|told| told.words.clone()).collect(),
        };
        if fault.is_none() {
            Record { key, cylinder: cylinder.clone(), told }.write(&files.record)?;
        }
        Ok(Some(Done { cylinder, fault, was_known: false }))
    }

    /// Monitors one log of a cylinder; on an error the file it is about.
    fn log(
        &self,
        job: &Job<'_>,
        file: &Path,
        files: &Files,
        run: &mut Run,
    ) -> Result<(), (String, anyhow::Error)> {
        let name = file.display().to_string();
        let messages = Messages::kept();
        let inputs = Inputs::of_command(self.command.to_owned());
        let watched = self.options(job, &name, files).and_then(|options| {
            let finished = watch(&options, &inputs, Some(&mut run.course), (&messages, &Progress::hidden()))?;
            finished.written.map(|()| finished.summary)
        });
        run.cautions.extend(messages.take_cautions());
        run.logs.extend(inputs.record_of(&name).map(Source::from));
        let summary = watched.map_err(|error| (name, error))?;
        if let Some(summary) = summary {
            let found = Finding::of(&summary, run.course.trace.means());
            run.found = Some(match &run.found {
                Some(earlier) => found.after(earlier),
                None => found,
            });
        }
        Ok(())
    }

    fn options(&self, job: &Job<'_>, log: &str, files: &Files) -> anyhow::Result<Options> {
        let Assigned { vessel, arguments, .. } = job.assigned;
        let places = Places {
            data: self.arguments.rows.then(|| Target::File(files.rows.clone())),
            events: None,
            state: Some(files.state.clone()),
            views: Views::default(),
        };
        let options = Options::of(self.arguments.of_monitor(vessel, log, arguments.clone()), places)?;
        let cylinder = (job.logs.naming == Naming::Column).then(|| job.name.to_owned());
        Ok(Options { cylinder, save_every: Duration::MAX, ..options })
    }

    /// Hash of everything that the result of a cylinder follows from.
    fn key(&self, job: &Job<'_>) -> String {
        let FleetArguments { reading, false_alarms, rows, .. } = self.arguments;
        let Assigned { vessel, arguments, .. } = job.assigned;
        let files = std::iter::once(vessel.clone())
            .chain(arguments.files().map(|file| file.to_string_lossy().into_owned()));
        let hashes: Vec<_> = files.map(|file| self.hashes.get(&file)).collect();
        let marks: Vec<_> = job.logs.files.iter().map(|file| (file, mark(file))).collect();
        let all = format!(
            "{} {VERSION} {vessel:?} {arguments:?} {hashes:?} {reading:?} {false_alarms:?} {rows} {:?} {marks:?}",
            Provenance::VERSION,
            job.logs.naming
        );
        Input::of("", all.as_bytes()).sha256
    }
}

/// Why a cylinder with a few rows has no verdict.
const NO_VERDICT: &str = "no verdict yet, all rows wait in the state for later ones: give a longer log";

/// Size and time of change of a file, ns.
fn mark(file: &Path) -> Option<(u64, u128)> {
    let metadata = file.metadata().ok()?;
    let changed = metadata.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
    Some((metadata.len(), changed.as_nanos()))
}

fn remove(path: &Path) -> anyhow::Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(error).with_context(|| format!("{} cannot be removed", path.display()))
        }
        _ => Ok(()),
    }
}
