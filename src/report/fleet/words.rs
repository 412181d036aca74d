//! A fleet in a few lines for a terminal, and a cylinder in the words that page and terminal share.
use super::order::Light;
use super::row::{Cylinder, Fault, Finding};
use crate::detector::prognosis::Passage;
use crate::report::monitor::{passage_text, reaction_text};
use crate::report::{GRAM, GRAM_PER_HOUR, Report, number};
use crate::thermal::units::{BAR_PA, DAY_S, HOUR_S, YEAR_S};

/// Rows that a terminal shows.
const SHOWN: usize = 10;

/// What a cylinder's row says in words.
pub(crate) struct Words {
    /// Verdict.
    pub verdict: String,
    /// Pressure at 15 °C and limit, bar.
    pub pressure: String,
    /// Gas lost with its interval, g, or the leak rate that there may be at most.
    pub lost: String,
    /// Time to the limit.
    pub left: String,
    /// What to do.
    pub due: String,
    /// Sensors at fault.
    pub sensors: String,
}

/// A cylinder in words.
pub(crate) fn in_words(one: &Cylinder) -> Words {
    let Some(found) = &one.found else {
        return Words {
            verdict: "not read".to_owned(),
            pressure: String::new(),
            lost: String::new(),
            left: String::new(),
            due: one.fault.clone(),
            sensors: String::new(),
        };
    };
    let bar = |pressure_pa: f64| {
        if pressure_pa.is_finite() { format!("{:.1}", pressure_pa / BAR_PA) } else { "?".to_owned() }
    };
    let sensors =
        found.at_fault().map(|(name, word, _)| format!("{name} {word}")).collect::<Vec<_>>().join(", ");
    Words {
        verdict: found.verdict.as_str().to_owned(),
        pressure: format!("{} / {} bar", bar(found.p15_pa), number(found.limit_pa / BAR_PA, 4)),
        lost: lost(found),
        left: left(found),
        due: due(found),
        sensors: if sensors.is_empty() { "all good".to_owned() } else { sensors },
    }
}

fn lost(found: &Finding) -> String {
    let digits = |value: f64| number(value, 3);
    match found.lost_kg {
        Some(lost) => {
            let lost = lost.scaled(GRAM);
            format!("{} g ({} to {})", digits(lost.value), digits(lost.low), digits(lost.high))
        }
        None => format!("none found; at most {} g/h", digits(found.leak_rate_kg_s.high * GRAM_PER_HOUR)),
    }
}

fn left(found: &Finding) -> String {
    let Some(left) = &found.left else { return "not known yet".to_owned() };
    let [p5, p50, p95] = [left.p5, left.p50, left.p95].map(|passage| near(passage, left.horizon_s));
    if p5 == p95 { p50 } else { format!("{p50} ({p5} to {p95})") }
}

/// When a limit is reached, with the digits that a table has room for.
fn near(passage: Passage, horizon_s: f64) -> String {
    match passage {
        Passage::In(time_s) if time_s < 2.0 * DAY_S => format!("{:.0} h", time_s / HOUR_S),
        Passage::In(time_s) if time_s < YEAR_S => format!("{} d", number(time_s / DAY_S, 2)),
        other => passage_text(other, horizon_s),
    }
}

fn due(found: &Finding) -> String {
    match (found.reaction, found.verdict.reason()) {
        (Some(reaction), _) => reaction_text(reaction).to_owned(),
        (None, Some(reason)) => format!("wait: {}", reason.as_str()),
        (None, None) => "not known yet".to_owned(),
    }
}

/// How many cylinders have each light, the most urgent first.
pub(crate) fn counts(cylinders: &[Cylinder]) -> [(Light, usize); 4] {
    Light::ALL.map(|light| (light, cylinders.iter().filter(|one| one.light() == light).count()))
}

/// The fleet in a few lines, its cylinders sorted by urgency; `page` is where all of it stands.
pub(crate) fn report(cylinders: &[Cylinder], faults: &[Fault], page: &str) -> Report {
    let counted = counts(cylinders).map(|(light, count)| (light.word(), count.to_string()));
    let urgent = cylinders.iter().filter(|one| one.light() != Light::Fine).take(SHOWN);
    let rows: Vec<Vec<String>> = urgent
        .map(|one| {
            let Words { verdict, pressure, lost, left, due, .. } = in_words(one);
            vec![one.name.clone(), one.light().word().to_owned(), verdict, pressure, lost, left, due]
        })
        .collect();
    let header = ["cylinder", "light", "verdict", "at 15 °C / limit", "lost", "to the limit", "what to do"];
    let unread = match faults.len() {
        0 => String::new(),
        1 => "1 thing could not be read: see the table of errors. ".to_owned(),
        count => format!("{count} things could not be read: see the table of errors. "),
    };
    Report::new(format!("Fleet of {} cylinders", cylinders.len()))
        .facts(counted)
        .rows("", &header, rows)
        .text(format!("{unread}The page is {page}"))
}
