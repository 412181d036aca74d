//! Sparkplug B: births name the metrics of a device, data brings what has changed, and a death ends what a birth said.
//!
//! # From metrics to rows
//! Metrics of one message with the same time are a row; other times are other rows, in their order. A reading that a message does not have is
//! missing in its row and is not held over from an earlier one: a value that is held looks like a sensor that stands still, and it says no
//! more than its own row did. Null, and the quality *bad* or *stale*, are missing as well.
//!
//! # Births
//! A birth gives each alias its metric. Data of a device without a birth, with an alias that its birth does not have, or after a gap in the
//! numbers of the node's messages may be misread: what it names is taken, and the node is asked for a rebirth, once in [`REBIRTH_PAUSE`].
//! A death of another session (another `bdSeq`) is passed over.
//!
//! Source: Eclipse Sparkplug 3.0.0, chapters 4 (topics), 5 (sessions), 6 (payloads).
use super::protobuf::{Metric, Payload, Value};
use super::{Accepted, Mapping, Refusal};
use prost::Message;
use std::collections::{BTreeMap, HashMap};
use std::time::{Duration, Instant};

/// First level of all topics.
const NAMESPACE: &str = "spBv1.0";
/// Between two requests to a node.
const REBIRTH_PAUSE: Duration = Duration::from_secs(60);
/// Metric that numbers the sessions of a node.
const SESSION: &str = "bdSeq";
/// Metric that asks a node for its births.
const REBIRTH: &str = "Node Control/Rebirth";
/// Property that says whether a value can be used, and the value that says so (OPC UA's good).
const QUALITY: (&str, u64) = ("Quality", 192);
/// Type of a truth value.
const BOOLEAN: u32 = 11;
/// Numbers of the messages of a node begin again after this one.
const LAST_SEQ: u64 = 255;

/// What a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Birth,
    Data,
    Death,
}

/// Where a message comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::cli::serve) struct Origin<'a> {
    kind: Kind,
    group: &'a str,
    node: &'a str,
    device: Option<&'a str>,
}

impl<'a> Origin<'a> {
    /// Of a topic; `None`: it is none of births, data and deaths.
    pub(in crate::cli::serve) fn of(topic: &'a str) -> Option<Self> {
        let levels: Vec<&str> = topic.split('/').collect();
        let (kind, group, node, device) = match levels[..] {
            [NAMESPACE, group, kind, node] => (kind.strip_prefix('N')?, group, node, None),
            [NAMESPACE, group, kind, node, device] => (kind.strip_prefix('D')?, group, node, Some(device)),
            _ => return None,
        };
        let kind = match kind {
            "BIRTH" => Kind::Birth,
            "DATA" => Kind::Data,
            "DEATH" => Kind::Death,
            _ => return None,
        };
        Some(Self { kind, group, node, device })
    }

    /// Whether values may be told once more, with the times that they had.
    pub(in crate::cli::serve) fn is_birth(&self) -> bool {
        self.kind == Kind::Birth
    }

    /// As the configuration names it: `GROUP/NODE`, and `/DEVICE` if it is one.
    pub(in crate::cli::serve) fn place(&self) -> String {
        let device = self.device.map_or(String::new(), |device| format!("/{device}"));
        format!("{}/{}{device}", self.group, self.node)
    }
}

/// Whether a topic is one of Sparkplug's; commands are among them, and the gateway's own come back.
pub(in crate::cli::serve) fn is_topic(topic: &str) -> bool {
    topic.strip_prefix(NAMESPACE).is_some_and(|rest| rest.starts_with('/'))
}

/// The filter for all that a node says: a place that the configuration names, or a pattern of such.
pub(super) fn filter(place: &str) -> String {
    let mut levels = place.split('/');
    let (group, node) = (levels.next().unwrap_or_default(), levels.next().unwrap_or_default());
    format!("{NAMESPACE}/{group}/+/{node}/#")
}

/// A request: a topic and its payload.
pub(in crate::cli::serve) type Command = (String, Vec<u8>);

/// What a birth said of a device: readings by alias, and their types.
#[derive(Default)]
struct Birth {
    aliases: HashMap<u64, usize>,
    types: HashMap<usize, u32>,
}

/// What is known of a node.
#[derive(Default)]
struct Node {
    seq: Option<u64>,
    session: Option<u64>,
    /// By device; the node itself has none.
    births: HashMap<Option<String>, Birth>,
    asked: Option<Instant>,
}

/// All nodes.
#[derive(Default)]
pub(in crate::cli::serve) struct Nodes(HashMap<String, Node>);

impl Nodes {
    /// The rows of a message from a cylinder's place, and what its node is to be asked for.
    pub(in crate::cli::serve) fn hear(
        &mut self,
        mapping: &Mapping,
        (origin, is_cylinder): (&Origin<'_>, bool),
        payload: &[u8],
        most: usize,
    ) -> Result<(Vec<Accepted>, Option<Command>), Refusal> {
        if payload.len() > mapping.message_bytes {
            return Err(Refusal::TooLarge);
        }
        let payload = Payload::decode(payload).map_err(|_| Refusal::NoSparkplug)?;
        let key = format!("{}/{}", origin.group, origin.node);
        if self.0.len() >= most && !self.0.contains_key(&key) {
            return Err(Refusal::TooManyCylinders);
        }
        let node = self.0.entry(key).or_default();
        let mut is_sure = node.follows(origin, &payload);
        let device = origin.device.map(str::to_owned);
        match origin.kind {
            Kind::Death => node.bury(origin, &payload),
            Kind::Birth if is_cylinder && (node.births.len() < most || node.births.contains_key(&device)) => {
                _ = node.births.insert(device.clone(), born(mapping, &payload.metrics));
            }
            Kind::Birth | Kind::Data => {}
        }
        let mut rows = Vec::new();
        if is_cylinder && origin.kind != Kind::Death {
            let birth = node.births.get(&device);
            is_sure &= birth.is_some();
            rows = found(mapping, birth.unwrap_or(&Birth::default()), &payload, &mut is_sure)?;
        }
        let is_asked = node.asked.is_some_and(|asked| asked.elapsed() < REBIRTH_PAUSE);
        if is_sure || is_asked || origin.kind == Kind::Death {
            return Ok((rows, None));
        }
        node.asked = Some(Instant::now());
        Ok((rows, Some(rebirth(origin))))
    }
}

impl Node {
    /// Notes the number of a message; `false`: one before it is missing.
    fn follows(&mut self, origin: &Origin<'_>, payload: &Payload) -> bool {
        if (origin.kind, origin.device) == (Kind::Death, None) {
            // The broker sends it, in the place of the node.
            return true;
        }
        if (origin.kind, origin.device) == (Kind::Birth, None) {
            let session = payload.metrics.iter().find(|metric| metric.name.as_deref() == Some(SESSION));
            *self = Self {
                seq: payload.seq,
                session: session.and_then(whole),
                asked: self.asked,
                ..Self::default()
            };
            return true;
        }
        let Some(seq) = payload.seq else { return true };
        let before = self.seq.replace(seq);
        before.is_none_or(|before| seq == if before >= LAST_SEQ { 0 } else { before + 1 })
    }

    /// Forgets what births said.
    fn bury(&mut self, origin: &Origin<'_>, payload: &Payload) {
        let Some(device) = origin.device else {
            let session = payload.metrics.iter().find(|metric| metric.name.as_deref() == Some(SESSION));
            let session = session.and_then(whole);
            if session.is_none() || self.session.is_none() || session == self.session {
                *self = Self { asked: self.asked, ..Self::default() };
            }
            return;
        };
        self.births.remove(&Some(device.to_owned()));
    }
}

/// The whole number of a metric.
fn whole(metric: &Metric) -> Option<u64> {
    match metric.value {
        Some(Value::Int(value)) => Some(u64::from(value)),
        Some(Value::Long(value)) => Some(value),
        _ => None,
    }
}

fn reading(mapping: &Mapping, name: &str) -> Option<usize> {
    mapping.readings.iter().position(|reading| reading.at == name)
}

fn born(mapping: &Mapping, metrics: &[Metric]) -> Birth {
    let mut birth = Birth::default();
    for metric in metrics {
        let Some(number) = metric.name.as_deref().and_then(|name| reading(mapping, name)) else { continue };
        birth.aliases.extend(metric.alias.map(|alias| (alias, number)));
        birth.types.extend(metric.datatype.map(|datatype| (number, datatype)));
    }
    birth
}

/// The rows of a payload; an alias that nobody knows makes it unsure.
fn found(
    mapping: &Mapping,
    birth: &Birth,
    payload: &Payload,
    is_sure: &mut bool,
) -> Result<Vec<Accepted>, Refusal> {
    let mut rows: BTreeMap<i64, Vec<f64>> = BTreeMap::new();
    for metric in &payload.metrics {
        let number = match (&metric.name, metric.alias) {
            (Some(name), _) => reading(mapping, name),
            (None, Some(alias)) => {
                let number = birth.aliases.get(&alias).copied();
                // Aliases of other metrics of a birth are not kept.
                *is_sure &= number.is_some() || !birth.aliases.is_empty();
                number
            }
            (None, None) => None,
        };
        let Some(number) = number else { continue };
        let datatype = metric.datatype.or(birth.types.get(&number).copied());
        let value = value(metric, datatype)?;
        let time_ms = metric.timestamp.or(payload.timestamp).ok_or(Refusal::NoTime)?;
        let time_ns = i64::try_from(time_ms).ok().and_then(|time_ms| time_ms.checked_mul(1_000_000));
        let row = rows.entry(time_ns.ok_or(Refusal::NoTime)?);
        row.or_insert_with(|| vec![f64::NAN; mapping.readings.len()])[number] = value;
    }
    let has_reading = |cells: &Vec<f64>| cells.iter().any(|cell| !cell.is_nan());
    let rows = rows.into_iter().filter(|(_, cells)| has_reading(cells));
    Ok(rows.map(|(time_ns, cells)| Accepted { time_ns, cells }).collect())
}

/// The number of a metric; NaN: it has none that can be used.
fn value(metric: &Metric, datatype: Option<u32>) -> Result<f64, Refusal> {
    if metric.is_null == Some(true) || !is_good(metric) {
        return Ok(f64::NAN);
    }
    // Signed numbers are sent as the unsigned ones with the same bits.
    match (&metric.value, datatype) {
        (None, _) => Ok(f64::NAN),
        (Some(Value::Int(bits)), Some(1)) => Ok(f64::from(*bits as u8 as i8)),
        (Some(Value::Int(bits)), Some(2)) => Ok(f64::from(*bits as u16 as i16)),
        (Some(Value::Int(bits)), Some(3)) => Ok(f64::from(*bits as i32)),
        (Some(Value::Int(bits)), Some(5..=7) | None) => Ok(f64::from(*bits)),
        (Some(Value::Long(bits)), Some(4)) => Ok(*bits as i64 as f64),
        (Some(Value::Long(bits)), Some(7 | 8) | None) => Ok(*bits as f64),
        (Some(Value::Float(value)), _) if value.is_finite() => Ok(f64::from(*value)),
        (Some(Value::Double(value)), _) if value.is_finite() => Ok(*value),
        _ => Err(Refusal::NoNumber),
    }
}

fn is_good(metric: &Metric) -> bool {
    let Some(properties) = &metric.properties else { return true };
    let quality = properties.keys.iter().position(|key| key == QUALITY.0);
    let quality = quality.and_then(|at| properties.values.get(at));
    let quality = quality.and_then(|value| value.int.map(u64::from).or(value.long));
    quality.is_none_or(|quality| quality == QUALITY.1)
}

fn rebirth(origin: &Origin<'_>) -> Command {
    let metric = Metric {
        name: Some(REBIRTH.to_owned()),
        datatype: Some(BOOLEAN),
        value: Some(Value::Boolean(true)),
        ..Metric::default()
    };
    let now_ms = jiff::Timestamp::now().as_millisecond().unsigned_abs();
    let payload = Payload { timestamp: Some(now_ms), metrics: vec![metric], seq: None };
    (format!("{NAMESPACE}/{}/NCMD/{}", origin.group, origin.node), payload.encode_to_vec())
}

#[cfg(test)]
mod tests;
