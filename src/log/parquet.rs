//! Logs as Parquet: the columns of a text log, as numbers and dates instead of text.
//!
//! Row groups are read in batches of a few thousand rows, so that memory does not grow with the file. Numbers may be
//! integers or floating point; a null is a missing value; `time` may be a timestamp or a text of RFC 3339.
mod text;

pub(super) use text::text;

use super::caution::{Cautions, Kind};
use super::columns::{Columns, TimeForm, one_line};
use super::row::RawRow;
use super::time::TimeReader;
use super::{LogError, LogOptions};
use crate::thermal::units::Unit;
use ::parquet::basic::{ConvertedType, LogicalType, TimeUnit, Type};
use ::parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use ::parquet::data_type::{ByteArray, DataType};
use ::parquet::errors::ParquetError;
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use ::parquet::schema::types::ColumnDescriptor;
use std::fs::File;

/// Rows that are decoded at a time.
const BATCH: usize = 4096;

/// Rows of a Parquet log.
pub(super) struct ParquetSource {
    file: String,
    reader: SerializedFileReader<File>,
    /// Row group that comes next.
    next_group: usize,
    /// Columns of the current row group: time, then the numbers.
    columns: Vec<SourceColumn>,
    time: TimeReader,
    /// Position in the batch and its length.
    at: usize,
    length: usize,
    /// Rows before the batch.
    rows_before: u64,
}

/// A column of the file that is read.
struct SourceColumn {
    index: usize,
    header: String,
    form: Form,
    reader: Option<ColumnReader>,
    batch: Batch,
}

/// How the cells of a column are meant.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    Number(&'static Unit),
    /// Nanoseconds of a tick, and whether the time has a zone.
    Instant(i64, bool),
    Text,
}

/// Decoded cells.
enum Batch {
    /// NaN is null.
    Numbers(Vec<f64>),
    Ticks(Vec<Option<i64>>),
    Texts(Vec<Option<ByteArray>>),
}

impl ParquetSource {
    /// Reads the schema and finds the columns.
    pub(super) fn open(
        input: File,
        file: &str,
        options: &LogOptions,
        cautions: &mut Cautions,
    ) -> Result<(Self, Columns), LogError> {
        let reader = SerializedFileReader::new(input).map_err(|error| refused(file, &error))?;
        let schema = reader.metadata().file_metadata().schema_descr_ptr();
        let names: Vec<String> =
            schema.columns().iter().map(|column| one_line(&column.path().string())).collect();
        let found = Columns::find(&names, file, options, cautions)?;
        let (time_at, time_name, form) = (found.time.index, &found.time.header, found.time.form);
        if found.time.clock.is_some() {
            let reason = format!("date and time stand in two columns, {time_name}: write one timestamp");
            return Err(LogError::Parquet { file: file.to_owned(), reason });
        }
        let time_form = time_form(&schema.column(time_at), form).ok_or_else(|| LogError::Parquet {
            file: file.to_owned(),
            reason: format!(
                "column {time_name} must be a timestamp, a text of RFC 3339, or a number with its unit"
            ),
        })?;
        let mut columns = vec![SourceColumn::new(time_at, time_name, time_form)];
        for (index, header, unit) in found.values() {
            check_number(&schema.column(index), file, header)?;
            columns.push(SourceColumn::new(index, header, Form::Number(unit)));
        }
        let source = Self {
            file: file.to_owned(),
            reader,
            next_group: 0,
            columns,
            time: TimeReader::new(time_name, form, false, options),
            at: 0,
            length: 0,
            rows_before: 0,
        };
        Ok((source, found))
    }

    /// Reads the next row that has a time; `false` at the end.
    pub(super) fn next(&mut self, row: &mut RawRow, cautions: &mut Cautions) -> Result<bool, LogError> {
        loop {
            if self.at == self.length && !self.fetch()? {
                return Ok(false);
            }
            let at = self.at;
            self.at += 1;
            let number = self.rows_before + self.at as u64;
            let place = || place(&self.file, number);
            let Some(time_s) = self.columns[0].time(at, &mut self.time, place, cautions)? else {
                cautions.count(Kind::WithoutTime, "", || (place(), String::new()));
                continue;
            };
            (row.time_s, row.number) = (time_s, number);
            row.values.clear();
            for column in &self.columns[1..] {
                let value = column.number(at);
                if value.is_infinite() {
                    cautions.count(Kind::Infinite, &column.header, || (place(), value.to_string()));
                }
                row.values.push(if value.is_finite() { value } else { f64::NAN });
            }
            return Ok(true);
        }
    }

    /// What reads the times.
    pub(super) fn time_reader(&self) -> &TimeReader {
        &self.time
    }

    pub(super) fn place(&self, number: u64) -> String {
        place(&self.file, number)
    }

    /// Share of the rows that has been read.
    pub(super) fn fraction(&self) -> f64 {
        let rows = self.reader.metadata().file_metadata().num_rows().max(1);
        (self.rows_before + self.at as u64) as f64 / rows as f64
    }

    /// Decodes the next batch; `false` at the end.
    fn fetch(&mut self) -> Result<bool, LogError> {
        self.rows_before += self.length as u64;
        (self.at, self.length) = (0, 0);
        loop {
            if self.columns.iter().all(|column| column.reader.is_some()) {
                let lengths: Result<Vec<usize>, ParquetError> =
                    self.columns.iter_mut().map(SourceColumn::fetch).collect();
                let lengths = lengths.map_err(|error| refused(&self.file, &error))?;
                if lengths.iter().any(|&length| length != lengths[0]) {
                    let reason = "the columns of a row group have different lengths: write the file again";
                    return Err(LogError::Parquet { file: self.file.clone(), reason: reason.to_owned() });
                }
                self.length = lengths[0];
                if self.length > 0 {
                    return Ok(true);
                }
            }
            if self.next_group == self.reader.num_row_groups() {
                return Ok(false);
            }
            let group =
                self.reader.get_row_group(self.next_group).map_err(|error| refused(&self.file, &error))?;
            self.next_group += 1;
            for column in &mut self.columns {
                let reader = group.get_column_reader(column.index);
                column.reader = Some(reader.map_err(|error| refused(&self.file, &error))?);
            }
        }
    }
}

impl SourceColumn {
    fn new(index: usize, header: &str, form: Form) -> Self {
        let batch = match form {
            Form::Number(_) => Batch::Numbers(Vec::new()),
            Form::Instant(..) => Batch::Ticks(Vec::new()),
            Form::Text => Batch::Texts(Vec::new()),
        };
        Self { index, header: header.to_owned(), form, reader: None, batch }
    }

    /// Decodes up to a batch; the number of rows.
    fn fetch(&mut self) -> Result<usize, ParquetError> {
        let Some(reader) = &mut self.reader else { return Ok(0) };
        match (&mut self.batch, reader) {
            (Batch::Numbers(out), ColumnReader::DoubleColumnReader(reader)) => {
                decode(reader, out, f64::NAN, |value| value)
            }
            (Batch::Numbers(out), ColumnReader::FloatColumnReader(reader)) => {
                decode(reader, out, f64::NAN, f64::from)
            }
            (Batch::Numbers(out), ColumnReader::Int32ColumnReader(reader)) => {
                decode(reader, out, f64::NAN, f64::from)
            }
            (Batch::Numbers(out), ColumnReader::Int64ColumnReader(reader)) => {
                decode(reader, out, f64::NAN, |value| value as f64)
            }
            (Batch::Ticks(out), ColumnReader::Int64ColumnReader(reader)) => decode(reader, out, None, Some),
            (Batch::Texts(out), ColumnReader::ByteArrayColumnReader(reader)) => {
                decode(reader, out, None, Some)
            }
            _ => Err(ParquetError::General("a row group changes the type of a column".to_owned())),
        }
    }

    /// A number in SI.
    fn number(&self, at: usize) -> f64 {
        match (&self.batch, self.form) {
            (Batch::Numbers(numbers), Form::Number(unit)) => unit.to_si(numbers[at]),
            _ => f64::NAN,
        }
    }

    /// A time, s; `None` is a missing one.
    fn time(
        &self,
        at: usize,
        reader: &mut TimeReader,
        place: impl Fn() -> String,
        cautions: &mut Cautions,
    ) -> Result<Option<f64>, LogError> {
        let refuse = |text: String| LogError::Time {
            at: place(),
            column: self.header.clone(),
            text,
            expected: "a finite number or a date of the years -9999 to 9999",
        };
        match (&self.batch, self.form) {
            (Batch::Texts(texts), _) => match &texts[at] {
                Some(text) => reader.read(text.data(), place, cautions),
                None => Ok(None),
            },
            (Batch::Ticks(ticks), Form::Instant(nanosecond, is_zoned)) => {
                let Some(tick) = ticks[at] else { return Ok(None) };
                let instant = jiff::Timestamp::from_nanosecond(i128::from(tick) * i128::from(nanosecond));
                let instant = instant.map_err(|_| refuse(tick.to_string()))?;
                if is_zoned {
                    return Ok(Some(reader.since_origin(instant)));
                }
                reader.without_zone(|| (place(), instant.to_string()), cautions);
                let local = jiff::tz::Offset::UTC.to_datetime(instant);
                let instant = reader.instant(local).ok_or_else(|| refuse(tick.to_string()))?;
                Ok(Some(reader.since_origin(instant)))
            }
            _ => match self.number(at) {
                time_s if time_s.is_infinite() => Err(refuse(time_s.to_string())),
                time_s => Ok(Some(time_s).filter(|time_s| !time_s.is_nan())),
            },
        }
    }
}

/// Reads up to a batch of a column and spreads its values over its rows.
fn decode<T: DataType, V: Clone>(
    reader: &mut ColumnReaderImpl<T>,
    out: &mut Vec<V>,
    null: V,
    convert: impl Fn(T::T) -> V,
) -> Result<usize, ParquetError> {
    let (mut levels, mut values) = (Vec::with_capacity(BATCH), Vec::with_capacity(BATCH));
    let mut rows = 0;
    // A page ends where it ends: one call may return less than what is there.
    while rows < BATCH {
        let (records, _, _) = reader.read_records(BATCH - rows, Some(&mut levels), None, &mut values)?;
        if records == 0 {
            break;
        }
        rows += records;
    }
    out.clear();
    if values.len() == rows {
        out.extend(values.into_iter().map(convert));
        return Ok(rows);
    }
    let mut values = values.into_iter();
    for level in levels {
        out.push(if level > 0 { values.next().map_or_else(|| null.clone(), &convert) } else { null.clone() });
    }
    Ok(out.len())
}

/// How a column holds the time; `None` if it cannot.
fn time_form(column: &ColumnDescriptor, form: TimeForm) -> Option<Form> {
    let is_flat = column.max_rep_level() == 0 && column.max_def_level() <= 1;
    match (form, column.physical_type()) {
        _ if !is_flat => None,
        (TimeForm::Number(unit), Type::INT32 | Type::INT64 | Type::FLOAT | Type::DOUBLE) => {
            (tick(column).is_none()).then_some(Form::Number(unit))
        }
        (TimeForm::Date, Type::INT64) => {
            tick(column).map(|(nanoseconds, zoned)| Form::Instant(nanoseconds, zoned))
        }
        (TimeForm::Date, Type::BYTE_ARRAY) => Some(Form::Text),
        _ => None,
    }
}

/// Nanoseconds of a timestamp's tick, and whether it has a zone.
fn tick(column: &ColumnDescriptor) -> Option<(i64, bool)> {
    if let Some(LogicalType::Timestamp(timestamp)) = column.logical_type_ref() {
        let nanoseconds = match timestamp.unit {
            TimeUnit::MILLIS => 1_000_000,
            TimeUnit::MICROS => 1_000,
            TimeUnit::NANOS => 1,
        };
        return Some((nanoseconds, timestamp.is_adjusted_to_u_t_c));
    }
    match column.converted_type() {
        ConvertedType::TIMESTAMP_MILLIS => Some((1_000_000, true)),
        ConvertedType::TIMESTAMP_MICROS => Some((1_000, true)),
        _ => None,
    }
}

fn check_number(column: &ColumnDescriptor, file: &str, header: &str) -> Result<(), LogError> {
    let is_number = matches!(column.physical_type(), Type::INT32 | Type::INT64 | Type::FLOAT | Type::DOUBLE);
    let is_scaled = column.converted_type() == ConvertedType::DECIMAL || tick(column).is_some();
    let is_flat = column.max_rep_level() == 0 && column.max_def_level() <= 1;
    if is_number && is_flat && !is_scaled {
        return Ok(());
    }
    let reason = format!("column {header} must hold integers or floating-point numbers: convert it");
    Err(LogError::Parquet { file: file.to_owned(), reason })
}

fn place(file: &str, row: u64) -> String {
    format!("{file} row {row}")
}

fn refused(file: &str, error: &ParquetError) -> LogError {
    let text = error.to_string();
    let remedy = if text.contains("Disabled feature") {
        "; write it with snappy or no compression"
    } else {
        "; write it again, or save the log as CSV"
    };
    LogError::Parquet { file: file.to_owned(), reason: text + remedy }
}
