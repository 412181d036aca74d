//! One column of a CSV file against its time column.
use csv::StringRecord;

use super::{Problem, check};
use crate::ThermalError;
use crate::units::{self, Dimension, Unit};

/// Knots of a column in SI, with the lines they stand in.
#[derive(Debug)]
pub(crate) struct Column {
    /// Name of the time column.
    pub time_name: String,
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Value, SI.
    pub value: Vec<f64>,
    /// Line of each knot, from 1.
    pub line: Vec<usize>,
    /// Cells of each knot as written: time and value.
    pub text: Vec<(String, String)>,
}

/// Which column of which file to read, as a specification says it.
pub(crate) struct Source<'a> {
    /// Path of the column's name in the specification.
    pub path: &'a str,
    /// Name of the column.
    pub name: &'a str,
    /// File.
    pub file: &'a str,
    /// What the column's suffix has to measure.
    pub dimension: Dimension,
}

impl Source<'_> {
    fn fault(&self, line: usize, problem: Problem) -> ThermalError {
        ThermalError::Document { file: self.file.to_owned(), line, problem: Box::new(problem) }
    }

    fn unreadable(&self, error: csv::Error) -> ThermalError {
        let line = error.position().map_or(1, |position| position.line() as usize);
        self.fault(line, Problem::Syntax { message: error.to_string() })
    }

    fn unit(&self) -> Result<&'static Unit, ThermalError> {
        let unit = units::split(self.name).and_then(|(_, unit)| units::find(unit.suffix, self.dimension));
        unit.ok_or_else(|| {
            let bound =
                format!("a column in a unit of this signal, one of {}", units::listed(self.dimension));
            check::broken(
                self.path,
                format!("{:?}", self.name),
                &bound,
                "the end of a column's name is its unit",
            )
        })
    }

    fn missing(&self, line: usize, key: String, remedy: String) -> ThermalError {
        self.fault(line, Problem::Missing { key, remedy })
    }

    fn number(&self, record: &StringRecord, i: usize, key: &str, unit: &Unit) -> Result<f64, ThermalError> {
        let text = record.get(i).unwrap_or_default();
        match text.parse::<f64>().map(|number| unit.to_si(number)) {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self
                .fault(line_of(record), Problem::NotFinite { key: key.to_owned(), text: text.to_owned() })),
        }
    }
}

fn line_of(record: &StringRecord) -> usize {
    record.position().map_or(1, |position| position.line() as usize)
}

/// The position and unit of the column `time_<unit>`.
fn time_column(header: &StringRecord) -> Option<(usize, &'static Unit)> {
    header.iter().enumerate().find_map(|(i, column)| match units::split(column) {
        Some(("time", unit)) if unit.dimension == Dimension::Time => Some((i, unit)),
        _ => None,
    })
}

/// Reads a column against the column `time_<unit>`.
///
/// Lines that start with `#` are comments; a row whose cell is empty has no knot.
pub(crate) fn read(text: &str, source: &Source<'_>) -> Result<Column, ThermalError> {
    let unit = source.unit()?;
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| source.unreadable(error))?.clone();
    let is_comment = |line: &str| line.starts_with('#') || line.trim().is_empty();
    let head_line = 1 + text.lines().take_while(|line| is_comment(line)).count();
    let at = header
        .iter()
        .position(|column| column == source.name)
        .ok_or_else(|| check::unknown(source.path, source.name, header.iter()))?;
    let (time_at, time_unit) = time_column(&header).ok_or_else(|| {
        let columns: Vec<&str> = header.iter().collect();
        let there = columns.join(", ");
        let remedy = format!("name one of the columns time_s, time_min, time_h or time_d; there are {there}");
        source.missing(head_line, "the time column".to_owned(), remedy)
    })?;
    let time_name = header.get(time_at).unwrap_or("time").to_owned();
    let mut column =
        Column { time_name, time_s: Vec::new(), value: Vec::new(), line: Vec::new(), text: Vec::new() };
    for record in reader.records() {
        let record = record.map_err(|error| source.unreadable(error))?;
        if record.get(at).is_none_or(str::is_empty) {
            continue;
        }
        column.time_s.push(source.number(&record, time_at, &column.time_name, time_unit)?);
        column.value.push(source.number(&record, at, source.name, unit)?);
        column.line.push(line_of(&record));
        let cell = |i: usize| record.get(i).unwrap_or_default().to_owned();
        column.text.push((cell(time_at), cell(at)));
    }
    if column.time_s.is_empty() {
        let remedy = "give at least one row with a time and a value".to_owned();
        return Err(source.missing(head_line, format!("a value of {}", source.name), remedy));
    }
    Ok(column)
}
