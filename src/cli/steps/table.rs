//! Rows of a table that steps take at once.
use super::StepTime;
use crate::log::{Cells, MemoryLog};
use crate::thermal::units::{self, Dimension, Unit};
use anyhow::{Context, bail};

/// Rows of a table, one by one.
pub(in crate::cli) struct TableRows<'a> {
    times: Times<'a>,
    readings: Vec<(&'a str, &'a [f64])>,
    row: Vec<(&'a str, f64)>,
    name: &'a str,
    at: usize,
}

/// Time and readings of a row.
type TableRow<'r, 'a> = (StepTime, &'r [(&'a str, f64)]);

/// Times of a table.
enum Times<'a> {
    Numbers(&'a [f64], &'static Unit),
    Instants(&'a [Option<i64>], String),
}

impl<'a> Times<'a> {
    /// The times of a column; `None`: it has none.
    fn of(table: &str, column: &str, cells: &'a Cells) -> anyhow::Result<Option<Self>> {
        let unit =
            units::split(column).filter(|(base, unit)| *base == "time" && unit.dimension == Dimension::Time);
        Ok(Some(match (cells, unit) {
            (Cells::Numbers(cells), Some((_, unit))) => Self::Numbers(cells, unit),
            (Cells::Instants { nanoseconds, zone }, None) if column == "time" => {
                let zone = zone.as_ref();
                let zone =
                    zone.with_context(|| format!("{table}: the column time has no zone: give its zone"))?;
                Self::Instants(nanoseconds, zone.to_string())
            }
            (_, None) if column != "time" => return Ok(None),
            _ => bail!(
                "{table}: column {column} has {}: dates are named time, and numbers have their unit in the name, as time_s",
                cells.kind()
            ),
        }))
    }
}

impl<'a> TableRows<'a> {
    /// Of a table with a column of times; all others are readings.
    ///
    /// # Errors
    /// There is no time, or a column has something else than its name says.
    pub(in crate::cli) fn of(log: &'a MemoryLog) -> anyhow::Result<Self> {
        let name = log.name.as_str();
        let (mut times, mut readings) = (None, Vec::new());
        for (column, cells) in &log.columns {
            let Some(found) = Times::of(name, column, cells)? else {
                let Cells::Numbers(cells) = cells else {
                    let kind = cells.kind();
                    bail!(
                        "{name}: column {column} has {kind}, and readings are numbers: convert it, or leave it out"
                    );
                };
                readings.push((column.as_str(), cells.as_slice()));
                continue;
            };
            if times.replace(found).is_some() {
                bail!("{name} has two columns of time: keep one of them");
            }
        }
        let times = times.with_context(|| {
            format!("{name} has no column of time: name it time if it has dates, else time_s")
        })?;
        let rows = Self { times, readings, row: Vec::new(), name, at: 0 };
        match rows.readings.iter().find(|(_, cells)| cells.len() != rows.len()) {
            Some((column, _)) => bail!("{name}: column {column} is not as long as the times: complete it"),
            None => Ok(rows),
        }
    }

    /// Whether times are dates.
    pub(in crate::cli) fn have_dates(&self) -> bool {
        matches!(self.times, Times::Instants(..))
    }

    /// The next row.
    ///
    /// # Errors
    /// It has no time.
    pub(in crate::cli) fn next(&mut self) -> anyhow::Result<Option<TableRow<'_, 'a>>> {
        let at = self.at;
        if at == self.len() {
            return Ok(None);
        }
        self.at += 1;
        let time = match &self.times {
            Times::Numbers(cells, unit) => {
                Some(unit.to_si(cells[at])).filter(|s| s.is_finite()).map(StepTime::Second)
            }
            Times::Instants(ticks, zone) => ticks[at].map(|tick| StepTime::Instant(tick, zone.clone())),
        };
        let time = time.with_context(|| format!("{}: there is no time: leave the row out", self.place()))?;
        self.row.clear();
        self.row.extend(self.readings.iter().map(|(name, cells)| (*name, cells[at])));
        Ok(Some((time, &self.row)))
    }

    /// Place of the row that was handed out last, for a message.
    pub(in crate::cli) fn place(&self) -> String {
        format!("{} row {}", self.name, self.at)
    }

    fn len(&self) -> usize {
        match &self.times {
            Times::Numbers(cells, _) => cells.len(),
            Times::Instants(ticks, _) => ticks.len(),
        }
    }
}
