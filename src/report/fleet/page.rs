//! The page of a fleet: one file, the most urgent first.
//!
//! Rows are drawn by a script from data inside the page, a hundred at a time, so that ten thousand cylinders open at once. Without scripts
//! the page has the most urgent hundred as a table. The script puts names and words in as text, never as markup, and the data has no `<`.
use super::order::Light;
use super::row::{Cylinder, Fault, Finding};
use super::words::{Words, counts, in_words};
use crate::report::page::{banner, head, origin};
use crate::report::{Provenance, Table, number};
use crate::thermal::units::BAR_PA;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde_json::{Value, json};

pub(super) const SCRIPT: &str = include_str!("page.js");
pub(super) const OWN_STYLE: &str = include_str!("page.css");
/// Nothing is loaded from anywhere.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";
/// Rows of the page without scripts.
const PLAIN: usize = 100;
/// Most things that could not be read in the table below.
const FAULTS: usize = 200;

/// Heads of the columns.
const HEADS: [&str; 9] = [
    "light",
    "cylinder",
    "verdict",
    "at 15 °C / limit",
    "gas lost (95 %)",
    "to the limit (5 to 95 %)",
    "what to do",
    "sensors",
    "pressure at 15 °C",
];

/// What a page has that others have not.
pub(super) struct Own {
    /// What a browser may load and run.
    pub policy: String,
    /// Styles after those of all pages.
    pub style: String,
    /// What stands above the cylinders.
    pub top: Markup,
    /// What the script draws.
    pub data: Value,
    pub script: String,
}

/// The page, its cylinders sorted by urgency.
pub(crate) fn page(cylinders: &[Cylinder], faults: &[Fault], provenance: &Provenance) -> String {
    let own = Own {
        policy: POLICY.to_owned(),
        style: OWN_STYLE.to_owned(),
        top: html! {},
        data: data(cylinders.iter().map(row).collect()),
        script: SCRIPT.to_owned(),
    };
    whole(cylinders, faults, provenance, &own)
}

/// A page with what is its own.
pub(super) fn whole(cylinders: &[Cylinder], faults: &[Fault], provenance: &Provenance, own: &Own) -> String {
    let title = match cylinders {
        [_] => "Fleet of 1 cylinder".to_owned(),
        many => format!("Fleet of {} cylinders", many.len()),
    };
    let in_head = html! {
        meta http-equiv="Content-Security-Policy" content=(own.policy);
        style { (PreEscaped(&own.style)) }
    };
    // Nothing in the data ends its element.
    let data = own.data.to_string().replace('<', "\\u003c");
    let heads = html! { thead { tr { @for head in HEADS { th scope="col" { (head) } } } } };
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            (head(&title, &in_head))
            body {
                (banner(&title))
                main {
                    (own.top)
                    (lights(cylinders))
                    input #find .find .script type="search" placeholder="Search: name, verdict, sensor \u{2026}" aria-label="Search";
                    p.remark {
                        span #count {} " The most urgent stand first. A tap on a row opens it. The dashed line is the limit."
                    }
                    table.fleet .script aria-label="Cylinders, the most urgent first" { (heads) tbody #body {} }
                    button #more .more type="button" hidden { "Show more" }
                    noscript {
                        @if cylinders.len() > PLAIN { p { "Without scripts the page shows the " (PLAIN) " most urgent cylinders." } }
                        table.fleet { (heads) tbody { @for one in cylinders.iter().take(PLAIN) { (plain(one)) } } }
                    }
                    (unread(faults))
                    (meaning())
                }
                (origin(provenance))
                script #data type="application/json" { (PreEscaped(data)) }
                script { (PreEscaped(&own.script)) }
            }
        }
    };
    page.into_string()
}

/// How many there are of each, as buttons that filter.
fn lights(cylinders: &[Cylinder]) -> Markup {
    html! {
        div.lights role="group" aria-label="Filter by light" {
            @for (light, count) in counts(cylinders) {
                button type="button" class=(light.word()) aria-pressed="false" { (light.word()) " " (count) }
            }
        }
    }
}

/// A row without scripts.
fn plain(one: &Cylinder) -> Markup {
    let light = one.light().word();
    let heads = &HEADS[2..];
    html! {
        tr.row {
            td { span class={ "light " (light) } { (light) } }
            th scope="row" { (one.name) }
            @for (cell, head) in cells(one).iter().zip(heads) { td data-l=(head) { (cell) } }
            td {}
        }
    }
}

/// Cells between name and course.
fn cells(one: &Cylinder) -> [String; 6] {
    let Words { verdict, pressure, lost, left, due, sensors } = in_words(one);
    [verdict, pressure, lost, left, due, sensors]
}

/// What the script draws.
pub(super) fn data(rows: Vec<Value>) -> Value {
    json!({ "lights": Light::ALL.map(Light::word), "rows": rows })
}

/// A cylinder for the script.
pub(super) fn row(one: &Cylinder) -> Value {
    let light = Light::ALL.iter().position(|light| *light == one.light());
    let bar = |pressure_pa: f64| (pressure_pa / BAR_PA * 100.0).round() / 100.0;
    let course: Vec<Option<f64>> = one
        .found
        .iter()
        .flat_map(|found| &found.course_pa)
        .map(|pa| pa.is_finite().then(|| bar(*pa)))
        .collect();
    json!({
        "n": one.name,
        "l": light,
        "w": cells(one),
        "p": course,
        "m": one.found.as_ref().map_or(0.0, |found| bar(found.limit_pa)),
        "f": facts(one),
        "e": one.last_events,
        "c": one.cautions,
    })
}

/// What is known of a cylinder, as names and values.
fn facts(one: &Cylinder) -> Vec<(String, String)> {
    let mut facts = vec![("vessel".to_owned(), one.vessel.clone())];
    match &one.found {
        None => facts.push(("not read".to_owned(), one.fault.clone())),
        Some(found) => {
            facts.extend(found.facts.iter().cloned());
            facts.push(("rows".to_owned(), span(found)));
        }
    }
    let names: Vec<&str> = one.logs.iter().map(|log| log.name.as_str()).collect();
    facts.push(("read from".to_owned(), names.join(", ")));
    facts.retain(|(_, value)| !value.is_empty());
    facts
}

fn span(found: &Finding) -> String {
    match &found.span {
        (first, last) if !first.is_empty() => format!("{}, from {first} to {last}", found.rows),
        _ => {
            let [first, last] = [found.span_s.0, found.span_s.1].map(|time_s| number(time_s, 9));
            format!("{}, from {first} s to {last} s", found.rows)
        }
    }
}

fn unread(faults: &[Fault]) -> Markup {
    let rows = faults.iter().take(FAULTS).map(|fault| {
        let line = fault.line.map_or(String::new(), |line| format!(":{line}"));
        vec![
            fault.cylinder.clone(),
            format!("{}{line}", fault.file),
            fault.reason.clone(),
            fault.remedy.clone(),
        ]
    });
    html! {
        @if !faults.is_empty() {
            h2 #unread { "What could not be read" }
            @if faults.len() > FAULTS { p { "The first " (FAULTS) " of " (faults.len()) "; the table of errors has all." } }
            (Table::of_texts(&["cylinder", "file", "reason", "what to do"], rows.collect()).to_html(""))
        }
    }
}

fn meaning() -> Markup {
    let words = [
        (
            Light::Act,
            "gas was lost, or a limit is reached before the next service with 5 % or more: act before the next service",
        ),
        (Light::Plan, "maintenance is due at the next service, or a sensor is at fault"),
        (
            Light::Unknown,
            "it cannot be told: the log is too short, a reading is missing, or the log could not be read",
        ),
        (Light::Fine, "no gas is being lost that could be seen, and nothing is due"),
    ];
    html! {
        h2 #meaning { "What the words mean" }
        div.wide { table.facts { tbody {
            @for (light, words) in words {
                tr { th scope="row" { span class={ "light " (light.word()) } { (light.word()) } } td { (words) } }
            }
        } } }
        p.remark {
            "Cylinders are sorted by what is due, then by severity of the alarms, time to the limit, probability of a leak, and name. \
             Intervals are of 95 %. The time to the limit is the median, with the times before which it is reached with 5 and with 95 %."
        }
    }
}
