//! One column of a CSV file against its time column.
use super::Problem;
use crate::ThermalError;
use crate::units::{self, Dimension};

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

/// Reads the column `name`, whose suffix has to be a unit of `dimension`, and the column `time_<unit>`.
///
/// Lines that start with `#` are comments; a row whose cell is empty has no knot.
pub(crate) fn read(text: &str, file: &str, name: &str, dimension: Dimension) -> Result<Column, ThermalError> {
    let fault =
        |line, problem| ThermalError::Document { file: file.to_owned(), line, problem: Box::new(problem) };
    let unreadable = |error: csv::Error| {
        let line = error.position().map_or(1, |position| position.line() as usize);
        fault(line, Problem::Syntax { message: error.to_string() })
    };
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = reader.headers().map_err(unreadable)?.clone();
    let is_comment = |line: &str| line.starts_with('#') || line.trim().is_empty();
    let head_line = 1 + text.lines().take_while(|line| is_comment(line)).count();
    let names = || header.iter().collect::<Vec<_>>().join(", ");
    let (_, unit) = units::split(name).ok_or_else(|| {
        let units = units::listed(dimension);
        let example =
            units::units_of(dimension).next().map_or(name.to_owned(), |u| format!("{name}_{}", u.suffix));
        fault(head_line, Problem::NoUnit { key: name.to_owned(), example, units })
    })?;
    let unit = units::find(unit.suffix, dimension).ok_or_else(|| {
        let (unit, units) = (unit.suffix.to_owned(), units::listed(dimension));
        fault(
            head_line,
            Problem::WrongUnit { key: name.to_owned(), unit, quantity: "this signal".into(), units },
        )
    })?;
    let at = header.iter().position(|column| column == name).ok_or_else(|| {
        let nearest = super::suggestion(name, header.iter());
        fault(head_line, Problem::UnknownKey { key: name.to_owned(), nearest, known: names() })
    })?;
    let time = header.iter().enumerate().find_map(|(i, column)| match units::split(column) {
        Some(("time", unit)) if unit.dimension == Dimension::Time => Some((i, unit)),
        _ => None,
    });
    let (time_at, time_unit) = time.ok_or_else(|| {
        let remedy =
            format!("name one of the columns time_s, time_min, time_h or time_d; there are {}", names());
        fault(head_line, Problem::Missing { key: "the time column".to_owned(), remedy })
    })?;
    let time_name = header.get(time_at).unwrap_or("time").to_owned();
    let mut column =
        Column { time_name, time_s: Vec::new(), value: Vec::new(), line: Vec::new(), text: Vec::new() };
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let line = record.position().map_or(1, |position| position.line() as usize);
        let number = |i: usize, key: &str, unit: &units::Unit| {
            let text = record.get(i).unwrap_or_default();
            match text.parse::<f64>().map(|number| unit.to_si(number)) {
                Ok(number) if number.is_finite() => Ok(number),
                _ => Err(fault(line, Problem::NotFinite { key: key.to_owned(), text: text.to_owned() })),
            }
        };
        if record.get(at).is_some_and(|cell| !cell.is_empty()) {
            column.time_s.push(number(time_at, &column.time_name, time_unit)?);
            column.value.push(number(at, name, unit)?);
            column.line.push(line);
            let cell = |i: usize| record.get(i).unwrap_or_default().to_owned();
            column.text.push((cell(time_at), cell(at)));
        }
    }
    if column.time_s.is_empty() {
        let remedy = "give at least one row with a time and a value".to_owned();
        return Err(fault(head_line, Problem::Missing { key: format!("a value of {name}"), remedy }));
    }
    Ok(column)
}
