//! `cylwatch completions`: a completion script for a shell.
use super::output::Target;
use clap::{Args, Command};

/// Arguments of `completions`.
#[derive(Debug, Args)]
pub(super) struct CompletionsArguments {
    /// Shell.
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

/// Writes the script to stdout.
pub(super) fn run(arguments: CompletionsArguments, mut program: Command) -> anyhow::Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut program, "cylwatch", &mut script);
    Target::Stdout.write(&script)
}
