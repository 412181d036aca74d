//! Exchanges of gas that were announced: `FROM..UNTIL`, each a time of the log in seconds or a date in RFC 3339.
use anyhow::{Context, bail};
use jiff::Timestamp;

/// An exchange of gas that was ordered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::cli) struct Announced {
    from: Moment,
    until: Moment,
}

/// A time as it was given.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Moment {
    /// Seconds of the log.
    Second(f64),
    Date(Timestamp),
}

impl Announced {
    /// Reads `FROM..UNTIL`.
    pub(super) fn parse(text: &str) -> anyhow::Result<Self> {
        const FORM: &str =
            "write FROM..UNTIL, each in seconds of the log or as a date like 2026-01-31T14:00:00Z";
        let Some((from, until)) = text.split_once("..") else {
            bail!("--announced {text}: {FORM}");
        };
        let moment = |text: &str| Moment::parse(text).with_context(|| format!("--announced {text}: {FORM}"));
        let announced = Self { from: moment(from)?, until: moment(until)? };
        match (announced.from, announced.until) {
            (Moment::Second(from_s), Moment::Second(until_s)) if from_s <= until_s => Ok(announced),
            (Moment::Date(from), Moment::Date(until)) if from <= until => Ok(announced),
            (Moment::Second(_), Moment::Date(_)) | (Moment::Date(_), Moment::Second(_)) => {
                bail!("--announced {text}: give both times in seconds or both as dates")
            }
            _ => bail!("--announced {text}: the end is before the beginning"),
        }
    }

    /// Both times in seconds of a log whose second 0 is an instant; `None`: it has no dates.
    pub(super) fn seconds(&self, origin: Option<Timestamp>) -> anyhow::Result<(f64, f64)> {
        Ok((self.from.second(origin)?, self.until.second(origin)?))
    }
}

impl Moment {
    fn parse(text: &str) -> anyhow::Result<Self> {
        match text.trim().parse::<f64>() {
            Ok(second) if second.is_finite() => Ok(Self::Second(second)),
            Ok(_) => bail!("{text} is no time"),
            Err(_) => Ok(Self::Date(text.trim().parse().with_context(|| format!("{text} is no date"))?)),
        }
    }

    fn second(self, origin: Option<Timestamp>) -> anyhow::Result<f64> {
        match (self, origin) {
            (Self::Second(second), _) => Ok(second),
            (Self::Date(date), Some(origin)) => Ok(date.duration_since(origin).as_secs_f64()),
            (Self::Date(date), None) => {
                bail!("--announced {date}: the log has no dates: give the time in seconds of the log")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_seconds_or_dates_of_the_log() {
        let origin: Timestamp = "2026-01-31T12:00:00Z".parse().unwrap();
        let seconds = |text: &str, origin| Announced::parse(text).unwrap().seconds(origin).unwrap();
        assert_eq!(seconds("60..3600", None), (60.0, 3600.0));
        assert_eq!(seconds("2026-01-31T12:01:00Z..2026-01-31T13:00:00Z", Some(origin)), (60.0, 3600.0));
        let date = Announced::parse("2026-01-31T12:01:00Z..2026-01-31T13:00:00Z").unwrap();
        assert!(date.seconds(None).unwrap_err().to_string().contains("no dates"));
    }

    #[test]
    fn what_is_no_span_of_time_is_refused_with_the_form() {
        for text in ["3600", "a..b", "60..NaN", "2026-01-31T12:01:00Z..60", "60..30"] {
            let message = format!("{:#}", Announced::parse(text).unwrap_err());
            assert!(message.contains("--announced"), "{message}");
        }
    }
}
