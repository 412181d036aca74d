//! What an observer goes on from with the gas freed: after something has disturbed it, it begins again with what it knew before.
//!
//! Less than a [`Snapshot`](super::Snapshot): an exchange of gas ends all onsets of leaks, so there is no place for them, and frees mass and gas temperature, so the rest need not be
//! known to the last digit. All members go on with the covariance of the first one, but for their leak rates; its factors have 8 significant bits,
//! 0.2 % of each, and stay those of a covariance. Its mean is of single precision; how far the others are from it has 8 bits.
use serde::{Deserialize, Serialize};

use super::Observer;
use super::clock::Clock;
use super::cylinder::Cylinder;
use crate::EstimatorError;
use crate::filter::{Outline, StateSpace};
use crate::thermal::reduced::WarmStart;

/// The members of an observer as they were after a sample, rounded, without onsets of leaks.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Checkpoint {
    bank: Outline<Cylinder>,
    clock: Clock,
    warm_start: WarmStart,
}

impl Checkpoint {
    /// Time of the sample that it was taken after, s.
    pub fn time_s(&self) -> Option<f64> {
        self.clock.time_s
    }
}

impl Observer {
    /// Checks a checkpoint that comes from elsewhere, such as a file.
    ///
    /// # Errors
    /// It is that of an observer of another cylinder, other sensors or another bank, or no observer's.
    pub fn validate_checkpoint(&mut self, checkpoint: &Checkpoint) -> Result<(), EstimatorError> {
        let fits = checkpoint.bank.is_like(self.cylinder.states(), self.roles.members)
            && self.cylinder.model().fits_warm_start(&checkpoint.warm_start);
        if !fits {
            return Err(EstimatorError::SnapshotForeign);
        }
        checkpoint.clock.validate(self.cylinder.outputs())
    }

    /// What to [begin an exchange from](Self::begin_exchange_from) later.
    pub fn checkpoint(&self) -> Checkpoint {
        let mut checkpoint = self.room_for_checkpoint();
        self.write_checkpoint(&mut checkpoint);
        checkpoint
    }

    /// Memory for [one](Self::write_checkpoint).
    pub fn room_for_checkpoint(&self) -> Checkpoint {
        Checkpoint {
            bank: self.bank.outline(self.cylinder.states()),
            clock: self.clock.clone(),
            warm_start: self.cylinder.warm_start(),
        }
    }

    /// Write a checkpoint over another one of this observer.
    pub fn write_checkpoint(&self, checkpoint: &mut Checkpoint) {
        self.bank.write_outline(self.cylinder.state_map().leak, &mut checkpoint.bank);
        checkpoint.clock.copy_from(&self.clock);
        self.cylinder.write_warm_start(&mut checkpoint.warm_start);
    }

    /// Back to a checkpoint of this observer, where gas begins to be exchanged: as [`begin_exchange`](Self::begin_exchange).
    pub fn begin_exchange_from(&mut self, checkpoint: &Checkpoint) {
        self.bank.return_to(&checkpoint.bank, self.cylinder.state_map().leak);
        self.turn_back(&checkpoint.clock, &checkpoint.warm_start);
        self.onsets.clear();
        self.begin_exchange();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observer::{Commissioning, Estimate, ObserverSettings};
    use crate::sensor::Sensor;
    use crate::thermal::vessel::presets;

    const NAMES: [&str; 3] = ["shoulder", "valve", "pressure"];

    fn new() -> Observer {
        let vessel = presets::load("nitrogen-20l").unwrap();
        let sensors = NAMES.map(|name| Sensor::typical(name).unwrap());
        let filled = Commissioning::filled(200e5, 288.15);
        Observer::new(&vessel, &sensors, &filled, &ObserverSettings::default()).unwrap()
    }

    /// Rows of these minutes, with a shoulder that reads so much too warm, K.
    fn rows(observer: &mut Observer, minutes: std::ops::Range<u32>, off_k: f64) -> Vec<Estimate> {
        let row = |minute: u32| {
            let warm_k = 4.0 * (f64::from(minute) / 300.0).sin();
            [288.0 + warm_k + off_k, 288.1 + warm_k, 200e5 + 0.7e5 * warm_k]
        };
        minutes.map(|minute| observer.step(60.0 * f64::from(minute), &row(minute)).unwrap()).collect()
    }

    /// An observer after a disturbance, and what it was before that.
    fn disturbed() -> (Observer, Checkpoint, super::super::Snapshot) {
        let mut observer = new();
        rows(&mut observer, 0..600, 0.0);
        let (checkpoint, snapshot) = (observer.checkpoint(), observer.snapshot());
        rows(&mut observer, 600..900, 3.0);
        (observer, checkpoint, snapshot)
    }

    fn go_on(observer: &mut Observer) -> Vec<Estimate> {
        let first = rows(observer, 900..901, 0.0);
        observer.end_exchange();
        first.into_iter().chain(rows(observer, 901..1500, 0.0)).collect()
    }

    #[test]
    fn an_exchange_from_a_checkpoint_is_one_from_a_snapshot_but_for_a_tenth_of_its_uncertainty() {
        let (mut observer, checkpoint, snapshot) = disturbed();
        observer.begin_exchange_from(&checkpoint);
        let rounded = go_on(&mut observer);
        observer.restore(&snapshot);
        observer.begin_exchange();
        let exact = go_on(&mut observer);
        for (rounded, exact) in rounded.iter().zip(&exact) {
            assert!((rounded.mass_kg - exact.mass_kg).abs() < 0.1 * exact.mass_sd_kg);
            assert!((rounded.gas_mean_k - exact.gas_mean_k).abs() < 0.1 * exact.gas_mean_sd_k);
            assert!((rounded.mass_sd_kg / exact.mass_sd_kg - 1.0).abs() < 0.05);
        }
    }

    #[test]
    fn a_checkpoint_that_was_saved_goes_on_to_the_last_digit() {
        let (mut observer, checkpoint, _) = disturbed();
        let before = observer.snapshot();
        observer.begin_exchange_from(&checkpoint);
        let expected = go_on(&mut observer);
        let bytes = postcard::to_allocvec(&checkpoint).unwrap();
        assert!(bytes.len() < 1350, "{} bytes", bytes.len());
        observer.restore(&before);
        observer.begin_exchange_from(&postcard::from_bytes(&bytes).unwrap());
        assert_eq!(go_on(&mut observer), expected);
    }
}
