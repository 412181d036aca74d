//! The tables of a fleet.
use super::row::{Cylinder, Fault, Finding};
use crate::detector::monitor::{Interval, Outcome};
use crate::detector::prognosis::{Passage, Quantiles};
use crate::report::monitor::reaction_word;
use crate::report::{Digits, GRAM, GRAM_PER_HOUR, Table};
use crate::thermal::units::{BAR_PA, DAY_S};

/// A row for each cylinder, in the order given; numbers have all digits, so that they are those of the monitor.
pub(crate) fn summary(cylinders: &[Cylinder]) -> Table {
    let mut table = Table::new();
    let texts = |of: &dyn Fn(&Cylinder) -> String| -> Vec<String> { cylinders.iter().map(of).collect() };
    let found = |of: &dyn Fn(&Finding) -> String| texts(&|one| one.found.as_ref().map_or(String::new(), of));
    table.push_texts("cylinder", texts(&|one| one.name.clone()));
    table.push_texts("vessel", texts(&|one| one.vessel.clone()));
    table.push_texts("light", texts(&|one| one.light().word().to_owned()));
    table.push_texts("outcome", texts(&|one| outcome_word(one).to_owned()));
    table.push_texts("verdict", found(&|found| found.verdict.as_str().to_owned()));
    let reason = |one: &Cylinder| match &one.found {
        Some(found) => found.verdict.reason().map_or("", |reason| reason.as_str()).to_owned(),
        None => one.fault.clone(),
    };
    table.push_texts("reason", texts(&reason));
    table.push_texts("reaction", found(&|found| found.reaction.map_or("", reaction_word).to_owned()));
    table.push_texts("due_because", found(&|found| found.due_because.clone()));
    numbers(&mut table, cylinders);
    let integers = |of: &dyn Fn(&Finding) -> usize| -> Vec<usize> {
        cylinders.iter().map(|one| one.found.as_ref().map_or(0, of)).collect()
    };
    table.push_integers("severity", integers(&|found| found.severity.into()));
    table.push_texts("alarms", found(&|found| found.alarms.join("; ")));
    let at_fault = |found: &Finding| {
        let sensors = found.at_fault().map(|(name, _, words)| format!("{name} {words}"));
        sensors.collect::<Vec<_>>().join("; ")
    };
    table.push_texts("sensors_at_fault", found(&at_fault));
    table.push_integers("events", cylinders.iter().map(|one| one.events));
    table.push_integers("cautions", cylinders.iter().map(|one| one.cautions.len()));
    table.push_integers("rows", integers(&|found| found.rows as usize));
    table.push_texts("first", found(&|found| found.span.0.clone()));
    table.push_texts("last", found(&|found| found.span.1.clone()));
    let files = |one: &Cylinder| one.logs.iter().map(|log| log.name.as_str()).collect::<Vec<_>>().join("; ");
    table.push_texts("log", texts(&files));
    let hashes =
        |one: &Cylinder| one.logs.iter().map(|log| log.sha256.as_str()).collect::<Vec<_>>().join("; ");
    table.push_texts("log_sha256", texts(&hashes));
    table
}

fn numbers(table: &mut Table, cylinders: &[Cylinder]) {
    let mut push = |name: &str, of: &dyn Fn(&Finding) -> f64| {
        let values = cylinders.iter().map(|one| one.found.as_ref().map_or(f64::NAN, of));
        table.push(name, Digits::All, values);
    };
    push("leak_probability", &|found| found.leak_probability.unwrap_or(f64::NAN));
    push("p15_bar", &|found| found.p15_pa / BAR_PA);
    push("limit_bar", &|found| found.limit_pa / BAR_PA);
    push("cold_pressure_bar", &|found| found.cold_pa / BAR_PA);
    let lost = |found: &Finding, of: fn(&Interval) -> f64| {
        found.lost_kg.map_or(f64::NAN, |lost| of(&lost.scaled(GRAM)))
    };
    push("lost_g", &|found| lost(found, |lost| lost.value));
    push("lost_low_g", &|found| lost(found, |lost| lost.low));
    push("lost_high_g", &|found| lost(found, |lost| lost.high));
    push("leak_g_h", &|found| found.leak_rate_kg_s.scaled(GRAM_PER_HOUR).value);
    push("leak_low_g_h", &|found| found.leak_rate_kg_s.scaled(GRAM_PER_HOUR).low);
    push("leak_high_g_h", &|found| found.leak_rate_kg_s.scaled(GRAM_PER_HOUR).high);
    let left =
        |found: &Finding, of: fn(&Quantiles) -> Passage| found.left.map_or(f64::NAN, |left| days(of(&left)));
    push("left_p5_d", &|found| left(found, |left| left.p5));
    push("left_p50_d", &|found| left(found, |left| left.p50));
    push("left_p95_d", &|found| left(found, |left| left.p95));
    push("horizon_d", &|found| found.left.map_or(f64::NAN, |left| left.horizon_s / DAY_S));
    push("first_s", &|found| found.span_s.0);
    push("last_s", &|found| found.span_s.1);
}

/// Days until a limit is reached; NaN: beyond the horizon, or not known.
fn days(passage: Passage) -> f64 {
    match passage {
        Passage::Reached => 0.0,
        Passage::In(time_s) => time_s / DAY_S,
        Passage::BeyondHorizon | Passage::Unknown => f64::NAN,
    }
}

fn outcome_word(one: &Cylinder) -> &'static str {
    match one.found.as_ref().map(|found| found.outcome) {
        Some(Outcome::Loss) => "loss",
        Some(Outcome::Unknown) | None => "unknown",
        Some(_) => "no-loss",
    }
}

/// A row for everything that could not be read.
pub(crate) fn errors(faults: &[Fault]) -> Table {
    let texts = |of: &dyn Fn(&Fault) -> &str| -> Vec<String> {
        faults.iter().map(|fault| of(fault).to_owned()).collect()
    };
    let mut table = Table::new();
    table.push_texts("cylinder", texts(&|fault| &fault.cylinder));
    table.push_texts("file", texts(&|fault| &fault.file));
    let line = |fault: &Fault| fault.line.map_or(f64::NAN, |line| line as f64);
    table.push("line", Digits::All, faults.iter().map(line));
    table.push_texts("reason", texts(&|fault| &fault.reason));
    table.push_texts("remedy", texts(&|fault| &fault.remedy));
    table
}

/// An event of a cylinder.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EventRow {
    /// Cylinder.
    pub cylinder: String,
    /// Time of the log, s.
    pub time_s: f64,
    /// The same as date; empty: the log has none.
    pub time: String,
    /// Name of the event, or `alarm`.
    pub event: String,
    /// Identity.
    pub id: String,
    /// In words.
    pub words: String,
    /// Line of JSON.
    pub line: String,
}

/// A row for every event.
pub(crate) fn events(rows: Vec<EventRow>) -> Table {
    let mut table = Table::new();
    let texts =
        |of: fn(&EventRow) -> &str| -> Vec<String> { rows.iter().map(|row| of(row).to_owned()).collect() };
    table.push_texts("cylinder", texts(|row| &row.cylinder));
    table.push("time_s", Digits::All, rows.iter().map(|row| row.time_s));
    table.push_texts("time", texts(|row| &row.time));
    table.push_texts("event", texts(|row| &row.event));
    table.push_texts("id", texts(|row| &row.id));
    table.push_texts("words", texts(|row| &row.words));
    table.push_texts("line", texts(|row| &row.line));
    table
}
