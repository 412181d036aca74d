//! `cylwatch reproduce`: the paper's scenarios and a measured blowdown, as files and as a table.
use super::arguments::ReproduceArguments;
use super::command_line;
use super::message::Messages;
use super::output::{self, Target};
use super::progress::Progress;
use cylwatch::report::Provenance;
use cylwatch::reproduce::{self, rows};
use cylwatch::thermal::simulate::SimulationSettings;

/// Computes, writes the files, prints the table.
pub fn run(arguments: ReproduceArguments, messages: &Messages) -> anyhow::Result<()> {
    let mut settings = SimulationSettings::default();
    if let Some(tolerance) = arguments.relative_tolerance {
        settings.relative_tolerance = tolerance;
    }
    settings.validate()?;
    output::make_folder(&arguments.out)?;
    let progress = Progress::new(messages);
    let results = reproduce::run(&settings, &mut |what, done| progress.show(what, done))?;
    let provenance = Provenance { command: command_line(), inputs: reproduce::inputs(), seed: None };
    progress.show("figures", 1.0);
    let files = results.files(&provenance)?;
    drop(progress);
    for (name, bytes) in &files {
        output::write_file(&arguments.out.join(name), bytes)?;
    }
    let table = rows::rows(&results);
    let missed = table.iter().filter(|row| row.met() == Some(false)).count();
    let text = format!("{}\n{}", rows::text(&table), rows::scenarios_text(&results));
    Target::Stdout.write(text.as_bytes())?;
    messages.say(&format!("\nwrote {} files to {}", files.len(), arguments.out.display()));
    if missed > 0 {
        messages.caution(&format!("{missed} of the bars are not met, marked NO"));
    }
    Ok(())
}
