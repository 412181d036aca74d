//! `cylwatch init`: start files to edit.
use super::message::Messages;
use super::output;
use crate::thermal::{scenario, vessel};
use anyhow::bail;
use clap::Args;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Arguments of `init`.
#[derive(Debug, Args)]
pub(super) struct InitArguments {
    /// Folder for the files; it is made if it is not there. Files that are there are not overwritten.
    #[arg(value_name = "DIR", default_value = ".")]
    pub folder: PathBuf,
    /// Built-in vessel to start from.
    #[arg(long, default_value = "nitrogen-20l")]
    pub vessel: String,
    /// Built-in scenario to start from.
    #[arg(long, default_value = "shock-cold")]
    pub scenario: String,
}

/// Writes `vessel.toml`, `scenario.toml` and the tables it names; files that are there stay as they are.
pub(super) fn run(arguments: InitArguments, messages: &Messages) -> anyhow::Result<()> {
    let folder = &arguments.folder;
    let vessel = vessel::presets::FILES.text(&arguments.vessel)?;
    let scenario = scenario::presets::FILES.text(&arguments.scenario)?;
    let mut files = tables(scenario)?;
    files.insert("vessel.toml".into(), vessel.into());
    files.insert("scenario.toml".into(), scenario.into());
    for name in files.keys() {
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
    let path = |name: &str| folder.join(name).display().to_string();
    let written: Vec<String> = files.keys().map(|name| path(name)).collect();
    messages.say(&format!(
        "wrote {}; try: cylwatch simulate {} {} --plot run.svg -o run.csv",
        written.join(", "),
        path("vessel.toml"),
        path("scenario.toml")
    ));
    Ok(())
}

/// The tables that a built-in scenario names, by file name.
fn tables(scenario: &str) -> anyhow::Result<BTreeMap<String, String>> {
    let read = RefCell::new(BTreeMap::new());
    let table = |file: &str| {
        let text = scenario::presets::table(file)?;
        read.borrow_mut().insert(file.to_owned(), text.clone());
        Ok(text)
    };
    scenario::read_scenario(scenario, "scenario.toml", &table)?;
    Ok(read.into_inner())
}
