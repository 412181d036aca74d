//! What the columns of a log mean.
//!
//! A name is a quantity and its unit, as in `shoulder_degc` or `pressure_barg`; capital letters do not matter.
//! * **Time**: `time_<unit>`, or `time` for RFC 3339. A number goes before a date where both are there.
//! * **Readings**: `shoulder`, `valve`, `ambient`, `wall_<place>`, `gas_<name>`, `pressure`, and the names of sensors
//!   that the options give.
//! * **Truth**: `gas_mean`, `mass`, `outflow`, for plots and scores, never for the estimate.
//! * `measured_<name>` is a reading in a log that was simulated. There the plain columns are what is true, not what
//!   was read, and set aside; of these only a pressure without `measured_pressure` is taken as a reading.
//!
//! `--map` goes before all of this. Everything else is set aside.
mod units;

use super::caution::{Cautions, Kind};
use super::{LogError, LogOptions, Mapping};
use crate::estimator::log::{Channel, Quantity};
use crate::thermal::document::Problem;
use crate::thermal::units::{Dimension, Unit};

/// Names of readings, for messages.
pub(super) const KNOWN: &str = "shoulder, valve, ambient, pressure, wall_<place>, gas_<name>";

/// Columns of a simulation that no observer has a use for.
const SIMULATED_ONLY: [&str; 1] = ["heat_to_gas_w"];

/// How the column of time is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeForm {
    /// A number in this unit.
    Number(&'static Unit),
    /// Date and time of RFC 3339.
    Date,
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
    /// Column of time: position, name, form.
    pub time: (usize, String, TimeForm),
    /// Readings.
    pub readings: Vec<ValueColumn<Channel>>,
    /// Truth.
    pub truth: Vec<ValueColumn<TruthQuantity>>,
}

/// What one column is.
#[derive(Clone, Debug, PartialEq)]
enum Meaning {
    Time(TimeForm),
    Reading { name: String, quantity: Quantity, unit: &'static Unit, measured: bool },
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
        let mapped = mapped(names, &options.mappings)?;
        let mut found = Vec::with_capacity(names.len());
        for (index, header) in names.iter().enumerate() {
            let own = header.to_ascii_lowercase();
            let name = mapped[index].as_deref().unwrap_or(&own);
            let meaning = meaning(name, &options.sensors).map_err(|problem| match mapped[index] {
                Some(_) => {
                    LogError::Mapping { mapping: format!("{name}={header}"), reason: problem.to_string() }
                }
                None => LogError::Column { at: at.to_owned(), problem: Box::new(problem) },
            })?;
            if mapped[index].is_some() && meaning == Meaning::Unknown {
                let reason = format!("{name} is nothing that is read; known are time, {KNOWN}");
                return Err(LogError::Mapping { mapping: format!("{name}={header}"), reason });
            }
            found.push(Found { index, header, mapped: mapped[index].is_some(), meaning });
        }
        set_aside(&found, at, cautions);
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

/// Our name of every column that a mapping names.
fn mapped(names: &[String], mappings: &[Mapping]) -> Result<Vec<Option<String>>, LogError> {
    let mut mapped = vec![None; names.len()];
    for (k, mapping) in mappings.iter().enumerate() {
        let refuse = |reason: String| LogError::Mapping { mapping: mapping.to_string(), reason };
        let same = |name: &&String| **name == mapping.theirs;
        let index = names.iter().position(|name| same(&name)).ok_or_else(|| {
            refuse(format!("the log has no column {}; it has {}", mapping.theirs, names.join(", ")))
        })?;
        if names.iter().filter(same).count() > 1 {
            return Err(refuse(format!("the log has several columns {}: rename them", mapping.theirs)));
        }
        if mappings[..k].iter().any(|other| other.theirs == mapping.theirs) {
            return Err(refuse(format!("column {} is mapped twice: keep one", mapping.theirs)));
        }
        mapped[index] = Some(units::with_unit_of(&mapping.ours, &mapping.theirs));
    }
    Ok(mapped)
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
    for base in ["shoulder", "valve", "ambient", "pressure"] {
        let dimension = if base == "pressure" { Dimension::Pressure } else { Dimension::Temperature };
        if let Some(unit) = units::of(plain, base, dimension)? {
            return Ok(reading(base, unit).unwrap_or(Meaning::Unknown));
        }
    }
    let prefixed = units::of_prefixed(plain)?;
    Ok(prefixed.and_then(|(base, unit)| reading(base, unit)).unwrap_or(Meaning::Unknown))
}

fn time(found: &[Found<'_>], at: &str) -> Result<(usize, String, TimeForm), LogError> {
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
    best.map(|(column, form)| (column.index, column.header.to_owned(), form))
        .ok_or_else(|| LogError::NoTime { at: at.to_owned(), columns: headers(found) })
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
        return Err(LogError::NoReadings { at: at.to_owned(), known: KNOWN, columns: headers(found) });
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

/// Names the columns that nobody knows, once, and what the first of them that looks like a slip may have meant.
fn set_aside(found: &[Found<'_>], at: &str, cautions: &mut Cautions) {
    let simulated = found.iter().any(|c| matches!(c.meaning, Meaning::Reading { measured: true, .. }));
    let is_known = |column: &Found<'_>| {
        column.meaning != Meaning::Unknown || (simulated && SIMULATED_ONLY.contains(&column.header))
    };
    let unknown: Vec<&str> = found.iter().filter(|c| !is_known(c)).map(|column| column.header).collect();
    if unknown.is_empty() {
        return;
    }
    let nearest = unknown.iter().find_map(|name| units::nearest(&name.to_ascii_lowercase()));
    let hint = nearest.map_or(String::new(), |name| format!("; did you mean {name}?"));
    cautions.count(Kind::SetAside, &unknown.join(", "), || (at.to_owned(), hint));
}

fn headers(found: &[Found<'_>]) -> String {
    found.iter().map(|column| column.header).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests;
