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

/// What a caller takes.
#[derive(Debug)]
pub(crate) struct Kept {
    /// Rows with all digits.
    pub rows: Table,
    /// Zone in which the dates of the rows are told.
    pub zone: Option<String>,
    /// Lines of JSON.
    pub events: Vec<String>,
    /// The summary, as the JSON of the command has it.
    pub summary: Value,
    /// Verdict at the end; empty: there is none.
    pub verdict: &'static str,
    /// Exit code of the command.
    pub exit_code: u8,
    /// The report with its figure.
    pub report: Report,
    /// Where all this comes from.
    pub provenance: Provenance,
}
