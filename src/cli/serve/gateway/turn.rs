//! What is told at each turn of the loop.
use super::{Gateway, PATIENCE};
use crate::cli::serve::status::{Status, Turn};
use std::sync::Arc;
use std::time::Duration;

impl Gateway<'_> {
    /// For those who look from outside.
    pub(in crate::cli::serve) fn status(&self) -> Arc<Status> {
        Arc::clone(&self.keeper.status)
    }

    /// Tells how it stands, and shows what has changed to those who look; the patience for messages is none while there is more to show.
    pub(super) fn turn(&mut self) -> Duration {
        let most_silent = self.keeper.most_silent();
        self.keeper.status.turn(&Turn {
            cylinders: self.keeper.len(),
            outbox: self.keeper.outbox.len(),
            is_connected: self.client.is_some(),
            is_writable: self.saving.is_written(),
            most_silent,
        });
        if self.keeper.show() { Duration::ZERO } else { PATIENCE }
    }
}
