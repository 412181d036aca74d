//! `cylwatch reproduce`: the paper rebuilt, as a report, as files and as tables.
use super::message::Messages;
use super::number::{at_least, within};
use super::options::{ReportArguments, SolverArguments};
use super::output::command_line;
use super::output::{self, Target};
use super::progress::Progress;
use super::views::Views;
use crate::report::Provenance;
use crate::reproduce::{self, Settings, checks};
use clap::Args;
use std::path::PathBuf;

/// Arguments of `reproduce`.
#[derive(Debug, Args)]
pub(super) struct ReproduceArguments {
    /// Folder for report.html, figures (SVG and PNG), CSV files and results.json; it is made if it is not there.
    #[arg(long, value_name = "DIR", default_value = "out/reproduce")]
    pub out: PathBuf,
    /// Seed of noise and drawn cylinders, a whole number of at least 0.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, value_parser = at_least(0_u64))]
    pub seed: u64,
    /// Drawn cylinders of each case, 1 to 1000; the time goes with it.
    #[arg(long, value_name = "NUMBER", default_value_t = 8, value_parser = within(1_u64, 1000))]
    pub cylinders: u64,
    #[command(flatten)]
    pub report: ReportArguments,
    #[command(flatten)]
    pub solver: SolverArguments,
}

/// Computes, writes the files, prints the tables.
pub(super) fn run(arguments: ReproduceArguments, messages: &Messages) -> anyhow::Result<()> {
    let mut settings =
        Settings { seed: arguments.seed, cylinders: arguments.cylinders, ..Settings::default() };
    if let Some(tolerance) = arguments.solver.relative_tolerance {
        settings.simulation.relative_tolerance = tolerance;
    }
    settings.simulation.validate()?;
    output::make_folder(&arguments.out)?;
    let views = Views::checked(&arguments.report.into(), &[], &[])?;
    let progress = Progress::new(messages);
    let results = reproduce::run(&settings, &mut |what, done| progress.show(what, done))?;
    let provenance =
        Provenance { command: command_line(), inputs: reproduce::inputs(), seed: Some(settings.seed) };
    progress.show("figures", 1.0);
    let files = results.files(&provenance)?;
    drop(progress);
    for (name, bytes) in &files {
        output::write_file(&arguments.out.join(name), bytes)?;
    }
    views.make_report(|| results.report(), Vec::new(), &provenance)?.write()?;
    let missed = checks::checks(&results).iter().filter(|row| row.met() == Some(false)).count();
    Target::Stdout.write(results.text().as_bytes())?;
    let out = arguments.out.display();
    messages.say(&format!("\nwrote {} files to {out}: open {out}/report.html in a browser", files.len()));
    if missed > 0 {
        messages.caution(&format!("{missed} of the bars are not met, marked NO"));
    }
    Ok(())
}
