//! What is to be published, until the broker has acknowledged it. Nothing here sends.
//!
//! Events keep their order and are never left out. Of verdict and estimate the newest waits alone: an older one would be replaced at the broker
//! at once. Nobody may push rows' events without end at a broker that never acknowledges: see [`Outbox::is_full`].
use std::collections::{BTreeMap, BTreeSet, HashMap, VecDeque};
use std::time::{Duration, Instant};

/// Events that have not arrived, beyond which no more rows are taken in; those of the rows of one batch may come on top.
const EVENTS: usize = 10_000;

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
    /// All of them.
    due: usize,
    /// When the broker last acknowledged a message, or had acknowledged all.
    acknowledged: Option<Instant>,
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
            Some(cylinder) => {
                *self.events.entry(cylinder.clone()).or_default() += 1;
                self.due += 1;
            }
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
        if self.handed.is_empty() && self.sent.is_empty() {
            self.acknowledged = Some(Instant::now());
        }
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
        self.acknowledged = Some(Instant::now());
        let Some(message) = self.sent.remove(&packet).and_then(|number| self.messages.remove(&number)) else {
            return;
        };
        if let Some(cylinder) = message.event_of
            && let Some(count) = self.events.get_mut(&cylinder)
        {
            *count -= 1;
            self.due -= 1;
            if *count == 0 {
                self.events.remove(&cylinder);
            }
        }
    }

    /// A new connection: what has not arrived is to be sent again, and to a broker that has forgotten us all that it is to keep.
    pub(super) fn connected(&mut self, is_known: bool) {
        // Of those that a newer one replaces the newest is enough: otherwise every lost connection would leave one more.
        let replaceable = self.messages.iter().filter(|(_, message)| message.event_of.is_none());
        self.replaceable = replaceable.map(|(number, message)| (message.topic.clone(), *number)).collect();
        let newest = &self.replaceable;
        self.messages.retain(|number, message| {
            message.event_of.is_some() || newest.get(&message.topic) == Some(number)
        });
        self.waiting = self.messages.keys().copied().collect();
        self.handed.clear();
        self.sent.clear();
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

    /// How long the broker has acknowledged nothing of what is on its way to it.
    pub(super) fn unacknowledged(&self, now: Instant) -> Duration {
        if self.handed.is_empty() && self.sent.is_empty() {
            return Duration::ZERO;
        }
        self.acknowledged.map_or(Duration::ZERO, |last| now.saturating_duration_since(last))
    }

    /// Whether so many events have not arrived that rows must wait.
    pub(super) fn is_full(&self) -> bool {
        self.due >= EVENTS
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
    fn events_that_never_arrive_fill_it_and_it_takes_rows_again_after_they_have() {
        let mut outbox = Outbox::default();
        for _ in 0..EVENTS - 1 {
            outbox.push(event("a"));
        }
        assert!(!outbox.is_full());
        outbox.push(event("a"));
        outbox.connected(true);
        assert!(outbox.is_full());
        outbox.hand(1).unwrap();
        outbox.sent(1);
        outbox.arrived(1);
        assert!(!outbox.is_full());
    }

    #[test]
    fn only_what_is_on_its_way_can_be_missing_an_acknowledgement() {
        let mut outbox = Outbox::default();
        let in_a_minute = Instant::now() + Duration::from_secs(60);
        let is_missed = |outbox: &Outbox| outbox.unacknowledged(in_a_minute) > Duration::from_secs(50);
        outbox.push(verdict("1"));
        assert!(!is_missed(&outbox));
        outbox.hand(1).unwrap();
        assert!(is_missed(&outbox), "it was handed to the link");
        outbox.sent(1);
        assert!(is_missed(&outbox));
        outbox.arrived(1);
        assert!(!is_missed(&outbox));
        assert_eq!(outbox.unacknowledged(Instant::now()), Duration::ZERO);
        outbox.push(verdict("2"));
        outbox.hand(1).unwrap();
        outbox.connected(true);
        assert!(!is_missed(&outbox), "another connection");
    }

    #[test]
    fn connections_that_are_lost_leave_one_verdict() {
        let mut outbox = Outbox::default();
        for connection in 0..5 {
            outbox.push(verdict(&connection.to_string()));
            assert_eq!(handed(&mut outbox, 20), [connection.to_string()]);
            outbox.connected(true);
        }
        assert_eq!(outbox.len(), 1);
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
