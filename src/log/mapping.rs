//! `ours=theirs`: a column of a log under a foreign name.
use super::LogError;

/// One foreign column: `shoulder_degc=T1 (C)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mapping {
    /// Our name, with its unit unless theirs ends in one.
    pub ours: String,
    /// Name in the file.
    pub theirs: String,
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
