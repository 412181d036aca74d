//! The reader: rows of a source in the order of time, checked.
use super::caution::{Caution, Cautions, Kind};
use super::columns::{Columns, TimeForm, ValueColumn};
use super::csv::CsvSource;
use super::cylinders;
use super::inspect::{Survey, Tap};
use super::memory::{MemoryLog, MemorySource};
use super::row::{self, RawRow, Row, RowScreen, Truth};
use super::sampling::Sampling;
use super::source::Source;
use super::stuck::StuckWatch;
use super::unit_check::{Doubt, UnitCheck, gauge_of};
use super::zone::Zone;
use super::{LogError, LogOptions};
use crate::estimator::log::{Channel, Log};
use crate::thermal::units::{HOUR_S, Unit};
use std::io::Read;
use std::path::Path;

/// What may have set a local clock back.
const WINTER_TIME: &str = "; if summer time ended there, say the zone, as --zone Europe/Berlin";

/// Rows between two questions whether the run is to end.
const BLOCK: u64 = 1024;

/// Reads a log row by row.
pub struct LogReader {
    file: String,
    source: Source,
    columns: Columns,
    channels: Vec<Channel>,
    ranges: Vec<(f64, f64)>,
    /// What the readings of every channel say of its unit.
    units: Vec<UnitCheck>,
    /// The row that waits for another of its time.
    pending: Option<RawRow>,
    fetched: RawRow,
    row: Row,
    stuck: StuckWatch,
    sampling: Sampling,
    cautions: Cautions,
    any_order: bool,
    /// Tells whether the input has nothing more at once.
    is_waiting: Option<Box<dyn Fn() -> bool>>,
    /// Tells whether the caller wants the run to end.
    is_stopped: Option<Box<dyn FnMut() -> bool>>,
    /// Whether readings in another unit than their column's are told, not refused.
    any_unit: bool,
    ended: bool,
}

impl LogReader {
    /// Opens a file; a name that ends in `.parquet` is a Parquet file, any other a text.
    ///
    /// # Errors
    /// The file cannot be read, or its header does not say what the columns mean.
    pub fn open(path: &Path, options: &LogOptions) -> Result<Self, LogError> {
        let file = path.display().to_string();
        let opened = std::fs::File::open(path);
        let opened = opened.map_err(|source| LogError::Io { file: file.clone(), source })?;
        if is_parquet(path) {
            return Self::from_parquet(opened, &file, options);
        }
        Self::from_text(Box::new(opened), &file, options)
    }

    /// Reads a text; `file` is what messages call it.
    ///
    /// # Errors
    /// The header does not say what the columns mean.
    pub fn from_text(input: Box<dyn Read>, file: &str, options: &LogOptions) -> Result<Self, LogError> {
        let mut cautions = Cautions::default();
        let (source, columns) = CsvSource::open(input, file, options, &mut cautions)?;
        Ok(Self::new(Source::Csv(Box::new(source)), columns, file, options, cautions))
    }

    /// Reads the rows that were taken out of a log into a spool; the file is read for its header alone.
    ///
    /// # Errors
    /// The header does not say what the columns mean.
    pub(crate) fn from_spool(
        file: std::fs::File,
        rows: Box<dyn Read>,
        name: &str,
        options: &LogOptions,
    ) -> Result<Self, LogError> {
        let mut cautions = Cautions::default();
        let text = cylinders::text(file, name, u64::MAX)?;
        let (source, columns) = CsvSource::of_spool(text, rows, name, options, &mut cautions)?;
        Ok(Self::new(Source::Csv(Box::new(source)), columns, name, options, cautions))
    }

    /// Reads a log in memory.
    ///
    /// # Errors
    /// The names of its columns do not say what they mean, or a column that is read has no numbers or dates.
    pub fn from_memory(log: MemoryLog, options: &LogOptions) -> Result<Self, LogError> {
        let mut cautions = Cautions::default();
        let file = log.name.clone();
        let (source, columns) = MemorySource::open(log, options, &mut cautions)?;
        Ok(Self::new(Source::Memory(Box::new(source)), columns, &file, options, cautions))
    }

    /// Reads a Parquet file; `file` is what messages call it.
    ///
    /// # Errors
    /// The file is no Parquet file, this build cannot read any, or the names of its columns do not say what they mean.
    #[cfg(feature = "parquet")]
    pub(crate) fn from_parquet(
        input: std::fs::File,
        file: &str,
        options: &LogOptions,
    ) -> Result<Self, LogError> {
        if options.cylinder.is_some() {
            return Self::from_text(cylinders::text(input, file, u64::MAX)?, file, options);
        }
        let mut cautions = Cautions::default();
        let (source, columns) = super::parquet::ParquetSource::open(input, file, options, &mut cautions)?;
        Ok(Self::new(Source::Parquet(Box::new(source)), columns, file, options, cautions))
    }

    /// Refuses a Parquet file, which this build cannot read.
    ///
    /// # Errors
    /// Always.
    #[cfg(not(feature = "parquet"))]
    pub(crate) fn from_parquet(_: std::fs::File, file: &str, _: &LogOptions) -> Result<Self, LogError> {
        Err(LogError::WithoutParquet { file: file.to_owned() })
    }

    /// Reads a text for inspection; what a run would refuse is told in the survey.
    ///
    /// # Errors
    /// The text has no header, or a mapping cannot be.
    pub(super) fn inspect(
        input: Box<dyn Read>,
        file: &str,
        options: &LogOptions,
    ) -> Result<(Self, Survey), LogError> {
        let mut cautions = Cautions::default();
        let (source, columns, survey) = CsvSource::inspect(input, file, options, &mut cautions)?;
        let options = LogOptions { any_order: true, ..options.clone() };
        let reader = Self::new(Source::Csv(Box::new(source)), columns, file, &options, cautions);
        Ok((Self { any_unit: true, ..reader }, survey))
    }

    /// What counted the cells of a log that is inspected.
    pub(super) fn tap(&self) -> Option<&Tap> {
        self.source.tap()
    }

    fn new(source: Source, columns: Columns, file: &str, options: &LogOptions, cautions: Cautions) -> Self {
        let channels: Vec<Channel> = columns.readings.iter().map(|column| column.meaning.clone()).collect();
        let count = channels.len();
        Self {
            file: file.to_owned(),
            source,
            ranges: channels.iter().map(|channel| options.range(channel.quantity)).collect(),
            units: columns.readings.iter().map(|column| UnitCheck::new(column.unit)).collect(),
            pending: None,
            fetched: RawRow::default(),
            row: Row { time_s: 0.0, readings: vec![f64::NAN; count], truth: Truth::UNKNOWN, number: 0 },
            stuck: StuckWatch::new(channels.iter().map(|channel| channel.quantity)),
            sampling: Sampling::default(),
            cautions,
            any_order: options.any_order,
            is_waiting: None,
            is_stopped: None,
            any_unit: false,
            ended: false,
            columns,
            channels,
        }
    }

    /// What the readings of a row are, in their order.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Columns of the file by what they are for.
    pub fn columns(&self) -> &Columns {
        &self.columns
    }

    /// Hands a row out while the input is waiting for more, rather than with the row after it.
    pub(crate) fn hands_out_while(&mut self, is_waiting: impl Fn() -> bool + 'static) {
        self.is_waiting = Some(Box::new(is_waiting));
    }

    /// Asks every thousand rows whether the run is to end, which is then an error.
    pub(crate) fn stops_when(&mut self, is_stopped: impl FnMut() -> bool + 'static) {
        self.is_stopped = Some(Box::new(is_stopped));
    }

    /// Narrows what a channel can read, SI; what lies outside is taken as missing.
    pub fn set_range(&mut self, channel: usize, low: f64, high: f64) {
        self.ranges[channel] = (low, high);
    }

    /// What becomes of rows that come later, without a log.
    pub(crate) fn row_screen(&self) -> RowScreen {
        let columns = self.columns.readings.iter().zip(&self.ranges);
        RowScreen(columns.map(|(column, &range)| (column.index, column.unit, range)).collect())
    }

    /// The option that makes a channel's pressure count from the air; `None`: it does, or it is no pressure.
    pub(crate) fn as_gauge(&self, channel: usize) -> Option<String> {
        let column = &self.columns.readings[channel];
        Some(renaming(column, gauge_of(column.unit)?))
    }

    /// Date of second 0 in RFC 3339, if the log has dates and a row has been read.
    pub fn origin(&self) -> Option<String> {
        self.origin_instant().map(|origin| origin.to_string())
    }

    /// Whether the rows have dates rather than times.
    pub(crate) fn has_dates(&self) -> bool {
        self.columns.time.form == TimeForm::Date
    }

    /// The same as an instant.
    pub(crate) fn origin_instant(&self) -> Option<jiff::Timestamp> {
        self.source.time_reader().origin()
    }

    /// Zone of the dates: their own, or the one that was given.
    pub(crate) fn zone(&self) -> Option<&Zone> {
        self.source.time_reader().zone()
    }

    /// Share of the log that has been read, where the file says how long it is.
    pub fn fraction(&self) -> Option<f64> {
        self.source.fraction()
    }

    /// Place of a row for a message: file and line.
    pub fn place(&self, row: &Row) -> String {
        self.source.place(row.number)
    }

    /// Cautions so far, in the order of their first occurrence.
    pub fn cautions(&self) -> &[Caution] {
        self.cautions.list()
    }

    /// How the log is sampled so far.
    pub fn sampling(&self) -> &Sampling {
        &self.sampling
    }

    /// The next row, or `None` at the end.
    ///
    /// # Errors
    /// The log cannot be read on, runs backwards or contradicts itself; or it has ended without one usable reading.
    pub fn next_row(&mut self) -> Result<Option<&Row>, LogError> {
        let found = self.advance();
        if !found.map_err(|error| self.source.explained(error))? {
            return self.end().map(|()| None);
        }
        if self.sampling.rows().is_multiple_of(BLOCK)
            && self.is_stopped.as_mut().is_some_and(|is_stopped| is_stopped())
        {
            return Err(LogError::Stopped { at: self.place(&self.row) });
        }
        self.screen()?;
        self.sampling.push(self.row.time_s);
        Ok(Some(&self.row))
    }

    /// The remaining rows in memory.
    ///
    /// # Errors
    /// As of [`LogReader::next_row`].
    pub fn read_all(&mut self) -> Result<Log, LogError> {
        let mut log = Log { channels: self.channels.clone(), ..Log::default() };
        while let Some(row) = self.next_row()? {
            log.time_s.push(row.time_s);
            log.values.extend_from_slice(&row.readings);
        }
        Ok(log)
    }

    /// Moves the next row, joined from all rows of its time, into `self.row`; `false` at the end.
    fn advance(&mut self) -> Result<bool, LogError> {
        loop {
            if self.pending.is_some() && !self.ended && self.nothing_comes() {
                break;
            }
            let found = !self.ended && self.source.next(&mut self.fetched, &mut self.cautions)?;
            self.ended |= !found;
            let Some(pending) = &mut self.pending else {
                if !found {
                    return Ok(false);
                }
                self.pending = Some(self.fetched.clone());
                continue;
            };
            let is_other = self.fetched.time_s > pending.time_s
                || (self.any_order && self.fetched.time_s < pending.time_s);
            if !found || is_other {
                row::tell(pending, &self.columns, &mut self.row);
                if found {
                    std::mem::swap(pending, &mut self.fetched);
                } else {
                    self.pending = None;
                }
                return Ok(true);
            }
            self.same_time()?;
        }
        let pending = self.pending.take();
        pending.iter().for_each(|pending| row::tell(pending, &self.columns, &mut self.row));
        Ok(true)
    }

    /// Whether the input has nothing more at once.
    fn nothing_comes(&self) -> bool {
        self.is_waiting.as_ref().is_some_and(|is_waiting| self.source.is_drained() && is_waiting())
    }

    /// Joins the fetched row with the pending one of the same time, or refuses it.
    fn same_time(&mut self) -> Result<(), LogError> {
        let (Some(pending), fetched) = (&mut self.pending, &self.fetched) else { return Ok(()) };
        let (at, before) = (|| self.source.place(fetched.number), self.source.place(pending.number));
        if fetched.time_s < pending.time_s {
            let back_s = pending.time_s - fetched.time_s;
            let text = format!("{} s", fetched.time_s);
            let is_local = self.has_dates() && self.source.time_reader().zone().is_none();
            let hint = if is_local && back_s <= HOUR_S { WINTER_TIME } else { "" };
            return Err(LogError::Backwards { at: at(), text, before, back_s, hint });
        }
        let contradicts = |(a, b): (&f64, &f64)| !a.is_nan() && !b.is_nan() && a != b;
        if self.any_order && pending.values.iter().zip(&fetched.values).any(contradicts) {
            self.cautions.count(Kind::Contradicted, "", || (at(), String::new()));
            return Ok(());
        }
        let mut joined = false;
        for ((_, header, unit), (first, second)) in
            self.columns.values().zip(pending.values.iter_mut().zip(&fetched.values))
        {
            if first.is_nan() && !second.is_nan() {
                (*first, joined) = (*second, true);
            } else if !second.is_nan() && *first != *second {
                let (first, value) = (unit.from_si(*first), unit.from_si(*second));
                return Err(LogError::Contradiction {
                    at: at(),
                    before,
                    column: header.to_owned(),
                    value,
                    first,
                });
            }
        }
        let kind = if joined { Kind::Joined } else { Kind::Repeated };
        self.cautions.count(kind, "", || (at(), String::new()));
        Ok(())
    }

    /// Takes impossible readings as missing and watches for those that stand still.
    fn screen(&mut self) -> Result<(), LogError> {
        let row = &mut self.row;
        let place = || self.source.place(row.number);
        for (channel, value) in row.readings.iter_mut().enumerate() {
            let (low, high) = self.ranges[channel];
            if value.is_nan() {
                continue;
            }
            let is_usable = (low..=high).contains(value);
            let other = self.units[channel].push(*value, is_usable);
            if is_usable {
                continue;
            }
            let column = &self.columns.readings[channel];
            if let Some(fitting) = other.filter(|_| !self.any_unit) {
                return Err(misread(column, &self.units[channel], fitting, place()));
            }
            self.cautions.count(Kind::OutOfRange, &column.header, || {
                let [value, low, high] = [*value, low, high].map(|si| tidy(column.unit.from_si(si)));
                (place(), format!("{value} lies outside of {low} to {high}"))
            });
            *value = f64::NAN;
        }
        let (columns, cautions) = (&self.columns.readings, &mut self.cautions);
        self.stuck.push(row.time_s, &row.readings, |channel| {
            let column = &columns[channel];
            let value = || tidy(column.unit.from_si(row.readings[channel])).to_string();
            cautions.count(Kind::Stuck, &column.header, || (place(), value()));
        });
        Ok(())
    }

    /// Says which unit fits a column better than its own.
    ///
    /// # Errors
    /// None of its readings can be in its own.
    fn doubt_units(&mut self) -> Result<(), LogError> {
        for (column, check) in self.columns.readings.iter().zip(&self.units) {
            let (fitting, what) = match check.judge() {
                None => continue,
                Some(Doubt::Impossible(fitting)) => {
                    return Err(misread(column, check, fitting, self.file.clone()));
                }
                Some(Doubt::Unusual(fitting)) => (fitting, "no cylinder is usually so"),
                Some(Doubt::Gauge(fitting)) => (fitting, "an absolute pressure is never below zero"),
            };
            self.cautions.count(Kind::Unit, &column.header, || {
                let (low, high) = check.range();
                let (unit, other) = (column.unit.suffix, fitting.suffix);
                let remedy = renaming(column, fitting);
                let detail = format!(
                    "reads {} to {} in _{unit}, and {what}: if it is in _{other}, add {remedy}",
                    tidy(low),
                    tidy(high)
                );
                (self.file.clone(), detail)
            });
        }
        Ok(())
    }

    /// Looks back over the whole log.
    fn end(&mut self) -> Result<(), LogError> {
        if !self.any_unit {
            self.doubt_units()?;
        }
        let silent: Vec<&str> = self
            .columns
            .readings
            .iter()
            .zip(&self.units)
            .filter_map(|(column, check)| check.is_silent().then_some(column.header.as_str()))
            .collect();
        if silent.len() == self.channels.len() {
            let columns = silent.join(", ");
            let first = self.cautions.list().iter().find(|caution| silent.contains(&caution.column.as_str()));
            let remedy = match first {
                Some(caution) => format!("{caution}; look at the unit"),
                None => "write a row of numbers for each time below the header".to_owned(),
            };
            return Err(LogError::NoRows { file: self.file.clone(), columns, remedy });
        }
        for column in silent.into_iter().map(str::to_owned).collect::<Vec<_>>() {
            if !self.cautions.list().iter().any(|c| c.kind == Kind::Silent && c.column == column) {
                self.cautions.count(Kind::Silent, &column, || (self.file.clone(), String::new()));
            }
        }
        Ok(())
    }
}

/// Readings of a column that are a cylinder's in another unit.
fn misread(column: &ValueColumn<Channel>, check: &UnitCheck, fitting: &Unit, at: String) -> LogError {
    let (low, high) = check.range();
    LogError::Unit {
        at,
        column: column.header.clone(),
        readings: format!(
            "{} to {}, which no sensor on a cylinder shows in _{}; in _{} they are usual",
            tidy(low),
            tidy(high),
            column.unit.suffix,
            fitting.suffix
        ),
        remedy: renaming(column, fitting),
    }
}

/// The option that gives a column another unit.
fn renaming(column: &ValueColumn<Channel>, unit: &Unit) -> String {
    let mapping = format!("{}_{}={}", column.meaning.name, unit.suffix, column.header);
    let quote = if mapping.contains([' ', '[', '(']) { "'" } else { "" };
    format!("--map {quote}{mapping}{quote}")
}

/// Whether a file's name says that it is Parquet.
pub(crate) fn is_parquet(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("parquet"))
}

/// A converted number without the rounding of its conversion.
fn tidy(value: f64) -> f64 {
    crate::report::rounded(value, 10)
}
