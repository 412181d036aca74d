//! From a message to a row: topic to cylinder, payload to time and readings. Nothing here reads a clock or a file.
mod protobuf;
pub(super) mod sparkplug;

use super::document::{PayloadFormat, TimeForm};
use jiff::Timestamp;
use serde_json::Value;
use std::collections::HashMap;

/// Longest name of a cylinder, bytes.
const LONGEST_NAME: usize = 128;
/// Last level of the topic by which alarms are acknowledged.
const ACKNOWLEDGE: &str = "acknowledge";

/// A row that can go to a monitor.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Accepted {
    /// Time since 1970 in UTC, ns.
    pub time_ns: i64,
    /// Readings in the order of the configuration; NaN: missing.
    pub cells: Vec<f64>,
}

/// Why a message is left out; each has a count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Refusal {
    UnknownTopic,
    TooManyCylinders,
    TooLarge,
    NoJson,
    NoSparkplug,
    NoTime,
    NoNumber,
    NoReading,
    /// More rows than a cylinder may send.
    TooFast,
    /// The monitor does not take it.
    Monitor,
    /// The broker has delivered it before.
    Again,
}

impl Refusal {
    /// In words.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::UnknownTopic => "its topic belongs to no cylinder",
            Self::TooManyCylinders => "there are as many cylinders as the configuration allows",
            Self::TooLarge => "it is larger than message_bytes",
            Self::NoJson => "it is no JSON",
            Self::NoSparkplug => "it is no Sparkplug B payload",
            Self::NoTime => "it has no time of the stated form",
            Self::NoNumber => "a reading is no number",
            Self::NoReading => "it has none of the readings",
            Self::TooFast => "its cylinder sends more than rows_a_minute",
            Self::Monitor => "the monitor does not take it",
            Self::Again => "it was delivered before",
        }
    }
}

/// A reading and its place in a message.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reading {
    /// Name of a column, with its unit.
    pub name: String,
    /// JSON pointer, or name of the metric.
    pub at: String,
}

/// A topic whose level `+` is the name of a cylinder.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pattern {
    before: String,
    after: String,
    /// Most cylinders that come by it.
    pub most: usize,
}

/// What a topic is for.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Addressed<'a> {
    /// Rows of a cylinder of the configuration.
    Named(&'a str),
    /// Rows of a cylinder that the pattern names.
    ByPattern(&'a str),
    /// Acknowledgement of the alarms of a cylinder.
    Acknowledge(&'a str),
}

/// Topics and payloads.
pub(super) struct Mapping {
    pub format: PayloadFormat,
    /// Names by topics, or by `GROUP/NODE/DEVICE`.
    pub topics: HashMap<String, String>,
    pub pattern: Option<Pattern>,
    /// JSON pointer of the time.
    pub time: String,
    pub form: TimeForm,
    pub readings: Vec<Reading>,
    /// Largest payload, bytes.
    pub message_bytes: usize,
    /// What results are published below.
    pub prefix: String,
}

/// Whether a topic has wildcards.
pub(super) fn has_filter(topic: &str) -> bool {
    topic.contains(['+', '#', '\0'])
}

/// Whether a name can be a level of a topic.
pub(super) fn is_level(name: &str) -> bool {
    !name.is_empty()
        && name.len() <= LONGEST_NAME
        && !has_filter(name)
        && !name.contains('/')
        && !name.chars().any(char::is_control)
}

impl Pattern {
    /// Of a filter with one level `+`.
    pub(super) fn of(filter: &str, most: usize) -> Option<Self> {
        let levels: Vec<&str> = filter.split('/').collect();
        let at = levels.iter().position(|level| *level == "+")?;
        let (before, after) = (levels[..at].join("/"), levels[at + 1..].join("/"));
        let (before, after) = match (at, at + 1 == levels.len()) {
            (0, true) => (before, after),
            (0, false) => (before, format!("/{after}")),
            (_, true) => (format!("{before}/"), after),
            (_, false) => (format!("{before}/"), format!("/{after}")),
        };
        (!has_filter(&before) && !has_filter(&after)).then_some(Self { before, after, most })
    }

    /// The name of the cylinder of a topic.
    fn name<'a>(&self, topic: &'a str) -> Option<&'a str> {
        let name = topic.strip_prefix(&self.before)?.strip_suffix(self.after.as_str())?;
        is_level(name).then_some(name)
    }

    /// The topic of a cylinder.
    fn topic(&self, name: &str) -> Option<String> {
        is_level(name).then(|| format!("{}{name}{}", self.before, self.after))
    }

    /// As a filter.
    fn filter(&self) -> String {
        format!("{}+{}", self.before, self.after)
    }
}

impl Mapping {
    /// The topics to subscribe to: a topic that a pattern covers is not delivered twice.
    pub(super) fn filters(&self) -> Vec<String> {
        let covered =
            |topic: &str| self.pattern.as_ref().is_some_and(|pattern| pattern.name(topic).is_some());
        let mut filters: Vec<String> = self.topics.keys().filter(|topic| !covered(topic)).cloned().collect();
        filters.extend(self.pattern.as_ref().map(Pattern::filter));
        if self.format == PayloadFormat::SparkplugB {
            filters.iter_mut().for_each(|place| *place = sparkplug::filter(place));
        }
        filters.push(format!("{}/+/{ACKNOWLEDGE}", self.prefix));
        filters.sort();
        filters.dedup();
        filters
    }

    /// What a topic is for, or a place of Sparkplug; `None`: for nothing here.
    pub(super) fn addressed<'a>(&'a self, topic: &'a str) -> Option<Addressed<'a>> {
        if let Some(name) = self.topics.get(topic) {
            return Some(Addressed::Named(name));
        }
        let own = topic.strip_prefix(&self.prefix).and_then(|rest| rest.strip_prefix('/'));
        if let Some((name, ACKNOWLEDGE)) = own.and_then(|rest| rest.rsplit_once('/')) {
            return is_level(name).then_some(Addressed::Acknowledge(name));
        }
        self.pattern.as_ref()?.name(topic).map(Addressed::ByPattern)
    }

    /// The topic of a cylinder; `None`: there is none, or it is another cylinder's.
    pub(super) fn topic(&self, name: &str) -> Option<String> {
        if let Some((topic, _)) = self.topics.iter().find(|(_, of)| *of == name) {
            return Some(topic.clone());
        }
        self.pattern.as_ref()?.topic(name).filter(|topic| !self.topics.contains_key(topic))
    }

    /// The row of a payload that came at a time, ns since 1970.
    pub(super) fn row(&self, payload: &[u8], arrival_ns: i64) -> Result<Accepted, Refusal> {
        if payload.len() > self.message_bytes {
            return Err(Refusal::TooLarge);
        }
        let message: Value = serde_json::from_slice(payload).map_err(|_| Refusal::NoJson)?;
        let time_ns = match self.form {
            TimeForm::Arrival => arrival_ns,
            form => {
                message.pointer(&self.time).and_then(|time| instant(time, form)).ok_or(Refusal::NoTime)?
            }
        };
        let cells: Vec<f64> = self
            .readings
            .iter()
            .map(|reading| match message.pointer(&reading.at) {
                None | Some(Value::Null) => Ok(f64::NAN),
                Some(Value::Number(number)) => number.as_f64().ok_or(Refusal::NoNumber),
                Some(_) => Err(Refusal::NoNumber),
            })
            .collect::<Result<_, _>>()?;
        match cells.iter().all(|cell| cell.is_nan()) {
            true => Err(Refusal::NoReading),
            false => Ok(Accepted { time_ns, cells }),
        }
    }
}

/// Time since 1970 in UTC, ns.
fn instant(time: &Value, form: TimeForm) -> Option<i64> {
    let micros = |per_unit: f64| {
        let scaled = (time.as_f64()? * per_unit).round();
        // A float counts microseconds exactly until the year 2255.
        (scaled.abs() < 9e15).then_some(scaled as i64)
    };
    let stamp = match form {
        TimeForm::Rfc3339 => time.as_str()?.parse::<Timestamp>().ok()?,
        TimeForm::Seconds => Timestamp::from_microsecond(micros(1e6)?).ok()?,
        TimeForm::Milliseconds => Timestamp::from_microsecond(micros(1e3)?).ok()?,
        TimeForm::Arrival => return None,
    };
    i64::try_from(stamp.as_nanosecond()).ok()
}

#[cfg(test)]
mod hostile;
#[cfg(test)]
mod tests;
