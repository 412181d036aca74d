//! The thread that plays: a client of the broker beside the gateway's.
use super::tracks::{Recording, Tracks};
use super::{Speed, Way};
use crate::cli::serve::config::Broker;
use crate::cli::serve::link::{Client, FromBroker, Link, WINDOW};
use crate::cli::serve::outbox::{Message, Outbox};
use anyhow::bail;
use std::time::{Duration, Instant};

/// Messages that are made before they can be sent.
const AHEAD: usize = 2 * WINDOW as usize;
/// Longest wait for the broker.
const PATIENCE: Duration = Duration::from_millis(100);
/// How often it is seen whether the gateway has taken rows.
const GLANCE: Duration = Duration::from_millis(1);

struct Player<'a> {
    tracks: Tracks<'a>,
    link: Link,
    client: Option<Client>,
    outbox: Outbox,
    way: &'a Way,
}

/// Plays until the broker has all, or the gateway ends.
pub(super) fn play(recording: &Recording, broker: Broker, speed: Speed, way: &Way) -> anyhow::Result<()> {
    let (tracks, link) = (recording.begin()?, Link::new(broker));
    let mut player = Player { tracks, link, client: None, outbox: Outbox::default(), way };
    let begin = Instant::now();
    let due = |time_us: i64| match speed {
        Speed::Factor(factor) => {
            let after_s = (time_us - recording.span_us.0) as f64 / 1e6 / factor;
            begin + Duration::try_from_secs_f64(after_s.max(0.0)).unwrap_or(Duration::MAX / 4)
        }
        Speed::Most => begin,
    };
    while !way.is_closed() {
        let Some(patience) = player.hand_in(due)? else { break };
        player.send();
        player.listen(patience)?;
    }
    if let Some(client) = &player.client {
        client.disconnect();
        while !matches!(player.link.next(PATIENCE), None | Some(FromBroker::Down(_))) {}
    }
    Ok(())
}

impl Player<'_> {
    /// Makes messages of the rows that are due: how long may be waited then; `None`: all have arrived.
    fn hand_in(&mut self, due: impl Fn(i64) -> Instant) -> anyhow::Result<Option<Duration>> {
        while let Some(time_us) = self.tracks.next_us() {
            let wait = due(time_us).saturating_duration_since(Instant::now());
            if !wait.is_zero() || self.outbox.len() >= AHEAD {
                return Ok(Some(if wait.is_zero() { PATIENCE } else { wait.clamp(GLANCE, PATIENCE) }));
            }
            if !self.way.has_room() {
                return Ok(Some(GLANCE));
            }
            if let Some(played) = self.tracks.take()? {
                self.way.set_out(&played.topic, played.payload.as_bytes());
                let (topic, payload) = (played.topic, played.payload);
                self.outbox.push(Message { topic, payload, retain: false, event_of: Some(played.cylinder) });
            }
        }
        Ok((self.outbox.len() > 0).then_some(PATIENCE))
    }

    fn send(&mut self) {
        let Some(client) = &self.client else { return };
        while let Some(message) = self.outbox.hand(usize::from(WINDOW)) {
            if client.publish(message.topic, message.payload, message.retain).is_err() {
                // The next connection sends it.
                client.disconnect();
                self.client = None;
                return;
            }
        }
    }

    fn listen(&mut self, patience: Duration) -> anyhow::Result<()> {
        let mut patience = patience;
        while let Some(said) = self.link.next(patience) {
            patience = Duration::ZERO;
            match said {
                FromBroker::Up(client, is_known) => {
                    self.outbox.connected(is_known);
                    self.client = Some(client);
                }
                FromBroker::Down(_) => self.client = None,
                FromBroker::Sent(packet) => self.outbox.sent(packet),
                FromBroker::Arrived(packet, refused) => {
                    if let Some(reason) = refused {
                        bail!(
                            "the broker does not take the rows of the replay: {reason}: allow this user to publish them"
                        );
                    }
                    self.outbox.arrived(packet);
                }
                FromBroker::Message(_) | FromBroker::Subscribed(_) => {}
            }
        }
        Ok(())
    }
}
