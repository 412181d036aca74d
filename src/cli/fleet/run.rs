//! What a cylinder comes to on its way through its logs, and the row that is left of it.
use super::folder::Files;
use super::logs::Logs;
use super::record::{LogRecord, Record};
use super::vessels::Assigned;
use crate::cli::monitor::{Course, Told};
use crate::report::fleet::{Cylinder, Fault, Finding};

/// Events that a cylinder's row keeps.
pub(in crate::cli) const LAST_EVENTS: usize = 5;

/// A cylinder that is to be done.
pub(super) struct Job<'a> {
    /// Its name.
    pub name: &'a str,
    /// Vessel and options.
    pub assigned: &'a Assigned,
    /// Its logs.
    pub logs: &'a Logs,
}

/// What a cylinder comes to before it is put on record.
#[derive(Default)]
pub(super) struct Run {
    /// Logs that were read.
    pub logs: Vec<LogRecord>,
    /// What was found; `None`: nothing yet.
    pub found: Option<Finding>,
    /// What happened.
    pub course: Course,
    /// Rows that this run has taken in.
    pub new_rows: u64,
}

impl Run {
    /// A run that goes on.
    pub(super) fn after(record: Record) -> Self {
        let Record { logs, cylinder, told, trace, .. } = record;
        Self { logs, found: cylinder.found, course: Course { told, trace }, new_rows: 0 }
    }

    /// Takes a log: in place of what it was before it grew, or after the others.
    pub(super) fn take(&mut self, grown: Option<usize>, log: LogRecord) {
        match grown {
            Some(at) => self.logs[at] = log,
            None => self.logs.push(log),
        }
    }

    /// The row of a cylinder; of one with a fault the events are those on record.
    pub(super) fn row(self, job: &Job<'_>, fault: Option<&Fault>, files: &Files) -> Cylinder {
        let on_record = fault.and_then(|_| Record::recovered(files));
        let told: &[Told] = match (fault, &on_record) {
            (None, _) => &self.course.told,
            (Some(_), Some(record)) => &record.told,
            (Some(_), None) => &[],
        };
        let rows = self.logs.iter().map(|log| log.rows - log.known_rows).sum();
        let first = self.logs.iter().find_map(|log| log.first.clone());
        let found = self.found.filter(|_| fault.is_none()).map(|found| {
            let (first_s, date) = first.unwrap_or((found.span_s.0, found.span.0));
            Finding { rows, span_s: (first_s, found.span_s.1), span: (date, found.span.1), ..found }
        });
        let cautions = self.logs.iter().flat_map(|log| log.before_rows.iter().chain(&log.of_rows));
        let last = &told[told.len().saturating_sub(LAST_EVENTS)..];
        Cylinder {
            name: job.name.to_owned(),
            vessel: job.assigned.vessel.clone(),
            logs: self.logs.iter().map(|log| log.source.clone()).collect(),
            found,
            fault: fault.map_or(String::new(), Fault::words),
            cautions: cautions.cloned().collect(),
            events: told.len(),
            last_events: last.iter().map(|told| told.words.clone()).collect(),
        }
    }
}
