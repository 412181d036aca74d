//! Sparkplug B through a broker: an edge node that was running before the gateway is asked for its births, and its rows give what `fleet` gives.
use super::*;
use rumqttc::{Client, Event, MqttOptions, Packet, QoS};
use std::sync::mpsc::{Receiver, channel};

/// 2026-01-01, ms.
const T_MS: u64 = 1_767_225_600_000;

/// A message of Protocol Buffers, written by hand.
#[derive(Default)]
struct Message(Vec<u8>);

impl Message {
    fn varint(mut self, mut value: u64) -> Self {
        while value >= 128 {
            self.0.push(value as u8 | 128);
            value >>= 7;
        }
        self.0.push(value as u8);
        self
    }

    fn number(self, field: u64, value: u64) -> Self {
        self.varint(field << 3).varint(value)
    }

    fn double(self, field: u64, value: f64) -> Self {
        let mut message = self.varint(field << 3 | 1);
        message.0.extend(value.to_le_bytes());
        message
    }

    fn bytes(self, field: u64, bytes: &[u8]) -> Self {
        let mut message = self.varint(field << 3 | 2).varint(bytes.len() as u64);
        message.0.extend(bytes);
        message
    }
}

/// Readings of a cylinder in a minute; a birth has names, data aliases.
fn payload(name: &str, minute: u32, seq: u64, is_birth: bool) -> Vec<u8> {
    let time_ms = T_MS + 60_000 * u64::from(minute);
    let mut payload = Message::default().number(1, time_ms);
    for (alias, value) in readings(name, minute).into_iter().enumerate() {
        let mut metric = Message::default();
        if is_birth {
            metric = metric.bytes(1, ["Shoulder", "Valve", "Pressure"][alias].as_bytes()).number(4, 10);
        }
        let metric = metric.number(2, alias as u64).number(3, time_ms).double(13, value);
        payload = payload.bytes(2, &metric.0);
    }
    payload.number(3, seq).0
}

/// An edge node: who publishes, and the commands that come.
fn edge(port: u16) -> (Client, Receiver<Vec<u8>>) {
    let mut options = MqttOptions::new("edge", "127.0.0.1", port);
    options.set_keep_alive(broker::PATIENCE).set_inflight(1000);
    let (client, mut connection) = Client::new(options, 1 << 16);
    client.subscribe("spBv1.0/depot/NCMD/n1", QoS::AtLeastOnce).unwrap();
    let ((sender, commands), (subscribed, is_subscribed)) = (channel(), channel());
    std::thread::spawn(move || {
        for said in connection.iter() {
            match said {
                Ok(Event::Incoming(Packet::Publish(publish))) => _ = sender.send(publish.payload.to_vec()),
                Ok(Event::Incoming(Packet::SubAck(_))) => _ = subscribed.send(()),
                _ => {}
            }
        }
    });
    is_subscribed.recv_timeout(broker::PATIENCE).unwrap();
    (client, commands)
}

/// The configuration in places and metrics.
fn of_sparkplug(port: u16) -> String {
    let mut text = configuration(port, "5").replace("time = \"/t\"", "format = \"sparkplug-b\"");
    for (from, to) in [
        ("train/", "depot/n1/"),
        ("depot/+/gas", "depot/n1/+"),
        ("at = \"/temps/0\"", "metric = \"Shoulder\""),
        ("at = \"/temps/1\"", "metric = \"Valve\""),
        ("at = \"/p\"", "metric = \"Pressure\""),
    ] {
        text = text.replace(from, to);
    }
    text
}

#[test]
fn rows_of_an_edge_node_give_the_events_and_states_of_fleet() {
    let Some((folder, broker, heard)) = begun("5") else { return };
    std::fs::write(folder.path().join("gateway.toml"), of_sparkplug(broker.port)).unwrap();
    let (client, commands) = edge(broker.port);
    let publish = |kind: &str, device: &str, payload: Vec<u8>| {
        let topic = format!("spBv1.0/depot/{kind}/n1{device}");
        client.publish(topic, QoS::AtLeastOnce, false, payload).unwrap();
    };
    let running = gateway(folder.path());
    wait("connected", || said(folder.path()).contains("connected"));
    // The gateway has not heard the births.
    publish("DDATA", "/A", payload("A", 0, 7, false));
    let command = commands.recv_timeout(broker::PATIENCE).unwrap();
    assert!(command.windows(20).any(|part| part == b"Node Control/Rebirth"), "{command:?}");
    publish("NBIRTH", "", Message::default().number(1, T_MS).number(3, 0).0);
    let mut seq = 0;
    for minute in 0..MINUTES {
        for name in NAMES {
            seq = (seq + 1) % 256;
            let kind = if minute == 0 { "DBIRTH" } else { "DDATA" };
            publish(kind, &format!("/{name}"), payload(name, minute, seq, minute == 0));
        }
    }
    wait_for(MINUTES - 1, &heard, folder.path());
    end(running, folder.path());
    assert_same_states(folder.path());
    assert_same_events(&heard, folder.path());
    assert!(commands.try_recv().is_err(), "nothing was missing");
}
