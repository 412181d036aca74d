//! Messages that were delivered: onto the disk, then acknowledged, then to the monitors. While the disk is full, or too many events
//! have not arrived, they wait here, and the broker keeps those that follow.
use super::reception::LeftOut;
use super::saving::{AGAIN, Written};
use super::{BATCH, Gateway, RETRY};
use crate::cli::serve::keeper::Delivered;
use crate::cli::serve::link::Delivery;
use std::time::Instant;

/// Messages that wait at most while events have not arrived. A broker that has more on their way is left: it delivers them again.
const HELD: usize = 4096;

/// Messages that go into the journal together.
#[derive(Default)]
pub(super) struct Batch {
    deliveries: Vec<Delivery>,
    inputs: Vec<(String, Delivered)>,
    /// When the disk is tried again, if it could not be written.
    retry: Option<Instant>,
    /// Whether it was said that they wait for events to arrive.
    is_held: bool,
}

impl Batch {
    pub(super) fn len(&self) -> usize {
        self.deliveries.len()
    }
}

impl Gateway<'_> {
    /// Takes in a message that was delivered.
    pub(super) fn receive(&mut self, delivery: Delivery) {
        match self.read(&delivery) {
            Ok(inputs) => self.batch.inputs.extend(inputs),
            Err(LeftOut { name, refusal, reason }) => self.refuse(&name, refusal, &reason),
        }
        self.batch.deliveries.push(delivery);
    }

    /// Messages that may wait. While events must arrive first, more than go into the journal together: their receipts come behind them.
    pub(super) fn room(&self) -> usize {
        if self.keeper.outbox.is_full() { HELD } else { BATCH }
    }

    /// Says once that rows wait for events to arrive; ends a connection that delivers too many meanwhile.
    pub(super) fn hold(&mut self) {
        if !std::mem::replace(&mut self.batch.is_held, true) {
            self.messages.caution("the broker acknowledges no events: rows wait until it does");
        }
        if self.batch.len() >= HELD {
            self.leave();
            self.drop_batch();
        }
    }

    /// The connection has ended: the broker delivers again what was not acknowledged.
    pub(super) fn drop_batch(&mut self) {
        self.batch = Batch { is_held: self.batch.is_held, ..Batch::default() };
    }

    /// Puts what was delivered on disk, tells the broker, and gives it to the monitors.
    pub(super) fn take(&mut self) {
        if self.batch.deliveries.is_empty() || self.batch.retry.is_some_and(|retry| Instant::now() < retry) {
            return;
        }
        if self.keeper.outbox.is_full() {
            return self.hold();
        }
        if let Err(error) = self.keeper.record(&self.batch.inputs) {
            self.noted(Written::Journal, Err(error), "the broker keeps the rows, and it is tried again");
            self.batch.retry = Some(Instant::now() + RETRY);
            return;
        }
        self.noted(Written::Journal, Ok(()), AGAIN);
        let Batch { deliveries, inputs, .. } = std::mem::take(&mut self.batch);
        if let Some(client) = &self.client {
            // A receipt that does not go out costs one more delivery, which is known.
            deliveries.iter().for_each(|delivery| _ = client.acknowledge(delivery));
        }
        self.keeper.outbox.cause = deliveries.iter().map(|delivery| delivery.arrived).min();
        for (name, input) in inputs {
            if let Err((refusal, reason)) = self.keeper.take(&name, input) {
                self.refuse(&name, refusal, &reason);
            }
        }
        self.replay.iter().for_each(|replay| replay.come(deliveries.iter()));
        self.publish_alarms();
        self.send();
    }

    /// Publishes what has changed of the gateway's own alarms.
    pub(super) fn publish_alarms(&mut self) {
        let written = self.keeper.publish_alarms();
        self.noted(Written::Alarms, written, AGAIN);
    }
}
