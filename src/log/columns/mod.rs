//! What the columns of a log mean.
//!
//! A name is a quantity and its unit, as in `shoulder_degc` or `pressure_barg`; capital letters do not matter.
//! * **Time**: `time_<unit>`, or `time` for a date. A number goes before a date where both are there. A log without either
//!   may have `Datum` and `Zeit`, or `Date` and `Time`, in two columns or in one.
//! * **Readings**: `shoulder`, `valve`, `ambient`, `wall_<place>`, `gas_<name>`, `pressure`, and the names of sensors
//!   that the options give.
//! * **Truth**: `gas_mean`, `mass`, `outflow`, for plots and scores, never for the estimate.
//! * `measured_<name>` is a reading in a log that was simulated. There the plain columns are what is true, not what
//!   was read, and set aside; of these only a pressure without `measured_pressure` is taken as a reading.
//!
//! A unit may stand in brackets, too: `Pressure [bar]`. `--map` goes before all of this. Everything else is set aside.
mod mapped;
mod survey;
mod units;

pub(super) use survey::survey;

use super::caution::{Cautions, Kind};
use super::label::{Label, is_cylinder};
use super::{LogError, LogOptions};
use crate::estimator::log::{Channel, Quantity};
use crate::estimator::sensor::KindChoice;
use crate::thermal::document::Problem;
use crate::thermal::units::{Dimension, Unit};
use std::sync::LazyLock;

/// Names of readings, for messages: whole ones before beginnings.
static KNOWN: LazyLock<String> = LazyLock::new(|| {
    let (beginnings, whole): (Vec<_>, Vec<_>) =
        KindChoice::columns().map(|(name, _)| name).partition(|name| name.contains('<'));
    [whole, beginnings].concat().join(", ")
});

/// Whether a column of a simulation is one that no observer has a use for: what only the model sees.
fn is_simulated_only(header: &str) -> bool {
    header == "heat_to_gas_w"
        || ["wall_inner_", "liner_"].iter().any(|beginning| header.starts_with(beginning))
        || ["_source_degc", "_source_bar"].iter().any(|end| header.ends_with(end))
}

/// Names of a column of dates, in small letters.
const DATE: [&str; 3] = ["date", "datum", "tag"];
/// Names of a column of times of day.
const CLOCK: [&str; 4] = ["time", "zeit", "uhrzeit", "clock"];
/// Names of a column of both.
const DATE_AND_CLOCK: [&str; 9] = [
    "date/time",
    "date time",
    "datetime",
    "datum/zeit",
    "datum/uhrzeit",
    "datum zeit",
    "datum uhrzeit",
    "datum und zeit",
    "date and time",
];

/// How the column of time is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeForm {
    /// A number in this unit.
    Number(&'static Unit),
    /// Date and time.
    Date,
    /// None: rows are counted. Only while a log is inspected that has no time.
    Rows,
}

/// Where the time of a row stands.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeColumn {
    /// Position in the file, from 0.
    pub index: usize,
    /// Name as written; of two columns `Datum+Zeit`.
    pub header: String,
    /// How it is written.
    pub form: TimeForm,
    /// Position of the time of day, where `index` holds the date alone.
    pub clock: Option<usize>,
}

/// Something true that only a simulation or a weighing knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TruthQuantity {
    /// Mean temperature of the gas, K.
    GasMean,
    /// Mass of the gas, kg.
    Mass,
    /// Mass that leaves, kg/s.
    Outflow,
}

/// A column with a number.
#[derive(Clone, Debug, PartialEq)]
pub struct ValueColumn<M> {
    /// Position in the file, from 0.
    pub index: usize,
    /// Name as written.
    pub header: String,
    /// Unit of its cells.
    pub unit: &'static Unit,
    /// What it means.
    pub meaning: M,
}

/// The columns of a log by what they are for.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// Time.
    pub time: TimeColumn,
    /// Readings.
    pub readings: Vec<ValueColumn<Channel>>,
    /// Truth.
    pub truth: Vec<ValueColumn<TruthQuantity>>,
}

/// What one column is.
#[derive(Clone, Debug, PartialEq)]
enum Meaning {
    Time(TimeForm),
    /// Time of day, beside a column of dates.
    Clock,
    Reading {
        name: String,
        quantity: Quantity,
        unit: &'static Unit,
        measured: bool,
    },
    Truth(TruthQuantity, &'static Unit),
    Unknown,
}

/// A column with what it is.
struct Found<'a> {
    index: usize,
    header: &'a str,
    mapped: bool,
    meaning: Meaning,
}

impl Columns {
    /// Finds out what the columns of a file mean; `at` is the place of the header.
    pub(super) fn find(
        names: &[String],
        at: &str,
        options: &LogOptions,
        cautions: &mut Cautions,
    ) -> Result<Self, LogError> {
        let mut found = found(names, at, options, Err)?;
        pair(&mut found);
        set_aside(&found, at, options, cautions);
        let columns = Self {
            time: time(&found, at)?,
            readings: readings(&found, at, options, cautions)?,
            truth: truth(&found, at)?,
        };
        Ok(columns)
    }

    /// Position, name and unit of every number of a row: readings, then truth.
    pub(super) fn values(&self) -> impl Iterator<Item = (usize, &str, &'static Unit)> {
        let readings = self.readings.iter().map(|c| (c.index, c.header.as_str(), c.unit));
        readings.chain(self.truth.iter().map(|c| (c.index, c.header.as_str(), c.unit)))
    }
}

/// What each column is by itself; `on_problem` decides what becomes of one whose unit is wrong.
fn found<'a>(
    names: &'a [String],
    at: &str,
    options: &LogOptions,
    mut on_problem: impl FnMut(LogError) -> Result<Meaning, LogError>,
) -> Result<Vec<Found<'a>>, LogError> {
    let mapped = mapped::names(names, &options.mappings)?;
    let mut found = Vec::with_capacity(names.len());
    for (index, (header, mapped)) in names.iter().zip(&mapped).enumerate() {
        let own = Label::of(header).own();
        let name = mapped.as_deref().unwrap_or(&own);
        let refuse = |reason| LogError::Mapping { mapping: format!("{name}={header}"), reason };
        let meaning = match meaning(name, &options.sensors) {
            _ if name == mapped::CLOCK => Meaning::Clock,
            Ok(Meaning::Unknown) if mapped.is_some() => {
                return Err(refuse(format!("{name} is nothing that is read; known are time, {}", *KNOWN)));
            }
            Ok(meaning) => meaning,
            Err(problem) if mapped.is_some() => return Err(refuse(problem.to_string())),
            Err(problem) => on_problem(LogError::Column { at: at.to_owned(), problem: Box::new(problem) })?,
        };
        found.push(Found { index, header, mapped: mapped.is_some(), meaning });
    }
    Ok(found)
}

/// Whether a name in small letters is one of ours, with its unit.
pub(super) fn is_ours(name: &str, sensors: &[String]) -> bool {
    let known = meaning(name, sensors);
    is_simulated_only(name)
        || known.is_ok_and(|known| {
            !matches!(known, Meaning::Unknown | Meaning::Clock | Meaning::Time(TimeForm::Date))
        })
}

/// Whether a name in small letters says that its column is a date or a time.
pub(super) fn is_time_word(name: &str) -> bool {
    [&DATE[..], &CLOCK, &DATE_AND_CLOCK].concat().contains(&name)
}

/// Finds date and time of day in a log that has no other time.
fn pair(found: &mut [Found<'_>]) {
    let is_time = |column: &Found<'_>| matches!(column.meaning, Meaning::Time(_));
    let is_plain = |column: &Found<'_>| {
        !column.mapped
            && column.meaning == Meaning::Time(TimeForm::Date)
            && Label::of(column.header).own() == "time"
    };
    if found.iter().any(|column| is_time(column) && !is_plain(column)) {
        return;
    }
    let position = |words: &[&str]| {
        let is_it = |column: &Found<'_>| {
            let is_free = column.meaning == Meaning::Unknown || is_plain(column);
            is_free && words.contains(&Label::of(column.header).own().as_str())
        };
        found.iter().position(is_it)
    };
    match (position(&DATE_AND_CLOCK), position(&DATE), position(&CLOCK)) {
        (Some(whole), ..) if !found.iter().any(is_time) => {
            found[whole].meaning = Meaning::Time(TimeForm::Date)
        }
        (_, Some(date), Some(clock)) => {
            found[date].meaning = Meaning::Time(TimeForm::Date);
            found[clock].meaning = Meaning::Clock;
        }
        _ => {}
    }
}

/// What a name in small letters means.
fn meaning(name: &str, sensors: &[String]) -> Result<Meaning, Problem> {
    if name == "time" {
        return Ok(Meaning::Time(TimeForm::Date));
    }
    if let Some(unit) = units::of(name, "time", Dimension::Time)? {
        return Ok(Meaning::Time(TimeForm::Number(unit)));
    }
    let truths = [
        ("gas_mean", Dimension::Temperature, TruthQuantity::GasMean),
        ("mass", Dimension::Mass, TruthQuantity::Mass),
        ("outflow", Dimension::MassFlow, TruthQuantity::Outflow),
    ];
    for (base, dimension, truth) in truths {
        if let Some(unit) = units::of(name, base, dimension)? {
            return Ok(Meaning::Truth(truth, unit));
        }
    }
    let (plain, measured) = name.strip_prefix("measured_").map_or((name, false), |plain| (plain, true));
    let reading = |name: &str, unit: &'static Unit| {
        let quantity = units::quantity(unit)?;
        Some(Meaning::Reading { name: name.to_owned(), quantity, unit, measured })
    };
    if let Some((base, unit)) = crate::thermal::units::split(plain)
        && (measured || sensors.iter().any(|sensor| sensor.eq_ignore_ascii_case(base)))
        && let Some(reading) = reading(base, unit)
    {
        return Ok(reading);
    }
    for (base, dimension) in units::whole_names() {
        if let Some(unit) = units::of(plain, base, dimension)? {
            return Ok(reading(base, unit).unwrap_or(Meaning::Unknown));
        }
    }
    // Inside is no place that a sensor of the surface sits at.
    if plain.starts_with("wall_inner_") {
        return Ok(Meaning::Unknown);
    }
    let prefixed = units::of_prefixed(plain)?;
    Ok(prefixed.and_then(|(base, unit)| reading(base, unit)).unwrap_or(Meaning::Unknown))
}

fn time(found: &[Found<'_>], at: &str) -> Result<TimeColumn, LogError> {
    let times = found.iter().filter_map(|column| match column.meaning {
        Meaning::Time(form) => Some((column, form)),
        _ => None,
    });
    let mut best: Option<(&Found<'_>, TimeForm)> = None;
    for (column, form) in times {
        let rank = |column: &Found<'_>, form| (column.mapped, matches!(form, TimeForm::Number(_)));
        match best {
            Some((first, of_first)) if rank(first, of_first) == rank(column, form) => {
                return Err(twice(column, first, at));
            }
            Some((first, of_first)) if rank(first, of_first) > rank(column, form) => {}
            _ => best = Some((column, form)),
        }
    }
    let (column, form) =
        best.ok_or_else(|| LogError::NoTime { at: at.to_owned(), columns: headers(found) })?;
    let clock = found.iter().find(|column| column.meaning == Meaning::Clock && form == TimeForm::Date);
    let header =
        clock.map_or(column.header.to_owned(), |clock| format!("{}+{}", column.header, clock.header));
    Ok(TimeColumn { index: column.index, header, form, clock: clock.map(|clock| clock.index) })
}

fn readings(
    found: &[Found<'_>],
    at: &str,
    options: &LogOptions,
    cautions: &mut Cautions,
) -> Result<Vec<ValueColumn<Channel>>, LogError> {
    let simulated = found.iter().any(|c| matches!(c.meaning, Meaning::Reading { measured: true, .. }));
    let mut chosen: Vec<(&Found<'_>, (bool, bool), ValueColumn<Channel>)> = Vec::new();
    for column in found {
        let Meaning::Reading { name, quantity, unit, measured } = &column.meaning else { continue };
        let is_read = *measured || column.mapped || !simulated || is_sensor(name, options);
        if !is_read && *quantity != Quantity::Pressure {
            continue;
        }
        let rank = (column.mapped, *measured);
        let channel = Channel { name: name.clone(), quantity: *quantity };
        let (index, header) = (column.index, column.header.to_owned());
        let value = ValueColumn { index, header, unit, meaning: channel };
        match chosen.iter_mut().find(|(_, _, other)| other.meaning.name == *name) {
            Some((first, of_first, _)) if *of_first == rank => return Err(twice(column, first, at)),
            Some((_, of_first, _)) if *of_first > rank => {}
            Some(first) => *first = (column, rank, value),
            None => chosen.push((column, rank, value)),
        }
    }
    if chosen.is_empty() {
        return Err(LogError::NoReadings { at: at.to_owned(), known: &KNOWN, columns: headers(found) });
    }
    for (_, rank, column) in &chosen {
        if simulated && *rank == (false, false) && !is_sensor(&column.meaning.name, options) {
            cautions.count(Kind::Perfect, &column.header, || (at.to_owned(), String::new()));
        }
    }
    Ok(chosen.into_iter().map(|(_, _, column)| column).collect())
}

fn is_sensor(name: &str, options: &LogOptions) -> bool {
    options.sensors.iter().any(|sensor| sensor.eq_ignore_ascii_case(name))
}

fn truth(found: &[Found<'_>], at: &str) -> Result<Vec<ValueColumn<TruthQuantity>>, LogError> {
    let mut chosen: Vec<(&Found<'_>, ValueColumn<TruthQuantity>)> = Vec::new();
    for column in found {
        let Meaning::Truth(truth, unit) = column.meaning else { continue };
        let (index, header) = (column.index, column.header.to_owned());
        let value = ValueColumn { index, header, unit, meaning: truth };
        match chosen.iter_mut().find(|(_, other)| other.meaning == truth) {
            Some((first, _)) if first.mapped == column.mapped => return Err(twice(column, first, at)),
            Some((first, _)) if first.mapped => {}
            Some(first) => *first = (column, value),
            None => chosen.push((column, value)),
        }
    }
    Ok(chosen.into_iter().map(|(_, column)| column).collect())
}

fn twice(second: &Found<'_>, first: &Found<'_>, at: &str) -> LogError {
    let (_, line) = at.rsplit_once(':').unwrap_or((at, "1"));
    LogError::Column {
        at: at.to_owned(),
        problem: Box::new(Problem::Twice {
            key: second.header.to_owned(),
            first: first.header.to_owned(),
            first_line: line.parse().unwrap_or(1),
        }),
    }
}

/// Names the unrecognised columns, once, and what the first of them that looks like a slip may have meant.
fn set_aside(found: &[Found<'_>], at: &str, options: &LogOptions, cautions: &mut Cautions) {
    let simulated = found.iter().any(|c| matches!(c.meaning, Meaning::Reading { measured: true, .. }));
    let is_known = |column: &Found<'_>| {
        column.meaning != Meaning::Unknown
            || (simulated && is_simulated_only(column.header))
            || (options.cylinder.is_some() && is_cylinder(column.header))
    };
    let unknown: Vec<&str> = found.iter().filter(|c| !is_known(c)).map(|column| column.header).collect();
    if unknown.is_empty() {
        return;
    }
    let nearest = unknown.iter().find_map(|name| units::nearest(&name.to_ascii_lowercase()));
    let hint = nearest.map_or(String::new(), |name| format!("; did you mean {name}?"));
    cautions.count(Kind::SetAside, &unknown.join(", "), || (at.to_owned(), hint));
}

/// A name of a table that is no text file as one line of text, as messages show it and mappings name it.
pub(super) fn one_line(name: &str) -> String {
    name.replace(char::is_control, " ").trim().to_owned()
}

fn headers(found: &[Found<'_>]) -> String {
    found.iter().map(|column| column.header).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests;
