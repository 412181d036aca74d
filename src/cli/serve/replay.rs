//! `serve --replay`: recorded logs go through the broker into the gateway, for trials and demonstrations.
//!
//! A second client, on a thread of its own, publishes the rows at quality of service 1 in the order of their times. A row is on its way until the gateway
//! has taken it or left it out; no more than [`MOST`] are, so that a broker with a short queue drops none. Rows have the values of the log bit by
//! bit, so that events and states are those of `fleet` on the same logs.
mod payload;
mod player;
mod tracks;

use super::config::{Broker, Settings};
use super::link::Delivery;
use crate::cli::message::Messages;
use anyhow::{anyhow, bail};
use clap::Args;
use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;
use std::str::FromStr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use tracks::Recording;

/// Rows on their way at most: Mosquitto drops what is beyond 1000 for a client.
const MOST: usize = 500;
/// When it is said that rows do not come.
const STALLED: Duration = Duration::from_secs(10);
/// When the replay is given up.
const LOST: Duration = Duration::from_secs(60);

/// Arguments of a replay.
#[derive(Debug, Args)]
pub(in crate::cli) struct ReplayArguments {
    /// Play recorded logs, or folders of logs, through the broker; end when the gateway has all rows.
    ///
    /// A log belongs to the cylinder of its name, as for `fleet`.
    #[arg(long, value_name = "LOG", num_args = 1.., help_heading = "Replay")]
    pub replay: Vec<PathBuf>,
    /// How many times faster than recorded, or max.
    #[arg(long, value_name = "FACTOR", default_value = "1", requires = "replay", help_heading = "Replay")]
    pub speed: Speed,
    /// Go on serving after the last row.
    #[arg(long, requires = "replay", help_heading = "Replay")]
    pub stay: bool,
}

/// How fast logs are played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::cli) enum Speed {
    /// Times faster than recorded.
    Factor(f64),
    /// As fast as the gateway takes rows.
    Most,
}

impl FromStr for Speed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let factor = text.parse().ok().filter(|factor: &f64| (1e-3..=1e9).contains(factor));
        match (text, factor) {
            ("max", _) => Ok(Self::Most),
            (_, Some(factor)) => Ok(Self::Factor(factor)),
            _ => Err("a number between 0.001 and 1e9, or max".to_owned()),
        }
    }
}

/// A replay beside a gateway.
pub(super) struct Replay {
    /// Until it begins.
    ready: Option<(Recording, Broker, Speed)>,
    stays: bool,
    way: Arc<Way>,
    thread: Option<JoinHandle<anyhow::Result<()>>>,
    /// How many rows had come, and since when no other has.
    seen: (u64, Instant),
    is_told: bool,
    is_over: bool,
}

/// Rows between the player and the gateway.
#[derive(Default)]
pub(super) struct Way(Mutex<Traffic>);

#[derive(Default)]
struct Traffic {
    on_way: HashSet<u64>,
    come: u64,
    /// The gateway ends.
    is_closed: bool,
}

impl Way {
    fn traffic(&self) -> MutexGuard<'_, Traffic> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn set_out(&self, topic: &str, payload: &[u8]) {
        self.traffic().on_way.insert(hash(topic, payload));
    }

    fn has_room(&self) -> bool {
        self.traffic().on_way.len() < MOST
    }

    fn is_closed(&self) -> bool {
        self.traffic().is_closed
    }
}

fn hash(topic: &str, payload: &[u8]) -> u64 {
    let mut hasher = DefaultHasher::new();
    (topic, payload).hash(&mut hasher);
    hasher.finish()
}

impl Replay {
    /// Reads the logs once; `None`: there is nothing to play.
    pub(super) fn of(
        arguments: &ReplayArguments,
        (settings, broker): (&Settings, &Broker),
        messages: &Messages,
    ) -> anyhow::Result<Option<Self>> {
        if arguments.replay.is_empty() {
            return Ok(None);
        }
        let recording = Recording::of(&arguments.replay, &settings.mapping)?;
        recording.cautions.iter().for_each(|caution| messages.caution(caution));
        let Recording { rows, cylinders, span_us, .. } = recording;
        let span_s = (span_us.1 - span_us.0) as f64 / 1e6;
        let lasts = match arguments.speed {
            Speed::Factor(factor) => format!("at speed {factor} they take {}", told(span_s / factor)),
            Speed::Most => "they come as fast as they are taken".to_owned(),
        };
        messages.say(&format!("replay: {rows} rows of {cylinders} cylinders, {}; {lasts}", told(span_s)));
        let broker = Broker {
            client_id: format!("{}-replay", broker.client_id),
            session_expiry: Duration::from_secs(60),
            ..broker.clone()
        };
        Ok(Some(Self {
            ready: Some((recording, broker, arguments.speed)),
            stays: arguments.stay,
            way: Arc::default(),
            thread: None,
            seen: (0, Instant::now()),
            is_told: false,
            is_over: false,
        }))
    }

    /// The gateway's subscription holds: the replay begins.
    pub(super) fn subscribed(&mut self) {
        if let Some((recording, broker, speed)) = self.ready.take() {
            let way = Arc::clone(&self.way);
            self.thread = Some(std::thread::spawn(move || player::play(&recording, broker, speed, &way)));
            self.seen.1 = Instant::now();
        }
    }

    /// The gateway is through with messages.
    pub(super) fn come<'a>(&self, deliveries: impl Iterator<Item = &'a Delivery>) {
        let mut traffic = self.way.traffic();
        for delivery in deliveries {
            traffic.come += u64::from(traffic.on_way.remove(&hash(&delivery.topic, &delivery.payload)));
        }
    }

    /// Whether the gateway is to go on; it `waits` while rows could not come.
    ///
    /// # Errors
    /// The logs cannot be played to their end.
    pub(super) fn goes_on(&mut self, waits: bool, messages: &Messages) -> anyhow::Result<bool> {
        let (on_way, come) = {
            let traffic = self.way.traffic();
            (traffic.on_way.len(), traffic.come)
        };
        if self.thread.as_ref().is_some_and(JoinHandle::is_finished)
            && let Some(played) = self.thread.take().map(JoinHandle::join)
        {
            played.map_err(|_| anyhow!("the replay failed"))??;
            self.is_over = true;
        }
        if self.is_over && on_way == 0 {
            if !self.is_told {
                messages.say(&format!("the replay is through: {come} rows have come"));
                self.is_told = true;
            }
            return Ok(self.stays);
        }
        if waits || on_way == 0 || come != self.seen.0 {
            self.seen = (come, Instant::now());
            self.is_told = false;
        }
        let lost = format!(
            "{on_way} rows of the replay do not come back from the broker: see whether it drops messages or lets this user publish to \
             the topics"
        );
        if self.seen.1.elapsed() > LOST {
            bail!(lost);
        }
        if self.seen.1.elapsed() > STALLED && !std::mem::replace(&mut self.is_told, true) {
            messages.caution(&lost);
        }
        Ok(true)
    }
}

impl Drop for Replay {
    fn drop(&mut self) {
        self.way.traffic().is_closed = true;
        // What it could say concerns a gateway that has ended.
        _ = self.thread.take().map(JoinHandle::join);
    }
}

/// A time in the largest fitting unit.
fn told(time_s: f64) -> String {
    let units = [(86_400.0, "d"), (3600.0, "h"), (60.0, "min")];
    let (unit_s, unit) = units.into_iter().find(|(unit_s, _)| time_s >= *unit_s).unwrap_or((1.0, "s"));
    format!("{:.1} {unit}", time_s / unit_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_speed_is_a_positive_number_or_max() {
        assert_eq!("1000".parse(), Ok(Speed::Factor(1000.0)));
        assert_eq!("max".parse(), Ok(Speed::Most));
        for wrong in ["0", "-1", "inf", "nan", "fast", ""] {
            assert!(wrong.parse::<Speed>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn rows_are_on_their_way_until_they_have_come_and_no_more_than_the_broker_can_queue() {
        let way = Way::default();
        for row in 0..MOST {
            assert!(way.has_room());
            way.set_out("t", row.to_string().as_bytes());
        }
        assert!(!way.has_room());
        assert!(way.traffic().on_way.remove(&hash("t", b"7")) && way.has_room());
        assert_ne!(hash("t", b"7"), hash("u", b"7"));
    }
}
