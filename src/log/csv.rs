//! Logs as text: comments, one header, rows; separated by commas, semicolons or tabs, whichever the header has most of.
//!
//! With semicolons or tabs a decimal comma is understood. A byte order mark, CRLF and blank lines are no fault; gzip is
//! unpacked.
use super::caution::{Cautions, Kind};
use super::cell::{Cell, shown};
use super::columns::Columns;
use super::header::{self, Header, decoded};
use super::inspect::{Survey, Tap};
use super::label::is_cylinder;
use super::record::Records;
use super::row::RawRow;
use super::time::TimeReader;
use super::{LogError, LogOptions, Packing, date};
use crate::thermal::units::Unit;
use std::io::Read;

/// Rows of a text log.
pub(super) struct CsvSource {
    file: String,
    records: Records,
    /// Cells of the header, as it was read.
    header: Vec<Vec<u8>>,
    separator: u8,
    decimal_comma: bool,
    time: TimeReader,
    time_at: usize,
    /// Column of the time of day, where date and time stand in two.
    clock_at: Option<usize>,
    /// Position, name, unit of every number.
    values: Vec<(usize, String, &'static Unit)>,
    /// Position of the column `cylinder` and the name whose rows are wanted.
    only: Option<(usize, Vec<u8>)>,
    /// What counts all cells, where a log is inspected.
    tap: Option<Box<Tap>>,
}

impl CsvSource {
    /// Reads comments and header, and finds the columns.
    pub(super) fn open(
        input: Box<dyn Read>,
        file: &str,
        options: &LogOptions,
        cautions: &mut Cautions,
    ) -> Result<(Self, Columns), LogError> {
        let mut records = Records::new(input, file)?;
        let Some(header) = Header::read(&mut records, options)? else {
            return Err(LogError::Empty { file: file.to_owned() });
        };
        say(&header, cautions);
        let columns = Columns::find(&header.names, &header.at, options, cautions)?;
        Ok((Self::of(file, records, header, &columns, options), columns))
    }

    /// As [`CsvSource::open`] for a log whose rows have been taken out of it into a spool: the text is read for its header alone.
    pub(super) fn of_spool(
        text: Box<dyn Read>,
        rows: Box<dyn Read>,
        file: &str,
        options: &LogOptions,
        cautions: &mut Cautions,
    ) -> Result<(Self, Columns), LogError> {
        let (source, columns) = Self::open(text, file, options, cautions)?;
        let records = Records::of_spool(rows, file, source.separator);
        Ok((Self { records, ..source }, columns))
    }

    /// As [`CsvSource::open`] for a log that is inspected: what a run would refuse is told, not refused.
    pub(super) fn inspect(
        input: Box<dyn Read>,
        file: &str,
        options: &LogOptions,
        cautions: &mut Cautions,
    ) -> Result<(Self, Columns, Survey), LogError> {
        let mut records = Records::new(input, file)?;
        let Some(header) = Header::read(&mut records, options)? else {
            return Err(LogError::Empty { file: file.to_owned() });
        };
        say(&header, cautions);
        let first = records.ahead(0)?.map(|line| header::cut(line, header.separator)).unwrap_or_default();
        let (columns, survey) = Survey::new(&header, &first, records.packing(), options, cautions)?;
        let count = header.names.len();
        let source = Self::of(file, records, header, &columns, options);
        Ok((Self { tap: Some(Box::new(Tap::new(count))), ..source }, columns, survey))
    }

    /// Whether what comes next has not been taken from the input yet.
    pub(super) fn is_drained(&self) -> bool {
        self.records.is_drained()
    }

    /// What counted the cells of a log that is inspected.
    pub(super) fn tap(&self) -> Option<&Tap> {
        self.tap.as_deref()
    }

    fn of(file: &str, records: Records, header: Header, columns: &Columns, options: &LogOptions) -> Self {
        let decimal_comma = header.separator != b',';
        let time = &columns.time;
        let named = header.names.iter().position(|name| is_cylinder(name));
        let wanted = options.cylinder.as_ref().map(|name| name.as_bytes().to_vec());
        Self {
            only: named.zip(wanted),
            file: file.to_owned(),
            records,
            header: header.cells,
            separator: header.separator,
            decimal_comma,
            time: TimeReader::new(&time.header, time.form, decimal_comma, options),
            time_at: time.index,
            clock_at: time.clock,
            values: columns.values().map(|(i, name, unit)| (i, name.to_owned(), unit)).collect(),
            tap: None,
        }
    }

    /// Reads the next row that has a time; `false` at the end.
    pub(super) fn next(&mut self, row: &mut RawRow, cautions: &mut Cautions) -> Result<bool, LogError> {
        while self.records.advance()? {
            if self.is_empty() || self.is_header(cautions) {
                continue;
            }
            if self.records.len() != self.header.len() && !self.has_width(cautions)? {
                continue;
            }
            if self.only.as_ref().is_some_and(|(at, name)| self.records.cell(*at).trim_ascii() != name) {
                continue;
            }
            let Some(time_s) = self.time(cautions)? else {
                cautions.count(Kind::WithoutTime, "", || (self.records.place(), String::new()));
                continue;
            };
            if let Some(tap) = &mut self.tap {
                tap.push(&self.records, self.decimal_comma, time_s);
            }
            (row.time_s, row.number) = (time_s, self.records.line());
            self.numbers(row, cautions);
            return Ok(true);
        }
        Ok(false)
    }

    /// Time of the row, s; `None` is a missing one.
    fn time(&mut self, cautions: &mut Cautions) -> Result<Option<f64>, LogError> {
        let (records, at) = (&self.records, || self.records.place());
        let cell = records.cell(self.time_at);
        match self.clock_at {
            None => self.time.read(cell, at, cautions),
            Some(clock) => {
                let joined = date::joined(&decoded(cell), &decoded(records.cell(clock)));
                self.time.read(joined.as_bytes(), at, cautions)
            }
        }
    }

    /// What is wrong with a packed stream, which is read to its end for that; an inspection reads on anyway.
    pub(super) fn damage(&mut self) -> Option<LogError> {
        if self.tap.is_some() || self.records.packing() == Packing::Plain {
            return None;
        }
        loop {
            match self.records.advance() {
                Ok(true) => {}
                Ok(false) | Err(LogError::Overlong { .. }) => return None,
                Err(damage) => return Some(damage),
            }
        }
    }

    /// What reads the times.
    pub(super) fn time_reader(&self) -> &TimeReader {
        &self.time
    }

    pub(super) fn place(&self, line: u64) -> String {
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
        if found < expected && self.is_remark() {
            cautions.count(Kind::Remark, "", || (at, shown(self.records.text())));
            return Ok(false);
        }
        let is_comma = found > expected && !self.decimal_comma;
        let hint = if is_comma { "; a decimal comma separates cells here: write a point" } else { "" };
        Err(LogError::Cells { at, found, expected, hint })
    }

    /// Whether the line has words and nothing that a row has: a time in its place, or a number.
    fn is_remark(&self) -> bool {
        let has_time =
            self.time_at < self.records.len() && self.time.is_time(self.records.cell(self.time_at));
        let is_word = |cell| matches!(Cell::read(cell, self.decimal_comma), Cell::Unreadable | Cell::Missing);
        let text = self.records.text();
        let is_text =
            text.iter().any(u8::is_ascii_alphabetic) && !text.iter().any(|&b| b < b' ' && b != b'\t');
        !has_time && is_text && self.records.iter().all(is_word)
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
                // A file that writes one number so writes all so: once for all columns.
                let column = if kind == Kind::DecimalComma { "" } else { header };
                cautions.count(kind, column, || (self.records.place(), shown(cell)));
            }
            row.values.push(value);
        }
    }
}

/// Says what was supposed of the header.
fn say(header: &Header, cautions: &mut Cautions) {
    if header.passed > 0 {
        cautions.count(Kind::Preamble, "", || (header.at.clone(), header.passed.to_string()));
    }
    if header.is_windows_1252 {
        cautions.count(Kind::Windows1252, "", || (header.at.clone(), String::new()));
    }
}
