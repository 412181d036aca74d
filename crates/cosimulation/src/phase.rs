//! Where an instance is between its beginning and its end.
use serde::{Deserialize, Serialize};

/// Where an instance is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Phase {
    Instantiated,
    Initialization,
    Stepping,
    Terminated,
}

impl Phase {
    /// In words.
    pub(crate) const fn place(self) -> &'static str {
        match self {
            Self::Instantiated => "before the initialization",
            Self::Initialization => "into the initialization",
            Self::Stepping => "between steps",
            Self::Terminated => "behind the end",
        }
    }
}
