//! What an observer goes on from with the gas freed: after something has disturbed it, it begins again with what it knew before.
//!
//! Less than a [`Snapshot`](super::Snapshot): an exchange of gas ends all onsets of leaks, so there is no place for them.
use serde::{Deserialize, Serialize};

use super::Observer;
use super::bank::Bank;
use super::clock::Clock;
use crate::thermal::model::reduced::WarmStart;

/// The members of an observer as they were after a sample, without onsets of leaks.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Checkpoint {
    bank: Bank,
    clock: Clock,
    warm_start: WarmStart,
}

impl Observer {
    /// What to [begin an exchange from](Self::begin_exchange_from) later.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            bank: self.bank.clone(),
            clock: self.clock.clone(),
            warm_start: self.cylinder.warm_start(),
        }
    }

    /// Back to a checkpoint of this observer, where gas begins to be exchanged: as [`begin_exchange`](Self::begin_exchange).
    pub fn begin_exchange_from(&mut self, checkpoint: &Checkpoint) {
        self.bank.copy_from(&checkpoint.bank);
        self.turn_back(&checkpoint.clock, &checkpoint.warm_start);
        self.onsets.clear();
        self.begin_exchange();
    }
}
