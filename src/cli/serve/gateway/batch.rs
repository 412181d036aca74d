//! Messages that were delivered: onto the disk, then acknowledged, then to the monitors. While the disk is full they wait here, and the
//! broker keeps those that follow.
use super::reception::LeftOut;
use super::saving::{AGAIN, Written};
use super::{Gateway, RETRY};
use crate::cli::serve::keeper::Delivered;
use crate::cli::serve::link::Delivery;
use std::time::Instant;

/// Messages that go into the journal together.
#[derive(Default)]
pub(super) struct Batch {
    deliveries: Vec<Delivery>,
    inputs: Vec<(String, Delivered)>,
    /// When the disk is tried again, if it could not be written.
    retry: Option<Instant>,
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
            Ok(input) => self.batch.inputs.push(input),
            Err(LeftOut { name, refusal, reason }) => self.refuse(&name, refusal, &reason),
        }
        self.batch.deliveries.push(delivery);
    }

    /// The connection has ended: the broker delivers again what was not acknowledged.
    pub(super) fn drop_batch(&mut self) {
        self.batch = Batch::default();
    }

    /// Puts what was delivered on disk, tells the broker, and gives it to the monitors.
    pub(super) fn take(&mut self) {
        if self.batch.deliveries.is_empty() || self.batch.retry.is_some_and(|retry| Instant::now() < retry) {
            return;
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
