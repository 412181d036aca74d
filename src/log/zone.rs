//! Zones of local times that do not say theirs: a fixed distance from UTC, or a place with its summer time.
use super::LogError;
use jiff::Timestamp;
use jiff::civil::DateTime;
use jiff::fmt::temporal::Pieces;
use jiff::tz::{AmbiguousOffset, Offset, TimeZone};

/// Farthest that a zone is from UTC, s.
const FARTHEST_S: i32 = 14 * 3600;

/// A zone: `+01:00`, `UTC`, or a name of the IANA database, as `Europe/Berlin`, which comes with the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Zone(TimeZone);

impl Zone {
    /// UTC itself.
    pub const UTC: Self = Self(TimeZone::UTC);

    /// The zone that a date with an offset has.
    pub(super) fn of_text(text: &str) -> Option<Self> {
        let offset = Pieces::parse(text).ok()?.to_numeric_offset()?;
        Some(Self(TimeZone::fixed(offset)))
    }

    /// The instant of a local time that follows another instant. Of an hour that the clock shows twice, the first one that does not
    /// lie before it. `None`: the clock leaves that time out.
    pub(super) fn instant(&self, local: DateTime, after: Option<Timestamp>) -> Option<Timestamp> {
        let of = |offset: Offset| offset.to_timestamp(local).ok();
        match self.0.to_ambiguous_timestamp(local).offset() {
            AmbiguousOffset::Unambiguous { offset } => of(offset),
            AmbiguousOffset::Gap { .. } => None,
            AmbiguousOffset::Fold { before, after: later } => {
                let first = of(before)?;
                if after.is_some_and(|after| first < after) { of(later) } else { Some(first) }
            }
        }
    }

    /// Whether its clock goes back from one local time to another, both of which it shows twice or on the edge of that.
    pub(super) fn goes_back(&self, from: DateTime, to: DateTime) -> bool {
        let instant = |local, after| self.instant(local, after);
        instant(from, None).is_some_and(|before| {
            let next = instant(to, Some(before));
            next.is_some_and(|next| next >= before && instant(to, None) != Some(next))
        })
    }

    /// An instant as RFC 3339 in whole seconds, with the distance from UTC that holds then.
    pub(crate) fn text(&self, instant: Timestamp) -> String {
        if self.0 == TimeZone::UTC {
            return instant.to_string();
        }
        instant.display_with_offset(self.0.to_offset(instant)).to_string()
    }
}

impl std::str::FromStr for Zone {
    type Err = LogError;

    /// Reads `+01:00`, `-0330`, `Z`, `UTC` or a name of the IANA database.
    fn from_str(text: &str) -> Result<Self, LogError> {
        if text.eq_ignore_ascii_case("utc") || text.eq_ignore_ascii_case("z") {
            return Ok(Self::UTC);
        }
        let refused = || LogError::Zone { text: text.to_owned() };
        if !text.starts_with(['+', '-']) {
            return TimeZone::get(text).map(Self).map_err(|_| refused());
        }
        let instant = format!("2000-01-01T00:00:00{text}");
        let offset = Pieces::parse(&instant).ok().and_then(|pieces| pieces.to_numeric_offset());
        let offset = offset.filter(|offset| offset.seconds().abs() <= FARTHEST_S).ok_or_else(refused)?;
        Ok(Self(TimeZone::fixed(offset)))
    }
}

impl std::fmt::Display for Zone {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let offset = match self.0.iana_name() {
            Some(name) => return f.write_str(name),
            None => self.0.to_fixed_offset().unwrap_or(Offset::UTC),
        };
        let (sign, minutes) = (if offset.seconds() < 0 { '-' } else { '+' }, offset.seconds().abs() / 60);
        write!(f, "{sign}{:02}:{:02}", minutes / 60, minutes % 60)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_and_places_are_read_and_written() {
        for (text, written) in [
            ("+01:00", "+01:00"),
            ("-0330", "-03:30"),
            ("Z", "UTC"),
            ("utc", "UTC"),
            ("+00:00", "UTC"),
            ("Europe/Berlin", "Europe/Berlin"),
            ("america/new_york", "America/New_York"),
        ] {
            assert_eq!(text.parse::<Zone>().unwrap().to_string(), written, "{text}");
        }
        for text in ["Europe/Berlni", "01:00", "+25:00", "", "CEST!"] {
            assert!(text.parse::<Zone>().is_err(), "{text}");
        }
    }

    fn berlin(local: &str, after: Option<&str>) -> Option<String> {
        let zone: Zone = "Europe/Berlin".parse().unwrap();
        let after = after.map(|after| after.parse().unwrap());
        zone.instant(local.parse().unwrap(), after).map(|instant| instant.to_string())
    }

    #[test]
    fn the_hour_that_comes_twice_is_told_by_what_came_before() {
        assert_eq!(berlin("2026-10-25T01:59", None).unwrap(), "2026-10-24T23:59:00Z");
        assert_eq!(berlin("2026-10-25T02:30", None).unwrap(), "2026-10-25T00:30:00Z");
        assert_eq!(berlin("2026-10-25T02:00", Some("2026-10-25T00:50:00Z")).unwrap(), "2026-10-25T01:00:00Z");
        assert_eq!(berlin("2026-10-25T02:50", Some("2026-10-25T00:50:00Z")).unwrap(), "2026-10-25T00:50:00Z");
        assert_eq!(berlin("2026-10-25T03:00", Some("2026-10-25T00:50:00Z")).unwrap(), "2026-10-25T02:00:00Z");
    }

    #[test]
    fn an_hour_that_the_clock_leaves_out_is_none() {
        assert_eq!(berlin("2026-03-29T02:30", None), None);
        assert_eq!(berlin("2026-03-29T03:00", None).unwrap(), "2026-03-29T01:00:00Z");
    }

    #[test]
    fn a_zone_is_known_by_when_its_clock_goes_back() {
        let goes_back = |name: &str, from: &str, to: &str| {
            let zone: Zone = name.parse().unwrap();
            zone.goes_back(from.parse().unwrap(), to.parse().unwrap())
        };
        let berlin = ("2026-10-25T02:50", "2026-10-25T02:00");
        assert!(goes_back("Europe/Berlin", berlin.0, berlin.1));
        for name in ["Europe/London", "Europe/Athens", "America/New_York", "+01:00"] {
            assert!(!goes_back(name, berlin.0, berlin.1), "{name}");
        }
        assert!(goes_back("Europe/London", "2026-10-25T01:50", "2026-10-25T01:00"));
        assert!(!goes_back("Europe/Berlin", "2026-10-25T02:10", "2026-10-25T02:50"));
        assert!(!goes_back("Europe/Berlin", "2026-10-26T02:50", "2026-10-26T02:00"));
    }

    #[test]
    fn an_instant_is_written_with_the_distance_that_holds_then() {
        let zone: Zone = "Europe/Berlin".parse().unwrap();
        let text = |instant: &str| zone.text(instant.parse().unwrap());
        assert_eq!(text("2026-10-25T00:30:00Z"), "2026-10-25T02:30:00+02:00");
        assert_eq!(text("2026-10-25T01:30:00Z"), "2026-10-25T02:30:00+01:00");
        assert_eq!(Zone::UTC.text("2026-10-25T01:30:00Z".parse().unwrap()), "2026-10-25T01:30:00Z");
    }
}
