//! Quantities that fix a state, from options (`--pressure-bar 200`) or from the columns of a CSV file.
use super::message::Messages;
use super::unit_options::{Choice, Choices, Quantity, QuantityArguments};
use crate::properties::FixedQuantities;
use crate::thermal::units::{self, Dimension, Unit};
use anyhow::{Context, anyhow, bail};
use clap::Arg;

/// Quantities that can be given.
#[derive(Clone, Debug)]
pub(super) struct StateQuantities;

impl Choices for StateQuantities {
    const CHOICES: &'static [Choice] = &[
        ("temperature", Dimension::Temperature, "Temperature"),
        ("pressure", Dimension::Pressure, "Pressure"),
        ("density", Dimension::Density, "Density in kg/m³"),
    ];

    fn finish(option: Arg) -> Arg {
        option.conflicts_with("states")
    }
}

/// The quantities given as options.
pub(super) type Quantities = QuantityArguments<StateQuantities>;

impl Quantities {
    /// The state that exactly two quantities fix.
    pub(super) fn state(&self) -> anyhow::Result<FixedQuantities> {
        let names: Vec<&str> = self.quantities.iter().map(|q| q.name.as_str()).collect();
        if self.quantities.len() != 2 || self.quantities[0].dimension == self.quantities[1].dimension {
            let found = if names.is_empty() { "none".to_owned() } else { names.join(" and ") };
            bail!(
                "a state takes two of temperature, pressure and density, and {found} was given: \
                 write e.g. --temperature-degc 15 --pressure-bar 200, or --states FILE"
            );
        }
        from_quantities(&self.quantities)?.ok_or_else(|| anyhow!("two quantities fix a state"))
    }
}

/// The state of two or three quantities; temperature and pressure go before density. `None`: fewer than two.
fn from_quantities(given: &[Quantity]) -> anyhow::Result<Option<FixedQuantities>> {
    let si = |dimension| given.iter().find(|q| q.dimension == dimension).map(Quantity::si).transpose();
    let found = (si(Dimension::Temperature)?, si(Dimension::Pressure)?, si(Dimension::Density)?);
    Ok(match found {
        (Some(t), Some(p), _) => Some(FixedQuantities::TemperaturePressure(t, p)),
        (Some(t), None, Some(rho)) => Some(FixedQuantities::TemperatureDensity(t, rho)),
        (None, Some(p), Some(rho)) => Some(FixedQuantities::PressureDensity(p, rho)),
        _ => None,
    })
}

/// A state of a file with the line it stands in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// Line, from 1.
    pub line: u64,
    /// What it says.
    pub given: FixedQuantities,
}

/// A column of the file that says something about the state.
struct Known {
    index: usize,
    name: String,
    unit: &'static Unit,
    dimension: Dimension,
}

/// Reads the states of a CSV file.
///
/// # Errors
/// Names the file, the line, the value, the bound and the remedy.
pub(super) fn read(text: &str, file: &str, messages: &Messages) -> anyhow::Result<Vec<Row>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = reader.headers().with_context(|| format!("{file}: the header cannot be read"))?.clone();
    let header_line = header.position().map_or(1, csv::Position::line);
    let columns = columns(&header, messages, file).with_context(|| format!("{file}:{header_line}"))?;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| unreadable(file, &error))?;
        let line = record.position().map_or(0, csv::Position::line);
        if record.iter().all(str::is_empty) {
            continue;
        }
        let given = row(&record, &columns).with_context(|| format!("{file}:{line}"))?;
        rows.push(Row { line, given });
    }
    if rows.is_empty() {
        bail!("{file}: there is no state below the header: write a row of numbers for each");
    }
    Ok(rows)
}

fn unreadable(file: &str, error: &csv::Error) -> anyhow::Error {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { pos, expected_len, len } => {
            let line = pos.as_ref().map_or(0, csv::Position::line);
            anyhow!("{file}:{line}: the row has {len} cells where the header has {expected_len}: complete it")
        }
        _ => anyhow!("{file}: {error}"),
    }
}

fn columns(header: &csv::StringRecord, messages: &Messages, file: &str) -> anyhow::Result<Vec<Known>> {
    let mut known: Vec<Known> = Vec::new();
    let mut ignored = Vec::new();
    for (index, name) in header.iter().enumerate() {
        let (base, unit) = units::split(name).map_or((name, None), |(base, unit)| (base, Some(unit)));
        let Some(&(_, dimension, _)) =
            StateQuantities::CHOICES.iter().find(|(quantity, _, _)| *quantity == base)
        else {
            ignored.push(name);
            continue;
        };
        let unit = unit.and_then(|unit| units::find(unit.suffix, dimension)).ok_or_else(|| {
            anyhow!(
                "column {name} has no unit of {base}: end its name in one of {}",
                units::listed(dimension)
            )
        })?;
        if let Some(first) = known.iter().find(|column| column.dimension == dimension) {
            bail!("columns {} and {name} state the same quantity: keep one of them", first.name);
        }
        known.push(Known { index, name: name.to_owned(), unit, dimension });
    }
    if known.len() < 2 {
        let found: Vec<&str> = header.iter().collect();
        bail!(
            "a state takes two of temperature, pressure and density with units, as temperature_degc,pressure_bar; \
             the columns are {}",
            found.join(", ")
        );
    }
    if !ignored.is_empty() {
        messages.caution(&format!("{file}: ignored columns {}", ignored.join(", ")));
    }
    if known.len() == 3 {
        messages.caution(&format!("{file}: density is used only in rows without temperature or pressure"));
    }
    Ok(known)
}

fn row(record: &csv::StringRecord, columns: &[Known]) -> anyhow::Result<FixedQuantities> {
    let mut given = Vec::new();
    for column in columns {
        let text = record.get(column.index).unwrap_or_default();
        if text.is_empty() {
            continue;
        }
        let name = &column.name;
        let value =
            text.parse().map_err(|_| anyhow!("{name} = {text} must be a number, with a decimal point"))?;
        given.push(Quantity { name: name.clone(), unit: column.unit, dimension: column.dimension, value });
    }
    from_quantities(&given)?.ok_or_else(|| {
        let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
        anyhow!("fewer than two of {} have a value: complete the row or leave it out", names.join(", "))
    })
}
