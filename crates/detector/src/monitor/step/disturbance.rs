//! What is learnt while one end of the cylinder is warmed by itself is wrong, and stays wrong for days: once it is over, the
//! observer goes on with what it knew before, and with the mass free.
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use super::{LOOK_S, Monitor};
use crate::DetectorError;
use crate::estimator::observer::{Checkpoint, Observer};
use crate::monitor::Reason;
use crate::units::DAY_S;

/// Time between two checkpoints of an undisturbed observer, s. The one before the last is gone back to: a disturbance is noticed an hour or two late.
const BETWEEN_S: f64 = 6.0 * 3600.0;

/// Age from which what was known says less than what is known now, s.
const OLDEST_S: f64 = 100.0 * DAY_S;

/// The observer as it was before a disturbance.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Undisturbed {
    due_s: f64,
    latest: Option<Checkpoint>,
    before: Option<Checkpoint>,
    /// The present row is the first one after a disturbance.
    returning: bool,
    /// Memory for those that are not there.
    #[serde(skip)]
    room: Vec<Checkpoint>,
}

impl Undisturbed {
    /// Checks one that was saved.
    pub(super) fn validate(&self, observer: &mut Observer) -> Result<(), DetectorError> {
        for checkpoint in self.latest.iter().chain(&self.before) {
            observer.validate_checkpoint(checkpoint)?;
        }
        Ok(())
    }

    /// Make room for checkpoints of this observer.
    pub(super) fn make_room(&mut self, observer: &Observer) {
        let there = usize::from(self.latest.is_some()) + usize::from(self.before.is_some());
        self.room = (there..2).map(|_| observer.room_for_checkpoint()).collect();
        self.room.reserve(there);
    }

    /// There is nothing to go back to any more.
    pub(super) fn forget(&mut self) {
        self.room.extend(self.latest.take().into_iter().chain(self.before.take()));
        (self.due_s, self.returning) = (0.0, false);
    }

    /// Keep the observer as it is now, and the checkpoint before this one.
    fn keep(&mut self, observer: &Observer) {
        let mut newest = self.before.take().or_else(|| self.room.pop());
        if let Some(checkpoint) = &mut newest {
            observer.write_checkpoint(checkpoint);
        }
        self.before = core::mem::replace(&mut self.latest, newest);
    }
}

impl Monitor {
    /// A disturbance is over with the present row, which is not taken yet: back to what was known before it.
    pub(super) fn go_back_before_disturbance(&mut self, time_s: f64) {
        // The masses from before it still say when a leak began.
        self.state.evidence.forget();
        if self.state.examined.is_some() {
            return;
        }
        let recent = |of: &&Checkpoint| {
            of.time_s().is_some_and(|before_s| (0.0..=OLDEST_S).contains(&(time_s - before_s)))
        };
        if let Some(before) = self.state.undisturbed.before.as_ref().filter(recent) {
            self.observer.begin_exchange_from(before);
            self.state.undisturbed.returning = true;
            self.state.jumps.forget();
        }
    }

    /// The observer has taken a row: what follows after a disturbance, and what is kept for the next one.
    pub(super) fn keep_undisturbed(&mut self, time_s: f64) {
        let undisturbed = &mut self.state.undisturbed;
        if core::mem::take(&mut undisturbed.returning) {
            self.observer.end_exchange();
            self.state.look = (time_s + LOOK_S, Reason::Settling);
            undisturbed.due_s = time_s + BETWEEN_S;
        } else if time_s >= undisturbed.due_s && self.state.parity.is_usual() {
            undisturbed.due_s = time_s + BETWEEN_S;
            undisturbed.keep(&self.observer);
        }
    }
}
