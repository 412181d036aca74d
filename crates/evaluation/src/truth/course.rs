//! What a cylinder goes through: the scenarios of the climatic chamber, a tunnel, weeks of railway operation,
//! and any of them after days of operation from which an observer has learnt.
use cylwatch_thermal::units::{DAY_S, HOUR_S};
use serde::{Deserialize, Serialize};

/// Time at the start temperature before the air changes, s: the commissioning hour that masses are compared with.
const COMMISSIONING_S: f64 = HOUR_S;
/// Ramp from the railway's air to the start temperature of the next course, s, and rest at it: 12 time constants.
pub(super) const TRANSFER_S: f64 = HOUR_S;
const REST_S: f64 = 4.0 * HOUR_S;

/// What a cylinder goes through.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Course {
    /// Chamber, from 21 to -25 °C at once.
    Scenario1,
    /// Chamber, from -25 to 40 °C at once.
    Scenario2,
    /// Chamber, linear rise from 10 to 60 °C in 5 h.
    Scenario3,
    /// Chamber, linear fall from 60 to 28 °C in 14 h.
    Scenario4,
    /// From -10 into a tunnel of 35 °C, with a lag of 6 s.
    Tunnel,
    /// Winter weeks under a rail vehicle.
    RailwayWeeks {
        /// How long, d.
        days: f64,
    },
    /// A year and more under a rail vehicle, from any day of the year on, with summer and winter.
    RailwayYear {
        /// How long, d.
        days: f64,
    },
    /// Railway operation, then, settled at its start temperature, another course.
    Learnt {
        /// Railway operation before, d.
        days: f64,
        /// What follows.
        then: Box<Course>,
    },
}

/// Which climate a railway course has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Climate {
    /// Weeks of winter.
    Winter,
    /// All seasons.
    Seasons,
}

/// Air temperature of a chamber course: rest at `start`, then the change, then rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Chamber {
    pub start_degc: f64,
    pub end_degc: f64,
    /// Duration of the linear change, s; 0: a jump.
    pub ramp_s: f64,
    /// Time constant of the change instead of a ramp, s.
    pub lag_s: f64,
    /// From the beginning of the change to the end of the course, s.
    pub after_s: f64,
}

impl Course {
    /// This course after ten days of railway operation.
    pub fn learnt(self) -> Self {
        Self::Learnt { days: 10.0, then: Box::new(self) }
    }

    /// A course by its name: `scenario1` to `scenario4`, `tunnel`, `week` or `year`, each with or without `-learnt`;
    /// `days` is the length of weeks and years, d.
    pub fn named(name: &str, days: f64) -> Option<Self> {
        if let Some(name) = name.strip_suffix("-learnt") {
            return Self::named(name, days).map(Self::learnt);
        }
        Some(match name {
            "scenario1" => Self::Scenario1,
            "scenario2" => Self::Scenario2,
            "scenario3" => Self::Scenario3,
            "scenario4" => Self::Scenario4,
            "tunnel" => Self::Tunnel,
            "week" => Self::RailwayWeeks { days },
            "year" => Self::RailwayYear { days },
            _ => return None,
        })
    }

    /// Its name, as [`Course::named`] takes it.
    pub fn name(&self) -> String {
        match self {
            Self::Scenario1 => "scenario1".into(),
            Self::Scenario2 => "scenario2".into(),
            Self::Scenario3 => "scenario3".into(),
            Self::Scenario4 => "scenario4".into(),
            Self::Tunnel => "tunnel".into(),
            Self::RailwayWeeks { .. } => "week".into(),
            Self::RailwayYear { .. } => "year".into(),
            Self::Learnt { then, .. } => format!("{}-learnt", then.name()),
        }
    }

    /// Whole duration, s.
    pub fn duration_s(&self) -> f64 {
        self.railway_s()
            + self.chamber().map_or(0.0, |chamber| self.transfer_s() + COMMISSIONING_S + chamber.after_s)
    }

    /// Time at which the course itself begins, s: after learning, the transfer and the rest that follows it.
    pub fn opening_s(&self) -> f64 {
        match self {
            Self::Learnt { .. } if self.chamber().is_some() => self.railway_s() + self.transfer_s(),
            Self::Learnt { days, then } => days * DAY_S + then.opening_s(),
            _ => 0.0,
        }
    }

    /// From the end of railway operation to the commissioning hour of a chamber course, s.
    fn transfer_s(&self) -> f64 {
        if self.railway_s() > 0.0 { TRANSFER_S + REST_S } else { 0.0 }
    }

    /// Time at which the air of a chamber course begins to change, s; the opening for railway weeks.
    pub fn change_s(&self) -> f64 {
        self.opening_s() + self.chamber().map_or(0.0, |_| COMMISSIONING_S)
    }

    /// Railway operation at the beginning, s.
    pub(super) fn railway_s(&self) -> f64 {
        match self {
            Self::RailwayWeeks { days } | Self::RailwayYear { days } => days * DAY_S,
            Self::Learnt { days, then } => days * DAY_S + then.railway_s(),
            _ => 0.0,
        }
    }

    /// The climate of its railway operation.
    pub(super) fn climate(&self) -> Climate {
        match self {
            Self::RailwayYear { .. } => Climate::Seasons,
            Self::Learnt { then, .. } => then.climate(),
            _ => Climate::Winter,
        }
    }

    /// The chamber course that this one ends with, if it does.
    pub(super) fn chamber(&self) -> Option<Chamber> {
        let jump = |start_degc, end_degc, hours: f64| Chamber {
            start_degc,
            end_degc,
            ramp_s: 0.0,
            lag_s: 0.0,
            after_s: hours * HOUR_S,
        };
        let ramp = |start_degc, end_degc, hours: f64| Chamber {
            ramp_s: hours * HOUR_S,
            ..jump(start_degc, end_degc, hours)
        };
        match self {
            Self::Scenario1 => Some(jump(21.0, -25.0, 3.0)),
            Self::Scenario2 => Some(jump(-25.0, 40.0, 3.45)),
            Self::Scenario3 => Some(ramp(10.0, 60.0, 5.0)),
            Self::Scenario4 => Some(ramp(60.0, 28.0, 14.0)),
            Self::Tunnel => Some(Chamber { lag_s: 6.0, ..jump(-10.0, 35.0, 3.0) }),
            Self::RailwayWeeks { .. } | Self::RailwayYear { .. } => None,
            Self::Learnt { then, .. } => then.chamber(),
        }
    }
}
