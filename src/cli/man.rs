//! `cylwatch man`: manual pages, made from the same words as `--help`.
use super::message::Messages;
use super::output::{self, Target, write_file};
use clap::{Args, Command};
use std::path::PathBuf;

/// Arguments of `man`.
#[derive(Debug, Args)]
pub(super) struct ManArguments {
    /// Folder for one page a command, cylwatch.1, cylwatch-estimate.1, ...; it is made if it is not there [default: the
    /// main page on stdout].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Writes the pages.
pub(super) fn run(arguments: ManArguments, mut program: Command, messages: &Messages) -> anyhow::Result<()> {
    program.build();
    let Some(folder) = arguments.out else { return Target::Stdout.write(&page(&program)?) };
    output::make_folder(&folder)?;
    let commands = program.get_subcommands().filter(|command| command.get_name() != "help");
    let pages: Vec<&Command> = std::iter::once(&program).chain(commands).collect();
    for command in &pages {
        // A subcommand that was built is called `cylwatch-estimate` for display.
        let name = command.get_display_name().unwrap_or(command.get_name());
        write_file(&folder.join(format!("{name}.1")), &page(command)?)?;
    }
    messages.say(&format!("wrote {} pages; try: man {}", pages.len(), folder.join("cylwatch.1").display()));
    Ok(())
}

fn page(command: &Command) -> anyhow::Result<Vec<u8>> {
    let name = command.get_display_name().unwrap_or(command.get_name()).to_owned();
    let mut page = Vec::new();
    clap_mangen::Man::new(command.clone().name(name)).render(&mut page)?;
    Ok(page)
}
