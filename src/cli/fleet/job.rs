//! One cylinder: monitored as by `cylwatch monitor`, known from an earlier run, or gone on with.
use super::arguments::FleetArguments;
use super::columns::ColumnLog;
use super::folder::{Files, Folder};
use super::logs::Naming;
use super::plan::{Changes, Plan, Step, mark};
use super::record::{LogRecord, Record, VERSION, file_hash};
use super::run::{Job, Run};
use super::vessels::Assigned;
use crate::cli::host::Host;
use crate::cli::input::Inputs;
use crate::cli::message::Messages;
use crate::cli::monitor::{Options, Places, watch};
use crate::cli::output::Target;
use crate::cli::progress::Progress;
use crate::cli::views::Views;
use crate::report::fleet::{Cylinder, Fault, Finding, Source};
use crate::report::{Input, Provenance};
use anyhow::{Context, bail};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

/// Why a cylinder with a few rows has no verdict.
const NO_VERDICT: &str = "no verdict yet, all rows wait for later ones: give a longer log";

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
    /// Logs of several cylinders, by their paths.
    pub columns: &'a BTreeMap<PathBuf, ColumnLog>,
    /// Compares logs with what they were.
    pub changes: Changes,
    /// Tells whether the run is to end.
    pub stop: Arc<dyn Fn() -> bool + Send + Sync>,
}

/// What became of a cylinder.
pub(super) struct Done {
    /// Its row.
    pub cylinder: Cylinder,
    /// What could not be read.
    pub fault: Option<Fault>,
    /// Rows that this run has taken in.
    pub new_rows: u64,
}

/// Why a log has no result: the file and the reason.
type Failure = (String, anyhow::Error);

impl Fleet<'_> {
    /// Does a cylinder; `None`: the run is to end.
    ///
    /// # Errors
    /// The output folder cannot be written.
    pub(super) fn done(&self, job: &Job<'_>) -> anyhow::Result<Option<Done>> {
        if (self.stop)() {
            return Ok(None);
        }
        let files = self.folder.files(job.name);
        let settings = self.settings(job);
        let before = Record::recovered(&files);
        if self.arguments.go_on && before.is_none() && files.record.is_file() {
            let reason = format!("{}: {OTHER_STATE}", files.state.display());
            let fault = Fault::of(job.name, &files.state.display().to_string(), &reason);
            return Ok(Some(Done {
                cylinder: Run::default().row(job, Some(&fault), &files),
                fault: Some(fault),
                new_rows: 0,
            }));
        }
        let plan = before.as_ref().map_or(Plan::Anew, |record| self.plan(job, record, &settings, &files));
        let (mut run, steps) = match (plan, before) {
            (Plan::Known, Some(record)) => {
                return Ok(Some(Done { cylinder: record.cylinder, fault: None, new_rows: 0 }));
            }
            (plan, before) => begun(job, plan, before, &files)?,
        };
        let outcome = steps.iter().try_for_each(|step| self.log(job, step, &files, &mut run));
        if (self.stop)() {
            return Ok(None);
        }
        self.put_on_record(job, (settings, &files), run, outcome).map(Some)
    }

    fn plan(&self, job: &Job<'_>, record: &Record, settings: &str, files: &Files) -> Plan {
        let goes_on = self.arguments.go_on;
        let is_same = record.settings == settings && (!self.arguments.rows || files.rows.is_file());
        if !is_same && !goes_on {
            return Plan::Anew;
        }
        self.changes.plan(&record.logs, &job.logs.files, job.logs.naming == Naming::Column, goes_on)
    }

    /// Reads one log of a cylinder.
    fn log(&self, job: &Job<'_>, step: &Step, files: &Files, run: &mut Run) -> Result<(), Failure> {
        let name = step.file.display().to_string();
        let (messages, inputs) = (Messages::kept(), self.inputs());
        let earlier = step.grown.map(|at| run.logs[at].clone());
        let changed_ns = mark(&step.file).and_then(|(_, changed_ns)| changed_ns);
        let watched = self.options(job, step, files, earlier.as_ref()).and_then(|options| {
            let finished = watch(&options, &inputs, Some(&mut run.course), (&messages, &Progress::hidden()))?;
            finished.written.map(|()| (finished.summary, finished.reading))
        });
        let cautions = messages.take_cautions();
        let source = inputs.record_of(&name).map(Source::from).unwrap_or_default();
        let (summary, reading) = match watched {
            Ok(watched) => watched,
            Err(error) => {
                if !source.name.is_empty() {
                    run.take(step.grown, LogRecord { source, before_rows: cautions, ..LogRecord::default() });
                }
                return Err((name, error));
            }
        };
        let shared = self.columns.get(&step.file).map_or(&[][..], |column| &column.index.cautions);
        let before_rows = cautions.len() - reading.cautions.len().min(cautions.len());
        let mut log = LogRecord {
            source,
            length: reading.length.unwrap_or_default(),
            changed_ns,
            rows: reading.rows,
            known_rows: reading.known_rows,
            before_rows: cautions[..before_rows].to_vec(),
            of_rows: shared.iter().chain(&reading.cautions).cloned().collect(),
            ..LogRecord::default()
        };
        if let Some(earlier) = earlier {
            log = LogRecord {
                known_rows: earlier.known_rows,
                counts: earlier.counts,
                first: earlier.first,
                before_rows: earlier.before_rows,
                ..log
            };
        }
        let is_news = reading.rows > reading.known_rows;
        if let Some(mut summary) = summary.filter(|_| is_news) {
            log.counts = summary.row_counts.and(log.counts);
            (summary.row_counts, summary.known_rows) = (log.counts, log.known_rows);
            let found = Finding::of(&summary, run.course.trace.means());
            log.first = log.first.or(Some((found.span_s.0, found.span.0.clone())));
            run.found = Some(match &run.found {
                Some(earlier) => found.after(earlier),
                None => found,
            });
        }
        run.new_rows += reading.rows - reading.known_rows;
        run.take(step.grown, log);
        Ok(())
    }

    fn options(
        &self,
        job: &Job<'_>,
        step: &Step,
        files: &Files,
        earlier: Option<&LogRecord>,
    ) -> anyhow::Result<Options> {
        let column = self.columns.get(&step.file);
        if let Some(damage) = column.and_then(|column| column.index.damage.as_ref()) {
            bail!("{damage}");
        }
        let Assigned { vessel, arguments, .. } = job.assigned;
        let places = Places {
            data: self.arguments.rows.then(|| Target::File(files.rows.clone())),
            events: None,
            state: Some(files.work.clone()),
            views: Views::default(),
        };
        let mut arguments = arguments.clone();
        if files.work.is_file() {
            // The state has it.
            arguments.learned_in = None;
        }
        let log = step.file.display().to_string();
        let options = Options::of(self.arguments.of_monitor(vessel, &log, arguments), places)?;
        let spooled = column.map(|column| column.spooled(job.name, &*self.stop)).transpose()?;
        let known_rows = earlier.map(|earlier| earlier.rows);
        Ok(Options { spooled, known_rows, save_every: Duration::MAX, ..options })
    }

    /// The inputs of a log, which end when the run is to end.
    fn inputs(&self) -> Inputs {
        let stop = Arc::clone(&self.stop);
        Inputs::of(Host {
            command: self.command.to_owned(),
            stop: Some(Rc::new(RefCell::new(move || stop()))),
            ..Host::default()
        })
    }

    /// Puts a cylinder on record if nothing is wrong with it.
    fn put_on_record(
        &self,
        job: &Job<'_>,
        (settings, files): (String, &Files),
        run: Run,
        outcome: Result<(), Failure>,
    ) -> anyhow::Result<Done> {
        let last = job.logs.files.last().map(|file| file.display().to_string()).unwrap_or_default();
        let fault = match (outcome, &run.found) {
            (Ok(()), Some(_)) => None,
            (Ok(()), None) => Some(Fault::of(job.name, &last, NO_VERDICT)),
            (Err((file, error)), _) => {
                let message = format!("{error:#}").replace(COLD_START, FLEET_COLD_START);
                Some(Fault::of(job.name, &file, &message))
            }
        };
        let new_rows = run.new_rows;
        if fault.is_some() {
            remove(&files.work)?;
            if !files.record.is_file() {
                remove(&files.rows)?;
            }
            return Ok(Done { cylinder: run.row(job, fault.as_ref(), files), fault, new_rows });
        }
        let Run { logs, course, .. } = &run;
        let state = file_hash(&files.work);
        let state = state.with_context(|| format!("{} cannot be read", files.work.display()))?;
        let (logs, told, trace) = (logs.clone(), course.told.clone(), course.trace.clone());
        let cylinder = run.row(job, None, files);
        let record = Record { settings, logs, state, cylinder, told, trace };
        record.commit(files)?;
        Ok(Done { cylinder: record.cylinder, fault, new_rows })
    }

    /// Hash of everything but the logs that the result of a cylinder follows from.
    fn settings(&self, job: &Job<'_>) -> String {
        let FleetArguments { reading, false_alarms, rows, .. } = self.arguments;
        let Assigned { vessel, arguments, .. } = job.assigned;
        let files = std::iter::once(vessel.clone())
            .chain(arguments.files().map(|file| file.to_string_lossy().into_owned()));
        let hashes: Vec<_> = files.map(|file| self.hashes.get(&file)).collect();
        let all = format!(
            "{} {VERSION} {vessel:?} {arguments:?} {hashes:?} {reading:?} {false_alarms:?} {rows} {:?}",
            Provenance::VERSION,
            job.logs.naming
        );
        Input::of("", all.as_bytes()).sha256
    }
}

/// Why a cylinder cannot be gone on with.
const OTHER_STATE: &str = "it is not the state that the record of the folder belongs to: put that back, or choose another output folder";
/// What `monitor` says of a state that does not fit, and what is said here.
const COLD_START: &str = "--cold-start starts fresh and replaces it";
const FLEET_COLD_START: &str = "choose another output folder to start fresh";

/// A run that goes on, or begins anew, and the logs that it reads.
fn begun(
    job: &Job<'_>,
    plan: Plan,
    before: Option<Record>,
    files: &Files,
) -> anyhow::Result<(Run, Vec<Step>)> {
    remove(&files.work)?;
    if let (Plan::GoOn(steps), Some(record)) = (plan, before) {
        let copied = std::fs::copy(&files.state, &files.work);
        copied.with_context(|| format!("{} cannot be written", files.work.display()))?;
        return Ok((Run::after(record), steps));
    }
    for path in [&files.record, &files.state, &files.rows] {
        remove(path)?;
    }
    let step = |file: &PathBuf| Step { file: file.clone(), grown: None };
    Ok((Run::default(), job.logs.files.iter().map(step).collect()))
}

fn remove(path: &Path) -> anyhow::Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(error).with_context(|| format!("{} cannot be removed", path.display()))
        }
        _ => Ok(()),
    }
}
