//! The gateway while it runs: messages in, results out, states saved one after the other.
mod batch;
mod rate;
mod reception;
mod reload;
mod saving;

use super::config::{Broker, Settings};
use super::keeper::Keeper;
use super::link::{Client, FromBroker, Link, WINDOW};
use super::mapping::Refusal;
use super::signals::Signals;
use crate::cli::message::Messages;
use batch::Batch;
use rate::Rates;
use reload::Reload;
use saving::Saving;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;
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
    /// The file of the configuration.
    path: PathBuf,
    settings: Arc<Settings>,
    broker: Broker,
    messages: &'a Messages,
    signals: Signals,
    keeper: Keeper<'a>,
    link: Link,
    /// The connection that there is.
    client: Option<Client>,
    batch: Batch,
    rates: Rates,
    refusals: BTreeMap<Refusal, u64>,
    /// What was said of cylinders.
    said: BTreeSet<(String, Refusal)>,
    /// Why there is no connection, as it was said.
    down: Option<String>,
    saving: Saving,
    /// A configuration that waits to be taken over.
    reload: Option<Reload>,
}

impl<'a> Gateway<'a> {
    /// With the configuration of a file.
    pub(super) fn new(
        path: PathBuf,
        (settings, broker): (Settings, Broker),
        messages: &'a Messages,
    ) -> anyhow::Result<Self> {
        let signals = Signals::listen()?;
        let settings = Arc::new(settings);
        Ok(Self {
            path,
            keeper: Keeper::open(Arc::clone(&settings), messages)?,
            saving: Saving::new(settings.save_every),
            settings,
            link: Link::new(broker.clone()),
            broker,
            messages,
            signals,
            client: None,
            batch: Batch::default(),
            rates: Rates::default(),
            refusals: BTreeMap::new(),
            said: BTreeSet::new(),
            down: None,
            reload: None,
        })
    }

    /// Runs until a signal comes.
    pub(super) fn run(mut self) -> anyhow::Result<()> {
        while !self.signals.end() {
            self.listen(PATIENCE);
            self.begin_anew();
            self.look_for_silence();
            self.save_some();
            if self.signals.reload() {
                self.read_again();
            }
            self.take_over();
        }
        self.end()
    }

    /// Takes in what has come, after a wait if nothing has.
    fn listen(&mut self, patience: Duration) {
        let mut patience = patience;
        if self.batch.len() >= self.room() {
            // They wait for the disk.
            std::thread::sleep(patience);
            return self.take();
        }
        while self.batch.len() < self.room()
            && let Some(said) = self.link.next(patience)
        {
            patience = Duration::ZERO;
            match said {
                FromBroker::Message(delivery) => self.receive(*delivery),
                FromBroker::Sent(packet) => self.keeper.outbox.sent(packet),
                FromBroker::Arrived(packet, refused) => {
                    if let Some(reason) = refused {
                        self.messages.caution(&format!("the broker does not take a message: {reason}"));
                    }
                    self.keeper.outbox.arrived(packet);
                    self.send();
                }
                FromBroker::Up(client, is_known) => self.up(client, is_known),
                FromBroker::Down(reason) => {
                    self.take();
                    self.drop_batch();
                    self.client = None;
                    if self.down.as_ref() != Some(&reason) {
                        self.messages
                            .caution(&format!("no connection to the broker: {reason}; it is called again"));
                        self.down = Some(reason);
                    }
                }
            }
        }
        self.take();
    }

    fn up(&mut self, client: Client, is_known: bool) {
        self.messages.say("connected to the broker");
        self.down = None;
        self.keeper.silence.begin(Instant::now());
        self.keeper.outbox.connected(is_known);
        if let Err(error) = client.subscribe(&self.settings.mapping.filters()) {
            self.messages.caution(&format!("the topics cannot be subscribed to: {error:#}"));
        }
        self.client = Some(client);
        self.send();
    }

    /// Raises the alarm of cylinders that have fallen silent, where rows could have come.
    fn look_for_silence(&mut self) {
        let now = Instant::now();
        if self.client.is_none() || self.batch.len() > 0 {
            self.keeper.silence.begin(now);
            return;
        }
        self.keeper.look_for_silence(now);
        self.publish_alarms();
        self.send();
    }

    /// Counts a message that is left out; says so once of a cylinder and a reason.
    fn refuse(&mut self, name: &str, refusal: Refusal, reason: &str) {
        *self.refusals.entry(refusal).or_default() += 1;
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
        }
    }

    /// Waits for events to arrive, saves all, and says what was done.
    fn end(mut self) -> anyhow::Result<()> {
        let until = Instant::now() + FAREWELL;
        while self.client.is_some() && self.keeper.outbox.len() > 0 && Instant::now() < until {
            self.listen(PATIENCE);
        }
        let (mut waiting, mut unwritten) = (0, None);
        for name in self.keeper.unsaved() {
            match self.keeper.save(&name) {
                Ok(saved) => waiting += usize::from(!saved),
                Err(error) => unwritten = Some(error),
            }
        }
        if let Some(error) = unwritten {
            let words = format!("{error:#}; the journal has the rows since the last states");
            self.messages.caution(&words);
        }
        if let Some(client) = &self.client {
            client.disconnect();
            // Its thread sends what it has.
            while !matches!(self.link.next(PATIENCE), None | Some(FromBroker::Down(_))) {}
        }
        let left_out: Vec<String> =
            self.refusals.iter().map(|(refusal, count)| format!("{} ({count})", refusal.words())).collect();
        let mut words =
            format!("stopped by a signal: {} rows of {} cylinders", self.keeper.rows, self.keeper.len());
        if !left_out.is_empty() {
            words.push_str(&format!("; messages left out: {}", left_out.join(", ")));
        }
        words.push_str(match (waiting, self.keeper.unsaved().len()) {
            (_, 0) => "; the states are saved",
            (0, _) => "; not all states are saved",
            _ => "; events have not arrived, and go out after the next start",
        });
        self.messages.say(&words);
        Ok(())
    }
}
