//! A configuration that changes while the gateway runs: taken over whole, or refused whole.
//!
//! It waits until the events of the cylinders that change have arrived, so that their states can be saved as they were; at most
//! [`LONGEST_WAIT`], because the change may be what brings the broker back.
use super::Gateway;
use crate::cli::serve::config::{self, Broker, Settings};
use crate::cli::serve::link::Link;
use crate::cli::serve::mapping::sparkplug::Nodes;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long events may take to arrive.
const LONGEST_WAIT: Duration = Duration::from_secs(10);

/// A configuration that waits.
pub(super) struct Reload {
    settings: Arc<Settings>,
    broker: Broker,
    since: Instant,
}

impl Gateway<'_> {
    /// Reads the configuration again.
    pub(super) fn read_again(&mut self) {
        self.notify.reloading();
        match config::read(&self.path) {
            Ok((settings, broker)) => {
                self.reload = Some(Reload { settings: Arc::new(settings), broker, since: Instant::now() });
            }
            Err(error) => self.stays(&error),
        }
    }

    /// Takes the configuration over as soon as it can be.
    pub(super) fn take_over(&mut self) {
        let Some(reload) = &self.reload else { return };
        if !self.keeper.is_settled(&reload.settings) && reload.since.elapsed() < LONGEST_WAIT {
            return;
        }
        let Some(Reload { settings, broker, .. }) = self.reload.take() else { return };
        // What was delivered belongs to the configuration of before.
        self.take();
        match self.keeper.take_over(Arc::clone(&settings)) {
            Ok(changes) => {
                let before = std::mem::replace(&mut self.settings, settings);
                // Births are read by the readings that there are.
                self.nodes = Nodes::default();
                self.greeting = format!("the configuration is taken over: {changes}");
                if !self.connect_anew(&before, broker) {
                    self.messages.say(&self.greeting);
                }
                self.notify.ready();
            }
            Err(error) => self.stays(&error),
        }
    }

    fn stays(&self, error: &anyhow::Error) {
        self.messages.caution(&format!("the configuration stays as it was: {error:#}"));
        self.notify.ready();
    }

    /// Another broker, or other topics; `true`: the broker will answer new subscriptions.
    fn connect_anew(&mut self, before: &Settings, broker: Broker) -> bool {
        if broker != self.broker {
            broker.caution().iter().for_each(|words| self.messages.caution(words));
            self.leave();
            self.drop_batch();
            self.link = Link::new(broker.clone());
            self.broker = broker;
            return false;
        }
        let (old, new) = (before.mapping.filters(), self.settings.mapping.filters());
        let only = |one: &[String], other: &[String]| -> Vec<String> {
            one.iter().filter(|filter| !other.contains(filter)).cloned().collect()
        };
        if let Some(client) = &self.client {
            let changed =
                client.unsubscribe(&only(&old, &new)).and_then(|()| client.subscribe(&only(&new, &old)));
            match changed {
                Ok(answers) => self.subscribing += answers,
                // The next connection subscribes.
                Err(_) => client.disconnect(),
            }
        }
        self.client.is_some() && self.subscribing > 0
    }
}
