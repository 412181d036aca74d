//! Readings that no working sensor gives: outside what it can read, or stuck.
//!
//! A gate judges one reading by its innovation. A sensor that stops moving passes every gate, since the estimate is pulled
//! along a little at each sample. So identical readings in a row are watched: how far has the estimate been pulled back to them
//! in sum, `sum h^T K nu`? At rest that is next to nothing. Beyond [`PULLED`] standard deviations of the sensor's own noise the
//! readings count as stuck, and are not used until they change. What a reading in steps may be off by, half a step, pulls by right.
use serde::{Deserialize, Serialize};

use crate::sensor::Sensor;

/// Identical readings in a row from which a sensor may be stuck.
const STUCK_READINGS: u32 = 10;
/// Standard deviations of a sensor's noise by which stuck readings have pulled the estimate.
const STUCK_PULL_SD: f64 = 20.0;

/// What is wrong with a reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    /// Outside what the sensor can read, or at the end of it.
    Implausible,
    /// The same as long before, while the cylinder moved on.
    Stuck,
}

/// Faulty readings of a sensor so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FaultCount {
    /// Readings outside what the sensor can read.
    pub implausible: u64,
    /// Stuck readings.
    pub stuck: u64,
}

/// Watch over one sensor.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Screen {
    /// Those of the sensor: not saved.
    #[serde(skip)]
    limits: Limits,
    latest: f64,
    in_a_row: u32,
    pulled: f64,
    pub count: FaultCount,
}

/// What a sensor can read and do.
#[derive(Clone, Copy, Debug, Default)]
struct Limits {
    low: f64,
    high: f64,
    /// Pull, in the sensor's unit, from which identical readings are stuck.
    pull: f64,
    /// Half a step of the readings.
    half_step: f64,
}

impl Limits {
    fn of(sensor: &Sensor) -> Self {
        let (low, high) = sensor.usable_range();
        let pull = STUCK_PULL_SD * libm::sqrt(sensor.noise_variance());
        Self { low, high, pull, half_step: 0.5 * sensor.resolution }
    }
}

impl Screen {
    pub(super) fn new(sensor: &Sensor) -> Self {
        Self {
            limits: Limits::of(sensor),
            latest: f64::NAN,
            in_a_row: 0,
            pulled: 0.0,
            count: FaultCount::default(),
        }
    }

    /// The same screen of a sensor after it has been saved.
    pub(super) fn of(self, sensor: &Sensor) -> Self {
        Self { limits: Limits::of(sensor), ..self }
    }

    /// Judge and count a reading; NaN is none.
    pub(super) fn judge(&mut self, reading: f64) -> Option<Fault> {
        if !reading.is_finite() {
            return None;
        }
        if reading < self.limits.low || reading > self.limits.high {
            self.count.implausible = self.count.implausible.saturating_add(1);
            return Some(Fault::Implausible);
        }
        if reading == self.latest {
            self.in_a_row = self.in_a_row.saturating_add(1);
        } else {
            (self.latest, self.in_a_row, self.pulled) = (reading, 1, 0.0);
        }
        // A sensor without noise of its own tells nothing by standing still.
        if self.in_a_row >= STUCK_READINGS && self.limits.pull > 0.0 && self.pulled.abs() > self.limits.pull {
            self.count.stuck = self.count.stuck.saturating_add(1);
            return Some(Fault::Stuck);
        }
        None
    }

    /// How often in a row the last reading has been read before.
    pub(super) fn repeats(&self) -> u32 {
        self.in_a_row.saturating_sub(1)
    }

    /// A reading that was so far from its expectation has been used, and has changed it by so much.
    pub(super) fn pull(&mut self, by: f64, innovation: f64) {
        if innovation.abs() > self.limits.half_step {
            self.pulled += by;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn screen() -> Screen {
        Screen::new(&Sensor::typical("pressure").unwrap())
    }

    #[test]
    fn readings_outside_the_range_are_implausible_and_counted() {
        let mut screen = screen();
        let (low, high) = Sensor::typical("pressure").unwrap().plausible();
        for reading in [-1e9, 1e12, low, high] {
            assert_eq!(screen.judge(reading), Some(Fault::Implausible));
        }
        assert_eq!(screen.judge(2e7), None);
        assert_eq!(screen.judge(f64::NAN), None);
        assert_eq!(screen.count, FaultCount { implausible: 4, stuck: 0 });
    }

    #[test]
    fn identical_readings_are_stuck_only_where_they_pull() {
        let mut screen = screen();
        for _ in 0..1000 {
            assert_eq!(screen.judge(2e7), None);
        }
        // 30 standard deviations of 10 mbar in sum.
        for _ in 0..30 {
            screen.judge(2e7);
            screen.pull(1e3, 1e4);
        }
        assert_eq!(screen.judge(2e7), Some(Fault::Stuck));
        assert_eq!(screen.judge(2e7 + 1.0), None);
        assert_eq!(screen.judge(2e7 + 1.0), None);
    }

    #[test]
    fn a_coarse_reading_is_stuck_only_beyond_half_a_step() {
        let stuck = |innovation: f64| {
            let mut sensor = Sensor::typical("pressure").unwrap();
            sensor.resolution = 5e4;
            let mut screen = Screen::new(&sensor);
            (0..1000).any(|_| {
                screen.pull(2e3, innovation);
                screen.judge(2e7).is_some()
            })
        };
        assert!(stuck(3e4) && !stuck(2e4));
    }
}
