//! Times of a log: numbers in a unit, or dates of RFC 3339, or as [`date`] understands them.
use super::caution::{Cautions, Kind};
use super::cell::{Cell, shown};
use super::columns::TimeForm;
use super::{LogError, LogOptions, Zone, date};
use jiff::Timestamp;
use jiff::civil::DateTime;

/// Reads the times of one log, s. Dates count from the first one, so that no digits are lost on the year.
#[derive(Debug)]
pub(super) struct TimeReader {
    column: String,
    form: TimeForm,
    decimal_comma: bool,
    origin: Option<Timestamp>,
    /// Zone of dates that do not say theirs.
    zone: Option<Zone>,
    /// Zone of the last date that says its own, and its end as written.
    own_zone: Option<(Zone, Vec<u8>)>,
    zoned: Option<bool>,
    last: Option<Timestamp>,
    /// Rows, where they are counted.
    rows: u64,
}

impl TimeReader {
    /// A reader of this column; a date of second 0 that is known beforehand is of no use to a log without dates.
    pub(super) fn new(column: &str, form: TimeForm, decimal_comma: bool, options: &LogOptions) -> Self {
        let origin = options.origin.filter(|_| form == TimeForm::Date);
        Self {
            column: column.to_owned(),
            form,
            decimal_comma,
            origin,
            zone: options.zone.clone(),
            own_zone: None,
            zoned: None,
            last: None,
            rows: 0,
        }
    }

    /// Date of second 0, if the log has dates.
    pub(super) fn origin(&self) -> Option<Timestamp> {
        self.origin
    }

    /// Reads a cell, s; `None` is an empty one.
    pub(super) fn read(
        &mut self,
        cell: &[u8],
        at: impl Fn() -> String,
        cautions: &mut Cautions,
    ) -> Result<Option<f64>, LogError> {
        match self.form {
            TimeForm::Number(unit) => match Cell::read(cell, self.decimal_comma) {
                Cell::Number(number) => Ok(Some(unit.to_si(number))),
                Cell::WithComma(number) => {
                    cautions.count(Kind::DecimalComma, "", || (at(), shown(cell)));
                    Ok(Some(unit.to_si(number)))
                }
                Cell::Missing => Ok(None),
                Cell::Infinite | Cell::Unreadable => {
                    Err(self.refuse(cell, at(), "a finite number, with a decimal point"))
                }
            },
            TimeForm::Rows => {
                self.rows += 1;
                Ok(Some(self.rows as f64))
            }
            TimeForm::Date => self.date(cell, at, cautions),
        }
    }

    /// The zone in which the dates themselves are told.
    pub(super) fn set_own_zone(&mut self, zone: Option<Zone>) {
        self.own_zone = zone.map(|zone| (zone, Vec::new()));
    }

    /// A time that is a number in the column's unit, s; `None` is a missing one.
    ///
    /// # Errors
    /// It is infinite, or the column has dates.
    pub(super) fn number(&self, value: f64) -> Result<Option<f64>, ()> {
        match self.form {
            TimeForm::Number(unit) if !value.is_infinite() => {
                Ok(Some(unit.to_si(value)).filter(|time_s| !time_s.is_nan()))
            }
            _ => Err(()),
        }
    }

    /// Counts a date without zone where nobody has said which one it has.
    pub(super) fn without_zone(&self, shown: impl FnOnce() -> (String, String), cautions: &mut Cautions) {
        if self.zone.is_none() {
            cautions.count(Kind::WithoutZone, &self.column, shown);
        }
    }

    /// The zone of the dates: their own, or the one that was given; `None`: nobody said one.
    pub(super) fn zone(&self) -> Option<&Zone> {
        self.own_zone.as_ref().map(|(zone, _)| zone).or(self.zone.as_ref())
    }

    /// The instant of a local time; `None`: there is none in the zone.
    pub(super) fn instant(&self, local: DateTime) -> Option<Timestamp> {
        self.zone.as_ref().unwrap_or(&Zone::UTC).instant(local, self.last)
    }

    /// Whether a cell says when.
    pub(super) fn is_time(&self, cell: &[u8]) -> bool {
        if self.form != TimeForm::Date {
            return matches!(Cell::read(cell, self.decimal_comma), Cell::Number(_) | Cell::WithComma(_));
        }
        let Ok(text) = std::str::from_utf8(cell.trim_ascii()) else { return false };
        let is_date = |text: &str| text.parse::<Timestamp>().is_ok() || text.parse::<DateTime>().is_ok();
        is_date(text) || date::as_rfc3339(text).is_some() || date::is_ambiguous(text)
    }

    fn date(
        &mut self,
        cell: &[u8],
        at: impl Fn() -> String,
        cautions: &mut Cautions,
    ) -> Result<Option<f64>, LogError> {
        const EXPECTED: &str = "a date and time of RFC 3339, as 2026-01-31T08:00:00Z or 2026-01-31T08:00:00+01:00, or \
                                31.01.2026 08:00:00; a number has its unit in the column's name, as time_s";
        const LEFT_OUT: &str = "a time that the clock of the zone shows: where summer time begins it leaves an hour out. A logger \
                                that keeps its time all year has a fixed zone, as --zone +01:00";
        const AMBIGUOUS: &str = "a date that says which number is the day: year first, as 2026-01-31 08:00:00, or day first \
                                 with dots, as 31.01.2026 08:00:00";
        let text = cell.trim_ascii();
        if Cell::read(text, false) == Cell::Missing {
            return Ok(None);
        }
        let Ok(text) = std::str::from_utf8(text) else { return Err(self.refuse(cell, at(), EXPECTED)) };
        let zoned = text.parse::<Timestamp>().ok();
        let instant = match zoned {
            Some(instant) => {
                self.note_zone(text);
                instant
            }
            None => {
                let local = match date::as_rfc3339(text) {
                    Some(text) => text.parse::<DateTime>(),
                    None => text.parse::<DateTime>(),
                };
                let expected = if date::is_ambiguous(text) { AMBIGUOUS } else { EXPECTED };
                let local = local.map_err(|_| self.refuse(cell, at(), expected))?;
                let instant = self.instant(local).ok_or_else(|| self.refuse(cell, at(), LEFT_OUT))?;
                self.without_zone(|| (at(), shown(cell)), cautions);
                instant
            }
        };
        if *self.zoned.get_or_insert(zoned.is_some()) != zoned.is_some() {
            return Err(self.refuse(cell, at(), "with a zone in all rows or in none"));
        }
        Ok(Some(self.since_origin(instant)))
    }

    /// Notes the zone that a date says. Most dates of a log say the same one.
    fn note_zone(&mut self, text: &str) {
        let end = &text.as_bytes()[text.len().saturating_sub("+01:00".len())..];
        if self.own_zone.as_ref().is_none_or(|(_, known)| known != end) {
            self.own_zone = Zone::of_text(text).map(|zone| (zone, end.to_vec()));
        }
    }

    /// Seconds from the first instant, which becomes the origin.
    pub(super) fn since_origin(&mut self, instant: Timestamp) -> f64 {
        let origin = *self.origin.get_or_insert(instant);
        self.last = Some(instant);
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
        let mut reader = TimeReader::new("time", TimeForm::Date, false, &LogOptions::default());
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
    fn a_zone_that_is_given_moves_local_times_and_saves_the_caution() {
        let options = LogOptions { zone: Some("+01:00".parse().unwrap()), ..LogOptions::default() };
        let mut reader = TimeReader::new("Datum", TimeForm::Date, true, &options);
        let mut cautions = Cautions::default();
        let mut read = |text: &str| reader.read(text.as_bytes(), || "x:2".into(), &mut cautions).unwrap();
        assert_eq!((read("22.11.2026 14:05"), read("22.11.26 14:05:30,5")), (Some(0.0), Some(30.5)));
        assert!(cautions.list().is_empty());
        assert_eq!(reader.origin().unwrap().to_string(), "2026-11-22T13:05:00Z");
    }

    #[test]
    fn dates_with_and_without_zone_do_not_mix() {
        let error = read(&["2026-01-01T00:00:00", "2026-01-01T00:00:10Z"]).unwrap_err();
        assert!(error.to_string().contains("in all rows or in none"), "{error}");
    }

    #[test]
    fn what_is_no_date_is_refused_with_the_form_that_is_right() {
        let error = read(&["01/31/2026 08:00"]).unwrap_err().to_string();
        assert!(error.contains("log.csv:2: time = 01/31/2026") && error.contains("31.01.2026"), "{error}");
        for text in
            ["12.5", "31.02.2026 08:00", "1.1.2026 25:00", "2026-02-30T00:00:00Z", "08:00:00", "\u{fc}"]
        {
            let error = read(&[text]).unwrap_err().to_string();
            assert!(
                error.contains("log.csv:2: time = ") && error.contains("2026-01-31T08:00:00Z"),
                "{error}"
            );
        }
    }
}
