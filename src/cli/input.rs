//! What a run reads: files, stdin, built-in vessels and scenarios. Everything read is recorded with its SHA-256.
use super::command_line;
use anyhow::{Context, bail};
use cylwatch::report::{Input, Provenance};
use cylwatch::thermal::scenario::{self, Scenario};
use cylwatch::thermal::vessel::{self, Vessel};
use std::cell::{Cell, RefCell};
use std::io::Read;
use std::path::Path;

/// The inputs of a run.
#[derive(Debug, Default)]
pub struct Inputs {
    records: RefCell<Vec<Input>>,
    stdin_taken: Cell<bool>,
}

/// A text, and what a message calls it.
struct Document {
    text: String,
    shown: String,
    built_in: bool,
}

impl Inputs {
    /// Where the outputs of this run come from.
    pub fn provenance(&self) -> Provenance {
        Provenance { command: command_line(), inputs: self.records.borrow().clone(), seed: None }
    }

    /// Reads a file, or stdin for `-`.
    pub fn read(&self, name: &str) -> anyhow::Result<String> {
        let bytes = if name == "-" {
            if self.stdin_taken.replace(true) {
                bail!("stdin can be read once: give the other input as a file");
            }
            let mut bytes = Vec::new();
            std::io::stdin().lock().read_to_end(&mut bytes).context("stdin cannot be read")?;
            bytes
        } else {
            std::fs::read(name).with_context(|| format!("{name} cannot be read"))?
        };
        self.records.borrow_mut().push(Input::of(name, &bytes));
        String::from_utf8(bytes).ok().with_context(|| format!("{name} is not UTF-8 text: save it as UTF-8"))
    }

    /// A vessel by file name, by built-in name, or from stdin.
    pub fn vessel(&self, name: &str) -> anyhow::Result<Vessel> {
        let document =
            self.document("vessel", name, vessel::presets::text, vessel::presets::names().collect())?;
        Ok(vessel::read_vessel(&document.text, &document.shown)?)
    }

    /// A scenario by file name, by built-in name, or from stdin; the tables it names lie beside it.
    pub fn scenario(&self, name: &str) -> anyhow::Result<Scenario> {
        let document =
            self.document("scenario", name, scenario::presets::text, scenario::presets::names().collect())?;
        if document.built_in {
            let table = |file: &str| {
                let text = scenario::presets::table(file)?;
                self.records.borrow_mut().push(Input::of(format!("preset {file}"), text.as_bytes()));
                Ok(text)
            };
            return Ok(scenario::read_scenario(&document.text, &document.shown, &table)?);
        }
        let folder = Path::new(name).parent().unwrap_or(Path::new("")).to_path_buf();
        let table = |file: &str| {
            let path = folder.join(file);
            let bytes = std::fs::read(&path)?;
            self.records.borrow_mut().push(Input::of(path.display().to_string(), &bytes));
            String::from_utf8(bytes).map_err(|_| {
                std::io::Error::new(std::io::ErrorKind::InvalidData, "it is not UTF-8 text: save it as UTF-8")
            })
        };
        Ok(scenario::read_scenario(&document.text, &document.shown, &table)?)
    }

    fn document(
        &self,
        kind: &str,
        name: &str,
        preset: fn(&str) -> Option<&'static str>,
        known: Vec<&'static str>,
    ) -> anyhow::Result<Document> {
        let path = Path::new(name);
        if name == "-" || (path.exists() && !path.is_dir()) {
            let shown = if name == "-" { "stdin".to_owned() } else { name.to_owned() };
            return Ok(Document { text: self.read(name)?, shown, built_in: false });
        }
        let Some(text) = preset(name) else { bail!("{}", neither(kind, name, &known)) };
        self.records.borrow_mut().push(Input::of(format!("preset {name}"), text.as_bytes()));
        Ok(Document { text: text.to_owned(), shown: format!("preset {name}"), built_in: true })
    }
}

/// The message for a name that is neither a file nor built in.
fn neither(kind: &str, name: &str, known: &[&str]) -> String {
    let stem = Path::new(name).file_stem().map_or(name.into(), |stem| stem.to_string_lossy());
    let likeness = |candidate: &str| strsim::jaro_winkler(&stem, candidate);
    let nearest = known.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let nearest = nearest.map_or(String::new(), |nearest| format!(", the nearest is {nearest}"));
    format!(
        "{name} is neither a {kind} file nor a built-in {kind}{nearest}: give the path of a TOML file, or a name \
         that `cylwatch simulate --list` shows"
    )
}
