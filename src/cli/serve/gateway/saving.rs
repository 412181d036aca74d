//! States saved one after the other, and monitors that begin anew; a disk that cannot be written is said once and tried again.
use super::{Gateway, RETRY};
use std::collections::{BTreeSet, VecDeque};
use std::time::{Duration, Instant};

/// Between two writes; the states of one reach the disk together.
const PAUSE: Duration = Duration::from_secs(1);

/// What becomes of what could not be written.
pub(super) const AGAIN: &str = "it is tried again";

/// What is to be saved, and when.
pub(super) struct Saving {
    /// The next first.
    names: VecDeque<String>,
    next: Instant,
    /// How many are written together.
    together: usize,
    next_round: Instant,
    /// When monitors that failed are tried again.
    next_anew: Instant,
    /// What could not be written.
    unwritten: BTreeSet<Written>,
}

/// What is written; the last bytes of a disk may hold a row and no state.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Written {
    Journal,
    States,
    Alarms,
}

impl Saving {
    pub(super) fn new(every: Duration) -> Self {
        let now = Instant::now();
        Self {
            names: VecDeque::new(),
            next: now,
            together: 1,
            next_round: now + every,
            next_anew: now,
            unwritten: BTreeSet::new(),
        }
    }
}

impl Gateway<'_> {
    /// Saves the states whose turn it is: spread over the first half of each round, so that not all are written at once.
    pub(super) fn save_some(&mut self) {
        let now = Instant::now();
        if now >= self.saving.next_round {
            let every = self.settings.save_every;
            self.saving.next_round = now + every;
            let turned = self.keeper.turn_over();
            self.noted(Written::Journal, turned, AGAIN);
            self.saving.names = self.keeper.unsaved().into();
            self.saving.next = now;
            let turns = (every / 2).as_secs_f64() / PAUSE.as_secs_f64();
            self.saving.together = (self.saving.names.len() as f64 / turns).ceil() as usize;
        }
        if now >= self.saving.next && !self.saving.names.is_empty() {
            self.saving.next = now + PAUSE;
            let together = self.saving.together.min(self.saving.names.len());
            let names: Vec<String> = self.saving.names.drain(..together).collect();
            if let Err(error) = self.keeper.save(&names) {
                self.noted(Written::States, Err(error), AGAIN);
            }
        }
        match self.keeper.note_saved() {
            Ok(0) => {}
            saved => self.noted(Written::States, saved.map(|_| ()), AGAIN),
        }
    }

    /// Begins the monitors anew that have failed.
    pub(super) fn begin_anew(&mut self) {
        let now = Instant::now();
        if now < self.saving.next_anew {
            return;
        }
        if let Err(error) = self.keeper.begin_failed_anew() {
            self.noted(Written::States, Err(error), AGAIN);
            self.saving.next_anew = now + RETRY;
        }
    }

    /// Says once what cannot be written, and once that all can be written again.
    pub(super) fn noted(&mut self, what: Written, written: anyhow::Result<()>, what_then: &str) {
        match written {
            Err(error) => {
                if self.saving.unwritten.insert(what) {
                    self.messages.caution(&format!("{error:#}; {what_then}"));
                }
            }
            Ok(()) => {
                if self.saving.unwritten.remove(&what) && self.saving.unwritten.is_empty() {
                    self.messages.caution("the disk can be written again");
                }
            }
        }
    }
}
