//! The observer at one time: what it goes back to, and what a program that was stopped goes on from.
use serde::{Deserialize, Serialize};

use super::Observer;
use super::clock::Clock;
use super::cylinder::Cylinder;
use super::signature::Onsets;
use crate::EstimatorError;
use crate::filter::{Bank, StateSpace};
use crate::thermal::reduced::WarmStart;

/// The members as they were after a sample: what to go back to, and what a program that was stopped goes on from. With
/// another engine than the extended filter it cannot be serialised. It holds numbers that are none, which JSON has no
/// word for: take a binary format.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Snapshot {
    pub(super) bank: Bank<Cylinder>,
    pub(super) onsets: Onsets,
    pub(super) clock: Clock,
    pub(super) warm_start: WarmStart,
}

impl Snapshot {
    /// Time of the sample that it was taken after, s; `None`: before the first one.
    pub fn time_s(&self) -> Option<f64> {
        self.clock.time_s
    }
}

/// The same where it is, to be serialised without a copy.
#[derive(Clone, Debug, Serialize)]
pub struct SnapshotRef<'a> {
    bank: &'a Bank<Cylinder>,
    onsets: &'a Onsets,
    clock: &'a Clock,
    /// As a [`WarmStart`].
    warm_start: ([f64; 2], &'a [f64]),
}

impl Observer {
    /// What [`snapshot`](Self::snapshot) would be.
    pub fn snapshot_ref(&self) -> SnapshotRef<'_> {
        SnapshotRef {
            bank: &self.bank,
            onsets: &self.onsets,
            clock: &self.clock,
            warm_start: self.cylinder.warm_start_parts(),
        }
    }

    /// The observer as it is now.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            bank: self.bank.clone(),
            onsets: self.onsets.clone(),
            clock: self.clock.clone(),
            warm_start: self.cylinder.warm_start(),
        }
    }

    /// Round covariances, and what onsets of leaks have made, to single precision: snapshots saved take little more than half of the bytes. An estimate changes by some
    /// 1e-7 of its standard deviation.
    pub fn round(&mut self) {
        self.bank.round();
        self.onsets.round();
    }

    /// The observer as it is now, in the memory of another snapshot of it.
    pub fn snapshot_into(&self, snapshot: &mut Snapshot) {
        snapshot.bank.copy_from(&self.bank);
        snapshot.onsets.copy_from(&self.onsets);
        snapshot.clock.copy_from(&self.clock);
        self.cylinder.write_warm_start(&mut snapshot.warm_start);
    }

    /// Back to a snapshot of this observer.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        self.bank.copy_from(&snapshot.bank);
        self.onsets.copy_from(&snapshot.onsets);
        self.turn_back(&snapshot.clock, &snapshot.warm_start);
    }

    /// The clock and the model as they were.
    pub(super) fn turn_back(&mut self, clock: &Clock, warm_start: &WarmStart) {
        self.clock.copy_from(clock);
        for (screen, sensor) in self.clock.screens.iter_mut().zip(self.cylinder.sensors()) {
            *screen = screen.of(sensor);
        }
        self.cylinder.set_loosened(&self.clock.loosened);
        self.cylinder.model().set_warm_start(warm_start);
    }

    /// Back to a snapshot that comes from elsewhere, such as a file.
    ///
    /// # Errors
    /// It is that of an observer of another cylinder, other sensors or another bank, or no observer's; this one stays as it was.
    pub fn try_restore(&mut self, snapshot: &Snapshot) -> Result<(), EstimatorError> {
        let members = &self.cylinder.settings().bank[..self.roles.members];
        let fits = snapshot.bank.is_like(&self.cylinder, members)
            && snapshot.onsets.is_like(self.cylinder.states())
            && self.cylinder.model().fits_warm_start(&snapshot.warm_start);
        if !fits {
            return Err(EstimatorError::SnapshotForeign);
        }
        snapshot.clock.validate(self.cylinder.outputs())?;
        self.restore(snapshot);
        Ok(())
    }
}
