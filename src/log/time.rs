//! Times of a log: numbers in a unit, or dates of RFC 3339.
use super::LogError;
use super::caution::{Cautions, Kind};
use super::cell::{Cell, shown};
use super::columns::TimeForm;
use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::tz::Offset;

/// Reads the times of one log, s. Dates count from the first one, so that no digits are lost on the year.
#[derive(Debug)]
pub(super) struct TimeReader {
    column: String,
    form: TimeForm,
    decimal_comma: bool,
    origin: Option<Timestamp>,
    zoned: Option<bool>,
}

impl TimeReader {
    pub fn new(column: &str, form: TimeForm, decimal_comma: bool) -> Self {
        Self { column: column.to_owned(), form, decimal_comma, origin: None, zoned: None }
    }

    /// The same with a date of second 0 that is known beforehand; of no use to a log without dates.
    pub fn with_origin(self, origin: Option<Timestamp>) -> Self {
        Self { origin: origin.filter(|_| matches!(self.form, TimeForm::Date)), ..self }
    }

    /// Date of second 0, if the log has dates.
    pub fn origin(&self) -> Option<Timestamp> {
        self.origin
    }

    /// Reads a cell, s; `None` is an empty one.
    pub fn read(
        &mut self,
        cell: &[u8],
        at: impl Fn() -> String,
        cautions: &mut Cautions,
    ) -> Result<Option<f64>, LogError> {
        match self.form {
            TimeForm::Number(unit) => match Cell::read(cell, self.decimal_comma) {
                Cell::Number(number) => Ok(Some(unit.to_si(number))),
                Cell::WithComma(number) => {
                    cautions.count(Kind::DecimalComma, &self.column, || (at(), shown(cell)));
                    Ok(Some(unit.to_si(number)))
                }
                Cell::Missing => Ok(None),
                Cell::Infinite | Cell::Unreadable => {
                    Err(self.refuse(cell, at(), "a finite number, with a decimal point"))
                }
            },
            TimeForm::Date => self.date(cell, at, cautions),
        }
    }

    fn date(
        &mut self,
        cell: &[u8],
        at: impl Fn() -> String,
        cautions: &mut Cautions,
    ) -> Result<Option<f64>, LogError> {
        const EXPECTED: &str = "a date and time of RFC 3339, as 2026-01-31T08:00:00Z or 2026-01-31T08:00:00+01:00; \
                                a number has its unit in the column's name, as time_s";
        let text = cell.trim_ascii();
        if Cell::read(text, false) == Cell::Missing {
            return Ok(None);
        }
        let Ok(text) = std::str::from_utf8(text) else { return Err(self.refuse(cell, at(), EXPECTED)) };
        let zoned = text.parse::<Timestamp>().ok();
        let instant = match zoned {
            Some(instant) => instant,
            None => {
                let local = text.parse::<DateTime>().ok();
                let instant = local.and_then(|local| Offset::UTC.to_timestamp(local).ok());
                let instant = instant.ok_or_else(|| self.refuse(cell, at(), EXPECTED))?;
                cautions.count(Kind::WithoutZone, &self.column, || (at(), shown(cell)));
                instant
            }
        };
        if *self.zoned.get_or_insert(zoned.is_some()) != zoned.is_some() {
            return Err(self.refuse(cell, at(), "with a zone in all rows or in none"));
        }
        Ok(Some(self.since_origin(instant)))
    }

    /// Seconds from the first instant, which becomes the origin.
    pub fn since_origin(&mut self, instant: Timestamp) -> f64 {
        let origin = *self.origin.get_or_insert(instant);
        (instant.as_nanosecond() - origin.as_nanosecond()) as f64 / 1e9
    }

    fn refuse(&self, cell: &[u8], at: String, expected: &'static str) -> LogError {
        LogError::Time { at, column: self.column.clone(), text: shown(cell), expected }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(cells: &[&str]) -> Result<Vec<Option<f64>>, LogError> {
        let mut reader = TimeReader::new("time", TimeForm::Date, false);
        let mut cautions = Cautions::default();
        cells.iter().map(|cell| reader.read(cell.as_bytes(), || "log.csv:2".into(), &mut cautions)).collect()
    }

    #[test]
    fn zones_are_accounted_for_and_the_first_date_is_zero() {
        let cells = ["2026-03-29T01:59:59.5+01:00", "2026-03-29T03:00:00+02:00", "2026-03-29 01:00:01z", ""];
        assert_eq!(read(&cells).unwrap(), [Some(0.0), Some(0.5), Some(1.5), None]);
    }

    #[test]
    fn a_nanosecond_of_a_date_is_not_lost_on_the_year() {
        let cells = ["2026-01-01T00:00:00Z", "2026-01-01T00:00:00.000000001Z"];
        assert_eq!(read(&cells).unwrap()[1], Some(1e-9));
    }

    #[test]
    fn dates_with_and_without_zone_do_not_mix() {
        let error = read(&["2026-01-01T00:00:00", "2026-01-01T00:00:10Z"]).unwrap_err();
        assert!(error.to_string().contains("in all rows or in none"), "{error}");
    }

    #[test]
    fn what_is_no_date_is_refused_with_the_form_that_is_right() {
        for text in ["12.5", "01/31/2026 08:00", "2026-02-30T00:00:00Z", "08:00:00", "\u{fc}"] {
            let error = read(&[text]).unwrap_err().to_string();
            assert!(
                error.contains("log.csv:2: time = ") && error.contains("2026-01-31T08:00:00Z"),
                "{error}"
            );
        }
    }
}
