//! A program that calls the commands instead of a shell ([`crate::run`]): what it brings in place of files, and what it takes.
use super::fleet_progress::FleetProgress;
use crate::log::MemoryLog;
use crate::report::{Provenance, Report, Table};
use serde_json::Value;
use std::cell::RefCell;
use std::rc::Rc;

/// Whether a run is to end.
type Stop = Rc<RefCell<dyn FnMut() -> bool>>;
/// Takes how far a run is.
type Told = RefCell<Box<dyn FnMut(FleetProgress)>>;

/// The caller wanted the run to end.
#[derive(Debug, thiserror::Error)]
#[error("stopped")]
pub(crate) struct Stopped;

/// What a caller brings; nothing of it where a shell calls.
#[derive(Default)]
pub(crate) struct Host {
    /// The call as provenance shows it; empty: the command line.
    pub command: String,
    /// Documents by their names.
    pub documents: Vec<(String, String)>,
    /// Logs that are no files.
    pub logs: RefCell<Vec<MemoryLog>>,
    /// Asked now and then.
    pub stop: Option<Stop>,
    /// Told now and then.
    pub progress: Option<Told>,
}

impl Host {
    /// Whether the caller wants the run to end.
    pub(super) fn is_stopped(&self) -> bool {
        self.stop.as_ref().is_some_and(|stop| stop.borrow_mut()())
    }

    /// Tells the caller how far the run is.
    pub(super) fn tell(&self, so_far: FleetProgress) {
        if let Some(progress) = &self.progress {
            progress.borrow_mut()(so_far);
        }
    }

    /// A document of the call.
    pub(super) fn document(&self, name: &str) -> Option<&str> {
        self.documents.iter().find(|(given, _)| given == name).map(|(_, text)| text.as_str())
    }

    /// The log of the call that has this name.
    pub(super) fn take_log(&self, name: &str) -> Option<MemoryLog> {
        let mut logs = self.logs.borrow_mut();
        logs.iter().position(|log| log.name == name).map(|place| logs.swap_remove(place))
    }
}

/// What a run hands out.
#[derive(Debug)]
pub struct Outcome {
    /// Rows with all digits, in the columns and units of the command's data; its files have fewer digits.
    pub rows: Table,
    /// Zone of the dates in the column `time`, as `Europe/Berlin` or `+01:00`; `None`: UTC, or there are none.
    pub zone: Option<String>,
    /// Events and alarms in the order in which they happened, each a JSON object as of the command's `--events`.
    pub events: Vec<String>,
    /// The summary, as the command's JSON has it.
    pub summary: Value,
    /// Verdict at the end; empty: none is given.
    pub verdict: &'static str,
    /// Exit code of the command: 0 done and no loss, 1 gas was lost, 3 inconclusive, or a search that was ended early.
    pub exit_code: u8,
    /// The calibrated vessel as TOML, of `calibrate`; empty: there is none.
    pub vessel: String,
    /// The fitted sensors as TOML, of `calibrate`; empty: there are none.
    pub sensors: String,
    /// Cautions, which the command writes to stderr.
    pub cautions: Vec<String>,
    /// The summary for people with its figure.
    pub report: Report,
    /// Where all this comes from.
    pub provenance: Provenance,
}

impl Outcome {
    /// An outcome of a command that gives no verdict.
    pub(super) fn of(rows: Table, summary: Value, report: Report, provenance: Provenance) -> Self {
        Self {
            rows,
            zone: None,
            events: Vec::new(),
            summary,
            verdict: "",
            exit_code: 0,
            vessel: String::new(),
            sensors: String::new(),
            cautions: Vec::new(),
            report,
            provenance,
        }
    }
}
