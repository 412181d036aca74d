//! What a run reads: files, stdin, built-in vessels, scenarios and plans. Everything read is recorded with its SHA-256.
use super::host::Host;
use super::live::Live;
use super::message::Messages;
use super::output::command_line;
use crate::evaluation::judge::candidate::Registry;
use crate::evaluation::judge::plan::{self, Plan};
use crate::log::inspect::Inspector;
use crate::log::{LogError, LogOptions, LogReader, MemoryLog, is_parquet};
use crate::report::{Fingerprint, Input, Provenance};
use crate::thermal::ThermalError;
use crate::thermal::document::Presets;
use crate::thermal::scenario::{self, Scenario};
use crate::thermal::vessel::{self, Vessel, VesselSpec};
use anyhow::{Context, anyhow, bail};
use std::cell::{Cell, RefCell};
use std::fs::File;
use std::io::{Read, Seek};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// The inputs of a run.
#[derive(Default)]
pub(super) struct Inputs {
    /// What a caller brings instead of files.
    host: Host,
    records: RefCell<Vec<Input>>,
    /// Texts of the documents, which a report shows: names and texts.
    sources: RefCell<Vec<(String, String)>>,
    stdin_taken: Cell<bool>,
    /// The command line that outputs name; `None`: as it was typed.
    command: Option<String>,
}

/// A text, and what a message calls it.
struct Document {
    text: String,
    shown: String,
    built_in: bool,
}

impl Inputs {
    /// The inputs of a call from a program.
    pub(super) fn of(host: Host) -> Self {
        Self { host, ..Self::default() }
    }

    /// Inputs of a run whose outputs name another command line than the one that was typed.
    pub(super) fn of_command(command: String) -> Self {
        Self { command: Some(command), ..Self::default() }
    }

    /// Where the outputs of this run come from.
    pub(super) fn provenance(&self) -> Provenance {
        let of_call = Some(&self.host.command).filter(|command| !command.is_empty());
        let command = self.command.as_ref().or(of_call).cloned().unwrap_or_else(command_line);
        Provenance { command, inputs: self.records.borrow().clone(), seed: None }
    }

    /// Reads a file, or stdin for `-`.
    pub(super) fn read(&self, name: &str) -> anyhow::Result<String> {
        let bytes = if let Some(text) = self.host.document(name) {
            text.as_bytes().to_vec()
        } else if name == "-" {
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
        let text = String::from_utf8(bytes).ok();
        let text = text.with_context(|| format!("{name} is not UTF-8 text: save it as UTF-8"))?;
        self.sources.borrow_mut().push((shown(name), text.clone()));
        Ok(text)
    }

    /// Texts that were read, with their names; logs are not among them.
    pub(super) fn sources(&self) -> Vec<(String, String)> {
        self.sources.borrow().clone()
    }

    /// Records something that was read elsewhere.
    pub(super) fn record(&self, input: Input) {
        self.records.borrow_mut().push(input);
    }

    /// A vessel by file name, by built-in name, or from stdin.
    pub(super) fn vessel(&self, name: &str, messages: &Messages) -> anyhow::Result<Vessel> {
        Ok(self.vessel_specification(name, messages)?.1)
    }

    /// A vessel as of [`Inputs::vessel`] with the content of its file, and where it comes from.
    pub(super) fn vessel_specification(
        &self,
        name: &str,
        messages: &Messages,
    ) -> anyhow::Result<(VesselSpec, Vessel, Input)> {
        let document = self.document(name, &vessel::presets::FILES, "simulate")?;
        let read = vessel::read_specification(&document.text, &document.shown);
        let (specification, vessel) = read.map_err(|error| {
            let no_table = |_: &str| Err(std::io::ErrorKind::NotFound.into());
            let other = scenario::read_scenario(&document.text, &document.shown, &no_table).is_ok();
            misplaced(error, other, &document.shown, ["a scenario", "a vessel"])
        })?;
        vessel.doubts().iter().for_each(|doubt| messages.caution(doubt));
        let origin = self.records.borrow().last().cloned().context("what was read is recorded")?;
        Ok((specification, vessel, origin))
    }

    /// The record of something that was read by its name.
    pub(super) fn record_of(&self, name: &str) -> Option<Input> {
        self.records.borrow().iter().find(|record| record.name == name).cloned()
    }

    /// A scenario by file name, by built-in name, or from stdin; the tables it names lie beside it.
    pub(super) fn scenario(&self, name: &str) -> anyhow::Result<Scenario> {
        let document = self.document(name, &scenario::presets::FILES, "simulate")?;
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
        scenario::read_scenario(&document.text, &document.shown, &table).map_err(|error| {
            let other = vessel::read_specification(&document.text, &document.shown).is_ok();
            misplaced(error, other, &document.shown, ["a vessel", "a scenario"])
        })
    }

    /// A plan of the judge by file name, by built-in name, or from stdin; `left_out` as in `climate=desert`.
    pub(super) fn plan(&self, name: &str, left_out: &[String]) -> anyhow::Result<Plan> {
        let Document { text, shown, .. } = self.document(name, &plan::presets::FILES, "bench-detector")?;
        Ok(Plan::parse(&text, &shown, &Registry::default(), left_out)?)
    }

    /// Opens a log for reading row by row; - is stdin.
    pub(super) fn log(&self, name: &str, options: &LogOptions) -> anyhow::Result<LogInput> {
        if let Some(log) = self.host.take_log(name) {
            return self.memory_log(log, options);
        }
        let mut log = self.opened(name, false, |content, shown| log_reader(content, shown, options))?;
        self.stop_with_caller(&mut log.reader);
        Ok(log)
    }

    /// The log of a caller.
    fn memory_log(&self, log: MemoryLog, options: &LogOptions) -> anyhow::Result<LogInput> {
        let name = log.name.clone();
        self.records.borrow_mut().push(log.fingerprint());
        let mut reader = LogReader::from_memory(log, options)?;
        self.stop_with_caller(&mut reader);
        Ok(LogInput { reader, name, passed: Rc::default(), length: Some(0), live: None })
    }

    /// Whether the caller wants the run to end.
    pub(super) fn is_stopped(&self) -> bool {
        self.host.is_stopped()
    }

    fn stop_with_caller(&self, reader: &mut LogReader) {
        if let Some(stop) = self.host.stop.clone() {
            reader.stops_when(move || stop.borrow_mut()());
        }
    }

    /// The same for a log that may be written while it is read: a row from a pipe is there when it has come.
    pub(super) fn live_log(&self, name: &str, options: &LogOptions) -> anyhow::Result<LogInput> {
        if !self.host.command.is_empty() {
            return self.log(name, options);
        }
        let mut log = self.opened(name, true, |content, shown| log_reader(content, shown, options))?;
        if let Some(live) = log.live.clone() {
            log.reader.hands_out_while(move || live.is_waiting());
        }
        Ok(log)
    }

    /// The rows of a cylinder that were taken out of a log of several.
    pub(super) fn spooled_log(&self, spooled: &Spooled, options: &LogOptions) -> anyhow::Result<LogInput> {
        let name = &spooled.log.name;
        let open = |path: &Path| {
            File::open(path).with_context(|| format!("{name} cannot be read by cylinder: {}", path.display()))
        };
        self.records.borrow_mut().push(spooled.log.clone());
        let (text, rows) = (open(Path::new(name))?, open(&spooled.rows)?);
        let mut reader = LogReader::from_spool(text, Box::new(rows), name, options)?;
        self.stop_with_caller(&mut reader);
        let length = Some(spooled.length);
        Ok(LogInput { reader, name: name.clone(), passed: Rc::default(), length, live: None })
    }

    /// Opens a log for inspection; - is stdin.
    pub(super) fn inspector(&self, name: &str, options: &LogOptions) -> anyhow::Result<LogInput<Inspector>> {
        self.opened(name, false, |content, shown| match content {
            Content::Text(text) => Inspector::new(text, shown, options),
            Content::Parquet(file) => Inspector::of_parquet(file, shown, options),
        })
    }

    /// Opens a log. A file is hashed first and then read up to the length that it had, so that a logger may go on writing.
    /// What cannot be read twice is hashed on the way and recorded at its end.
    fn opened<R>(
        &self,
        name: &str,
        is_live: bool,
        reader: impl FnOnce(Content, &str) -> Result<R, LogError>,
    ) -> anyhow::Result<LogInput<R>> {
        if name == "-" {
            if self.stdin_taken.replace(true) {
                bail!("stdin can be read once: give the other input as a file");
            }
            return LogInput::of_pipe(std::io::stdin(), (name, "stdin"), is_live, reader);
        }
        let failed = || format!("{name} cannot be read");
        if let Some(kind) =
            NO_LOG.iter().find(|kind| name.to_ascii_lowercase().ends_with(&format!(".{kind}")))
        {
            bail!(
                "{name} is a {} file, and a log is wanted here: a table in CSV or Parquet",
                kind.to_uppercase()
            );
        }
        let mut file = File::open(name).with_context(failed)?;
        let metadata = file.metadata().with_context(failed)?;
        if metadata.is_dir() {
            bail!("{name} is a folder: name a file in it");
        }
        let name = name.to_owned();
        if !metadata.is_file() {
            return LogInput::of_pipe(file, (&name, &name), is_live, reader);
        }
        let passed = Rc::new(Passed::default());
        let (record, length) = hashed(&mut file, &name).with_context(failed)?;
        file.rewind().with_context(failed)?;
        self.records.borrow_mut().push(record);
        let content = if is_parquet(Path::new(&name)) {
            Content::Parquet(file)
        } else {
            Content::Text(Box::new(Metered {
                input: file.take(length),
                passed: passed.clone(),
                hashes: false,
            }))
        };
        let reader = reader(content, &name)?;
        Ok(LogInput { reader, name, passed, length: Some(length), live: None })
    }

    /// Records a log that was hashed on the way, when it has been read; `None` if it was recorded before.
    pub(super) fn record_log<R>(&self, log: &LogInput<R>) -> Option<Input> {
        if !log.is_hashed_late() {
            return None;
        }
        let record = log.passed.fingerprint.borrow().input(&log.name);
        self.records.borrow_mut().push(record.clone());
        Some(record)
    }

    /// A document by file name, by built-in name, or from stdin; `listed_by` is the command that lists the built-in ones.
    fn document(&self, name: &str, presets: &Presets, listed_by: &str) -> anyhow::Result<Document> {
        let path = Path::new(name);
        let is_given = self.host.document(name).is_some();
        if is_given || name == "-" || (path.exists() && !path.is_dir()) {
            return Ok(Document { text: self.read(name)?, shown: shown(name), built_in: false });
        }
        let text = presets.text(name).map_err(|_| unknown(name, presets, listed_by))?;
        let preset = format!("preset {name}");
        self.records.borrow_mut().push(Input::of(&preset, text.as_bytes()));
        self.sources.borrow_mut().push((preset, text.to_owned()));
        Ok(Document { text: text.to_owned(), shown: format!("preset {name}"), built_in: true })
    }
}

/// Endings of files that are no logs.
const NO_LOG: [&str; 4] = ["toml", "json", "html", "svg"];

fn log_reader(content: Content, shown: &str, options: &LogOptions) -> Result<LogReader, LogError> {
    match content {
        Content::Text(text) => LogReader::from_text(text, shown, options),
        Content::Parquet(file) => LogReader::from_parquet(file, shown, options),
    }
}

/// What a log is, by its name.
enum Content {
    Text(Box<dyn Read>),
    Parquet(File),
}

/// The rows of a cylinder, taken out of a log of several.
#[derive(Clone, Debug)]
pub(super) struct Spooled {
    /// The cylinder.
    pub cylinder: String,
    /// The log.
    pub log: Input,
    /// Its length, bytes.
    pub length: u64,
    /// File of the rows.
    pub rows: PathBuf,
}

/// A log that is being read.
pub(super) struct LogInput<R = LogReader> {
    /// Its rows.
    pub reader: R,
    name: String,
    passed: Rc<Passed>,
    /// Bytes, where they are known beforehand.
    length: Option<u64>,
    /// The pipe, where rows are wanted as they come.
    live: Option<Live>,
}

impl<R> LogInput<R> {
    /// A log that cannot be read twice, by its name and by what messages call it.
    fn of_pipe(
        input: impl Read + Send + 'static,
        (name, shown): (&str, &str),
        is_live: bool,
        reader: impl FnOnce(Content, &str) -> Result<R, LogError>,
    ) -> anyhow::Result<Self> {
        let passed = Rc::new(Passed::default());
        let (live, input): (Option<Live>, Box<dyn Read>) = if is_live {
            let live = Live::new(input)?;
            (Some(live.clone()), Box::new(live))
        } else {
            (None, Box::new(input))
        };
        let metered = Metered { input, passed: passed.clone(), hashes: true };
        let reader = reader(Content::Text(Box::new(metered)), shown)?;
        Ok(Self { reader, name: name.to_owned(), passed, length: None, live })
    }

    /// Whether its hash is known at its end only.
    pub(super) fn is_hashed_late(&self) -> bool {
        self.length.is_none()
    }

    /// Bytes, where they are known beforehand.
    pub(super) fn length(&self) -> Option<u64> {
        self.length
    }

    /// Share of the bytes that has been read, as they are in the file; 0 where the total is unknown.
    pub(super) fn fraction_of_bytes(&self) -> f64 {
        self.length.map_or(0.0, |length| self.passed.bytes.get() as f64 / length.max(1) as f64)
    }
}

impl LogInput {
    /// Share that has been read.
    pub(super) fn fraction(&self) -> f64 {
        self.reader.fraction().unwrap_or_else(|| self.fraction_of_bytes())
    }
}

/// What has passed through a [`Metered`] input.
#[derive(Default)]
struct Passed {
    bytes: Cell<u64>,
    fingerprint: RefCell<Fingerprint>,
}

/// An input that counts what is read from it, and hashes it where it cannot be read twice.
struct Metered<R> {
    input: R,
    passed: Rc<Passed>,
    hashes: bool,
}

impl<R: Read> Read for Metered<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.input.read(buffer)?;
        self.passed.bytes.set(self.passed.bytes.get() + count as u64);
        if self.hashes {
            self.passed.fingerprint.borrow_mut().update(&buffer[..count]);
        }
        Ok(count)
    }
}

/// Hash and length of an input, which is read to its end.
pub(super) fn hashed(input: &mut impl Read, name: &str) -> std::io::Result<(Input, u64)> {
    let mut fingerprint = Fingerprint::default();
    let mut piece = vec![0; 1 << 16];
    let mut length = 0;
    loop {
        let count = input.read(&mut piece)?;
        if count == 0 {
            break;
        }
        fingerprint.update(&piece[..count]);
        length += count as u64;
    }
    Ok((fingerprint.input(name), length))
}

/// What a message calls an input.
pub(super) fn shown(name: &str) -> String {
    if name == "-" { "stdin".to_owned() } else { name.to_owned() }
}

/// The error of a file, or that it is fine as something else and given in the wrong place.
fn misplaced(error: ThermalError, other: bool, shown: &str, [found, wanted]: [&str; 2]) -> anyhow::Error {
    if other { anyhow!("{shown} is {found}, and {wanted} is wanted here") } else { error.into() }
}

/// The error for a name that is neither that of a file nor of a preset.
fn unknown(name: &str, presets: &Presets, listed_by: &str) -> anyhow::Error {
    let kind = presets.kind;
    let stem = Path::new(name).file_stem().map_or(name.into(), |stem| stem.to_string_lossy());
    let likeness = |candidate: &str| strsim::jaro_winkler(&stem, candidate);
    let nearest = presets.names().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let nearest = nearest.map_or(String::new(), |nearest| format!(", the nearest is {nearest}"));
    anyhow!(
        "{name}: no such file, and no built-in {kind} is called so{nearest}: give the path of a TOML file, or a name \
         that `cylwatch {listed_by} --list` shows"
    )
}
