//! What happened, once: each event has a name that stays the same however often and wherever the log is replayed.
use core::fmt;
use serde::{Deserialize, Serialize};

use super::restored::Restored;
use super::{Health, LeakFinding, Verdict};
use crate::DetectorError;

/// Something that happened.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Time of the sample at which it was noticed, s.
    pub time_s: f64,
    /// When it began, s.
    pub onset_s: f64,
    /// What it was.
    pub kind: EventKind,
}

/// Kinds of events.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EventKind {
    /// The verdict changed.
    Verdict {
        /// What it was.
        from: Verdict,
        /// What it is.
        to: Verdict,
    },
    /// A leak was found.
    LeakFound(LeakFinding),
    /// A leak is over, or was none.
    LeakEnded,
    /// Gas went out at once; mass lost, kg.
    Discharge(f64),
    /// Gas was put in; mass gained, kg.
    Refill(f64),
    /// A sensor's health changed.
    Sensor {
        /// Its index in the order of the readings.
        sensor: usize,
        /// How it is now.
        health: Health,
    },
    /// The raw pressure will be below the limit at the coldest temperature expected, Pa, although no gas is being lost.
    ColdNight(f64),
    /// The first readings do not fit the filling that was stated.
    FillingDoubted {
        /// Mass that they stand for, kg.
        mass_kg: f64,
        /// Mass that was stated, kg.
        filled_kg: f64,
    },
    /// Two thermometers were in each other's place, which is taken into account; their indices in the order of the readings.
    Swapped([usize; 2]),
    /// A channel is late, which is taken into account.
    Late {
        /// Index of the sensor in the order of the readings.
        sensor: usize,
        /// By so much against the earliest, s.
        by_s: f64,
    },
    /// Two thermometers have been farther apart than usual for an hour: one end is warmed or cooled by itself, or one of them has shifted. Small leaks
    /// are not seen meanwhile.
    Disturbed {
        /// Their indices in the order of the readings.
        sensors: [usize; 2],
        /// By so much, first less second, K.
        off_k: f64,
    },
    /// The clock jumped by so much, s.
    ClockJump(f64),
    /// Rows came after a gap, s.
    Gap(f64),
    /// A row came too late to be used.
    TooLate,
    /// The estimate began again from its prior.
    Restarted,
}

impl Event {
    /// Checks one that was saved.
    pub(super) fn validate(&self, of: &Restored) -> Result<(), DetectorError> {
        let sensors = match self.kind {
            EventKind::Sensor { sensor, .. } | EventKind::Late { sensor, .. } => [sensor; 2],
            EventKind::Swapped(sensors) | EventKind::Disturbed { sensors, .. } => sensors,
            EventKind::Verdict { .. }
            | EventKind::LeakFound(_)
            | EventKind::LeakEnded
            | EventKind::Discharge(_)
            | EventKind::Refill(_)
            | EventKind::ColdNight(_)
            | EventKind::FillingDoubted { .. }
            | EventKind::ClockJump(_)
            | EventKind::Gap(_)
            | EventKind::TooLate
            | EventKind::Restarted => return Ok(()),
        };
        sensors.into_iter().try_for_each(|sensor| of.sensor("events", sensor))
    }

    /// An event of this sample that began then, s.
    pub fn new(time_s: f64, onset_s: f64, kind: EventKind) -> Self {
        Self { time_s, onset_s, kind }
    }

    /// The same for the same happening: `<kind>-<onset, ms>`.
    pub fn id(&self) -> impl fmt::Display + use<> {
        Id { words: [self.kind.name()], ms: libm::round(self.onset_s * 1e3) }
    }
}

/// Words and a time, ms, with strokes between them.
pub(super) struct Id<const WORDS: usize> {
    pub words: [&'static str; WORDS],
    pub ms: f64,
}

impl<const WORDS: usize> fmt::Display for Id<WORDS> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.words.iter().try_for_each(|word| write!(f, "{word}-"))?;
        write!(f, "{}", self.ms)
    }
}

impl EventKind {
    /// One word.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Verdict { .. } => "verdict",
            Self::LeakFound(_) => "leak-found",
            Self::LeakEnded => "leak-ended",
            Self::Discharge(_) => "discharge",
            Self::Refill(_) => "refill",
            Self::Sensor { .. } => "sensor",
            Self::ColdNight(_) => "cold-night",
            Self::FillingDoubted { .. } => "filling-doubted",
            Self::Swapped(_) => "swapped",
            Self::Late { .. } => "late",
            Self::Disturbed { .. } => "disturbed",
            Self::ClockJump(_) => "clock-jump",
            Self::Gap(_) => "gap",
            Self::TooLate => "too-late",
            Self::Restarted => "restarted",
        }
    }
}
