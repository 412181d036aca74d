//! What a message is for, or why it is left out.
use super::Gateway;
use crate::cli::serve::keeper::Delivered;
use crate::cli::serve::link::Delivery;
use crate::cli::serve::mapping::{Addressed, Refusal};
use jiff::Timestamp;
use std::sync::Arc;
use std::time::Instant;

/// A message that is left out.
pub(super) struct LeftOut {
    /// Its cylinder; empty: none that is known.
    pub name: String,
    pub refusal: Refusal,
    pub reason: String,
}

impl LeftOut {
    pub(super) fn of(name: &str, refusal: Refusal) -> Self {
        Self { name: name.to_owned(), refusal, reason: refusal.words().to_owned() }
    }
}

impl Gateway<'_> {
    /// What a message is for and says, or why it is left out.
    pub(super) fn read(&mut self, delivery: &Delivery) -> Result<(String, Delivered), LeftOut> {
        let settings = Arc::clone(&self.settings);
        let mapping = &settings.mapping;
        match mapping.addressed(&delivery.topic) {
            None => Err(LeftOut::of("", Refusal::UnknownTopic)),
            Some(Addressed::Acknowledge(name)) if !self.keeper.knows(name) => {
                Err(LeftOut::of("", Refusal::UnknownTopic))
            }
            Some(Addressed::Acknowledge(name)) if delivery.payload.len() > mapping.message_bytes => {
                Err(LeftOut::of(name, Refusal::TooLarge))
            }
            Some(Addressed::Acknowledge(name)) => {
                let comment = String::from_utf8_lossy(&delivery.payload).into_owned();
                Ok((name.to_owned(), Delivered::Acknowledge(comment)))
            }
            Some(Addressed::Named(name)) => self.row(name, delivery),
            Some(Addressed::ByPattern(name)) => {
                // Names that are not taken up leave no trace: there is no end of them.
                let told = if self.keeper.knows(name) { name } else { "" };
                mapping.row(&delivery.payload, 0).map_err(|refusal| LeftOut::of(told, refusal))?;
                let admitted = self.keeper.admits(name);
                admitted.map_err(|(refusal, reason)| LeftOut { name: told.to_owned(), refusal, reason })?;
                self.row(name, delivery)
            }
        }
    }

    /// A row of a cylinder.
    fn row(&mut self, name: &str, delivery: &Delivery) -> Result<(String, Delivered), LeftOut> {
        let now_ns = Timestamp::now().as_nanosecond() as i64;
        let row = self.settings.mapping.row(&delivery.payload, now_ns);
        let row = row.map_err(|refusal| LeftOut::of(name, refusal))?;
        if delivery.again && self.keeper.recent.has(name, row.time_ns, &row.cells) {
            return Err(LeftOut::of(name, Refusal::Again));
        }
        // What the broker delivers again was counted.
        let a_minute = self.settings.rows_a_minute;
        if !delivery.again && !self.rates.admit(name, row.time_ns, Instant::now(), a_minute) {
            return Err(LeftOut::of(name, Refusal::TooFast));
        }
        Ok((name.to_owned(), Delivered::Row(row)))
    }
}
