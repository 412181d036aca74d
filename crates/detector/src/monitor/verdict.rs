//! What the monitor says about the cylinder, and why.
use core::fmt;

use serde::{Deserialize, Serialize};

/// What is happening to the gas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// No gas is being lost that could be seen.
    Tight,
    /// Gas is being lost steadily.
    Leak,
    /// Gas was let out fast, or is being: a loss unless it was announced.
    Discharge,
    /// Gas was put in, or is being.
    Refill,
    /// A sensor is at fault; what is said of the gas rests on the others.
    SensorFault,
    /// It cannot be told, and never counts as tight.
    Unknown(Reason),
}

/// Why it cannot be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// The observer has not seen enough yet to know its sensors.
    Learning,
    /// The readings do not fit the filling that was stated: units mixed up, another bottle, or gas gone before the first row.
    Filling,
    /// No usable pressure for too long.
    NoPressure,
    /// No usable temperature for too long.
    NoTemperature,
    /// No rows for too long.
    Gap,
    /// The pressure jumped, and it is not told yet whether gas or the transmitter did.
    Jump,
    /// Gas was exchanged, and temperature and mass have not come to rest.
    Settling,
    /// One end of the cylinder is warmed or cooled by itself, or was until a while ago: the thermometers do not stand for the gas.
    Disturbed,
    /// A reading stands still while it should move.
    Stuck,
    /// The times of the rows cannot be relied on.
    Clock,
    /// The estimate had to begin again.
    Restarted,
    /// A leak is more likely than not, but not found at the stated rate of false alarms.
    Suspected,
    /// The gas is nearly at the pressure of the air: it drives no leak that could be seen.
    Empty,
}

impl Verdict {
    /// One word for a table.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Tight => "tight",
            Self::Leak => "leak",
            Self::Discharge => "discharge",
            Self::Refill => "refill",
            Self::SensorFault => "sensor fault",
            Self::Unknown(_) => "unknown",
        }
    }

    /// Why it is unknown.
    pub fn reason(self) -> Option<Reason> {
        match self {
            Self::Unknown(reason) => Some(reason),
            _ => None,
        }
    }
}

impl Reason {
    /// All, in the order in which interfaces number them.
    pub const ALL: [Self; 13] = [
        Self::Learning,
        Self::Filling,
        Self::NoPressure,
        Self::NoTemperature,
        Self::Gap,
        Self::Jump,
        Self::Settling,
        Self::Disturbed,
        Self::Stuck,
        Self::Clock,
        Self::Restarted,
        Self::Suspected,
        Self::Empty,
    ];

    /// Words for a person.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Learning => "still learning the sensors",
            Self::Filling => "the readings do not fit the filling that was stated",
            Self::NoPressure => "no usable pressure",
            Self::NoTemperature => "no usable temperature",
            Self::Gap => "no rows for too long",
            Self::Jump => "the pressure jumped: gas or transmitter",
            Self::Settling => "gas was exchanged and has not settled",
            Self::Disturbed => "one end of the cylinder is warmed or cooled by itself",
            Self::Stuck => "a reading stands still",
            Self::Clock => "the clock jumped",
            Self::Restarted => "the estimate had to begin again",
            Self::Suspected => "a leak is likely, but not certain yet",
            Self::Empty => "the cylinder is nearly empty: no leak would show",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.reason() {
            Some(reason) => write!(f, "unknown: {}", reason.as_str()),
            None => f.write_str(self.as_str()),
        }
    }
}
