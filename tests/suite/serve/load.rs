//! How fast and how large a gateway is: a row of every cylinder each 10 s, from the message to the verdict that was published.
//!
//! A monitor decides once a minute: the first row of the next minute brings the verdict, so its message is where the time begins.
use super::*;
use rumqttc::{Client, Event, MqttOptions, Packet, QoS};
use std::collections::HashMap;
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// Between two rows of a cylinder.
const EVERY_S: u64 = 10;

pub(super) fn asked(name: &str, usual: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// A pattern takes them all up.
fn of_many(port: u16, cylinders: u64) -> String {
    let text = configuration(port, "5").replace("most = 1", &format!("most = {cylinders}"));
    text.replace("save_every_s = 1", "save_every_s = 600")
        .replace("time = \"/t\"", "time = \"/t\"\nclock = \"seconds\"")
}

pub(super) fn rss_mb(gateway: &Process) -> f64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", gateway.0.id())).unwrap();
    let kb = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    kb.trim().trim_end_matches(" kB").parse::<f64>().unwrap() / 1024.0
}

/// Seconds of processor time.
fn processor_s(gateway: &Process) -> f64 {
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", gateway.0.id())).unwrap();
    let fields: Vec<&str> = stat.rsplit(") ").next().unwrap().split(' ').collect();
    (fields[11].parse::<f64>().unwrap() + fields[12].parse::<f64>().unwrap()) / 100.0
}

/// When rows were published, by cylinder and second, and how long it took until their verdicts came, s.
#[derive(Default)]
struct Flight {
    published: HashMap<(u64, u64), Instant>,
    took_s: Vec<f64>,
}

/// Listens to verdicts.
fn time_verdicts(port: u16, flight: &Arc<Mutex<Flight>>) {
    let mut options = MqttOptions::new("stopwatch", "127.0.0.1", port);
    options.set_max_packet_size(1 << 20, 1 << 20).set_keep_alive(broker::PATIENCE);
    let (client, mut connection) = Client::new(options, 1 << 10);
    client.subscribe("cylwatch/+/verdict", QoS::AtMostOnce).unwrap();
    let flight = Arc::clone(flight);
    std::thread::spawn(move || {
        for said in connection.iter() {
            let Ok(Event::Incoming(Packet::Publish(publish))) = said else { continue };
            let came = Instant::now();
            let number = publish.topic.split('/').nth(1).unwrap().parse().unwrap();
            let verdict: serde_json::Value = serde_json::from_slice(&publish.payload).unwrap();
            let time: jiff::Timestamp = verdict["time"].as_str().unwrap().parse().unwrap();
            let mut flight = flight.lock().unwrap();
            let of = time.as_second() as u64 + EVERY_S;
            if let Some(begin) = flight.published.remove(&(number, of)) {
                flight.took_s.push((came - begin).as_secs_f64());
            }
        }
        drop(client);
    });
}

/// `CYLINDERS=5000 MINUTES=30 cargo test --release --features serve --test suite -- --ignored --nocapture serve::load`.
#[test]
#[ignore = "half an hour: cargo test --release --features serve --test suite -- --ignored --nocapture serve::load"]
#[allow(clippy::print_stdout)]
fn many_cylinders_with_a_row_each_10_s() {
    let (cylinders, minutes) = (asked("CYLINDERS", 5000), asked("MINUTES", 30));
    let folder = tempdir().unwrap();
    let Some(broker) = Broker::begin(folder.path()) else { return };
    std::fs::write(folder.path().join("gateway.toml"), of_many(broker.port, cylinders)).unwrap();
    let running = gateway(folder.path());
    wait("connected", || said(folder.path()).contains("connected"));
    let flight = Arc::<Mutex<Flight>>::default();
    time_verdicts(broker.port, &flight);
    let mut options = MqttOptions::new("loggers", "127.0.0.1", broker.port);
    options.set_keep_alive(broker::PATIENCE).set_inflight(1000);
    let (client, mut connection) = Client::new(options, 1 << 16);
    std::thread::spawn(move || connection.iter().for_each(drop));
    // Rows have whole seconds, so that the verdict tells which one it is of.
    let (begin, begin_s) = (Instant::now(), jiff::Timestamp::now().as_second() as u64);
    let rows = minutes * 60 / EVERY_S;
    println!("min  rss MB  processor %  verdicts  p50 ms  p99 ms  longest ms");
    let (mut minute, mut before_s, mut all_s) = (0, processor_s(&running), Vec::new());
    for row in 0..rows {
        for number in 0..cylinders {
            let due = Duration::from_secs(row * EVERY_S)
                + Duration::from_secs(EVERY_S) * number as u32 / cylinders as u32;
            std::thread::sleep(due.saturating_sub(begin.elapsed()));
            let second = begin_s + row * EVERY_S;
            let [shoulder, valve, pressure] = readings("A", ((row + 7 * number) % 600) as u32);
            let payload = format!("{{\"t\":{second},\"p\":{pressure},\"temps\":[{shoulder},{valve}]}}");
            flight.lock().unwrap().published.insert((number, second), Instant::now());
            client.publish(format!("depot/{number}/gas"), QoS::AtLeastOnce, false, payload).unwrap();
        }
        if begin.elapsed().as_secs() / 60 > minute {
            minute = begin.elapsed().as_secs() / 60;
            let now_s = processor_s(&running);
            let mut took_s = flight.lock().unwrap().took_s.split_off(0);
            let [p50, p99, longest] = quantiles_ms(&mut took_s);
            println!(
                "{minute:3}  {:6.0}  {:11.1}  {:8}  {p50:6.1}  {p99:6.1}  {longest:10.1}",
                rss_mb(&running),
                (now_s - before_s) / 0.6,
                took_s.len()
            );
            before_s = now_s;
            all_s.extend(took_s);
        }
    }
    std::thread::sleep(Duration::from_secs(3));
    all_s.append(&mut flight.lock().unwrap().took_s);
    let [p50, p99, longest] = quantiles_ms(&mut all_s);
    println!("all verdicts {}: p50 {p50:.1} ms, p99 {p99:.1} ms, longest {longest:.1} ms", all_s.len());
    let begin = Instant::now();
    end(running, folder.path());
    println!("ended within {:.1} s", begin.elapsed().as_secs_f64());
    // Two have a topic of their own, and send nothing.
    let words = format!("{} rows of {} cylinders", rows * cylinders, cylinders + 2);
    assert!(said(folder.path()).contains(&words), "rows are lost: {}", said(folder.path()));
}

fn quantiles_ms(took_s: &mut [f64]) -> [f64; 3] {
    took_s.sort_by(f64::total_cmp);
    let at =
        |part: f64| took_s.get(((took_s.len() as f64 * part) as usize).min(took_s.len().saturating_sub(1)));
    [0.5, 0.99, 1.0].map(|part| at(part).map_or(f64::NAN, |took_s| took_s * 1e3))
}
