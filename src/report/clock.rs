//! Times of a log as its own clock showed them: dates where it has them.
//!
//! Inside, time goes on where the clock of the log jumped. Here it is told as the clock showed it, before a jump as before, after it as after.
use crate::log::Zone;
use jiff::Timestamp;
use jiff::civil::Date;
use serde::{Deserialize, Serialize};

/// Jumps that are remembered.
const MOST_JUMPS: usize = 64;

/// Offsets that differ by less are the same, s: times have rounding errors.
const RESOLVED_S: f64 = 1e-3;

/// Names times of a log.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clock {
    origin: Option<Timestamp>,
    zone: Option<Zone>,
    shown: Shown,
}

/// What the clock of a log shows at the times inside: from each time on, s, so much more, s.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Shown(Vec<(f64, f64)>);

impl Shown {
    /// Time of the log, s.
    fn at(&self, time_s: f64) -> f64 {
        let piece = self.0.iter().rev().find(|(from_s, _)| *from_s <= time_s).or(self.0.first());
        time_s + piece.map_or(0.0, |&(_, offset_s)| offset_s)
    }

    /// Notes that at a time the clock shows so much more.
    fn note(&mut self, time_s: f64, offset_s: f64) {
        let last_s = self.0.last().map(|(_, last_s)| *last_s);
        if last_s.is_some_and(|last_s| (last_s - offset_s).abs() < RESOLVED_S) {
            return;
        }
        self.0.push((if last_s.is_none() { f64::NEG_INFINITY } else { time_s }, offset_s));
        let surplus = self.0.len().saturating_sub(MOST_JUMPS);
        self.0.drain(..surplus);
    }
}

impl Clock {
    /// Of a log whose second 0 is an instant and whose dates have a zone; `None`: it has no dates, or nobody said a zone.
    pub(crate) fn new(origin: Option<Timestamp>, zone: Option<Zone>) -> Self {
        Self { origin, zone, shown: Shown::default() }
    }

    /// The same, going on from what it showed before.
    pub(crate) fn after(self, shown: Shown) -> Self {
        Self { shown, ..self }
    }

    /// What becomes known of the dates with the rows.
    pub(crate) fn set(&mut self, origin: Option<Timestamp>, zone: Option<&Zone>) {
        self.origin = origin;
        if self.zone.as_ref() != zone {
            self.zone = zone.cloned();
        }
    }

    /// Notes what the clock of the log showed at a time.
    pub(crate) fn note(&mut self, time_s: f64, shown_s: f64) {
        self.shown.note(time_s, shown_s - time_s);
    }

    /// What the clock of the log has shown, for a run that goes on.
    pub(crate) fn shown(&self) -> &Shown {
        &self.shown
    }

    /// The time as the log has it, s.
    pub(crate) fn of_log_s(&self, time_s: f64) -> f64 {
        self.shown.at(time_s)
    }

    /// The time as date in RFC 3339, in whole seconds and in the zone of the log.
    pub(crate) fn date(&self, time_s: f64) -> Option<String> {
        self.date_of_log(self.shown.at(time_s))
    }

    /// The same to the minute, as it stands below a figure.
    pub(crate) fn minute(&self, time_s: f64) -> Option<String> {
        let date = self.date(time_s)?;
        let (day, time) = date.split_once('T')?;
        Some(format!("{day} {} {}", time.get(..5)?, time.get(8..)?.replace('Z', "UTC")))
    }

    /// The same of a time as the log has it.
    pub(crate) fn date_of_log(&self, time_s: f64) -> Option<String> {
        let origin = self.origin?;
        let fraction_s = f64::from(origin.subsec_nanosecond()) * 1e-9;
        let second = origin.as_second() as f64 + (fraction_s + time_s);
        // A float beyond all dates saturates here and is refused there.
        let instant = Timestamp::from_second(second.round() as i64).ok()?;
        Some(self.zone.as_ref().unwrap_or(&Zone::UTC).text(instant))
    }

    /// The day of a time as the log has it, in its zone.
    pub(crate) fn day_of_log(&self, time_s: f64) -> Option<Date> {
        let text = self.date_of_log(time_s)?;
        text.split_once('T')?.0.parse().ok()
    }

    /// The time in words: a date, or the time of the log in the unit that people would say.
    pub(crate) fn text(&self, time_s: f64) -> String {
        self.text_of_log(self.shown.at(time_s))
    }

    /// The same of a time as the log has it.
    pub(crate) fn text_of_log(&self, time_s: f64) -> String {
        self.date_of_log(time_s).unwrap_or_else(|| {
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
        let clock = Clock::new(Some("2026-01-31T23:59:59.6Z".parse().unwrap()), None);
        assert_eq!(clock.text(0.1), "2026-02-01T00:00:00Z");
        assert_eq!(clock.date(86_400.4).as_deref(), Some("2026-02-02T00:00:00Z"));
        assert_eq!(clock.minute(0.4).as_deref(), Some("2026-02-01 00:00 UTC"));
        assert_eq!((clock.date(1e300), clock.date(f64::NAN).is_some()), (None, true));
    }

    #[test]
    fn without_dates_a_time_has_a_unit_that_suits_it() {
        let clock = Clock::default();
        assert_eq!(clock.date(5.0), None);
        let words = [90.0, 10_800.0, 864_000.0].map(|time_s| clock.text(time_s));
        assert_eq!(words, ["t = 90 s", "t = 3 h", "t = 10 d"]);
    }

    #[test]
    fn a_time_before_a_jump_of_the_clock_stays_what_the_clock_showed() {
        let mut clock = Clock::default();
        for (time_s, shown_s) in [(0.0, 0.0), (60.0, 60.0), (120.0, 3720.0), (180.0, 3780.0), (240.0, 180.0)]
        {
            clock.note(time_s, shown_s);
        }
        assert_eq!(
            [30.0, 119.0, 120.0, 200.0, 250.0].map(|s| clock.of_log_s(s)),
            [30.0, 119.0, 3720.0, 3800.0, 190.0]
        );
        let later = Clock::default().after(clock.shown().clone());
        assert_eq!(later.of_log_s(130.0), 3730.0);
        // A state that begins after a jump knows no other offset.
        let mut clock = Clock::default();
        clock.note(500.0, 440.0);
        assert_eq!(clock.of_log_s(90.0), 30.0);
    }

    #[test]
    fn dates_are_in_the_zone_of_the_log() {
        let midnight =
            Clock::new(Some("2026-10-30T23:00:00Z".parse().unwrap()), "Europe/Berlin".parse().ok());
        assert_eq!(midnight.day_of_log(0.0).unwrap().to_string(), "2026-10-31");
        assert_eq!(midnight.minute(0.0).as_deref(), Some("2026-10-31 00:00 +01:00"));
        let zone: Zone = "Europe/Berlin".parse().unwrap();
        let clock = Clock::new(Some("2026-10-25T00:59:00Z".parse().unwrap()), Some(zone));
        assert_eq!(
            [0.0, 60.0].map(|s| clock.text(s)),
            ["2026-10-25T02:59:00+02:00", "2026-10-25T02:00:00+01:00"]
        );
    }
}
