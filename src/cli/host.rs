//! A program that calls the commands instead of a shell ([`crate::run`]): what it brings in place of files, and what it takes.
use crate::log::MemoryLog;
use crate::report::{Provenance, Report, Table};
use serde_json::Value;
use std::cell::RefCell;
use std::rc::Rc;

/// Whether a run is to end.
type Stop = Rc<RefCell<dyn FnMut() -> bool>>;

/// What a caller brings; nothing of it where a shell calls.
#[derive(Default)]
pub(crate) struct Host {
    /// The call as provenance shows it; empty: the command line.
    pub command: String,
    /// Documents by their names.
    pub documents: Vec<(String, String)>,
    /// The log, if it is no file.
    pub log: RefCell<Option<MemoryLog>>,
    /// Asked now and then.
    pub stop: Option<Stop>,
}

impl Host {
    /// A document of the call.
    pub(super) fn document(&self, name: &str) -> Option<&str> {
        self.documents.iter().find(|(given, _)| given == name).map(|(_, text)| text.as_str())
    }

    /// The log of the call, if it has this name.
    pub(super) fn take_log(&self, name: &str) -> Option<MemoryLog> {
        self.log.borrow_mut().take_if(|log| log.name == name)
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
    /// Exit code of the command: 0 no loss, 1 gas was lost, 3 inconclusive.
    pub exit_code: u8,
    /// Cautions, which the command writes to stderr.
    pub cautions: Vec<String>,
    /// The summary for people with its figure.
    pub report: Report,
    /// Where all this comes from.
    pub provenance: Provenance,
}
