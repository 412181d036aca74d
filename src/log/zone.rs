//! A fixed distance from UTC, for local times that do not say theirs.
use super::LogError;
use jiff::fmt::temporal::Pieces;
use jiff::tz::Offset;

/// Farthest that a zone is from UTC, s.
const FARTHEST_S: i32 = 14 * 3600;

/// A fixed offset, as `+01:00`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Zone(Offset);

impl Zone {
    /// The offset of UTC itself.
    pub const UTC: Self = Self(Offset::UTC);

    pub(super) fn offset(self) -> Offset {
        self.0
    }
}

impl std::str::FromStr for Zone {
    type Err = LogError;

    /// Reads `+01:00`, `-0330`, `Z` or `UTC`.
    fn from_str(text: &str) -> Result<Self, LogError> {
        if text.eq_ignore_ascii_case("utc") || text.eq_ignore_ascii_case("z") {
            return Ok(Self::UTC);
        }
        let instant = format!("2000-01-01T00:00:00{text}");
        let is_number = text.starts_with(['+', '-']);
        let offset = Pieces::parse(&instant).ok().and_then(|pieces| pieces.to_numeric_offset());
        let is_zone = |offset: &Offset| is_number && offset.seconds().abs() <= FARTHEST_S;
        let offset = offset.filter(is_zone).ok_or_else(|| LogError::Zone { text: text.to_owned() })?;
        Ok(Self(offset))
    }
}

impl std::fmt::Display for Zone {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0 == Offset::UTC {
            return f.write_str("UTC");
        }
        let (sign, minutes) = (if self.0.seconds() < 0 { '-' } else { '+' }, self.0.seconds().abs() / 60);
        write!(f, "{sign}{:02}:{:02}", minutes / 60, minutes % 60)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_read_and_written_and_names_of_places_refused() {
        for (text, shown) in [("+01:00", "+01:00"), ("-0330", "-03:30"), ("Z", "UTC"), ("utc", "UTC")] {
            assert_eq!(text.parse::<Zone>().unwrap().to_string(), shown);
        }
        for text in ["Europe/Berlin", "CET", "1", "", "+25:00", "+01:00[x", "T"] {
            let error = text.parse::<Zone>().unwrap_err().to_string();
            assert!(error.contains("+01:00"), "{error}");
        }
    }
}
