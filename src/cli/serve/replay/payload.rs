//! From a row to a message: what `mapping` reads, written.
use crate::cli::serve::document::{PayloadFormat, TimeForm};
use crate::cli::serve::mapping::Mapping;
use crate::report::rounded;
use crate::thermal::units::Unit;
use anyhow::bail;
use jiff::Timestamp;
use serde_json::{Map, Value, json};

/// A list of a message has at most so many places; a higher number is the key of an object.
const LONGEST_LIST: usize = 1000;
/// Digits that a reading has as a rule.
const DIGITS: usize = 10;
/// Neighbours of a number that are tried: a conversion and its inverse round once each.
const NEIGHBOURS: usize = 4;

/// The shape of a message.
#[derive(Debug)]
pub(super) struct Payload {
    root: Node,
    form: TimeForm,
}

/// A place of a message.
#[derive(Debug)]
enum Node {
    Time,
    /// A reading, by its number in the configuration.
    Reading(usize),
    Inner(Vec<(String, Node)>),
}

impl Payload {
    /// As the configuration has it.
    ///
    /// # Errors
    /// Two values have one place, or messages have no time.
    pub(super) fn of(mapping: &Mapping) -> anyhow::Result<Self> {
        if mapping.format == PayloadFormat::SparkplugB {
            bail!(
                "a log is played in JSON, and the messages are of Sparkplug B: play it to a gateway of JSON"
            );
        }
        if mapping.form == TimeForm::Arrival {
            bail!(
                "messages have no time (clock = \"arrival\"), and a log is played with its own: name a time"
            );
        }
        let mut root = Node::Inner(Vec::new());
        root.insert(&mapping.time, Node::Time)?;
        for (number, reading) in mapping.readings.iter().enumerate() {
            root.insert(&reading.at, Node::Reading(number))?;
        }
        Ok(Self { root, form: mapping.form })
    }

    /// The message of a row; the time is since 1970 in UTC, µs.
    pub(super) fn text(&self, time_us: i64, cells: &[f64]) -> String {
        self.root.value(&instant(time_us, self.form), cells).to_string()
    }
}

impl Node {
    fn insert(&mut self, pointer: &str, leaf: Self) -> anyhow::Result<()> {
        let mut node = self;
        let mut keys =
            pointer.split('/').skip(1).map(|key| key.replace("~1", "/").replace("~0", "~")).peekable();
        while let Some(key) = keys.next() {
            let Self::Inner(inner) = node else { break };
            let at = inner.iter().position(|(known, _)| *known == key);
            if keys.peek().is_none() && at.is_none() {
                inner.push((key, leaf));
                return Ok(());
            }
            let at = at.unwrap_or_else(|| {
                inner.push((key, Self::Inner(Vec::new())));
                inner.len() - 1
            });
            node = &mut inner[at].1;
        }
        bail!("two values of the payload stand at {pointer}: a log cannot be played in this form")
    }

    fn value(&self, time: &Value, cells: &[f64]) -> Value {
        match self {
            Self::Time => time.clone(),
            Self::Reading(number) => json!(cells[*number]),
            Self::Inner(inner) => {
                let indices: Option<Vec<usize>> = inner.iter().map(|(key, _)| index(key)).collect();
                let values = inner.iter().map(|(_, node)| node.value(time, cells));
                match indices {
                    Some(indices) if !indices.is_empty() => {
                        let mut list = vec![Value::Null; indices.iter().max().map_or(0, |last| last + 1)];
                        indices.into_iter().zip(values).for_each(|(index, value)| list[index] = value);
                        Value::Array(list)
                    }
                    _ => {
                        let keys = inner.iter().map(|(key, _)| key.clone());
                        Value::Object(keys.zip(values).collect::<Map<_, _>>())
                    }
                }
            }
        }
    }
}

/// A place of a list; a pointer has no other spelling of it.
fn index(key: &str) -> Option<usize> {
    key.parse().ok().filter(|index: &usize| *index < LONGEST_LIST && index.to_string() == key)
}

fn instant(time_us: i64, form: TimeForm) -> Value {
    match form {
        TimeForm::Rfc3339 => {
            json!(Timestamp::from_microsecond(time_us).map(|time| time.to_string()).unwrap_or_default())
        }
        TimeForm::Seconds => json!(time_us as f64 / 1e6),
        TimeForm::Milliseconds => json!(time_us as f64 / 1e3),
        TimeForm::Arrival => Value::Null,
    }
}

/// A value in a unit that becomes the same SI value again, bit by bit, wherever there is one; the shortest that is found.
pub(super) fn written(unit: &Unit, si: f64) -> f64 {
    let near = unit.from_si(si);
    let (above, below) = (
        std::iter::successors(Some(near), |value| Some(value.next_up())),
        std::iter::successors(Some(near), |value| Some(value.next_down())),
    );
    let neighbours = above.skip(1).zip(below.skip(1)).take(NEIGHBOURS).flat_map(|(up, down)| [up, down]);
    let mut candidates = [rounded(near, DIGITS), near].into_iter().chain(neighbours);
    candidates.find(|value| unit.to_si(*value) == si).unwrap_or(near)
}

#[cfg(test)]
mod tests;
