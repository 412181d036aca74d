//! What is published of a cylinder: topics below the prefix, and JSON with an identity that replayed rows give again.
//!
//! | topic | kept by the broker | content |
//! |---|---|---|
//! | `verdict` | yes | the decision of the last row |
//! | `estimate` | yes | the last row, in the columns of `monitor` |
//! | `alarm/NAME` | yes | the last change of an alarm, as a line of `monitor --events` |
//! | `event` | no | an event, as a line of `monitor --events` |
use super::outbox::Message;
use crate::cli::monitor::{ALARM, Told};
use crate::report::{Table, digest};
use serde_json::{Map, Value, json};

/// Columns that a verdict has.
const VERDICT: [&str; 8] =
    ["time_s", "time", "verdict", "leak_probability", "onset_s", "lost_g", "reaction", "reason"];

/// An event or the change of an alarm.
pub(super) fn told(prefix: &str, name: &str, told: &Told) -> Message {
    let alarm = (told.event == ALARM).then(|| serde_json::from_str::<Value>(&told.line).ok()).flatten();
    let alarm = alarm.as_ref().and_then(|line| line["alarm"].as_str());
    let topic = match alarm {
        Some(alarm) => format!("{prefix}/{name}/alarm/{alarm}"),
        None => format!("{prefix}/{name}/event"),
    };
    Message { topic, payload: told.line.clone(), retain: alarm.is_some(), event_of: Some(name.to_owned()) }
}

/// That a monitor began anew; the time is that of the last row before, s since 1970.
pub(super) fn anew(prefix: &str, name: &str, reason: &str, time_s: f64) -> Message {
    let id = digest(&format!("cold-start {name} {time_s} {reason}"));
    let payload = json!({ "id": id, "event": "cold-start", "time_s": time_s, "reason": reason }).to_string();
    Message {
        topic: format!("{prefix}/{name}/event"),
        payload,
        retain: false,
        event_of: Some(name.to_owned()),
    }
}

/// Verdict and estimate of the last of some rows; none where there is none.
pub(super) fn last_row(prefix: &str, name: &str, rows: &Table) -> Vec<Message> {
    let Value::Object(columns) = rows.to_json() else { return Vec::new() };
    let last = |cells: &Value| cells.as_array().and_then(|cells| cells.last()).cloned();
    let row: Option<Map<String, Value>> =
        columns.iter().map(|(column, cells)| Some((column.clone(), last(cells)?))).collect();
    let Some(row) = row else { return Vec::new() };
    let verdict = row.iter().filter(|(column, _)| VERDICT.contains(&column.as_str()));
    let verdict = verdict.map(|(column, cell)| (column.clone(), cell.clone())).collect();
    [("verdict", verdict), ("estimate", row)].map(|(what, cells)| kept(prefix, name, what, cells)).into()
}

fn kept(prefix: &str, name: &str, what: &str, cells: Map<String, Value>) -> Message {
    let id = digest(&format!(
        "{what} {name} {} {}",
        cells.get("time").unwrap_or(&Value::Null),
        cells.get("time_s").unwrap_or(&Value::Null)
    ));
    let content: Map<String, Value> = [("id".to_owned(), json!(id))].into_iter().chain(cells).collect();
    let payload = Value::Object(content).to_string();
    Message { topic: format!("{prefix}/{name}/{what}"), payload, retain: true, event_of: None }
}
