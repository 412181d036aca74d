//! Refusals as a label has them.
use crate::cli::serve::mapping::Refusal;

impl Refusal {
    /// Those that have a count from the start.
    pub(in crate::cli::serve) const ALL: [Self; 11] = [
        Self::UnknownTopic,
        Self::TooManyCylinders,
        Self::TooLarge,
        Self::NoJson,
        Self::NoSparkplug,
        Self::NoTime,
        Self::NoNumber,
        Self::NoReading,
        Self::TooFast,
        Self::Monitor,
        Self::Again,
    ];

    /// Value of the label `reason`.
    pub(in crate::cli::serve) fn label(self) -> &'static str {
        match self {
            Self::UnknownTopic => "unknown_topic",
            Self::TooManyCylinders => "too_many_cylinders",
            Self::TooLarge => "too_large",
            Self::NoJson => "no_json",
            Self::NoSparkplug => "no_sparkplug",
            Self::NoTime => "no_time",
            Self::NoNumber => "no_number",
            Self::NoReading => "no_reading",
            Self::TooFast => "too_fast",
            Self::Monitor => "monitor",
            Self::Again => "again",
        }
    }
}
