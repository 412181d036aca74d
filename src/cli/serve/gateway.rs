//! The gateway while it runs: messages in, results out, states saved one after the other.
mod batch;
mod rate;
mod reception;
mod reload;
mod saving;
mod turn;

use super::config::{Broker, Settings};
use super::keeper::Keeper;
use super::link::{Client, FromBroker, Link, WINDOW};
use super::mapping::Refusal;
use super::mapping::sparkplug::Nodes;
use super::notify::Notify;
use super::replay::Replay;
use super::saver::TOGETHER;
use super::signals::Signals;
use crate::cli::message::Messages;
use batch::Batch;
use rate::Rates;
use reload::Reload;
use saving::Saving;
use std::collections::BTreeSet;
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
    /// Subscriptions that the broker has not answered, and what is said when it has.
    subscribing: usize,
    greeting: String,
    batch: Batch,
    rates: Rates,
    nodes: Nodes,
    /// What was said of cylinders.
    said: BTreeSet<(String, Refusal)>,
    /// Why there is no connection, as it was said.
    down: Option<String>,
    /// Whether it was said that the broker acknowledges nothing.
    is_mute: bool,
    saving: Saving,
    /// A configuration that waits to be taken over.
    reload: Option<Reload>,
    notify: Notify,
    /// Logs that are played to the broker.
    replay: Option<Replay>,
}

impl<'a> Gateway<'a> {
    /// With the configuration of a file.
    pub(super) fn new(
        path: PathBuf,
        (settings, broker): (Settings, Broker),
        replay: Option<Replay>,
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
            subscribing: 0,
            greeting: String::new(),
            batch: Batch::default(),
            rates: Rates::default(),
            nodes: Nodes::default(),
            said: BTreeSet::new(),
            down: None,
            is_mute: false,
            reload: None,
            notify: Notify::of_environment(),
            replay,
        })
    }

    /// Runs until a signal comes.
    pub(super) fn run(mut self) -> anyhow::Result<()> {
        self.notify.ready();
        while !self.signals.end() && self.replay_goes_on()? {
            self.notify.turned();
            let patience = self.turn();
            self.listen(patience);
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

    /// Whether the gateway is to run on, as far as a replay is concerned.
    fn replay_goes_on(&mut self) -> anyhow::Result<bool> {
        let waits = self.client.is_none() || self.batch.len() > 0;
        self.replay.as_mut().map_or(Ok(true), |replay| replay.goes_on(waits, self.messages))
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
                    self.is_mute = false;
                    self.send();
                }
                FromBroker::Up(client, is_known) => self.up(client, is_known),
                FromBroker::Subscribed(refused) => self.subscribed(refused),
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
        if self.batch.len() < self.room() {
            // All that it has said was heard.
            self.look_for_a_mute_broker();
        }
        self.take();
    }

    /// Leaves a broker that has acknowledged nothing for as long as it may not answer: what was on its way is sent again.
    fn look_for_a_mute_broker(&mut self) {
        let patience = self.broker.keep_alive;
        if self.client.is_none() || self.keeper.outbox.unacknowledged(Instant::now()) < patience {
            return;
        }
        if !std::mem::replace(&mut self.is_mute, true) {
            let seconds = patience.as_secs();
            let words =
                format!("the broker has acknowledged nothing for {seconds} s: the connection begins anew");
            self.messages.caution(&words);
        }
        self.leave();
    }

    /// Ends the connection if there is one.
    fn leave(&mut self) {
        if let Some(client) = self.client.take() {
            client.disconnect();
        }
    }

    fn up(&mut self, client: Client, is_known: bool) {
        self.down = None;
        self.keeper.silence.begin(Instant::now());
        self.keeper.outbox.connected(is_known);
        match client.subscribe(&self.settings.mapping.filters()) {
            Ok(answers) => {
                self.subscribing = answers;
                "connected to the broker".clone_into(&mut self.greeting);
            }
            Err(error) => self.messages.caution(&format!("the topics cannot be subscribed to: {error:#}")),
        }
        self.client = Some(client);
        self.send();
    }

    /// The broker has answered a subscription.
    fn subscribed(&mut self, refused: usize) {
        if refused > 0 {
            let words =
                format!("the broker refuses {refused} of the topics: look at what it lets this user read");
            self.messages.caution(&words);
        }
        self.subscribing = self.subscribing.saturating_sub(1);
        if self.subscribing == 0 {
            self.messages.say(&self.greeting);
            self.replay.iter_mut().for_each(Replay::subscribed);
        }
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
                return self.leave();
            }
            if let Some(since) = self.keeper.outbox.since() {
                self.keeper.status.publish.observe(since.elapsed());
            }
        }
    }

    /// Waits for events to arrive, saves all, and says what was done.
    fn end(mut self) -> anyhow::Result<()> {
        self.notify.stopping();
        let until = Instant::now() + FAREWELL;
        while self.client.is_some() && self.keeper.outbox.len() > 0 && Instant::now() < until {
            self.listen(PATIENCE);
        }
        // What is being written may be older than the last rows.
        let mut saved = self.keeper.settle();
        for some in self.keeper.unsaved().chunks(TOGETHER) {
            saved = saved.and_then(|()| self.keeper.save(some)).and_then(|()| self.keeper.settle());
        }
        if let Err(error) = saved {
            let words = format!("{error:#}; the journal has the rows since the last states");
            self.messages.caution(&words);
        }
        if let Some(client) = &self.client {
            client.disconnect();
            // Its thread sends what it has.
            while !matches!(self.link.next(PATIENCE), None | Some(FromBroker::Down(_))) {}
        }
        let left_out = self.keeper.status.refusals().into_iter().filter(|(_, count)| *count > 0);
        let left_out: Vec<String> =
            left_out.map(|(refusal, count)| format!("{} ({count})", refusal.words())).collect();
        let why = if self.signals.end() { "stopped by a signal" } else { "the replay has ended" };
        let rows = self.keeper.status.rows.count();
        let mut words = format!("{why}: {rows} rows of {} cylinders", self.keeper.len());
        if !left_out.is_empty() {
            words.push_str(&format!("; messages left out: {}", left_out.join(", ")));
        }
        words.push_str(match (self.keeper.unsaved().len(), self.keeper.outbox.len()) {
            (0, _) => "; the states are saved",
            (_, 0) => "; not all states are saved",
            _ => "; events have not arrived, and go out after the next start",
        });
        self.messages.say(&words);
        Ok(())
    }
}
