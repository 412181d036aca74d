//! What a message is for, or why it is left out.
use super::Gateway;
use crate::cli::serve::config::Settings;
use crate::cli::serve::document::PayloadFormat;
use crate::cli::serve::keeper::Delivered;
use crate::cli::serve::link::Delivery;
use crate::cli::serve::mapping::sparkplug::{self, Origin};
use crate::cli::serve::mapping::{Accepted, Addressed, Refusal};
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
    pub(super) fn read(&mut self, delivery: &Delivery) -> Result<Vec<(String, Delivered)>, LeftOut> {
        let settings = Arc::clone(&self.settings);
        let mapping = &settings.mapping;
        if mapping.format == PayloadFormat::SparkplugB && sparkplug::is_topic(&delivery.topic) {
            return self.sparkplug(&settings, delivery);
        }
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
                Ok(vec![(name.to_owned(), Delivered::Acknowledge(comment))])
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

    /// The row of a message.
    fn row(&mut self, name: &str, delivery: &Delivery) -> Result<Vec<(String, Delivered)>, LeftOut> {
        let now_ns = Timestamp::now().as_nanosecond() as i64;
        let row = self.settings.mapping.row(&delivery.payload, now_ns);
        let row = row.map_err(|refusal| LeftOut::of(name, refusal))?;
        self.checked(name, row, delivery.again).map(|input| vec![input])
    }

    /// A row that is new and not one too many; `again`: it may have come before.
    fn checked(&mut self, name: &str, row: Accepted, again: bool) -> Result<(String, Delivered), LeftOut> {
        if again && self.keeper.recent.has(name, row.time_ns, &row.cells) {
            return Err(LeftOut::of(name, Refusal::Again));
        }
        // What the broker delivers again was counted.
        let a_minute = self.settings.rows_a_minute;
        if !again && !self.rates.admit(name, row.time_ns, Instant::now(), a_minute) {
            return Err(LeftOut::of(name, Refusal::TooFast));
        }
        Ok((name.to_owned(), Delivered::Row(row)))
    }

    /// The rows of a message of Sparkplug; asks its node for a rebirth where it cannot be understood.
    fn sparkplug(
        &mut self,
        settings: &Settings,
        delivery: &Delivery,
    ) -> Result<Vec<(String, Delivered)>, LeftOut> {
        // Commands come back to the one who sent them.
        let Some(origin) = Origin::of(&delivery.topic) else { return Ok(Vec::new()) };
        let place = origin.place();
        let addressed = settings.mapping.addressed(&place);
        let name = match addressed {
            Some(Addressed::Named(name) | Addressed::ByPattern(name)) => name,
            Some(Addressed::Acknowledge(_)) | None => "",
        };
        let told = if self.keeper.knows(name) { name } else { "" };
        let heard = self.nodes.hear(
            &settings.mapping,
            (&origin, !name.is_empty()),
            &delivery.payload,
            settings.cylinders,
        );
        let (rows, command) = heard.map_err(|refusal| LeftOut::of(told, refusal))?;
        if let (Some((topic, payload)), Some(client)) = (command, &self.client)
            && client.command(topic, payload).is_err()
        {
            // The next connection begins with births.
            client.disconnect();
        }
        if rows.is_empty() {
            return Ok(Vec::new());
        }
        if matches!(addressed, Some(Addressed::ByPattern(_))) {
            let admitted = self.keeper.admits(name);
            admitted.map_err(|(refusal, reason)| LeftOut { name: told.to_owned(), refusal, reason })?;
        }
        let again = delivery.again || origin.is_birth();
        let mut inputs = Vec::new();
        for row in rows {
            match self.checked(name, row, again) {
                Ok(input) => inputs.push(input),
                Err(LeftOut { name, refusal, reason }) => self.refuse(&name, refusal, &reason),
            }
        }
        Ok(inputs)
    }
}
