//! `cylwatch init`: start files to edit.
use super::arguments::InitArguments;
use super::message::Messages;
use super::output;
use anyhow::bail;
use cylwatch::thermal::{scenario, vessel};

/// Writes `vessel.toml` and `scenario.toml`; files that are there stay as they are.
pub fn run(arguments: InitArguments, messages: &Messages) -> anyhow::Result<()> {
    let folder = &arguments.folder;
    // Loading says which name is unknown, and which would be right.
    vessel::presets::load(&arguments.vessel)?;
    scenario::presets::load(&arguments.scenario)?;
    let vessel = vessel::presets::text(&arguments.vessel).unwrap_or_default();
    let scenario = scenario::presets::text(&arguments.scenario).unwrap_or_default();
    let files = [("vessel.toml", vessel), ("scenario.toml", scenario)];
    for (name, _) in &files {
        let path = folder.join(name);
        if path.symlink_metadata().is_ok() {
            bail!(
                "{} is there already and stays as it is: name another folder, or move it away",
                path.display()
            );
        }
    }
    output::make_folder(folder)?;
    for (name, text) in &files {
        output::write_new_file(&folder.join(name), text.as_bytes())?;
    }
    let [vessel, scenario] = files.map(|(name, _)| folder.join(name).display().to_string());
    messages.say(&format!(
        "wrote {vessel} and {scenario}; try: cylwatch simulate {vessel} {scenario} --plot run.svg -o run.csv"
    ));
    Ok(())
}
