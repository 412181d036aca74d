//! Calls from a program ([`crate::run`]): the arguments of a command line, without a shell.
use super::arguments::{Arguments, Command};
use super::host::{Host, Outcome};
use super::input::Inputs;
use super::message::Messages;
use super::output::quoted_line_without;
use super::{calibrate, estimate, fleet, identify, monitor, place, properties, simulate};
use crate::report::Table;
use anyhow::{anyhow, bail};
use clap::FromArgMatches;
use std::ffi::OsString;

/// Options that name a place for a result or belong to a terminal: a caller has the result in memory.
const FOR_A_SHELL: [&str; 16] = [
    "output",
    "out",
    "sensors-out",
    "matrices",
    "json",
    "format",
    "events",
    "plot",
    "report",
    "quiet",
    "state",
    "save-every",
    "cold-start",
    "acknowledge",
    "learned-out",
    "list",
];

/// Runs a command for a caller.
pub(crate) fn called(host: Host, arguments: &[OsString]) -> anyhow::Result<Outcome> {
    let (messages, inputs) = (Messages::kept(), Inputs::of(host));
    let outcome = match parsed(arguments)? {
        Command::Monitor(arguments) => monitor::kept(*arguments, &inputs, &messages),
        Command::Estimate(arguments) => estimate::kept(*arguments, &inputs, &messages),
        Command::Simulate(arguments) => simulate::kept(arguments, &inputs, &messages),
        Command::Identify(arguments) => identify::kept(*arguments, &inputs, &messages),
        Command::Calibrate(arguments) => calibrate::kept(*arguments, &inputs, &messages),
        Command::Place(arguments) => place::kept(*arguments, &inputs, &messages),
        _ => bail!("this command has no result in rows"),
    };
    Ok(Outcome { cautions: messages.take_cautions(), ..outcome? })
}

/// Monitors a fleet for a caller; provenance shows the command line that does the same.
pub(crate) fn fleet_of(host: Host, arguments: &[OsString]) -> anyhow::Result<fleet::FleetOutcome> {
    let words = std::iter::once(OsString::from("cylwatch")).chain(arguments.iter().cloned());
    let host = Host { command: quoted_line_without(words, "--threads"), ..host };
    match parsed(arguments)? {
        Command::Fleet(arguments) => fleet::kept(&arguments, &host, &Messages::kept()),
        _ => bail!("this is no call of fleet"),
    }
}

/// The properties of a gas at the state that the arguments give: a table of one row.
pub(crate) fn properties_of(arguments: &[OsString]) -> anyhow::Result<Table> {
    match parsed(arguments)? {
        Command::Properties(arguments) => properties::kept(&arguments),
        _ => bail!("this is no command for properties"),
    }
}

/// A monitor step by step.
pub(crate) fn monitor_steps(
    arguments: &[OsString],
    documents: Vec<(String, String)>,
) -> anyhow::Result<monitor::Steps> {
    match parsed(arguments)? {
        Command::Monitor(arguments) => monitor::Steps::new(*arguments, documents),
        _ => bail!("this is no call of monitor"),
    }
}

/// An observer step by step.
pub(crate) fn estimate_steps(
    arguments: &[OsString],
    documents: Vec<(String, String)>,
) -> anyhow::Result<estimate::Steps> {
    match parsed(arguments)? {
        Command::Estimate(arguments) => estimate::Steps::new(*arguments, documents),
        _ => bail!("this is no call of estimate"),
    }
}

fn parsed(arguments: &[OsString]) -> anyhow::Result<Command> {
    // The output of `identify` names a column, and a fleet has its results in a folder.
    let allowed: &[&str] = match arguments.first().and_then(|command| command.to_str()) {
        Some("identify") => &["output"],
        Some("fleet") => &["output", "format"],
        _ => &[],
    };
    for argument in arguments {
        let text = argument.to_string_lossy();
        let option = text.strip_prefix("--").map(|option| option.split('=').next().unwrap_or(option));
        if let Some(option) = option.filter(|option| !allowed.contains(option))
            && (FOR_A_SHELL.contains(&option) || option.starts_with("save-every"))
        {
            bail!("--{option} is for the command line: the result is in memory");
        }
        if text.starts_with('-') && option.is_none() {
            bail!("{text} is no input: standard input is for the command line");
        }
    }
    let words = std::iter::once(OsString::from("cylwatch")).chain(arguments.iter().cloned());
    let refused = |error: clap::Error| anyhow!(words_of(&error));
    let mut matches = Arguments::prepared().try_get_matches_from(words).map_err(refused)?;
    Ok(Arguments::from_arg_matches_mut(&mut matches).map_err(refused)?.command)
}

/// The words of a refused argument, without what only a terminal has use for.
fn words_of(error: &clap::Error) -> String {
    let text = error.render().to_string();
    let lines = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
    let lines: Vec<&str> =
        lines.filter(|line| !line.is_empty() && !line.starts_with("tip: to pass")).collect();
    lines.join("; ").trim_start_matches("error: ").to_owned()
}
