//! The fleet for a program that calls it ([`crate::run::fleet`]): the same files, and the tables in memory.
use super::tally::Tally;
use super::{FleetArguments, Stop, monitored};
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

/// Monitors the fleet for a caller, who is told on his own thread how far it is, and asked whether it is to end.
pub(in crate::cli) fn kept(
    arguments: &FleetArguments,
    host: &Host,
    messages: &Messages,
) -> anyhow::Result<FleetOutcome> {
    let flag = Arc::new(AtomicBool::new(false));
    let stop: Stop = {
        let flag = Arc::clone(&flag);
        Arc::new(move || flag.load(Ordering::Relaxed))
    };
    let (command, tally, mut told) = (host.command.as_str(), Tally::default(), None);
    let mut tell = || {
        let so_far = tally.so_far();
        let count = so_far.map(|so_far| so_far.done);
        if let Some(so_far) = so_far.filter(|_| told != count) {
            told = count;
            host.tell(so_far);
        }
    };
    let run = || monitored(arguments, command, (stop, &tally), messages);
    let attend = || {
        tell();
        flag.fetch_or(host.is_stopped(), Ordering::Relaxed);
    };
    let done = beside(run, attend)?;
    tell();
    let [summary, events, errors] = done.results().tables(&done.folder).map(|(_, table)| table);
    let page = done.folder.file("page.html");
    let exit_code = done.exit_code()?;
    Ok(FleetOutcome { summary, events, errors, exit_code, page, provenance: done.provenance })
}
