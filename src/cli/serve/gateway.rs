//! The gateway while it runs: messages in, results out, states saved one after the other.
mod reception;
mod turn;

use super::config::Settings;
use super::keeper::Keeper;
use super::link::{Client, Delivery, FromBroker, Link, WINDOW};
use super::mapping::Refusal;
use crate::cli::interrupt;
use crate::cli::message::Messages;
use reception::LeftOut;
use std::collections::{BTreeSet, VecDeque};
use std::time::{Duration, Instant};

/// Messages that go into the journal together.
const BATCH: usize = 256;
/// How long nothing may come before states are looked at.
const PATIENCE: Duration = Duration::from_millis(100);
/// Before a disk that was full is tried again.
const RETRY: Duration = Duration::from_secs(1);
/// How long events may take to arrive when the gateway ends.
const FAREWELL: Duration = Duration::from_secs(5);

/// The gateway.
pub(super) struct Gateway<'a> {
    settings: &'a Settings,
    messages: &'a Messages,
    keeper: Keeper<'a>,
    link: Link,
    /// The connection that there is.
    client: Option<Client>,
    deliveries: Vec<Delivery>,
    /// What was said of cylinders.
    said: BTreeSet<(String, Refusal)>,
    /// Why there is no connection, as it was said.
    down: Option<String>,
    /// States to save, the next first, when, and the time between two of them.
    saving: VecDeque<String>,
    next_save: Instant,
    pause: Duration,
    next_round: Instant,
    /// Why the disk cannot be written, as it was said.
    unwritten: bool,
}

impl<'a> Gateway<'a> {
    pub(super) fn new(
        settings: &'a Settings,
        keeper: Keeper<'a>,
        link: Link,
        messages: &'a Messages,
    ) -> Self {
        let now = Instant::now();
        Self {
            settings,
            messages,
            keeper,
            link,
            client: None,
            deliveries: Vec::new(),
            said: BTreeSet::new(),
            down: None,
            saving: VecDeque::new(),
            next_save: now,
            pause: Duration::ZERO,
            next_round: now + settings.save_every,
            unwritten: false,
        }
    }

    /// Runs until a signal comes.
    pub(super) fn run(mut self) -> anyhow::Result<()> {
        while !interrupt::has_come() {
            let patience = self.turn();
            self.listen(patience)?;
            self.save_some();
        }
        self.end()
    }

    /// Takes in what has come, after a wait if nothing has.
    fn listen(&mut self, patience: Duration) -> anyhow::Result<()> {
        let mut patience = patience;
        while let Some(said) = self.link.next(patience) {
            patience = Duration::ZERO;
            match said {
                FromBroker::Message(delivery) => self.deliveries.push(*delivery),
                FromBroker::Sent(packet) => self.keeper.outbox.sent(packet),
                FromBroker::Arrived(packet, refused) => {
                    if let Some(reason) = refused {
                        self.messages.caution(&format!("the broker does not take a message: {reason}"));
                    }
                    self.keeper.outbox.arrived(packet);
                    self.send();
                }
                FromBroker::Up(client, is_known) => {
                    self.take()?;
                    self.up(client, is_known);
                }
                FromBroker::Down(reason) => {
                    self.take()?;
                    self.client = None;
                    if self.down.as_ref() != Some(&reason) {
                        self.messages
                            .caution(&format!("no connection to the broker: {reason}; it is called again"));
                        self.down = Some(reason);
                    }
                }
            }
            if self.deliveries.len() >= BATCH {
                break;
            }
        }
        self.take()
    }

    fn up(&mut self, client: Client, is_known: bool) {
        self.messages.say("connected to the broker");
        self.down = None;
        self.keeper.outbox.connected(is_known);
        if let Err(error) = client.subscribe(&self.settings.mapping.filters()) {
            self.messages.caution(&format!("the topics cannot be subscribed to: {error:#}"));
        }
        self.client = Some(client);
        self.send();
    }

    /// Puts what was delivered on disk, tells the broker, and gives it to the monitors.
    fn take(&mut self) -> anyhow::Result<()> {
        let deliveries = std::mem::take(&mut self.deliveries);
        if deliveries.is_empty() {
            return Ok(());
        }
        let mut inputs = Vec::new();
        for delivery in &deliveries {
            match self.read(delivery) {
                Ok(input) => inputs.push(input),
                Err(LeftOut { name, refusal, reason }) => self.refuse(&name, refusal, &reason),
            }
        }
        while let Err(error) = self.keeper.record(&inputs) {
            if !std::mem::replace(&mut self.unwritten, true) {
                self.messages
                    .caution(&format!("{error:#}; the broker keeps the rows, and it is tried again"));
            }
            if interrupt::has_come() {
                // Not acknowledged: the broker delivers them again.
                return Ok(());
            }
            self.turn();
            std::thread::sleep(RETRY);
        }
        if std::mem::take(&mut self.unwritten) {
            self.messages.caution("the disk can be written again");
        }
        if let Some(client) = &self.client {
            // A receipt that does not go out costs one more delivery, which is known.
            deliveries.iter().for_each(|delivery| _ = client.acknowledge(delivery));
        }
        self.keeper.outbox.cause = deliveries.iter().map(|delivery| delivery.arrived).min();
        for (name, input) in inputs {
            if let Err((refusal, reason)) = self.keeper.take(&name, input)? {
                self.refuse(&name, refusal, &reason);
            }
        }
        self.send();
        Ok(())
    }

    /// Counts a message that is left out; says so once of a cylinder and a reason.
    fn refuse(&mut self, name: &str, refusal: Refusal, reason: &str) {
        self.keeper.status.refused(refusal);
        if refusal != Refusal::Again && self.said.insert((name.to_owned(), refusal)) {
            let whose = if name.is_empty() { String::new() } else { format!("{name}: ") };
            self.messages
                .caution(&format!("{whose}a message is left out: {reason}; more of this kind are counted"));
        }
    }

    /// Sends what waits, as much as may be on its way.
    fn send(&mut self) {
        let Some(client) = &self.client else { return };
        while let Some(message) = self.keeper.outbox.hand(usize::from(WINDOW)) {
            if let Err(error) = client.publish(message.topic, message.payload, message.retain) {
                // The connection ends, and the next one sends all that has not arrived.
                self.messages.caution(&format!("a message cannot be sent: {error:#}"));
                client.disconnect();
                self.client = None;
                return;
            }
            self.keeper
                .outbox
                .since()
                .into_iter()
                .for_each(|since| self.keeper.status.publish.observe(since.elapsed()));
        }
    }

    /// Saves the states whose turn it is: spread over the first half of each round, so that not all are written at once.
    fn save_some(&mut self) {
        let now = Instant::now();
        if now >= self.next_round {
            self.next_round = now + self.settings.save_every;
            let turned = self.keeper.turn_over();
            self.noted(turned);
            self.saving = self.keeper.unsaved().into();
            self.next_save = now;
            self.pause = self.settings.save_every / 2 / (self.saving.len().max(1) as u32);
        }
        while now >= self.next_save
            && let Some(name) = self.saving.pop_front()
        {
            self.next_save += self.pause;
            let saved = self.keeper.save(&name).map(|_| ());
            if saved.is_err() {
                self.keeper.status.states_failed.add();
            }
            self.noted(saved);
        }
    }

    /// Says once that the disk cannot be written; what waits is tried again in the next round.
    fn noted(&mut self, written: anyhow::Result<()>) {
        match written {
            Ok(()) => {}
            Err(error) if self.unwritten => _ = error,
            Err(error) => {
                self.unwritten = true;
                self.messages.caution(&format!("{error:#}; it is tried again"));
            }
        }
    }

    /// Waits for events to arrive, saves all, and says what was done.
    fn end(mut self) -> anyhow::Result<()> {
        let until = Instant::now() + FAREWELL;
        while self.client.is_some() && self.keeper.outbox.len() > 0 && Instant::now() < until {
            self.listen(PATIENCE)?;
        }
        let mut waiting = 0;
        for name in self.keeper.unsaved() {
            waiting += usize::from(!self.keeper.save(&name)?);
        }
        if let Some(client) = &self.client {
            client.disconnect();
            // Its thread sends what it has.
            while !matches!(self.link.next(PATIENCE), None | Some(FromBroker::Down(_))) {}
        }
        let left_out = self.keeper.status.refusals().into_iter().filter(|(_, count)| *count > 0);
        let left_out: Vec<String> =
            left_out.map(|(refusal, count)| format!("{} ({count})", refusal.words())).collect();
        let rows = self.keeper.status.rows.count();
        let mut words = format!("stopped by a signal: {rows} rows of {} cylinders", self.keeper.len());
        if !left_out.is_empty() {
            words.push_str(&format!("; messages left out: {}", left_out.join(", ")));
        }
        words.push_str(match waiting {
            0 => "; the states are saved",
            _ => "; events have not arrived, and go out after the next start",
        });
        self.messages.say(&words);
        Ok(())
    }
}
