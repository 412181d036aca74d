//! Logs in memory: the columns of a table that another program holds, such as a frame, as numbers, instants or texts.
//!
//! Names of columns mean what they mean in a file. Numbers and instants come as they are, texts as the cells of a text log.
use super::caution::{Cautions, Kind};
use super::cell::{Cell, shown};
use super::columns::{Columns, TimeForm, one_line};
use super::row::RawRow;
use super::time::TimeReader;
use super::{LogError, LogOptions, Zone};
use crate::report::{Fingerprint, Input};
use crate::thermal::units::Unit;

/// A log in memory.
#[derive(Clone, Debug, Default)]
pub struct MemoryLog {
    /// What messages call it.
    pub name: String,
    /// Names, with their units, and cells; all columns are of one length.
    pub columns: Vec<(String, Cells)>,
}

/// Cells of a column.
#[derive(Clone, Debug)]
pub enum Cells {
    /// Numbers in the unit of the column's name; NaN is a missing one.
    Numbers(Vec<f64>),
    /// Instants.
    Instants {
        /// Time since 1970, ns, in UTC, or as the clock of a log without a zone showed it.
        nanoseconds: Vec<Option<i64>>,
        /// Zone in which they are told; `None`: nobody says what their clock showed.
        zone: Option<Zone>,
    },
    /// Texts, which may be numbers or dates.
    Texts(Vec<Option<String>>),
    /// Neither of these, by the name of the type: refused if the column is one that is read.
    Other(String),
}

impl MemoryLog {
    /// Hash of names and cells.
    pub(crate) fn fingerprint(&self) -> Input {
        let mut fingerprint = Fingerprint::default();
        for (name, cells) in &self.columns {
            fingerprint.update(name.as_bytes());
            match cells {
                Cells::Numbers(cells) => {
                    cells.iter().for_each(|cell| fingerprint.update(&cell.to_le_bytes()))
                }
                Cells::Instants { nanoseconds, .. } => {
                    let ticks = nanoseconds.iter().map(|tick| tick.unwrap_or(i64::MIN));
                    ticks.for_each(|tick| fingerprint.update(&tick.to_le_bytes()));
                }
                Cells::Texts(cells) => {
                    cells.iter().flatten().for_each(|cell| fingerprint.update(cell.as_bytes()));
                }
                Cells::Other(name) => fingerprint.update(name.as_bytes()),
            }
        }
        fingerprint.input(&self.name)
    }
}

impl Cells {
    /// Number of cells.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(cells) => cells.len(),
            Self::Instants { nanoseconds, .. } => nanoseconds.len(),
            Self::Texts(cells) => cells.len(),
            Self::Other(_) => 0,
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What they are, for a message.
    pub(crate) fn kind(&self) -> &str {
        match self {
            Self::Numbers(_) => "numbers",
            Self::Instants { .. } => "dates",
            Self::Texts(_) => "texts",
            Self::Other(name) => name,
        }
    }
}

/// Rows of a log in memory.
pub(super) struct MemorySource {
    log: MemoryLog,
    time: TimeReader,
    time_at: usize,
    values: Vec<(usize, &'static Unit)>,
    at: usize,
    length: usize,
}

impl MemorySource {
    /// Finds the columns.
    pub(super) fn open(
        mut log: MemoryLog,
        options: &LogOptions,
        cautions: &mut Cautions,
    ) -> Result<(Self, Columns), LogError> {
        log.columns.iter_mut().for_each(|(name, _)| *name = one_line(name));
        let names: Vec<String> = log.columns.iter().map(|(name, _)| name.clone()).collect();
        let found = Columns::find(&names, &log.name, options, cautions)?;
        let (time_at, header, form) = (found.time.index, &found.time.header, found.time.form);
        let refuse = |column: &str, found: &str, expected| LogError::Cell {
            at: log.name.clone(),
            column: column.to_owned(),
            found: found.to_owned(),
            expected,
        };
        if found.time.clock.is_some() {
            return Err(refuse(header, "date and time of day in two columns", "one column of dates"));
        }
        let mut time = TimeReader::new(header, form, false, options);
        match (&log.columns[time_at].1, form) {
            (Cells::Numbers(_) | Cells::Texts(_), TimeForm::Number(_)) => {}
            (Cells::Instants { zone, .. }, TimeForm::Date) => time.set_own_zone(zone.clone()),
            (Cells::Texts(_), TimeForm::Date) => {}
            (cells, TimeForm::Date) => {
                return Err(refuse(
                    header,
                    cells.kind(),
                    "dates; a number has its unit in the name, as time_s",
                ));
            }
            (cells, _) => {
                return Err(refuse(header, cells.kind(), "numbers; a column of dates is named time"));
            }
        }
        for (index, header, _) in found.values() {
            if let cells @ (Cells::Instants { .. } | Cells::Other(_)) = &log.columns[index].1 {
                return Err(refuse(header, cells.kind(), "numbers"));
            }
        }
        let length = log.columns[time_at].1.len();
        let values: Vec<_> = found.values().map(|(index, _, unit)| (index, unit)).collect();
        if let Some((index, _)) = values.iter().find(|(index, _)| log.columns[*index].1.len() != length) {
            let (header, cells) = &log.columns[*index];
            return Err(refuse(header, &format!("{} cells", cells.len()), "one cell for each time"));
        }
        Ok((Self { log, time, time_at, values, at: 0, length }, found))
    }

    /// Reads the next row that has a time; `false` at the end.
    pub(super) fn next(&mut self, row: &mut RawRow, cautions: &mut Cautions) -> Result<bool, LogError> {
        while self.at < self.length {
            let at = self.at;
            self.at += 1;
            let number = self.at as u64;
            let Some(time_s) = self.time_s(at, cautions)? else {
                let place = || (self.place(number), String::new());
                cautions.count(Kind::WithoutTime, "", place);
                continue;
            };
            (row.time_s, row.number) = (time_s, number);
            row.values.clear();
            for &(index, unit) in &self.values {
                row.values.push(unit.to_si(self.number(index, at, cautions)));
            }
            return Ok(true);
        }
        Ok(false)
    }

    /// What reads the times.
    pub(super) fn time_reader(&self) -> &TimeReader {
        &self.time
    }

    /// Place of a row for a message; the first row is 1.
    pub(super) fn place(&self, number: u64) -> String {
        format!("{} row {number}", self.log.name)
    }

    /// Share of the rows that has been read.
    pub(super) fn fraction(&self) -> f64 {
        self.at as f64 / self.length.max(1) as f64
    }

    /// A number in its column's unit; NaN for one that is missing or none.
    fn number(&self, index: usize, at: usize, cautions: &mut Cautions) -> f64 {
        let (header, cells) = &self.log.columns[index];
        let place = |shown: String| (self.place(at as u64 + 1), shown);
        match cells {
            Cells::Numbers(numbers) if numbers[at].is_infinite() => {
                cautions.count(Kind::Infinite, header, || place(numbers[at].to_string()));
                f64::NAN
            }
            Cells::Numbers(numbers) => numbers[at],
            Cells::Texts(texts) => {
                let text = texts[at].as_deref().unwrap_or_default().as_bytes();
                let fault = match Cell::read(text, false) {
                    Cell::Number(number) | Cell::WithComma(number) => return number,
                    Cell::Missing => return f64::NAN,
                    Cell::Infinite => Kind::Infinite,
                    Cell::Unreadable => Kind::Unreadable,
                };
                cautions.count(fault, header, || place(shown(text)));
                f64::NAN
            }
            Cells::Instants { .. } | Cells::Other(_) => f64::NAN,
        }
    }

    /// A time, s; `None` is a missing one.
    fn time_s(&mut self, at: usize, cautions: &mut Cautions) -> Result<Option<f64>, LogError> {
        let (header, cells) = &self.log.columns[self.time_at];
        let place = || format!("{} row {}", self.log.name, at + 1);
        let refuse = |text: String| LogError::Time {
            at: place(),
            column: header.clone(),
            text,
            expected: "a finite number or a date of the years -9999 to 9999",
        };
        match cells {
            Cells::Texts(texts) => match &texts[at] {
                Some(text) => self.time.read(text.as_bytes(), place, cautions),
                None => Ok(None),
            },
            Cells::Numbers(numbers) => {
                self.time.number(numbers[at]).map_err(|_| refuse(numbers[at].to_string()))
            }
            Cells::Instants { nanoseconds, zone } => {
                let Some(tick) = nanoseconds[at] else { return Ok(None) };
                let instant = jiff::Timestamp::from_nanosecond(i128::from(tick));
                let instant = instant.map_err(|_| refuse(tick.to_string()))?;
                if zone.is_some() {
                    return Ok(Some(self.time.since_origin(instant)));
                }
                self.time.without_zone(|| (place(), instant.to_string()), cautions);
                let local = jiff::tz::Offset::UTC.to_datetime(instant);
                let instant = self.time.instant(local).ok_or_else(|| refuse(local.to_string()))?;
                Ok(Some(self.time.since_origin(instant)))
            }
            Cells::Other(_) => Ok(None),
        }
    }
}
