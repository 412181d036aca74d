//! The fleet for a program that calls it ([`crate::run::fleet`]): the same files, and the tables in memory.
use super::{FleetArguments, monitored};
use crate::cli::beside::beside;
use crate::cli::host::Host;
use crate::cli::message::Messages;
use crate::report::{Provenance, Table};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What a run over a fleet hands out.
#[derive(Debug)]
pub struct FleetOutcome {
    /// A row for each cylinder, the most urgent first; the columns are those of the file.
    pub summary: Table,
    /// A row for each event and change of an alarm.
    pub events: Table,
    /// A row for everything that could not be read.
    pub errors: Table,
    /// Exit code of the command: 0 no cylinder lost gas, 1 one did, 3 of one it cannot be told.
    pub exit_code: u8,
    /// The page that was written.
    pub page: PathBuf,
    /// Where all this comes from.
    pub provenance: Provenance,
}

/// Monitors the fleet for a caller, who is asked on his own thread whether the run is to end.
pub(in crate::cli) fn kept(
    arguments: &FleetArguments,
    host: &Host,
    messages: &Messages,
) -> anyhow::Result<FleetOutcome> {
    let flag = Arc::new(AtomicBool::new(false));
    let stop = {
        let flag = Arc::clone(&flag);
        Arc::new(move || flag.load(Ordering::Relaxed))
    };
    let command = host.command.as_str();
    let run = || monitored(arguments, command, stop, messages);
    let done = beside(run, || _ = flag.fetch_or(host.is_stopped(), Ordering::Relaxed))?;
    let [summary, events, errors] = done.results().tables(&done.folder).map(|(_, table)| table);
    let page = done.folder.file("page.html");
    let exit_code = done.exit_code()?;
    Ok(FleetOutcome { summary, events, errors, exit_code, page, provenance: done.provenance })
}
