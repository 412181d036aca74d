//! JSON schemas of what is published; the tests hold every message against them.
use serde_json::{Map, Value, json};

/// Words of a verdict.
const VERDICTS: [&str; 6] = ["tight", "leak", "discharge", "refill", "sensor fault", "unknown"];
/// Names of events; `cold-start` is the gateway's own.
const EVENTS: [&str; 16] = [
    "verdict",
    "leak-found",
    "leak-ended",
    "discharge",
    "refill",
    "sensor",
    "cold-night",
    "filling-doubted",
    "swapped",
    "late",
    "disturbed",
    "clock-jump",
    "gap",
    "too-late",
    "restarted",
    "cold-start",
];
/// Changes of an alarm.
const CHANGES: [&str; 9] = [
    "active",
    "limit-changed",
    "re-alarm",
    "inactive",
    "acknowledged",
    "confirmed",
    "reset",
    "enabled",
    "disabled",
];
/// Numbers of an estimate beside those of a verdict; null: not known.
const ESTIMATED: [&str; 13] = [
    "gas_mean_degc",
    "gas_mean_sd_k",
    "mass_kg",
    "mass_sd_g",
    "leak_g_h",
    "leak_sd_g_h",
    "leak_bar_h",
    "pressure_bar",
    "pressure_expected_bar",
    "p15_bar",
    "leak_low_g_h",
    "leak_high_g_h",
    "cold_pressure_bar",
];

/// JSON schema of `verdict`, `estimate`, `alarm` or `event`.
pub(in crate::cli::serve) fn schema(what: &str) -> Value {
    let (properties, optional) = match what {
        "verdict" => (verdict(), Map::new()),
        "estimate" => (estimate(), Map::new()),
        "alarm" => (alarm(), Map::new()),
        _ => event(),
    };
    let required: Vec<String> = properties.keys().cloned().collect();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": format!("{what} of cylwatch serve"),
        "type": "object",
        "required": required,
        "properties": properties.clone().into_iter().chain(optional).collect::<Map<_, _>>(),
        "additionalProperties": false,
    })
}

fn number() -> Value {
    json!({ "type": ["number", "null"] })
}

fn text() -> Value {
    json!({ "type": ["string", "null"] })
}

fn one_of(words: &[&str], or_null: bool) -> Value {
    let words = words.iter().map(|word| json!(word));
    json!({ "enum": words.chain(or_null.then_some(Value::Null)).collect::<Vec<_>>() })
}

fn date() -> Value {
    json!({ "type": ["string", "null"], "format": "date-time" })
}

fn map<const N: usize>(properties: [(&str, Value); N]) -> Map<String, Value> {
    properties.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// What every message has.
fn head() -> Map<String, Value> {
    map([
        ("id", json!({ "type": "string", "description": "the same whenever the same rows are computed" })),
        (
            "time_s",
            json!({ "type": "number", "description": "time since the first row, s; of cold-start and of the gateway's own alarms since 1970" }),
        ),
    ])
}

fn verdict() -> Map<String, Value> {
    let own = map([
        ("time", date()),
        ("verdict", one_of(&VERDICTS, false)),
        ("leak_probability", json!({ "type": ["number", "null"], "minimum": 0, "maximum": 1 })),
        ("onset_s", number()),
        ("lost_g", number()),
        ("reaction", one_of(&["none", "next-interval", "as-soon-as-possible", "shutdown"], true)),
        ("reason", text()),
    ]);
    head().into_iter().chain(own).collect()
}

fn estimate() -> Map<String, Value> {
    let own = map([("quality", one_of(&["good", "degraded", "predicted", "open", "restarted"], false))]);
    let numbers = ESTIMATED.map(|name| (name.to_owned(), number()));
    verdict().into_iter().chain(numbers).chain(own).collect()
}

fn alarm() -> Map<String, Value> {
    let truth = || json!({ "type": "boolean" });
    let own = map([
        ("event", json!({ "const": "alarm" })),
        ("time", date()),
        ("alarm", json!({ "type": "string" })),
        ("change", one_of(&CHANGES, false)),
        ("Severity", json!({ "type": "integer", "minimum": 1, "maximum": 1000 })),
        ("EnabledState", truth()),
        ("ActiveState", truth()),
        ("LimitState", one_of(&["Low", "LowLow"], true)),
        ("AckedState", truth()),
        ("ConfirmedState", truth()),
        ("LatchedState", truth()),
        ("Retain", truth()),
        ("ReAlarmRepeatCount", json!({ "type": "integer", "minimum": 0 })),
        ("active_since_s", number()),
        ("Comment", json!({ "type": "string" })),
    ]);
    head().into_iter().chain(own).collect()
}

/// What all events have, and what some have.
fn event() -> (Map<String, Value>, Map<String, Value>) {
    let interval =
        || json!({ "type": "array", "items": { "type": ["number", "null"] }, "minItems": 3, "maxItems": 3 });
    let verdict = || {
        json!({
            "type": "object",
            "required": ["verdict", "reason"],
            "properties": { "verdict": one_of(&VERDICTS, false), "reason": text() },
            "additionalProperties": false,
        })
    };
    let sensors = json!({ "type": "array", "items": { "type": "string" }, "minItems": 2, "maxItems": 2 });
    let health = ["good", "missing", "implausible", "stuck", "spikes", "shifted", "deviates", "detached"];
    let some = map([
        ("time", date()),
        ("onset_s", number()),
        ("onset", date()),
        ("from", verdict()),
        ("to", verdict()),
        ("rate_g_h", interval()),
        ("rate_bar_h", interval()),
        ("began_s", interval()),
        ("lost_g", interval()),
        ("mass_g", number()),
        ("sensor", json!({ "type": "string" })),
        ("health", one_of(&health, false)),
        (
            "shift",
            json!({ "type": ["object", "null"], "properties": { "k": number(), "bar": number() }, "additionalProperties": false }),
        ),
        ("pressure_bar", number()),
        ("mass_kg", number()),
        ("filled_kg", number()),
        ("sensors", sensors),
        ("by_s", number()),
        ("off_k", number()),
        ("jump_s", number()),
        ("gap_s", number()),
        ("reason", text()),
    ]);
    let all = head().into_iter().chain(map([("event", one_of(&EVENTS, false))])).collect();
    (all, some)
}
