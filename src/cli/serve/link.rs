//! The connection to the broker, on a thread of its own; no other file names the MQTT client.
//!
//! Each connection has a client of its own: what had not arrived when one was lost is the outbox's to send again. Messages are acknowledged by hand.
mod tls;

use super::config::Broker;
use super::document::Protocol;
use rumqttc::v5::mqttbytes::v5::{
    ConnectProperties, Filter, Packet as Packet5, PubAckReason, SubscribeReasonCode as SubscribeReasonCode5,
};
use rumqttc::{Outgoing, SubscribeFilter, SubscribeReasonCode, v5};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::{Duration, Instant};

/// Messages of the broker that wait at most; then it is not listened to.
const WAITING: usize = 1024;
/// Requests that a client holds.
const REQUESTS: usize = 1 << 16;
/// Largest packet of the broker, bytes: larger than any message that is taken, so that those are counted instead of ending the connection.
const LARGEST: usize = 1 << 24;
/// Largest packet of protocol 3.1.1, which has no way to tell the broker of a bound: the largest that there is. The client would end the
/// connection at a larger one, and the broker would deliver it again for ever; so it is read, let go at once, and acknowledged as one that
/// is too large.
const LARGEST_OF_ALL: usize = 268_435_455;
/// Packets on their way to the broker.
pub(super) const WINDOW: u16 = 20;
/// Messages on their way from it: as many go to the disk at once.
const DELIVERIES: u16 = 256;
/// Filters of a subscription.
const FILTERS: usize = 100;
/// Between two calls of a broker that does not answer.
const PAUSE: Duration = Duration::from_secs(1);
/// Why a connection ended that was ended here.
const LEFT: &str = "it was left";

/// What the broker says.
pub(super) enum FromBroker {
    /// A connection, and whether the broker remembers the last one.
    Up(Client, bool),
    /// None any more.
    Down(String),
    Message(Box<Delivery>),
    /// The broker has answered a part of a subscription, and refuses so many of its topics.
    Subscribed(usize),
    /// The first message that was handed over and has no packet yet went out in this one.
    Sent(u16),
    /// A packet has arrived, and why the broker does not want it.
    Arrived(u16, Option<String>),
}

/// A message.
pub(super) struct Delivery {
    pub topic: String,
    /// Of a payload that is too large its beginning: see [`held`].
    pub payload: Vec<u8>,
    /// Whether it may have been delivered before: once more, or as what the broker keeps.
    pub again: bool,
    pub arrived: Instant,
    receipt: Receipt,
}

enum Receipt {
    V4(rumqttc::Publish),
    V5(v5::mqttbytes::v5::Publish),
}

/// One connection.
#[derive(Clone)]
pub(super) enum Client {
    V4(rumqttc::Client),
    V5(v5::Client),
}

impl Client {
    /// Subscribes; says how often the broker will answer.
    pub(super) fn subscribe(&self, filters: &[String]) -> anyhow::Result<usize> {
        for some in filters.chunks(FILTERS) {
            match self {
                Self::V4(client) => {
                    let filter =
                        |path: &String| SubscribeFilter::new(path.clone(), rumqttc::QoS::AtLeastOnce);
                    client.try_subscribe_many(some.iter().map(filter))?;
                }
                Self::V5(client) => {
                    let filter = |path: &String| Filter::new(path.clone(), v5::mqttbytes::QoS::AtLeastOnce);
                    client.try_subscribe_many(some.iter().map(filter))?;
                }
            }
        }
        Ok(filters.len().div_ceil(FILTERS))
    }

    /// Ends subscriptions.
    pub(super) fn unsubscribe(&self, filters: &[String]) -> anyhow::Result<()> {
        for filter in filters {
            match self {
                Self::V4(client) => client.try_unsubscribe(filter)?,
                Self::V5(client) => client.try_unsubscribe(filter)?,
            }
        }
        Ok(())
    }

    /// Publishes at quality of service 1.
    pub(super) fn publish(&self, topic: String, payload: String, retain: bool) -> anyhow::Result<()> {
        match self {
            Self::V4(client) => client.try_publish(topic, rumqttc::QoS::AtLeastOnce, retain, payload)?,
            Self::V5(client) => {
                client.try_publish(topic, v5::mqttbytes::QoS::AtLeastOnce, retain, payload)?
            }
        }
        Ok(())
    }

    /// Sends a command: at quality of service 0, as Sparkplug has it.
    pub(super) fn command(&self, topic: String, payload: Vec<u8>) -> anyhow::Result<()> {
        match self {
            Self::V4(client) => client.try_publish(topic, rumqttc::QoS::AtMostOnce, false, payload)?,
            Self::V5(client) => client.try_publish(topic, v5::mqttbytes::QoS::AtMostOnce, false, payload)?,
        }
        Ok(())
    }

    /// Tells the broker that a message of this connection need not come again.
    pub(super) fn acknowledge(&self, delivery: &Delivery) -> anyhow::Result<()> {
        match (self, &delivery.receipt) {
            (Self::V4(client), Receipt::V4(publish)) => client.try_ack(publish)?,
            (Self::V5(client), Receipt::V5(publish)) => client.try_ack(publish)?,
            _ => {}
        }
        Ok(())
    }

    /// Ends the connection; the broker remembers it.
    pub(super) fn disconnect(&self) {
        // A connection that is lost ends by itself.
        match self {
            Self::V4(client) => _ = client.try_disconnect(),
            Self::V5(client) => _ = client.try_disconnect(),
        }
    }
}

/// What the broker says from now on.
pub(super) struct Link(Receiver<FromBroker>);

impl Link {
    /// Calls the broker, again and again.
    pub(super) fn new(broker: Broker) -> Self {
        let (sender, receiver) = sync_channel(WAITING);
        std::thread::spawn(move || while called(&broker, &sender).is_some() {});
        Self(receiver)
    }

    /// What comes within a time.
    pub(super) fn next(&self, patience: Duration) -> Option<FromBroker> {
        self.0.recv_timeout(patience).ok()
    }
}

/// A payload while it waits: of one that is too large so much that this is seen, whatever its size.
fn held(payload: &[u8], broker: &Broker) -> Vec<u8> {
    payload[..payload.len().min(broker.message_bytes + 1)].to_vec()
}

/// One connection from its beginning to its end; `None`: it is not listened to any more.
fn called(broker: &Broker, sender: &SyncSender<FromBroker>) -> Option<()> {
    let end = match broker.protocol {
        Protocol::V311 => of_v4(broker, sender)?,
        Protocol::V5 => of_v5(broker, sender)?,
    };
    sender.send(FromBroker::Down(end)).ok()?;
    std::thread::sleep(PAUSE);
    Some(())
}

fn of_v4(broker: &Broker, sender: &SyncSender<FromBroker>) -> Option<String> {
    let mut options = rumqttc::MqttOptions::new(&broker.client_id, &broker.host, broker.port);
    options.set_clean_session(false).set_manual_acks(true).set_keep_alive(broker.keep_alive);
    options.set_max_packet_size(LARGEST_OF_ALL, LARGEST_OF_ALL).set_inflight(WINDOW);
    options.set_transport(tls::transport(broker));
    if let Some((user, password)) = &broker.login {
        options.set_credentials(user, password);
    }
    let (client, mut connection) = rumqttc::Client::new(options, REQUESTS);
    loop {
        let said = match connection.recv() {
            Ok(Ok(rumqttc::Event::Incoming(packet))) => match packet {
                rumqttc::Packet::ConnAck(ack) => {
                    FromBroker::Up(Client::V4(client.clone()), ack.session_present)
                }
                rumqttc::Packet::Publish(publish) => FromBroker::Message(Box::new(Delivery {
                    topic: publish.topic.clone(),
                    payload: held(&publish.payload, broker),
                    again: publish.dup || publish.retain,
                    arrived: Instant::now(),
                    receipt: Receipt::V4(rumqttc::Publish { payload: Vec::new().into(), ..publish }),
                })),
                rumqttc::Packet::SubAck(ack) => {
                    let is_refused = |code: &&SubscribeReasonCode| **code == SubscribeReasonCode::Failure;
                    FromBroker::Subscribed(ack.return_codes.iter().filter(is_refused).count())
                }
                rumqttc::Packet::PubAck(ack) => FromBroker::Arrived(ack.pkid, None),
                _ => continue,
            },
            Ok(Ok(rumqttc::Event::Outgoing(Outgoing::Publish(packet)))) => FromBroker::Sent(packet),
            // Whether the broker hears of it or not.
            Ok(Ok(rumqttc::Event::Outgoing(Outgoing::Disconnect))) => return Some(LEFT.to_owned()),
            Ok(Ok(rumqttc::Event::Outgoing(_))) => continue,
            Ok(Err(error)) => return Some(tls::reason(&error, broker)),
            Err(_) => return None,
        };
        sender.send(said).ok()?;
    }
}

fn of_v5(broker: &Broker, sender: &SyncSender<FromBroker>) -> Option<String> {
    let mut options = v5::MqttOptions::new(&broker.client_id, &broker.host, broker.port);
    options.set_clean_start(false).set_manual_acks(true).set_keep_alive(broker.keep_alive);
    options.set_connect_properties(ConnectProperties {
        session_expiry_interval: Some(broker.session_expiry.as_secs().min(u64::from(u32::MAX)) as u32),
        receive_maximum: Some(DELIVERIES),
        max_packet_size: Some(LARGEST as u32),
        ..ConnectProperties::new()
    });
    options.set_outgoing_inflight_upper_limit(WINDOW).set_transport(tls::transport(broker));
    if let Some((user, password)) = &broker.login {
        options.set_credentials(user, password);
    }
    let (client, mut connection) = v5::Client::new(options, REQUESTS);
    loop {
        let said = match connection.recv() {
            Ok(Ok(v5::Event::Incoming(packet))) => match packet {
                Packet5::ConnAck(ack) => FromBroker::Up(Client::V5(client.clone()), ack.session_present),
                Packet5::Publish(publish) => FromBroker::Message(Box::new(Delivery {
                    topic: String::from_utf8_lossy(&publish.topic).into_owned(),
                    payload: held(&publish.payload, broker),
                    again: publish.dup || publish.retain,
                    arrived: Instant::now(),
                    receipt: Receipt::V5(v5::mqttbytes::v5::Publish {
                        payload: Vec::new().into(),
                        ..publish
                    }),
                })),
                Packet5::SubAck(ack) => {
                    let is_refused =
                        |code: &&SubscribeReasonCode5| !matches!(code, SubscribeReasonCode5::Success(_));
                    FromBroker::Subscribed(ack.return_codes.iter().filter(is_refused).count())
                }
                Packet5::PubAck(ack) => {
                    let is_fine =
                        matches!(ack.reason, PubAckReason::Success | PubAckReason::NoMatchingSubscribers);
                    FromBroker::Arrived(ack.pkid, (!is_fine).then(|| format!("{:?}", ack.reason)))
                }
                _ => continue,
            },
            Ok(Ok(v5::Event::Outgoing(Outgoing::Publish(packet)))) => FromBroker::Sent(packet),
            Ok(Ok(v5::Event::Outgoing(Outgoing::Disconnect))) => return Some(LEFT.to_owned()),
            Ok(Ok(v5::Event::Outgoing(_))) => continue,
            Ok(Err(error)) => return Some(tls::reason(&error, broker)),
            Err(_) => return None,
        };
        sender.send(said).ok()?;
    }
}
