//! States saved one after the other, and monitors that begin anew; a disk that cannot be written is said once and tried again.
use super::{Gateway, RETRY};
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// What is to be saved, and when.
pub(super) struct Saving {
    /// The next first.
    names: VecDeque<String>,
    next: Instant,
    /// Between two states.
    pause: Duration,
    next_round: Instant,
    /// When monitors that failed are tried again.
    next_anew: Instant,
    /// Whether the disk could not be written.
    is_full: bool,
}

impl Saving {
    pub(super) fn new(every: Duration) -> Self {
        let now = Instant::now();
        Self {
            names: VecDeque::new(),
            next: now,
            pause: Duration::ZERO,
            next_round: now + every,
            next_anew: now,
            is_full: false,
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
            self.noted(turned);
            self.saving.names = self.keeper.unsaved().into();
            self.saving.next = now;
            self.saving.pause = every / 2 / (self.saving.names.len().max(1) as u32);
        }
        while now >= self.saving.next
            && let Some(name) = self.saving.names.pop_front()
        {
            self.saving.next += self.saving.pause;
            let saved = self.keeper.save(&name).map(|_| ());
            self.noted(saved);
        }
    }

    /// Begins the monitors anew that have failed.
    pub(super) fn begin_anew(&mut self) {
        let now = Instant::now();
        if now < self.saving.next_anew {
            return;
        }
        if let Err(error) = self.keeper.begin_failed_anew() {
            self.unwritable(&format!("{error:#}; it is tried again"));
            self.saving.next_anew = now + RETRY;
        }
    }

    fn noted(&mut self, written: anyhow::Result<()>) {
        match written {
            Ok(()) => self.writable(),
            Err(error) => self.unwritable(&format!("{error:#}; it is tried again")),
        }
    }

    /// Says once that the disk cannot be written.
    pub(super) fn unwritable(&mut self, words: &str) {
        if !std::mem::replace(&mut self.saving.is_full, true) {
            self.messages.caution(words);
        }
    }

    /// Says that it can be written again.
    pub(super) fn writable(&mut self) {
        if std::mem::take(&mut self.saving.is_full) {
            self.messages.caution("the disk can be written again");
        }
    }
}
