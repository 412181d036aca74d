//! The file of vessels: a row for each cylinder.
use super::arguments::{FleetArguments, SAVE_EVERY};
use crate::cli::input::Inputs;
use crate::cli::message::Messages;
use crate::cli::monitor::{CylinderArguments, Options, Places};
use crate::cli::views::Views;
use crate::thermal::vessel;
use anyhow::{Context, anyhow, bail};
use clap::{Args, Command, FromArgMatches};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Columns that are no options.
const CYLINDER: &str = "cylinder";
const VESSEL: &str = "vessel";
/// Options whose value is a file.
const FILES: [&str; 3] = ["sensors", "commissioned", "learned-in"];
/// Options without a value.
const FLAGS: [&str; 1] = ["settled"];

/// What is known of a cylinder before its log is read.
#[derive(Clone, Debug)]
pub(super) struct Assigned {
    /// Line of the file; `None`: all cylinders have this vessel.
    pub line: Option<u64>,
    /// Vessel: a file or a built-in name.
    pub vessel: String,
    /// Options.
    pub arguments: CylinderArguments,
}

/// Vessels by the names of their cylinders.
pub(super) enum Vessels {
    /// All alike.
    Alike(Box<Assigned>),
    /// By name.
    Named(BTreeMap<String, Assigned>),
}

impl Vessels {
    /// Reads and checks what the options say.
    pub(super) fn read(fleet: &FleetArguments, inputs: &Inputs, messages: &Messages) -> anyhow::Result<Self> {
        let Some(path) = &fleet.vessels else {
            let vessel = fleet.vessel.clone().context("give --vessels or --vessel")?;
            let assigned = Assigned { line: None, vessel, arguments: fleet.cylinder.clone() };
            check(&assigned, fleet, inputs, messages)?;
            return Ok(Self::Alike(Box::new(assigned)));
        };
        let name = path.to_string_lossy();
        let text = inputs.read(&name)?;
        let named = parse(&text, &name, fleet)?;
        let mut checked: Vec<&Assigned> = Vec::new();
        for assigned in named.values() {
            let is_known = |other: &&Assigned| other.vessel == assigned.vessel;
            let place = || format!("{name}:{}", assigned.line.unwrap_or(1));
            if !checked.iter().any(is_known) {
                inputs.vessel(&assigned.vessel, messages).with_context(place)?;
                checked.push(assigned);
            }
            options(assigned, fleet)
                .map_err(|error| anyhow!("{}: {}", place(), as_columns(&format!("{error:#}"))))?;
        }
        Ok(Self::Named(named))
    }

    /// What is known of a cylinder.
    pub(super) fn of(&self, cylinder: &str) -> Option<&Assigned> {
        match self {
            Self::Alike(assigned) => Some(assigned),
            Self::Named(named) => named.get(cylinder),
        }
    }

    /// Names of all cylinders, where they are stated.
    pub(super) fn names(&self) -> impl Iterator<Item = (&String, &Assigned)> {
        match self {
            Self::Alike(_) => None,
            Self::Named(named) => Some(named.iter()),
        }
        .into_iter()
        .flatten()
    }
}

fn check(
    assigned: &Assigned,
    fleet: &FleetArguments,
    inputs: &Inputs,
    messages: &Messages,
) -> anyhow::Result<()> {
    if assigned.vessel == "-" {
        bail!("--vessel must be a file or a built-in name: it is read once for each cylinder");
    }
    inputs.vessel(&assigned.vessel, messages)?;
    options(assigned, fleet)
}

/// Finds out whether `monitor` takes the options.
fn options(assigned: &Assigned, fleet: &FleetArguments) -> anyhow::Result<()> {
    let places = Places { data: None, events: None, state: None, views: Views::default() };
    Options::of(fleet.of_monitor(&assigned.vessel, "", assigned.arguments.clone()), places)?;
    match assigned.arguments.files().find(|file| !file.is_file()) {
        Some(file) => {
            bail!("{} is no file: name one that is there, beside the file of vessels", file.display())
        }
        None => Ok(()),
    }
}

/// Options as columns call them.
pub(in crate::cli) fn as_columns(message: &str) -> String {
    let words = message.split(' ').map(|word| match word.strip_prefix("--") {
        Some(option) => option.replace('-', "_"),
        None => word.to_owned(),
    });
    words.collect::<Vec<_>>().join(" ")
}

/// The options that a row can give.
fn command() -> Command {
    CylinderArguments::augment_args(Command::new("row").no_binary_name(true).disable_help_flag(true))
}

fn parse(text: &str, file: &str, fleet: &FleetArguments) -> anyhow::Result<BTreeMap<String, Assigned>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text.lines().zip(1..);
    let first = lines.find(|(line, _)| !line.starts_with('#') && !line.trim().is_empty());
    let (first, at) = first.with_context(|| {
        format!("{file} is empty: write a header such as cylinder,vessel and a row for each cylinder")
    })?;
    let count = |separator: &u8| first.bytes().filter(|byte| byte == separator).count();
    let separator = [b'\t', b';', b','].into_iter().max_by_key(count).unwrap_or(b',');
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .delimiter(separator)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let header = reader.headers().with_context(|| format!("{file}: the header cannot be read"))?.clone();
    let columns = columns(&header).with_context(|| format!("{file}:{at}"))?;
    let mut named: BTreeMap<String, Assigned> = BTreeMap::new();
    for record in reader.records() {
        let record = record.map_err(|error| unreadable(file, &error))?;
        let line = record.position().map_or(0, csv::Position::line);
        if record.iter().all(str::is_empty) {
            continue;
        }
        let place = || format!("{file}:{line}");
        let row =
            Row { record: &record, columns: &columns, folder: folder_of(file), comma: separator != b',' };
        let (name, assigned) = row.assigned(line, fleet).with_context(place)?;
        if let Some(first) = named.get(&name) {
            let first = first.line.unwrap_or(1);
            bail!("{}: cylinder {name} stands in line {first} already: keep one of the rows", place());
        }
        named.insert(name, assigned);
    }
    if named.is_empty() {
        bail!("{file}: there is no cylinder below the header: write a row for each");
    }
    Ok(named)
}

/// A vessel as a file of a folder names it: a file beside it, or a built-in name.
pub(in crate::cli) fn vessel_beside(folder: &Path, vessel: &str) -> String {
    let beside = folder.join(vessel);
    let is_preset = vessel::presets::FILES.text(vessel).is_ok();
    match beside.is_file() || !is_preset {
        true => beside.to_string_lossy().into_owned(),
        false => vessel.to_owned(),
    }
}

fn folder_of(file: &str) -> &Path {
    Path::new(file).parent().unwrap_or(Path::new(""))
}

fn unreadable(file: &str, error: &csv::Error) -> anyhow::Error {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { pos, expected_len, len } => {
            let line = pos.as_ref().map_or(0, csv::Position::line);
            anyhow!(
                "{file}:{line}: the row has {len} cells where the header has {expected_len}: complete it, and quote \
                 cells that contain the separator"
            )
        }
        _ => anyhow!("{file}: {error}"),
    }
}

/// Checks the names of the columns; each as `cylinder`, `vessel` or the name of an option.
fn columns(header: &csv::StringRecord) -> anyhow::Result<Vec<String>> {
    let command = command();
    let options: Vec<&str> = command.get_arguments().filter_map(clap::Arg::get_long).collect();
    let mut columns: Vec<String> = Vec::new();
    for column in header {
        let name = column.to_ascii_lowercase().replace('_', "-");
        if columns.contains(&name) {
            bail!("column {column} stands there twice: keep one of them");
        }
        let is_known = [CYLINDER, VESSEL].contains(&name.as_str())
            || (options.contains(&name.as_str()) && !name.starts_with(SAVE_EVERY));
        if !is_known {
            // Of a quantity the usual unit alone.
            let usual = command.get_arguments().filter(|arg| !arg.is_hide_set());
            let known = [CYLINDER, VESSEL].into_iter().chain(usual.filter_map(clap::Arg::get_long));
            let likeness = |known: &&str| strsim::jaro_winkler(known, &name);
            let nearest = known.max_by(|a, b| likeness(a).total_cmp(&likeness(b))).unwrap_or(CYLINDER);
            let nearest = nearest.replace('-', "_");
            bail!(
                "column {column:?} is unknown, the nearest is {nearest}: the columns are cylinder, vessel and options of \
                 `cylwatch monitor` with their unit, as fill_pressure_bar; remove it or rename it"
            );
        }
        columns.push(name);
    }
    for needed in [CYLINDER, VESSEL] {
        if !columns.iter().any(|name| name == needed) {
            bail!("there is no column {needed}: the header names cylinder and vessel at least");
        }
    }
    Ok(columns)
}

/// A row of the file.
struct Row<'a> {
    record: &'a csv::StringRecord,
    columns: &'a [String],
    /// Where files are looked for.
    folder: &'a Path,
    /// Whether numbers may have a decimal comma.
    comma: bool,
}

impl Row<'_> {
    fn assigned(&self, line: u64, fleet: &FleetArguments) -> anyhow::Result<(String, Assigned)> {
        let cell = |of: &str| {
            let index = self.columns.iter().position(|name| name == of);
            index.and_then(|index| self.record.get(index)).unwrap_or_default()
        };
        let (name, vessel) = (cell(CYLINDER).to_owned(), cell(VESSEL));
        if name.is_empty() {
            bail!("cylinder is empty: write its name, or leave the row out");
        }
        if vessel.is_empty() || vessel == "-" {
            bail!("vessel of {name} is {vessel:?}: write a TOML file or the name of a built-in vessel");
        }
        let vessel = vessel_beside(self.folder, vessel);
        let arguments = self.arguments()?.or(&fleet.cylinder);
        Ok((name, Assigned { line: Some(line), vessel, arguments }))
    }

    /// The cells as options.
    fn arguments(&self) -> anyhow::Result<CylinderArguments> {
        let mut words: Vec<String> = Vec::new();
        for (column, cell) in self.columns.iter().zip(self.record) {
            if cell.is_empty() || [CYLINDER, VESSEL].contains(&column.as_str()) {
                continue;
            }
            if FLAGS.contains(&column.as_str()) {
                match cell.to_ascii_lowercase().as_str() {
                    "yes" | "true" | "1" => words.push(format!("--{column}")),
                    "no" | "false" | "0" => {}
                    _ => bail!("{} = {cell} must be yes or no", column.replace('-', "_")),
                }
                continue;
            }
            let with_point = cell.replace(',', ".");
            let value = match self.comma && with_point.parse::<f64>().is_ok() {
                true => with_point,
                false if FILES.contains(&column.as_str()) => {
                    self.folder.join(cell).to_string_lossy().into_owned()
                }
                false => cell.to_owned(),
            };
            words.push(format!("--{column}={value}"));
        }
        let matches = command().try_get_matches_from(words);
        let arguments = matches.and_then(|matches| CylinderArguments::from_arg_matches(&matches));
        arguments.map_err(|error| {
            let text = error.to_string();
            let text = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
            anyhow!("{}", as_columns(&text))
        })
    }
}

/// Whether both are one file or folder that is there.
pub(super) fn is_same(a: &Path, b: &Path) -> bool {
    let whole = |path: &Path| -> Option<PathBuf> { path.canonicalize().ok() };
    whole(a).is_some_and(|a| whole(b) == Some(a))
}
