//! A broker that takes everything in and acknowledges nothing, which no real one does for long: spoken to by hand, in MQTT 3.1.1.
use super::*;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, Mutex};

/// What it was told, by connection.
#[derive(Default)]
struct Told {
    /// Topic and payload of each message.
    published: Vec<(String, String)>,
    /// Packets that the gateway acknowledged.
    acknowledged: BTreeSet<u16>,
    is_left: bool,
}

type Connections = Arc<Mutex<Vec<Told>>>;

/// The first byte of a packet, and what follows its length; `None`: the connection has ended.
fn packet(stream: &mut TcpStream) -> Option<(u8, Vec<u8>)> {
    let mut byte = [0];
    let mut next = |stream: &mut TcpStream| stream.read_exact(&mut byte).ok().map(|()| byte[0]);
    let kind = next(stream)?;
    let (mut length, mut shift) = (0, 0);
    loop {
        let digit = next(stream)?;
        length |= usize::from(digit & 127) << shift;
        shift += 7;
        if digit < 128 {
            break;
        }
    }
    let mut body = vec![0; length];
    stream.read_exact(&mut body).ok()?;
    Some((kind, body))
}

fn u16_at(body: &[u8], at: usize) -> u16 {
    u16::from_be_bytes([body[at], body[at + 1]])
}

/// Topic, packet and payload of a message at quality of service 1.
fn published(body: &[u8]) -> (String, u16, String) {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    let end = 2 + usize::from(u16_at(body, 0));
    (text(&body[2..end]), u16_at(body, end), text(&body[end + 2..]))
}

/// A row as the broker delivers it.
fn delivered(packet: u16, topic: &str, payload: &str) -> Vec<u8> {
    let length = 2 + topic.len() + 2 + payload.len();
    let mut bytes = vec![0x32, length as u8 & 127 | 128, (length >> 7) as u8];
    bytes.extend((topic.len() as u16).to_be_bytes());
    bytes.extend(topic.as_bytes());
    bytes.extend(packet.to_be_bytes());
    bytes.extend(payload.as_bytes());
    bytes
}

/// One connection: the first acknowledges nothing, the others all.
fn serve(stream: &mut TcpStream, number: usize, connections: &Connections) {
    while let Some((kind, body)) = packet(stream) {
        let told = |change: &mut dyn FnMut(&mut Told)| change(&mut connections.lock().unwrap()[number]);
        let answer = match kind >> 4 {
            1 => vec![0x20, 2, u8::from(number > 0), 0],
            8 => {
                let mut filters = 0;
                let mut at = 2;
                while at < body.len() {
                    at += 2 + usize::from(u16_at(&body, at)) + 1;
                    filters += 1;
                }
                let mut bytes = vec![0x90, 2 + filters, body[0], body[1]];
                bytes.resize(bytes.len() + usize::from(filters), 1);
                if number == 0 {
                    let rows = messages(0..MINUTES).into_iter().filter(|(topic, _)| topic == "train/B");
                    for (row, (topic, payload)) in rows.enumerate() {
                        bytes.extend(delivered(row as u16 + 1, &topic, &payload));
                    }
                }
                bytes
            }
            3 => {
                let (topic, packet, payload) = published(&body);
                told(&mut |told| told.published.push((topic.clone(), payload.clone())));
                let [high, low] = packet.to_be_bytes();
                if number == 0 { Vec::new() } else { vec![0x40, 2, high, low] }
            }
            4 => {
                told(&mut |told| _ = told.acknowledged.insert(u16_at(&body, 0)));
                Vec::new()
            }
            12 => vec![0xd0, 0],
            14 => {
                // The connection stays: its other end has to close it.
                told(&mut |told| told.is_left = true);
                Vec::new()
            }
            _ => panic!("a packet that no gateway sends: {kind:x}"),
        };
        if stream.write_all(&answer).is_err() {
            return;
        }
    }
}

fn begin() -> (u16, Connections) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let connections = Connections::default();
    let sink = Arc::clone(&connections);
    std::thread::spawn(move || {
        for (number, stream) in listener.incoming().enumerate() {
            sink.lock().unwrap().push(Told::default());
            let (mut stream, sink) = (stream.unwrap(), Arc::clone(&sink));
            std::thread::spawn(move || serve(&mut stream, number, &sink));
        }
    });
    (port, connections)
}

#[test]
fn a_broker_that_acknowledges_nothing_is_left_and_gets_everything_again() {
    let folder = with_fleet(time);
    let folder = folder.path();
    let (port, connections) = begin();
    let quick = configuration(port, "3.1.1").replace("client_id", "keep_alive_s = 5\nclient_id");
    std::fs::write(folder.join("gateway.toml"), quick).unwrap();
    let running = gateway(folder);
    let last = format!("\"time\":\"{}\"", time(MINUTES - 1));
    wait("the last estimate arrives", || {
        let connections = connections.lock().unwrap();
        connections.get(1).is_some_and(|second| {
            second
                .published
                .iter()
                .any(|(topic, payload)| topic == "cylwatch/B/estimate" && payload.contains(&last))
        })
    });
    end(running, folder);
    let connections = connections.lock().unwrap();
    assert_eq!(connections.len(), 2, "{}", said(folder));
    let [first, second] = &connections[..] else { panic!("two connections") };
    assert_eq!(said(folder).matches("acknowledged nothing for 5 s").count(), 1, "{}", said(folder));
    assert!(first.is_left);
    assert_eq!(first.acknowledged.len(), MINUTES as usize, "rows do not wait for what was published");
    // No more than the window, and of these all again.
    assert!((1..=20).contains(&first.published.len()), "{}", first.published.len());
    let topics = |told: &Told| told.published.iter().map(|(topic, _)| topic.clone()).collect::<BTreeSet<_>>();
    assert!(topics(first).is_subset(&topics(second)));
    let is_event = |(topic, _): &&(String, String)| {
        topic.starts_with("cylwatch/B/event") || topic.starts_with("cylwatch/B/alarm")
    };
    let events: Vec<String> =
        second.published.iter().filter(is_event).map(|(_, payload)| payload.clone()).collect();
    assert_eq!(events, fleet_lines(folder)["B"], "all events, each once over one connection");
}
