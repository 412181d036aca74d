//! What can happen to a cylinder, or be said about it.
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::detector::monitor::Verdict;

/// What can happen to a cylinder, or be said about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// Nothing is lost.
    Tight,
    /// A steady loss.
    Leak,
    /// A loss at once.
    Discharge,
    /// A gain.
    Refill,
    /// A sensor at fault.
    SensorFault,
    /// It cannot be told.
    Unknown,
}

impl Class {
    /// All of them, in the order of their numbers.
    pub(crate) const ALL: [Self; 6] =
        [Self::Tight, Self::Leak, Self::Discharge, Self::Refill, Self::SensorFault, Self::Unknown];
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Tight => "tight",
            Self::Leak => "leak",
            Self::Discharge => "discharge",
            Self::Refill => "refill",
            Self::SensorFault => "sensor fault",
            Self::Unknown => "unknown",
        })
    }
}

impl From<Verdict> for Class {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Tight => Self::Tight,
            Verdict::Leak => Self::Leak,
            Verdict::Discharge => Self::Discharge,
            Verdict::Refill => Self::Refill,
            Verdict::SensorFault => Self::SensorFault,
            Verdict::Unknown(_) => Self::Unknown,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detector::monitor::Reason;

    #[test]
    fn classes_are_in_their_order_and_every_verdict_has_one() {
        assert!(Class::ALL.iter().enumerate().all(|(index, class)| *class as usize == index));
        assert_eq!(Class::from(Verdict::Unknown(Reason::Gap)), Class::Unknown);
        for verdict in
            [Verdict::Tight, Verdict::Leak, Verdict::Discharge, Verdict::Refill, Verdict::SensorFault]
        {
            assert_eq!(Class::from(verdict).to_string(), verdict.as_str());
        }
    }
}
