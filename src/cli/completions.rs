//! `cylwatch completions`: a completion script for a shell.
use super::arguments::{Arguments, CompletionsArguments};
use super::output::Target;

/// Writes the script to stdout.
pub fn run(arguments: CompletionsArguments) -> anyhow::Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::prepared(), "cylwatch", &mut script);
    Target::Stdout.write(&script)
}
