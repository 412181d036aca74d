//! What the observer keeps of time: samples, events and the sensors' faults.
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use super::screen::Screen;
use crate::EstimatorError;
use crate::sensor::Sensor;

/// Times that the observer keeps.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Clock {
    pub time_s: Option<f64>,
    pub last_reading_s: Vec<f64>,
    /// What each sensor's offset may have changed by since it was new, standard deviation.
    pub loosened: Vec<f64>,
    /// Last reading of each sensor that was no fault, and how far a thermometer on the surface lately moved between two, K.
    pub last_reading: Vec<f64>,
    pub moved_k: f64,
    /// What explanations of a surprising row lately disagreed on the gas temperature, K.
    pub ambiguous_k: f64,
    /// How far one moved from the row before to this one, and to that, K, and the interval, s.
    pub moves_k: [f64; 2],
    pub interval_s: f64,
    /// What is considered for the surroundings is multiplied by.
    pub doubt: f64,
    pub reference_due_s: f64,
    pub reference_mass_kg: Option<f64>,
    pub exchange: Exchange,
    pub restarts: u64,
    pub screens: Vec<Screen>,
    /// Until then an estimate that has just begun or been opened is pulled by good readings too.
    pub pulled_until_s: f64,
}

/// Exchange of gas with the outside.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Exchange {
    None,
    Open,
    Settling { until_s: f64 },
}

impl Clock {
    /// Before the first sample.
    pub(super) fn new(sensors: &[Sensor]) -> Self {
        Self {
            time_s: None,
            last_reading_s: vec![f64::NEG_INFINITY; sensors.len()],
            loosened: vec![0.0; sensors.len()],
            last_reading: vec![f64::NAN; sensors.len()],
            moved_k: 0.0,
            ambiguous_k: 0.0,
            moves_k: [0.0; 2],
            interval_s: 0.0,
            doubt: 1.0,
            reference_due_s: f64::INFINITY,
            reference_mass_kg: None,
            exchange: Exchange::None,
            restarts: 0,
            screens: sensors.iter().map(Screen::new).collect(),
            pulled_until_s: f64::INFINITY,
        }
    }

    /// Checks one that comes from elsewhere.
    ///
    /// # Errors
    /// It is of another number of sensors, or a number is one that bounds and intervals cannot be made of.
    pub(super) fn validate(&self, sensors: usize) -> Result<(), EstimatorError> {
        let Self { last_reading_s, loosened, last_reading, screens, .. } = self;
        if [last_reading_s.len(), loosened.len(), last_reading.len(), screens.len()] != [sensors; 4] {
            return Err(EstimatorError::SnapshotForeign);
        }
        let wrong = |what, value, bound| Err(EstimatorError::SnapshotValue { what, value, bound });
        if let Some(value) = self.time_s.filter(|time_s| !time_s.is_finite()) {
            return wrong("time_s", value, "finite");
        }
        match self.loosened.iter().find(|sd| !(**sd >= 0.0 && sd.is_finite())) {
            Some(value) => wrong("loosened", *value, "finite and at least 0"),
            None => Ok(()),
        }
    }

    /// Become as another clock of the same sensors, without allocating.
    pub(super) fn copy_from(&mut self, other: &Self) {
        let keep = |to: &mut Vec<f64>, from: &Vec<f64>| {
            to.clone_from(from);
            core::mem::take(to)
        };
        let last_reading_s = keep(&mut self.last_reading_s, &other.last_reading_s);
        let loosened = keep(&mut self.loosened, &other.loosened);
        let last_reading = keep(&mut self.last_reading, &other.last_reading);
        let mut screens = core::mem::take(&mut self.screens);
        screens.clone_from(&other.screens);
        *self = Self { last_reading_s, loosened, last_reading, screens, ..*other };
    }

    /// Back to before the first sample, without allocating.
    pub(super) fn forget(&mut self, sensors: &[Sensor]) {
        let mut now = core::mem::replace(self, Self::new(&[]));
        now.last_reading_s.fill(f64::NEG_INFINITY);
        now.loosened.fill(0.0);
        now.last_reading.fill(f64::NAN);
        now.screens.iter_mut().zip(sensors).for_each(|(screen, sensor)| *screen = Screen::new(sensor));
        let Self { last_reading_s, loosened, last_reading, screens, .. } = now;
        *self = Self { last_reading_s, loosened, last_reading, screens, ..Self::new(&[]) };
    }

    /// The mass of a later time, s, is the reference, and until then there is none.
    pub(super) fn await_reference(&mut self, due_s: f64) {
        self.reference_mass_kg = None;
        self.reference_due_s = due_s;
    }

    /// Whether gas is exchanged at a time; ends the settling that is over.
    pub(super) fn exchanging(&mut self, time_s: f64) -> bool {
        match self.exchange {
            Exchange::None => false,
            Exchange::Open => true,
            Exchange::Settling { until_s } if time_s <= until_s => true,
            Exchange::Settling { .. } => {
                self.exchange = Exchange::None;
                false
            }
        }
    }
}
