//! Times for people: dates where the log has them.
use jiff::Timestamp;

/// Names times of a log.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Clock {
    origin: Option<Timestamp>,
    offset_s: f64,
}

impl Clock {
    /// Of a log whose second 0 is an instant; `None`: it has no dates.
    pub(crate) fn new(origin: Option<Timestamp>) -> Self {
        Self { origin, offset_s: 0.0 }
    }

    /// The same with a date of second 0 that has become known.
    pub(crate) fn with_origin(self, origin: Option<Timestamp>) -> Self {
        Self { origin, ..self }
    }

    /// The same for times of an axis without the jumps of the log's clock, which lies so many seconds before it.
    pub(crate) fn with_offset(self, offset_s: f64) -> Self {
        Self { offset_s, ..self }
    }

    /// The time as date in RFC 3339, in UTC and whole seconds.
    pub(crate) fn date(&self, time_s: f64) -> Option<String> {
        let origin = self.origin?;
        let fraction_s = f64::from(origin.subsec_nanosecond()) * 1e-9;
        let second = origin.as_second() as f64 + (fraction_s + time_s + self.offset_s);
        // A float beyond all dates saturates here and is refused there.
        Timestamp::from_second(second.round() as i64).ok().map(|instant| instant.to_string())
    }

    /// The time in words: a date, or the time of the log in the unit that people would say.
    pub(crate) fn text(&self, time_s: f64) -> String {
        self.date(time_s).unwrap_or_else(|| {
            let time_s = time_s + self.offset_s;
            let (size, unit) = match time_s.abs() {
                size if size < 7200.0 => (time_s, "s"),
                size if size < 3.0 * 86_400.0 => (time_s / 3600.0, "h"),
                _ => (time_s / 86_400.0, "d"),
            };
            format!("t = {} {unit}", crate::report::number(size, 4))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_a_date_in_whole_seconds_where_the_log_has_dates() {
        let clock = Clock::new(Some("2026-01-31T23:59:59.6Z".parse().unwrap()));
        assert_eq!(clock.text(0.1), "2026-02-01T00:00:00Z");
        assert_eq!(clock.date(86_400.4).as_deref(), Some("2026-02-02T00:00:00Z"));
        assert_eq!((clock.date(1e300), clock.date(f64::NAN).is_some()), (None, true));
    }

    #[test]
    fn without_dates_a_time_has_a_unit_that_suits_it() {
        let clock = Clock::default();
        assert_eq!(clock.date(5.0), None);
        let words = [90.0, 10_800.0, 864_000.0].map(|time_s| clock.text(time_s));
        assert_eq!(words, ["t = 90 s", "t = 3 h", "t = 10 d"]);
        assert_eq!(clock.with_offset(-60.0).text(90.0), "t = 30 s");
    }
}
