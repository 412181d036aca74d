//! Which column may be what: by the words of its name, the unit in its header, and the range of its values.
use super::{ColumnReport, Role};
use crate::log::header::is_value;
use crate::log::label::{self, Label};
use crate::log::unit_check::{GAS_PA, WALL_K, fitting, gauge_of};
use crate::log::{Mapping, date};
use crate::thermal::units::{self, Dimension};

/// A mapping that may be right.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal {
    /// For `--map`.
    pub mapping: Mapping,
    /// Whether the name says so; otherwise the quantity is likely and the place is not known.
    pub is_likely: bool,
    /// Why.
    pub reason: String,
}

/// Parts of names, in small letters, of places and quantities; the first that fits wins.
const WORDS: [(&[&str], &str); 9] = [
    (&["schulter", "shoulder"], "shoulder"),
    (&["ventil", "valve", "armatur"], "valve"),
    (
        &["umgebung", "ambient", "außen", "aussen", "luft", "raum", "kammer", "chamber", "outdoor", "room"],
        "ambient",
    ),
    (&["boden", "bottom", "unten"], "wall_bottom"),
    (&["hals", "neck"], "wall_neck"),
    (&["mantel", "wand", "mitte", "wall", "middle", "surface", "oberfl"], "wall_middle"),
    (&["gas"], "gas_mean"),
    (&["druck", "pressure", "manometer", "press"], "pressure"),
    (&["temp", "pt100", "pt1000", "thermo"], "shoulder"),
];
/// Pressure that none is below when it counts from nothing, and that one at rest is above, Pa.
const NEARLY_NOTHING_PA: f64 = 0.5e5;
const OFTEN_MORE_PA: f64 = 5e5;
/// What thermometers without a place may be, in this order.
const PLACES: [&str; 4] = ["shoulder", "valve", "wall_middle", "wall_bottom"];

/// A column of times, by its first cell and its name.
pub(super) fn time(names: &[String], first: &[String]) -> Option<Mapping> {
    let cell = |k: usize| first.get(k).map_or("", |cell| cell.trim());
    let is_date =
        |k: &usize| date::as_rfc3339(cell(*k)).is_some() || cell(*k).parse::<jiff::civil::Date>().is_ok();
    let is_clock = |k: &usize| cell(*k).contains(':') && !is_date(k) && is_value(cell(*k));
    let all = 0..names.len();
    let mapping = |ours: &str, theirs: String| Some(Mapping { ours: ours.to_owned(), theirs });
    if let Some(day) = all.clone().find(is_date) {
        if cell(day).contains(':') {
            return mapping("time", names[day].clone());
        }
        if let Some(clock) = all.clone().find(is_clock) {
            let [day, clock] = [day, clock].map(|k| Label::of(&names[k]).base.to_owned());
            return mapping("time", format!("{day}+{clock}"));
        }
    }
    let is_time = |name: &str| {
        ["zeit", "time", "elapsed", "dauer", "sec", "sek"].iter().any(|word| name.contains(word))
    };
    let numbered =
        all.into_iter().find(|&k| is_time(&names[k].to_lowercase()) && is_value(cell(k)) && !is_clock(&k))?;
    let unit = Label::of(&names[numbered]).suffixes().and_then(|suffixes| suffixes.first());
    let unit = unit.filter(|unit| units::find(unit, Dimension::Time).is_some()).unwrap_or(&"s");
    mapping(&format!("time_{unit}"), names[numbered].clone())
}

/// Gives every column that is set aside and may be something a proposal; no quantity twice.
pub(super) fn propose(reports: &mut [ColumnReport]) {
    reports.iter_mut().for_each(doubt_unit);
    let mut taken: Vec<String> = reports.iter().filter_map(|report| report.role.quantity()).collect();
    for is_likely in [true, false] {
        for k in 0..reports.len() {
            let report = &reports[k];
            if report.role != Role::Aside || report.proposal.is_some() || !report.has_numbers() {
                continue;
            }
            if let Some((quantity, unit, reason)) = guess(report, is_likely, &taken) {
                let theirs = unique_name(reports, k);
                let mapping = Mapping { ours: format!("{quantity}_{unit}"), theirs };
                taken.push(quantity);
                reports[k].proposal = Some(Proposal { mapping, is_likely, reason });
            }
        }
    }
}

/// Proposes another unit for a reading whose values speak against its own.
fn doubt_unit(report: &mut ColumnReport) {
    let Role::Reading(name, suffix) = &report.role else { return };
    let Some((unit, why)) = doubt(suffix, report.range) else { return };
    let mapping = Mapping { ours: format!("{name}_{unit}"), theirs: report.header.clone() };
    report.proposal = Some(Proposal { mapping, is_likely: true, reason: why });
}

/// Which unit fits better than this one, and what speaks for it.
fn doubt(suffix: &str, range: [f64; 3]) -> Option<(&'static str, String)> {
    let dimension = dimension_of(suffix)?;
    let unit = units::find(suffix, dimension)?;
    let [low, median, _] = range;
    let usual = if dimension == Dimension::Temperature { WALL_K } else { GAS_PA };
    if !usual.contains(&unit.to_si(median)) {
        let other = fitting(dimension, range).filter(|other| other.suffix != suffix)?.suffix;
        return Some((
            other,
            format!("a median of {median} is no cylinder's in _{suffix}; in _{other} it is"),
        ));
    }
    let falls = unit.to_si(low) < NEARLY_NOTHING_PA && unit.to_si(median) > OFTEN_MORE_PA;
    let gauge = gauge_of(unit).filter(|_| falls)?.suffix;
    Some((gauge, format!("falls to {low} in _{suffix}, less than the air: gauge pressure, or no reading")))
}

impl Role {
    /// Name of the quantity, if it is one.
    pub(super) fn quantity(&self) -> Option<String> {
        match self {
            Self::Reading(name, _) => Some(name.clone()),
            Self::Truth(name, _) => Some((*name).to_owned()),
            Self::Time | Self::Simulated | Self::Aside => None,
        }
    }
}

/// Quantity, unit and reason; `by_name`: only if the name has a word for its place.
fn guess(report: &ColumnReport, by_name: bool, taken: &[String]) -> Option<(String, &'static str, String)> {
    let label = Label::of(&report.header);
    let base = label.base.to_lowercase();
    let word = WORDS.iter().find(|(parts, _)| parts.iter().any(|part| base.contains(part)));
    let is_place = word.is_some_and(|(parts, _)| parts[0] != "temp");
    let dimension = match (word, label.suffixes()) {
        (_, Some(suffixes)) => suffixes.iter().find_map(|suffix| dimension_of(suffix))?,
        (Some((_, "pressure")), None) => Dimension::Pressure,
        (Some(_), None) => Dimension::Temperature,
        (None, None) => return None,
    };
    let named = word
        .map(|(_, name)| *name)
        .filter(|name| (*name == "pressure") == (dimension == Dimension::Pressure));
    let quantity = match (dimension, named) {
        (Dimension::Pressure, _) => "pressure",
        (_, Some(name)) if is_place => name,
        _ if by_name => return None,
        _ => PLACES.into_iter().find(|place| !taken.iter().any(|name| name == place))?,
    };
    if taken.iter().any(|name| name == quantity) {
        return None;
    }
    let unit = match label.suffixes() {
        Some(suffixes) => suffixes.iter().copied().find(|suffix| units::find(suffix, dimension).is_some())?,
        None => fitting(dimension, report.range)?.suffix,
    };
    let gauge = units::find(unit, dimension).and_then(gauge_of);
    let (unit, but) = match gauge {
        Some(gauge) if is_gauge(&report.header) => (gauge.suffix, String::new()),
        Some(gauge) => (unit, format!("; as _{} if it counts from the air", gauge.suffix)),
        None => (unit, String::new()),
    };
    let by = match (named.is_some() && is_place, label.suffixes()) {
        (true, Some(_)) => "by its name and unit".to_owned(),
        (true, None) => "by its name and range".to_owned(),
        (false, _) if dimension == Dimension::Pressure => "by its unit".to_owned(),
        _ => "a temperature; where it sits is not known".to_owned(),
    };
    Some((quantity.to_owned(), unit, by + &but))
}

/// Whether a name says that the pressure counts from that of the air.
fn is_gauge(header: &str) -> bool {
    let header = header.to_lowercase();
    ["überdruck", "ueberdruck", "gauge", "relativdruck"].iter().any(|word| header.contains(word))
}

fn dimension_of(suffix: &str) -> Option<Dimension> {
    [Dimension::Temperature, Dimension::Pressure].into_iter().find(|&of| units::find(suffix, of).is_some())
}

/// The name without unit, or with it where that alone is unique.
fn unique_name(reports: &[ColumnReport], k: usize) -> String {
    let header = &reports[k].header;
    let base = Label::of(header).base;
    let others = reports.iter().enumerate().filter(|(other, _)| *other != k);
    let is_unique = others.clone().all(|(_, other)| Label::of(&other.header).base != base);
    let name = if is_unique { base } else { header };
    if label::suffixes(name).is_some() { header.clone() } else { name.to_owned() }
}
