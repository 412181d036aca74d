//! What is to be published, until the broker has acknowledged it. Nothing here sends.
//!
//! Events keep their order and are never left out. Of verdict and estimate the newest waits alone: an older one would be replaced at the broker
//! at once.
use std::collections::{BTreeMap, BTreeSet, HashMap, VecDeque};
use std::time::Instant;

/// A message to the broker.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Message {
    pub topic: String,
    pub payload: String,
    /// Whether the broker keeps it for those who come later.
    pub retain: bool,
    /// The cylinder whose state must wait until it has arrived; `None`: a later message says the same.
    pub event_of: Option<String>,
}

/// Messages by their numbers, which are given in their order.
#[derive(Default)]
pub(super) struct Outbox {
    next: u64,
    messages: BTreeMap<u64, Message>,
    /// Not handed to the link yet.
    waiting: BTreeSet<u64>,
    /// Handed to the link, which has not told their packet yet.
    handed: VecDeque<u64>,
    /// By their packets.
    sent: HashMap<u16, u64>,
    /// Waiting messages that a newer one replaces, by topic.
    replaceable: HashMap<String, u64>,
    /// The newest that the broker keeps, by topic.
    kept: BTreeMap<String, String>,
    /// Events that have not arrived, by cylinder.
    events: HashMap<String, usize>,
    /// When the message came that leads to what is pushed now.
    pub cause: Option<Instant>,
    /// The same of messages that were not handed to the link.
    causes: BTreeMap<u64, Instant>,
}

impl Outbox {
    /// Adds a message.
    pub(super) fn push(&mut self, message: Message) {
        if message.retain && message.payload.is_empty() {
            self.kept.remove(&message.topic);
        } else if message.retain {
            self.kept.insert(message.topic.clone(), message.payload.clone());
        }
        match &message.event_of {
            Some(cylinder) => *self.events.entry(cylinder.clone()).or_default() += 1,
            None => {
                if let Some(number) = self.replaceable.get(&message.topic) {
                    self.messages.insert(*number, message);
                    return;
                }
                self.replaceable.insert(message.topic.clone(), self.next);
            }
        }
        self.waiting.insert(self.next);
        self.causes.extend(self.cause.map(|cause| (self.next, cause)));
        self.messages.insert(self.next, message);
        self.next += 1;
    }

    /// Lets the broker forget what it keeps below some levels: an empty message is kept as none.
    pub(super) fn clear(&mut self, levels: &str) {
        let topics: Vec<String> =
            self.kept.keys().filter(|topic| topic.starts_with(levels)).cloned().collect();
        for topic in topics {
            self.push(Message { topic, payload: String::new(), retain: true, event_of: None });
        }
    }

    /// The next message to send while fewer than `window` are on their way; it counts as handed to the link.
    pub(super) fn hand(&mut self, window: usize) -> Option<Message> {
        if self.handed.len() + self.sent.len() >= window {
            return None;
        }
        let number = self.waiting.pop_first()?;
        let message = self.messages.get(&number)?.clone();
        if self.replaceable.get(&message.topic) == Some(&number) {
            self.replaceable.remove(&message.topic);
        }
        self.handed.push_back(number);
        Some(message)
    }

    /// When the message came that led to the last that was handed; `None`: it was handed before.
    pub(super) fn since(&mut self) -> Option<Instant> {
        self.causes.remove(self.handed.back()?)
    }

    /// The first of the handed messages went out in a packet.
    pub(super) fn sent(&mut self, packet: u16) {
        if let Some(number) = self.handed.pop_front() {
            self.sent.insert(packet, number);
        }
    }

    /// A packet has arrived.
    pub(super) fn arrived(&mut self, packet: u16) {
        let Some(message) = self.sent.remove(&packet).and_then(|number| self.messages.remove(&number)) else {
            return;
        };
        if let Some(cylinder) = message.event_of
            && let Some(count) = self.events.get_mut(&cylinder)
        {
            *count -= 1;
            if *count == 0 {
                self.events.remove(&cylinder);
            }
        }
    }

    /// A new connection: what has not arrived is to be sent again, and to a broker that has forgotten us all that it is to keep.
    pub(super) fn connected(&mut self, is_known: bool) {
        self.waiting = self.messages.keys().copied().collect();
        self.handed.clear();
        self.sent.clear();
        self.replaceable.clear();
        if is_known {
            return;
        }
        let waiting: BTreeSet<String> = self
            .messages
            .values()
            .filter(|message| message.retain)
            .map(|message| message.topic.clone())
            .collect();
        for (topic, payload) in self.kept.clone() {
            if !waiting.contains(&topic) {
                self.push(Message { topic, payload, retain: true, event_of: None });
            }
        }
    }

    /// Whether a cylinder has events that have not arrived.
    pub(super) fn has_events(&self, cylinder: &str) -> bool {
        self.events.contains_key(cylinder)
    }

    /// Messages that have not arrived.
    pub(super) fn len(&self) -> usize {
        self.messages.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(payload: &str) -> Message {
        Message { topic: "e".into(), payload: payload.into(), retain: false, event_of: Some("A".into()) }
    }

    fn verdict(payload: &str) -> Message {
        Message { topic: "v".into(), payload: payload.into(), retain: true, event_of: None }
    }

    fn handed(outbox: &mut Outbox, window: usize) -> Vec<String> {
        std::iter::from_fn(|| outbox.hand(window)).map(|message| message.payload).collect()
    }

    #[test]
    fn events_wait_for_their_arrival_and_verdicts_for_the_newest() {
        let mut outbox = Outbox::default();
        for message in [verdict("1"), event("a"), verdict("2"), event("b")] {
            outbox.push(message);
        }
        assert_eq!(handed(&mut outbox, 2), ["2", "a"]);
        outbox.sent(7);
        outbox.sent(8);
        outbox.push(verdict("3"));
        outbox.arrived(8);
        assert!(outbox.has_events("A"), "b has not arrived");
        assert_eq!(handed(&mut outbox, 9), ["b", "3"]);
        outbox.sent(9);
        outbox.arrived(9);
        assert!(!outbox.has_events("A"));
        outbox.arrived(1234);
        assert_eq!(outbox.len(), 2);
    }

    #[test]
    fn what_has_not_arrived_is_sent_again_in_its_order_after_the_connection_was_lost() {
        let mut outbox = Outbox::default();
        ["a", "b", "c"].map(event).into_iter().for_each(|message| outbox.push(message));
        assert_eq!(handed(&mut outbox, 2), ["a", "b"]);
        outbox.sent(1);
        outbox.connected(true);
        assert_eq!(handed(&mut outbox, 9), ["a", "b", "c"]);
        for packet in 1..=3 {
            outbox.sent(packet);
            outbox.arrived(packet);
        }
        assert_eq!(outbox.len(), 0);
    }

    #[test]
    fn a_broker_that_has_forgotten_gets_what_it_is_to_keep_once() {
        let mut outbox = Outbox::default();
        outbox.push(verdict("1"));
        assert_eq!(handed(&mut outbox, 9), ["1"]);
        outbox.sent(1);
        outbox.arrived(1);
        outbox.connected(true);
        assert_eq!(handed(&mut outbox, 9).len(), 0);
        outbox.push(verdict("2"));
        outbox.connected(false);
        assert_eq!(handed(&mut outbox, 9), ["2"]);
        outbox.sent(1);
        outbox.arrived(1);
        outbox.connected(false);
        assert_eq!(handed(&mut outbox, 9), ["2"]);
    }
}
