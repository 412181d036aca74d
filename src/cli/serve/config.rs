//! Settings from the configuration, checked: whatever is wrong with it is told before the broker is called.
mod assigned;
mod broker;
mod certificate;
mod page;
mod payload;
mod secret;
mod tls;

use super::document::Document;
use super::mapping::{Mapping, Pattern, has_filter, is_level};
use crate::thermal::ThermalError;
use crate::thermal::document::{self, Places, check};
use anyhow::{Context, bail};
pub(super) use assigned::Assigned;
pub(super) use broker::Broker;
pub(super) use page::{Page, Token};
use serde_json::Value;
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::time::Duration;
pub(super) use tls::Tls;

/// All that the gateway is told.
pub(super) struct Settings {
    /// Folder of states and journal.
    pub folder: PathBuf,
    pub save_every: Duration,
    pub mapping: Mapping,
    /// Calls of `monitor` by the names of the cylinders.
    pub named: BTreeMap<String, Assigned>,
    /// Call for cylinders of the pattern.
    pub by_pattern: Option<Assigned>,
    /// What results are published below.
    pub prefix: String,
    /// Most cylinders.
    pub cylinders: usize,
    /// `None`: nothing listens.
    pub page: Option<Page>,
    /// Most rows of a cylinder.
    pub rows_a_minute: u32,
}

/// Largest payload that a configuration may allow, bytes: [`link`](super::link) holds many.
const MESSAGE_BYTES: u32 = 1 << 20;

/// Without a row for so long a cylinder is silent, unless the configuration says otherwise, s.
const SILENT_AFTER_S: f64 = 3600.0;

/// The file while it is checked.
struct Checked<'a> {
    places: &'a Places,
    folder: &'a Path,
}

impl Checked<'_> {
    fn refuse<T>(&self, path: &str, value: &str, bound: &str, remedy: &str) -> anyhow::Result<T> {
        Err(self.places.locate(check::broken(path, value, bound, remedy)).into())
    }

    /// File and line of a path.
    fn at(&self, path: &str) -> String {
        match self.places.locate(check::broken(path, "", "", "")) {
            ThermalError::Document { file, line, .. } => format!("{file}:{line}"),
            other => other.to_string(),
        }
    }

    /// An option of the command line, in the unit in which it is written: states name it.
    fn word(&self, path: &str, value: &Value) -> Option<String> {
        let (key, text) = self.places.written(path)?;
        let option = key.replace('_', "-");
        match value {
            Value::Null | Value::Bool(false) => None,
            Value::Bool(true) => Some(format!("--{option}")),
            Value::String(file) => Some(format!("--{option}={}", self.folder.join(file).display())),
            // A number of TOML may be grouped.
            _ => Some(format!("--{option}={}", text.replace('_', ""))),
        }
    }

    /// When a cylinder is silent.
    fn silent_after(&self, path: &str, given: Option<f64>, usual: f64) -> anyhow::Result<Duration> {
        self.seconds(path, given, usual, (1.0, 400.0 * 86_400.0))
    }

    /// A number from 1 on.
    fn count(&self, path: &str, given: Option<u32>, usual: u32, most: u32) -> anyhow::Result<u32> {
        let value = given.unwrap_or(usual);
        if (1..=most).contains(&value) {
            return Ok(value);
        }
        self.refuse(path, &value.to_string(), &format!("between 1 and {most}"), "another number")
    }

    /// A time within bounds.
    fn seconds(
        &self,
        path: &str,
        given: Option<f64>,
        usual: f64,
        range: (f64, f64),
    ) -> anyhow::Result<Duration> {
        let value = given.unwrap_or(usual);
        if (range.0..=range.1).contains(&value) {
            return Ok(Duration::from_secs_f64(value));
        }
        self.refuse(
            path,
            &value.to_string(),
            &format!("between {} s and {} s", range.0, range.1),
            "another time",
        )
    }
}

/// Reads and checks a configuration.
///
/// # Errors
/// Names file, line, value, bound and remedy.
pub(super) fn read(path: &Path) -> anyhow::Result<(Settings, Broker)> {
    let file = path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(|| format!("{file} cannot be read"))?;
    let (document, places) = document::read::<Document>(&text, &file)?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let checked = Checked { places: &places, folder: &folder };
    let settings = settings(&document, &checked)?;
    let broker = checked.broker(document.broker, settings.mapping.message_bytes)?;
    Ok((settings, broker))
}

fn settings(document: &Document, checked: &Checked<'_>) -> anyhow::Result<Settings> {
    let limit = document.limits.cylinders.unwrap_or(10_000) as usize;
    let message_bytes =
        checked.count("limits.message_bytes", document.limits.message_bytes, 65_536, MESSAGE_BYTES)? as usize;
    let rows_a_minute =
        checked.count("limits.rows_a_minute", document.limits.rows_a_minute, 600, 1_000_000)?;
    let prefix = document.publish.prefix.clone().unwrap_or_else(|| "cylwatch".to_owned());
    if prefix.is_empty() || has_filter(&prefix) || prefix.starts_with('$') {
        checked.refuse("publish.prefix", &prefix, "a topic without + and #", "cylwatch is usual")?;
    }
    if document.cylinder.len() > limit {
        let count = document.cylinder.len();
        checked.refuse(
            "limits.cylinders",
            &limit.to_string(),
            &format!("at least {count}, the cylinders of this file"),
            "raise it",
        )?;
    }
    let readings = checked.readings(&document.payload)?;
    let names: Vec<String> = readings.iter().map(|reading| reading.name.clone()).collect();
    let types = types(document, &names, checked)?;
    let kind = |path: String, name: &str| match types.get(name) {
        Some(index) => Ok((format!("type[{index}].options"), &document.types[*index])),
        None => Err(checked.places.locate(check_unknown(&path, name, types.keys()))),
    };
    let format = document.payload.format.unwrap_or_default();
    let (mut named, mut topics) = (BTreeMap::new(), HashMap::new());
    for (i, cylinder) in document.cylinder.iter().enumerate() {
        let path = |key: &str| format!("cylinder[{i}].{key}");
        if !is_level(&cylinder.name) {
            checked.refuse(
                &path("name"),
                &cylinder.name,
                "one level of a topic",
                "leave out /, + and #, and at most 128 bytes",
            )?;
        }
        checked.place(format, &path("topic"), &cylinder.topic)?;
        if cylinder.topic.is_empty() || has_filter(&cylinder.topic) {
            checked.refuse(
                &path("topic"),
                &cylinder.topic,
                "a topic without + and #",
                "a [pattern] has them",
            )?;
        }
        let (of_kind, kind) = kind(path("type"), &cylinder.kind)?;
        let usual_s = kind.silent_after_s.unwrap_or(SILENT_AFTER_S);
        let silent_after = checked.silent_after(&path("silent_after_s"), cylinder.silent_after_s, usual_s)?;
        let tables = [(of_kind, &kind.options), (path("options"), &cylinder.options)];
        let assigned = Assigned::new(&kind.vessel, &tables, silent_after, checked)?;
        assigned
            .monitor()
            .and_then(|steps| steps.check(&names))
            .with_context(|| checked.at(&path("options")))?;
        if named.insert(cylinder.name.clone(), assigned).is_some() {
            checked.refuse(
                &path("name"),
                &cylinder.name,
                "the name of one cylinder",
                "it stands there twice",
            )?;
        }
        if topics.insert(cylinder.topic.clone(), cylinder.name.clone()).is_some() {
            checked.refuse(
                &path("topic"),
                &cylinder.topic,
                "the topic of one cylinder",
                "it stands there twice",
            )?;
        }
    }
    let (mut pattern, mut by_pattern) = (None, None);
    if let Some(table) = &document.pattern {
        checked.place(format, "pattern.topic", &table.topic)?;
        pattern = Pattern::of(&table.topic, table.most as usize);
        if pattern.is_none() {
            let bound = "a topic with one level +, the name of a cylinder";
            checked.refuse("pattern.topic", &table.topic, bound, "leave out #")?;
        }
        let (path, kind) = kind("pattern.type".to_owned(), &table.kind)?;
        let silent_after =
            checked.silent_after("type.silent_after_s", kind.silent_after_s, SILENT_AFTER_S)?;
        by_pattern = Some(Assigned::new(&kind.vessel, &[(path, &kind.options)], silent_after, checked)?);
    }
    if named.is_empty() && pattern.is_none() {
        bail!("{}: there is no cylinder: write a [[cylinder]] for each, or a [pattern]", checked.at(""));
    }
    let folder = checked.folder.join(&document.store.folder);
    let save_every =
        checked.seconds("store.save_every_s", document.store.save_every_s, 600.0, (1.0, 86_400.0))?;
    Ok(Settings {
        folder,
        save_every,
        mapping: Mapping {
            format,
            topics,
            pattern,
            time: document.payload.time.clone().unwrap_or_default(),
            form: document.payload.clock.unwrap_or_default(),
            readings,
            message_bytes,
            prefix: prefix.clone(),
        },
        named,
        by_pattern,
        prefix,
        cylinders: limit,
        page: document.page.as_ref().map(|table| checked.page(table)).transpose()?,
        rows_a_minute,
    })
}

/// The types by their names, each with a vessel, options and readings that a monitor takes.
fn types(
    document: &Document,
    names: &[String],
    checked: &Checked<'_>,
) -> anyhow::Result<BTreeMap<String, usize>> {
    let mut types = BTreeMap::new();
    for (i, kind) in document.types.iter().enumerate() {
        let path = format!("type[{i}].name");
        let options = (format!("type[{i}].options"), &kind.options);
        let silent_after = checked.silent_after(
            &format!("type[{i}].silent_after_s"),
            kind.silent_after_s,
            SILENT_AFTER_S,
        )?;
        let assigned = Assigned::new(&kind.vessel, &[options], silent_after, checked)?;
        assigned.monitor().and_then(|steps| steps.check(names)).with_context(|| checked.at(&path))?;
        if types.insert(kind.name.clone(), i).is_some() {
            checked.refuse(&path, &kind.name, "the name of one type", "it stands there twice")?;
        }
    }
    Ok(types)
}

fn check_unknown<'a>(path: &str, name: &str, known: impl Iterator<Item = &'a String>) -> ThermalError {
    let known: Vec<&str> = known.map(String::as_str).collect();
    check::broken(path, name, &format!("one of {}", known.join(", ")), "it is the name of a [[type]]")
}
