//! The health of each sensor, from its own readings.
//!
//! * *Missing*: no number in three rows in a row. A cell that is empty now and then is how loggers are, and no fault of the sensor.
//! * *Implausible*: a number outside what the sensor can read or at the end of its range.
//! * *Stuck*: identical readings in a row. How many are too many depends on how often a reading of this logger repeats itself:
//!   with the share `f` of repeated readings so far, `n` in a row have the probability `f^n`; below 2e-9 it is no chance, below 0.7 % what the readings
//!   show waits for it. The share is no less
//!   than that of a cylinder at rest in the middle of a step `q` of the sensor with the noise `sigma`, `erf(q / (2 sqrt(2) sigma))`: a
//!   coarse sensor that stands still says nothing.
//! * *Spikes*: readings refused by the observer's gate within the last hour. A shift lasts, and is told though there are some.
//! * *Shifted*: a thermometer that jumps while the other one does not, and stays there, has changed its offset; a
//!   disturbance from outside moves both, since air and sun reach both. The jump is taken off the readings from then on.
//! * *Deviates*: for half an hour it has been off while the other thermometer agrees with the pressure; the comparison of both tells.
//! * *Detached*: a thermometer that jumps so by more than an offset can, or is restless while the other one is not and more so than usually, reads the air.
//!
//! What a transmitter's jump is, [`crate::monitor::gas::jump`] tells.
use serde::{Deserialize, Serialize};

use crate::DetectorError;
use crate::estimator::log::Quantity;
use crate::estimator::sensor::Sensor;
use crate::monitor::Health;
use crate::monitor::restored;
use crate::units::ATMOSPHERE_PA;

/// Rows without a number that are too many in a row.
const MISSING_ROWS: u32 = 3;
/// Logarithm of the probability of a repetition that is no chance.
const NO_CHANCE: f64 = 20.0;
/// The same of one that may be one.
const UNUSUAL: f64 = 5.0;
/// Fewest identical readings in a row that are too many.
const FEWEST_IN_A_ROW: u32 = 10;
/// Readings from which the share of repeated ones is learnt.
const MEMORY: f64 = 2000.0;
/// Growth of the smallest change from one reading to the next, so that it can become larger again.
const STEP_FORGETS: f64 = 1.01;
/// Time for which a spike is remembered, s.
const SPIKES_S: f64 = 3600.0;
/// Least pressure that a transmitter on a vented cylinder reads, atmospheres.
const LEAST: f64 = 0.5;

/// Watch over one sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorWatch {
    low: f64,
    high: f64,
    latest: f64,
    in_a_row: u32,
    /// Rows without a number in a row.
    missing: u32,
    /// Smallest change lately, K or Pa.
    step: f64,
    /// Share of repeated readings in a cylinder at rest, by the sensor's step and noise.
    at_rest: f64,
    /// Number of readings, at most the memory, and how many of them were repeated.
    seen: f64,
    repeated: f64,
    spiked_s: f64,
    last_used_s: f64,
    /// Taken off every reading, K or Pa.
    correction: f64,
    /// By how much its offset has changed, taken off or not.
    shifted: f64,
    detached: bool,
    /// Off by so much, K, while others agree.
    deviates: Option<f64>,
    health: Health,
}

impl SensorWatch {
    /// Checks one of this sensor that was saved.
    pub(crate) fn validate(&self, sensor: &Sensor) -> Result<(), DetectorError> {
        let Self { low, high, at_rest, .. } = Self::new(sensor);
        for (what, own, of_sensor) in [
            ("watches.low", self.low, low),
            ("watches.high", self.high, high),
            ("watches.at_rest", self.at_rest, at_rest),
        ] {
            let same = own.to_bits() == of_sensor.to_bits();
            restored::require(same, what, own, "that of the sensor")?;
        }
        for (what, value) in [
            ("watches.seen", self.seen),
            ("watches.repeated", self.repeated),
            ("watches.correction", self.correction),
            ("watches.shifted", self.shifted),
        ] {
            restored::require(value.is_finite(), what, value, "finite")?;
        }
        Ok(())
    }

    /// Of a sensor.
    pub fn new(sensor: &Sensor) -> Self {
        let (low, high) = sensor.usable_range();
        let least =
            if sensor.quantity() == Quantity::Pressure { LEAST * ATMOSPHERE_PA } else { f64::NEG_INFINITY };
        Self {
            low: low.max(least),
            high,
            latest: f64::NAN,
            in_a_row: 0,
            missing: 0,
            step: f64::INFINITY,
            at_rest: if sensor.resolution > 0.0 {
                libm::erf(sensor.resolution / (libm::sqrt(8.0_f64) * sensor.noise_sd))
            } else {
                0.0
            },
            seen: 0.0,
            repeated: 0.0,
            spiked_s: f64::NEG_INFINITY,
            last_used_s: f64::NEG_INFINITY,
            correction: 0.0,
            shifted: 0.0,
            detached: false,
            deviates: None,
            health: Health::Good,
        }
    }

    /// Judge a reading as it came, K or Pa; the usable one, or NaN.
    pub fn judge(&mut self, time_s: f64, reading: f64) -> f64 {
        if reading.is_nan() {
            self.missing = self.missing.saturating_add(1);
            if self.missing >= MISSING_ROWS {
                self.health = Health::Missing;
            }
            return f64::NAN;
        }
        self.missing = 0;
        if !(self.low..=self.high).contains(&reading) {
            self.health = Health::Implausible;
            return f64::NAN;
        }
        if self.stands_still(reading) {
            self.health = Health::Stuck;
            return f64::NAN;
        }
        if self.detached {
            self.health = Health::Detached;
            return f64::NAN;
        }
        self.health = match self.deviates {
            None if self.shifted != 0.0 => Health::Shifted(self.shifted),
            _ if time_s - self.spiked_s < SPIKES_S => Health::Spikes,
            Some(by) => Health::Deviates(by),
            None => Health::Good,
        };
        reading - self.correction
    }

    fn stands_still(&mut self, reading: f64) -> bool {
        let change = (reading - self.latest).abs();
        let repeats = change == 0.0;
        if change > 0.0 {
            self.step = change.min(STEP_FORGETS * self.step);
        }
        self.latest = reading;
        if !repeats {
            // A run of repetitions that has ended was none of chance only if it was too long.
            self.learn(self.in_a_row);
            self.in_a_row = 0;
            return false;
        }
        self.in_a_row = self.in_a_row.saturating_add(1);
        self.too_many(self.in_a_row)
    }

    fn too_many(&self, in_a_row: u32) -> bool {
        in_a_row >= FEWEST_IN_A_ROW && self.unlikeliness(in_a_row) > NO_CHANCE
    }

    /// Minus the logarithm of the probability of so many identical readings in a row.
    fn unlikeliness(&self, in_a_row: u32) -> f64 {
        let learnt = (self.repeated + 5.0) / (self.seen + 10.0);
        let share = learnt.max(self.at_rest).clamp(0.05, 1.0 - 1e-6);
        f64::from(in_a_row) * -libm::log(share)
    }

    /// Whether it may be standing still: readings have been identical for longer than is usual, and not for so long that it is no chance.
    pub(crate) fn may_stand_still(&self) -> bool {
        self.unlikeliness(self.in_a_row) > UNUSUAL
    }

    fn learn(&mut self, in_a_row: u32) {
        let repeated = if self.too_many(in_a_row) { 0.0 } else { f64::from(in_a_row) };
        let kept = (1.0 - (repeated + 1.0) / MEMORY).max(0.0);
        if self.seen + repeated + 1.0 > MEMORY {
            (self.seen, self.repeated) = (kept * self.seen, kept * self.repeated);
        }
        self.seen += repeated + 1.0;
        self.repeated += repeated;
    }

    /// The observer refused the reading.
    pub fn refused(&mut self, time_s: f64) {
        self.spiked_s = time_s;
        if matches!(self.health, Health::Good | Health::Deviates(_)) {
            self.health = Health::Spikes;
        }
    }

    /// Step in which it reads, K or Pa: the smallest change of late.
    pub fn step(&self) -> f64 {
        if self.step.is_finite() { self.step } else { 0.0 }
    }

    /// From now on so much more, K or Pa, is taken off.
    pub fn shift(&mut self, by: f64) {
        self.correction += by;
        self.may_have_shifted(by);
    }

    /// Its offset may have changed by so much; the reading is left as it is.
    pub(crate) fn may_have_shifted(&mut self, by: f64) {
        self.shifted += by;
    }

    /// From the next reading on it is off by so much, K, while others agree, or no longer.
    pub fn deviates(&mut self, by: Option<f64>) {
        self.deviates = by;
    }

    /// The sensor reads something else than it should.
    pub fn detach(&mut self) {
        self.detached = true;
    }

    /// Somebody has looked after the sensor: it is trusted again, with the offset it has.
    pub(crate) fn repaired(&mut self) {
        (self.detached, self.in_a_row) = (false, 0);
    }

    /// Health after the last reading.
    pub fn health(&self) -> Health {
        self.health
    }

    /// The observer took the reading.
    pub fn used(&mut self, time_s: f64) {
        self.last_used_s = time_s;
    }

    /// Time of the last reading that was usable and that the observer took, s.
    pub(crate) fn last_used_s(&self) -> f64 {
        self.last_used_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pressure() -> SensorWatch {
        SensorWatch::new(&Sensor::typical("pressure").unwrap())
    }

    #[test]
    fn a_reading_that_repeats_itself_may_stand_still_long_before_it_does() {
        let mut watch = SensorWatch::new(&Sensor::typical("pressure").unwrap());
        for row in 0..500 {
            watch.judge(60.0 * f64::from(row), 2e7 + 1e4 * f64::from(row % 7));
            assert!(!watch.may_stand_still());
        }
        let doubted: Vec<bool> = (0..12)
            .map(|row| {
                watch.judge(30_000.0 + 60.0 * f64::from(row), 2e7);
                watch.may_stand_still()
            })
            .collect();
        assert_eq!(doubted.iter().position(|doubted| *doubted), Some(2));
        assert!(doubted[2..].iter().all(|doubted| *doubted) && watch.health() == Health::Stuck);
        watch.judge(40_000.0, 2.01e7);
        assert!(!watch.may_stand_still());
    }

    #[test]
    fn zero_full_scale_and_minus_999_are_no_pressures() {
        let mut watch = pressure();
        for reading in [0.0, 250e5, 257e5, -999.0, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(watch.judge(0.0, reading).is_nan(), "{reading}");
            assert_eq!(watch.health(), Health::Implausible);
        }
        assert_eq!(watch.judge(1.0, 1.013e5), 1.013e5);
        assert_eq!(watch.health(), Health::Good);
    }

    #[test]
    fn cells_that_are_empty_now_and_then_are_no_fault_and_three_in_a_row_are() {
        let mut watch = pressure();
        let mut judged = |reading: f64| {
            assert_eq!(watch.judge(0.0, reading).is_nan(), reading.is_nan());
            watch.health()
        };
        let rows = [180e5, f64::NAN, f64::NAN, 181e5, f64::NAN, f64::NAN];
        assert!(rows.into_iter().all(|reading| judged(reading) == Health::Good));
        assert_eq!([f64::NAN, 182e5].map(judged), [Health::Missing, Health::Good]);
    }

    #[test]
    fn a_fine_reading_that_repeats_is_stuck_and_a_coarse_one_is_not() {
        let mut fine = pressure();
        let noisy = |n: u32| 180e5 + f64::from(n % 7919);
        (0..100).for_each(|n| assert!(fine.judge(f64::from(n), noisy(n)).is_finite()));
        let stuck_at = (0..100).find(|n| fine.judge(100.0 + f64::from(*n), 181e5).is_nan());
        assert_eq!(stuck_at, Some(10), "the first of them is no repetition");
        assert!(fine.judge(300.0, 181.5e5).is_finite() && fine.health() == Health::Good);
        // Steps of half a bar: a reading stands for 60 samples.
        let mut coarse = pressure();
        for n in 0..3000 {
            coarse.judge(f64::from(n), 180e5 + 0.5e5 * f64::from((n / 20) % 5));
        }
        for n in 3000..3060 {
            assert!(coarse.judge(f64::from(n), 185e5).is_finite(), "sample {n}");
        }
        assert!((3060..4000).any(|n| coarse.judge(f64::from(n), 185e5).is_nan()));
    }

    #[test]
    fn a_coarse_sensor_that_has_always_moved_may_come_to_rest() {
        let mut sensor = Sensor::typical("pressure").unwrap();
        (sensor.resolution, sensor.noise_sd) = (0.5e5, 0.1e5);
        let mut watch = SensorWatch::new(&sensor);
        for n in 0..2000 {
            assert!(watch.judge(f64::from(n), 180e5 + 0.5e5 * f64::from(n % 7)).is_finite());
        }
        // Noise of a fifth of a step stays within it 98.8 % of the time.
        let stuck = (0..5000).find(|n| watch.judge(2000.0 + f64::from(*n), 180e5).is_nan());
        assert!(stuck.is_some_and(|after| (1500..1800).contains(&after)), "{stuck:?}");
    }

    #[test]
    fn a_shift_is_taken_off_and_told() {
        let mut watch = pressure();
        watch.shift(2e5);
        assert_eq!(watch.judge(0.0, 182e5), 180e5);
        assert_eq!(watch.health(), Health::Shifted(2e5));
        // It lasts, and is told once, whatever else the sensor does.
        watch.refused(10.0);
        assert_eq!(watch.health(), Health::Shifted(2e5));
        watch.judge(20.0, 183e5);
        assert_eq!(watch.health(), Health::Shifted(2e5));
    }
}
