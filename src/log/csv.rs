//! Logs as text: comments, one header, rows; separated by commas, semicolons or tabs, whichever the header has most of.
//!
//! With semicolons or tabs a decimal comma is understood. A byte order mark, CRLF and blank lines are no fault.
use super::caution::{Cautions, Kind};
use super::cell::{Cell, shown};
use super::columns::Columns;
use super::reader::RawRow;
use super::record::Records;
use super::time::TimeReader;
use super::{LogError, LogOptions};
use crate::thermal::units::Unit;
use std::io::Read;

/// Rows of a text log.
pub(super) struct CsvSource {
    file: String,
    records: Records,
    /// Cells of the header, as it was read.
    header: Vec<Vec<u8>>,
    decimal_comma: bool,
    time: TimeReader,
    time_at: usize,
    /// Position, name, unit of every number.
    values: Vec<(usize, String, &'static Unit)>,
}

impl CsvSource {
    /// Reads comments and header, and finds the columns.
    pub fn open(
        input: Box<dyn Read>,
        file: &str,
        options: &LogOptions,
        cautions: &mut Cautions,
    ) -> Result<(Self, Columns), LogError> {
        let mut records = Records::new(input, file);
        if !records.advance()? {
            return Err(LogError::Empty { file: file.to_owned() });
        }
        let separator = separator(records.text());
        records.separate(separator);
        let at = records.place();
        let header: Vec<Vec<u8>> = records.iter().map(<[u8]>::to_vec).collect();
        let columns = Columns::find(&names(&header, &at)?, &at, options, cautions)?;
        let decimal_comma = separator != b',';
        let (time_at, name, form) = &columns.time;
        let source = Self {
            file: file.to_owned(),
            records,
            header,
            decimal_comma,
            time: TimeReader::new(name, *form, decimal_comma).with_origin(options.origin),
            time_at: *time_at,
            values: columns.values().map(|(i, name, unit)| (i, name.to_owned(), unit)).collect(),
        };
        Ok((source, columns))
    }

    /// Reads the next row that has a time; `false` at the end.
    pub fn next(&mut self, row: &mut RawRow, cautions: &mut Cautions) -> Result<bool, LogError> {
        while self.records.advance()? {
            if self.is_empty() || self.is_header(cautions) {
                continue;
            }
            if self.records.len() != self.header.len() && !self.has_width(cautions)? {
                continue;
            }
            let (records, at) = (&self.records, || self.records.place());
            let Some(time_s) = self.time.read(records.cell(self.time_at), at, cautions)? else {
                cautions.count(Kind::WithoutTime, "", || (at(), String::new()));
                continue;
            };
            (row.time_s, row.number) = (time_s, records.line());
            self.numbers(row, cautions);
            return Ok(true);
        }
        Ok(false)
    }

    /// Date of second 0, if the log has dates.
    pub fn origin(&self) -> Option<jiff::Timestamp> {
        self.time.origin()
    }

    pub fn place(&self, line: u64) -> String {
        format!("{}:{line}", self.file)
    }

    /// Whether the row has nothing but separators.
    fn is_empty(&self) -> bool {
        self.records.cell(0).is_empty() && self.records.iter().all(|cell| cell.trim_ascii().is_empty())
    }

    /// Whether the row is the header once more, as in logs that were joined.
    fn is_header(&self, cautions: &mut Cautions) -> bool {
        let again = self.records.cell(0) == self.header[0] && self.records.iter().eq(&self.header);
        if again {
            cautions.count(Kind::HeaderAgain, "", || (self.records.place(), String::new()));
        }
        again
    }

    /// Looks at a row with another number of cells than the header: surplus cells may be empty, a last row may be cut
    /// off (`false`), all else is refused.
    fn has_width(&self, cautions: &mut Cautions) -> Result<bool, LogError> {
        let (found, expected) = (self.records.len(), self.header.len());
        if self.records.iter().skip(expected).all(|cell| cell.trim_ascii().is_empty()) && found > expected {
            return Ok(true);
        }
        let at = self.records.place();
        if found < expected && self.records.is_cut() {
            cautions.count(Kind::CutOff, "", || (at, String::new()));
            return Ok(false);
        }
        let is_comma = found > expected && !self.decimal_comma;
        let hint = if is_comma { "; a decimal comma separates cells here: write a point" } else { "" };
        Err(LogError::Cells { at, found, expected, hint })
    }

    fn numbers(&self, row: &mut RawRow, cautions: &mut Cautions) {
        row.values.clear();
        for (index, header, unit) in &self.values {
            let cell = self.records.cell(*index);
            let (value, fault) = match Cell::read(cell, self.decimal_comma) {
                Cell::Number(number) => (unit.to_si(number), None),
                Cell::WithComma(number) => (unit.to_si(number), Some(Kind::DecimalComma)),
                Cell::Missing => (f64::NAN, None),
                Cell::Infinite => (f64::NAN, Some(Kind::Infinite)),
                Cell::Unreadable => (f64::NAN, Some(Kind::Unreadable)),
            };
            if let Some(kind) = fault {
                cautions.count(kind, header, || (self.records.place(), shown(cell)));
            }
            row.values.push(value);
        }
    }
}

/// The separator that the header has most of; a comma where it has none.
fn separator(header: &[u8]) -> u8 {
    let count = |separator: u8| header.iter().filter(|&&byte| byte == separator).count();
    // The last of equals wins.
    [b'\t', b';', b','].into_iter().max_by_key(|&separator| count(separator)).unwrap_or(b',')
}

fn names(header: &[Vec<u8>], at: &str) -> Result<Vec<String>, LogError> {
    let refuse = |what: String| LogError::NotUtf8 { at: at.to_owned(), what };
    let name = |cell: &Vec<u8>| {
        let cell = cell.trim_ascii();
        if cell.contains(&b'\r') {
            return Err(refuse("lines end in carriage returns alone".to_owned()));
        }
        let text = std::str::from_utf8(cell).map(str::to_owned);
        text.map_err(|_| refuse(format!("column {} is not UTF-8 text", shown(cell))))
    };
    header.iter().map(name).collect()
}
