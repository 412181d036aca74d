//! Groups of worlds that the table has a row for.
use cylwatch_thermal::units::DAY_S;
use std::fmt;

use serde::Serialize;

use crate::judge::plan::{Role, Task};
use crate::world::{Climate, Family, GasKind, RowPattern, SensorClass, VesselKind};

/// Worlds of one role, and what they have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Group {
    /// What their families are for.
    pub role: Role,
    /// What they have in common.
    pub by: Grouping,
}

/// What the worlds of a group have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Grouping {
    /// Nothing.
    All,
    /// Their vessel.
    Vessel(VesselKind),
    /// Their climate.
    Climate(Climate),
    /// How the gas is resolved.
    Gas(GasKind),
    /// Their sensors.
    Sensors(SensorClass),
    /// Their rows.
    Rows(RowPattern),
    /// The length of their logs.
    Length(Length),
    /// Vessel and climate.
    Place(VesselKind, Climate),
    /// All axes.
    Family(Family),
}

/// Lengths of logs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub(crate) enum Length {
    /// Up to 2 d.
    Days,
    /// Up to 30 d.
    Weeks,
    /// Up to 200 d.
    Months,
    /// Longer.
    Year,
}

impl Length {
    fn of(length_s: f64) -> Self {
        match length_s / DAY_S {
            days if days <= 2.0 => Self::Days,
            days if days <= 30.0 => Self::Weeks,
            days if days <= 200.0 => Self::Months,
            _ => Self::Year,
        }
    }
}

impl Group {
    /// All groups that a task is in.
    pub(crate) fn all(task: &Task) -> [Self; 9] {
        let family = task.request.family;
        let Family { vessel, climate, gas, sensors, rows } = family;
        [
            Grouping::All,
            Grouping::Vessel(vessel),
            Grouping::Climate(climate),
            Grouping::Gas(gas),
            Grouping::Sensors(sensors),
            Grouping::Rows(rows),
            Grouping::Length(Length::of(task.request.length_s)),
            Grouping::Place(vessel, climate),
            Grouping::Family(family),
        ]
        .map(|by| Self { role: task.role, by })
    }

    /// Whether the table for people shows it among the first rows.
    pub(crate) fn is_of_one_axis(&self) -> bool {
        !matches!(self.by, Grouping::Place(..) | Grouping::Family(_))
    }
}

impl fmt::Display for Grouping {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => f.write_str("all"),
            Self::Vessel(kind) => write!(f, "vessel {kind}"),
            Self::Climate(kind) => write!(f, "climate {kind}"),
            Self::Gas(kind) => write!(f, "gas {kind}"),
            Self::Sensors(kind) => write!(f, "sensors {kind}"),
            Self::Rows(kind) => write!(f, "rows {kind}"),
            Self::Length(Length::Days) => f.write_str("logs to 2 d"),
            Self::Length(Length::Weeks) => f.write_str("logs of 2 to 30 d"),
            Self::Length(Length::Months) => f.write_str("logs of 30 to 200 d"),
            Self::Length(Length::Year) => f.write_str("logs beyond 200 d"),
            Self::Place(vessel, climate) => write!(f, "{vessel}/{climate}"),
            Self::Family(family) => write!(f, "{family}"),
        }
    }
}
