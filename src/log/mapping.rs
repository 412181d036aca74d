//! `ours=theirs`: a column of a log under a foreign name.
use super::LogError;
use super::label::Label;

/// One foreign column: `shoulder_degc=T1 (C)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mapping {
    /// Our name, with its unit unless theirs ends in one.
    pub ours: String,
    /// Name in the file.
    pub theirs: String,
}

impl Mapping {
    /// Whether it names this header, with or without its unit in brackets, or as one of `Datum+Zeit`.
    pub(super) fn names(&self, header: &str) -> bool {
        let is_it = |name: &str| is_named(header, name);
        is_it(&self.theirs) || self.pair().is_some_and(|(date, clock)| is_it(date) || is_it(clock))
    }

    /// Columns of date and time of day in `time=Datum+Zeit`.
    pub(super) fn pair(&self) -> Option<(&str, &str)> {
        let (date, clock) = self.theirs.split_once('+').filter(|_| self.ours == "time")?;
        Some((date.trim(), clock.trim()))
    }
}

/// Whether a header is called so, with or without its unit.
pub(super) fn is_named(header: &str, name: &str) -> bool {
    header == name || Label::of(header).base == name
}

impl std::str::FromStr for Mapping {
    type Err = LogError;

    /// Splits at the first `=`.
    fn from_str(text: &str) -> Result<Self, LogError> {
        let parts = text.split_once('=').map(|(ours, theirs)| (ours.trim(), theirs.trim()));
        match parts {
            Some((ours, theirs)) if !ours.is_empty() && !theirs.is_empty() => {
                Ok(Self { ours: ours.to_ascii_lowercase(), theirs: theirs.to_owned() })
            }
            _ => Err(LogError::Mapping {
                mapping: text.to_owned(),
                reason: "write OURS=THEIRS, our name first, as shoulder_degc=T1".to_owned(),
            }),
        }
    }
}

impl std::fmt::Display for Mapping {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}={}", self.ours, self.theirs)
    }
}
