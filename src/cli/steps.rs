//! What the stepping forms of `monitor` and `estimate` share: rows one by one, until the fill is known kept, and their bytes.
mod table;

use super::host::Host;
use super::input::{Inputs, LogInput};
use crate::log::{Cells, LogOptions, MemoryLog, Row, RowScreen, Truth, Zone};
use crate::report::Input;
use anyhow::{Context, bail};
use jiff::Timestamp;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
pub(super) use table::TableRows;

/// What messages call the log.
pub(super) const NAME: &str = "<steps>";
/// First bytes of a saved state, before its checksum.
const MARK: &[u8] = b"cylwatch-steps 1\n";
/// Characters of the checksum.
const SUM: usize = 64;
/// Rows that are kept at most until one has a pressure; as many as the commands look through.
pub(super) const LONGEST_WAIT: usize = 10_000;

/// When a row was read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum StepTime {
    /// Seconds of a log without dates.
    Second(f64),
    /// Time since 1970 in UTC, ns, and the zone in which it is told, as `Europe/Berlin` or `+01:00`.
    Instant(i64, String),
}

/// Rows as they came, in the units of their columns.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Frame {
    /// Names of the readings, by the first row.
    pub names: Vec<String>,
    times: Vec<StepTime>,
    /// Row by row.
    cells: Vec<f64>,
}

impl Frame {
    /// Names of rows that are not here, and a time as they have it.
    #[cfg(feature = "serve")]
    pub(super) fn of(names: &[String], time: StepTime) -> Self {
        Self { names: names.to_vec(), times: vec![time], cells: Vec::new() }
    }

    /// Readings in the order of the names; NaN for one that is missing.
    ///
    /// # Errors
    /// A name is not one of the first row, or stands twice.
    pub(super) fn cells(&mut self, readings: &[(&str, f64)]) -> anyhow::Result<Vec<f64>> {
        if self.names.is_empty() {
            self.names = readings.iter().map(|(name, _)| (*name).to_owned()).collect();
        }
        let mut cells = vec![f64::NAN; self.names.len()];
        for (name, value) in readings {
            let Some(at) = self.names.iter().position(|known| known == name) else {
                bail!(
                    "{name} was not among the readings of the first step, which has {}: name all there, NaN where one is missing",
                    self.names.join(", ")
                );
            };
            cells[at] = *value;
        }
        Ok(cells)
    }

    /// Adds a row.
    ///
    /// # Errors
    /// It is a date where the first row is none, or the other way round.
    pub(super) fn push(&mut self, time: StepTime, cells: &[f64]) -> anyhow::Result<()> {
        if let Some(first) = self.times.first()
            && std::mem::discriminant(first) != std::mem::discriminant(&time)
        {
            bail!("times are seconds or dates, as in the first step: give all of them so");
        }
        self.times.push(time);
        self.cells.extend_from_slice(cells);
        Ok(())
    }

    /// Takes the last row back.
    pub(super) fn pop(&mut self) {
        if self.times.pop().is_some() {
            self.cells.truncate(self.times.len() * self.names.len());
        }
        if self.times.is_empty() {
            self.names.clear();
        }
    }

    /// Cells of every row.
    pub(super) fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.cells.chunks(self.names.len().max(1))
    }

    /// Names, and whether there are dates, of rows that have been used.
    pub(super) fn head(&self) -> Self {
        Self {
            names: self.names.clone(),
            times: self.times.first().cloned().into_iter().collect(),
            cells: Vec::new(),
        }
    }

    /// Number of rows.
    pub(super) fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether the rows have dates; `None`: there is none yet.
    pub(super) fn has_dates(&self) -> Option<bool> {
        self.times.first().map(|time| matches!(time, StepTime::Instant(..)))
    }

    /// The rows as a log; `empty` has its columns alone.
    fn log(&self, empty: bool) -> anyhow::Result<MemoryLog> {
        let rows = if empty { 0 } else { self.len() };
        let (mut seconds, mut ticks, mut zone) = (Vec::new(), Vec::new(), None);
        for time in &self.times[..rows] {
            match time {
                StepTime::Second(second) => seconds.push(*second),
                StepTime::Instant(tick, name) => {
                    zone = Some(name.parse::<Zone>()?);
                    ticks.push(Some(*tick));
                }
            }
        }
        let time = if self.has_dates() == Some(true) {
            let zone = Some(zone.unwrap_or(Zone::UTC));
            ("time".to_owned(), Cells::Instants { nanoseconds: ticks, zone })
        } else {
            ("time_s".to_owned(), Cells::Numbers(seconds))
        };
        let width = self.names.len();
        let column = |at: usize| (0..rows).map(|row| self.cells[row * width + at]).collect();
        let readings =
            self.names.iter().enumerate().map(|(at, name)| (name.clone(), Cells::Numbers(column(at))));
        Ok(MemoryLog { name: NAME.to_owned(), columns: std::iter::once(time).chain(readings).collect() })
    }

    /// Inputs with these rows as their log, and the log.
    pub(super) fn opened(
        &self,
        documents: &[(String, String)],
        empty: bool,
        options: &LogOptions,
    ) -> anyhow::Result<(Inputs, LogInput)> {
        let inputs = inputs(documents, Some(self.log(empty)?));
        let log = inputs.log(NAME, options)?;
        Ok((inputs, log))
    }
}

/// Inputs of a stepping form.
pub(super) fn inputs(documents: &[(String, String)], log: Option<MemoryLog>) -> Inputs {
    Inputs::of(Host {
        command: "a stepping object".to_owned(),
        documents: documents.to_vec(),
        logs: RefCell::new(log.into_iter().collect()),
        ..Host::default()
    })
}

/// A row after the first ones, and the zone of its time.
///
/// # Errors
/// Its time is a date where the first row is none, or the other way round, or no number.
pub(super) fn row(
    time: &StepTime,
    origin: Option<Timestamp>,
    screen: &RowScreen,
    cells: &[f64],
) -> anyhow::Result<(Row, Option<Zone>)> {
    let (time_s, zone) = (second(time, origin)?, zone(time)?);
    Ok((Row { time_s, readings: screened(screen, cells), truth: Truth::UNKNOWN, number: 0 }, zone))
}

/// A time of a row after the first ones, s.
///
/// # Errors
/// It is a date where the first row is none, or the other way round, or no number.
fn second(time: &StepTime, origin: Option<Timestamp>) -> anyhow::Result<f64> {
    match (time, origin) {
        (StepTime::Second(second), None) if second.is_finite() => Ok(*second),
        (StepTime::Second(second), None) => bail!("time = {second} must be a finite number"),
        (StepTime::Instant(nanosecond, _), Some(origin)) => {
            Ok((i128::from(*nanosecond) - origin.as_nanosecond()) as f64 / 1e9)
        }
        _ => bail!("times are seconds or dates, as in the first step: give all of them so"),
    }
}

/// The zone of a time.
///
/// # Errors
/// It is none.
fn zone(time: &StepTime) -> anyhow::Result<Option<Zone>> {
    Ok(match time {
        StepTime::Second(_) => None,
        StepTime::Instant(_, name) => Some(name.parse()?),
    })
}

/// Bytes of a state, with a checksum.
pub(super) fn encoded(state: &impl Serialize) -> anyhow::Result<Vec<u8>> {
    let content = postcard::to_allocvec(state).context("the state cannot be put into bytes")?;
    let sum = Input::of("", &content).sha256;
    Ok([MARK, sum.as_bytes(), &content].concat())
}

/// A state from its bytes.
///
/// # Errors
/// They are those of something else, of another version, or damaged.
pub(super) fn decoded<T: for<'de> Deserialize<'de>>(bytes: &[u8]) -> anyhow::Result<T> {
    let Some(rest) = bytes.strip_prefix(MARK) else {
        bail!("these bytes are no state of this version: begin with a new object");
    };
    let damaged = "the state is damaged: its content does not fit its checksum";
    let (sum, content) = rest.split_at_checked(SUM).context(damaged)?;
    if Input::of("", content).sha256.as_bytes() != sum {
        bail!(damaged);
    }
    postcard::from_bytes(content).ok().context(damaged)
}

/// Readings of a row, SI, as a log with these columns gives them.
pub(super) fn screened(screen: &RowScreen, cells: &[f64]) -> Vec<f64> {
    // The first column of the log is the time.
    screen.readings(|column| cells[column - 1])
}
