//! `cylwatch serve` beside a real broker: the events and states of `fleet`, through kills of either; bad configurations and bad messages.
mod broker;
mod demonstration;
mod hardship;
mod hostile;
mod http;
mod load;
mod mute;
#[cfg(target_os = "linux")]
mod notify;
mod refusals;
mod reload;
mod replay;
mod schema;
mod sparkplug;
mod tls;

use crate::support::{program, run};
use broker::{Broker, Heard, Process, listen, publish, wait};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;
use tempfile::{TempDir, tempdir};

const NAMES: [&str; 3] = ["A", "B", "C"];
const MINUTES: u32 = 800;

/// Shoulder and valve in °C and pressure in bar of a cylinder in a minute of a day; B leaks 1 bar/h from minute 600 on.
fn readings(name: &str, minute: u32) -> [f64; 3] {
    let residue = |by: u32| f64::from(minute * minute * by % 101) / 50.0 - 1.0;
    let lost_bar = if name == "B" { f64::from(minute.saturating_sub(600)) / 60.0 } else { 0.0 };
    let rounded = |value: f64| (value * 1e4).round() / 1e4;
    [15.0 + 0.03 * residue(3), 15.0 + 0.03 * residue(7), 200.0 + 0.02 * residue(11) - lost_bar].map(rounded)
}

fn time(minute: u32) -> String {
    format!("2026-01-01T{:02}:{:02}:00Z", minute / 60, minute % 60)
}

/// Messages of some minutes: A and B have topics, C comes by the pattern.
fn messages(minutes: std::ops::Range<u32>) -> Vec<(String, String)> {
    messages_by(time, minutes)
}

/// The same by another clock.
fn messages_by(clock: fn(u32) -> String, minutes: std::ops::Range<u32>) -> Vec<(String, String)> {
    let message = |name: &str, minute| {
        let [shoulder, valve, pressure] = readings(name, minute);
        let topic = if name == "C" { "depot/C/gas".to_owned() } else { format!("train/{name}") };
        let content =
            format!("{{\"t\":\"{}\",\"p\":{pressure},\"temps\":[{shoulder},{valve}]}}", clock(minute));
        (topic, content)
    };
    minutes.flat_map(|minute| NAMES.map(|name| message(name, minute))).collect()
}

/// A folder with what `fleet` makes of all rows, by a clock.
fn with_fleet(clock: fn(u32) -> String) -> TempDir {
    let folder = tempdir().unwrap();
    let row = |name: &str| format!("{name},nitrogen-20l,200,15,yes\n");
    let vessels = NAMES.map(row).concat();
    let header = "cylinder,vessel,fill_pressure_bar,fill_temperature_degc,settled\n";
    std::fs::write(folder.path().join("fleet.csv"), header.to_owned() + &vessels).unwrap();
    std::fs::create_dir(folder.path().join("logs")).unwrap();
    for name in NAMES {
        let mut log = "time,shoulder_degc,valve_degc,pressure_bar\n".to_owned();
        for minute in 0..MINUTES {
            let [shoulder, valve, pressure] = readings(name, minute);
            log.push_str(&format!("{},{shoulder},{valve},{pressure}\n", clock(minute)));
        }
        std::fs::write(folder.path().join(format!("logs/{name}.csv")), log).unwrap();
    }
    let fleet = ["fleet", "logs", "--vessels", "fleet.csv", "-o", "fleet", "--format", "csv", "-q"];
    assert_eq!(run(folder.path(), &fleet).code, Some(1));
    folder
}

/// The lines of the events of `fleet`, in their order, by cylinder.
fn fleet_lines(folder: &Path) -> BTreeMap<String, Vec<String>> {
    let text = std::fs::read_to_string(folder.join("fleet/events.csv")).unwrap();
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    let headers = reader.headers().unwrap().clone();
    let at = |name: &str| headers.iter().position(|header| header == name).unwrap();
    let (cylinder, line) = (at("cylinder"), at("line"));
    let mut lines: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for record in reader.records() {
        let record = record.unwrap();
        lines.entry(record[cylinder].to_owned()).or_default().push(record[line].to_owned());
    }
    assert!(lines["B"].len() >= 4, "{lines:?}");
    lines
}

/// A configuration for the port of a broker.
fn configuration(port: u16, protocol: &str) -> String {
    format!(
        r#"
[broker]
host = "127.0.0.1"
port = {port}
protocol = "{protocol}"
client_id = "gateway"
[store]
folder = "store"
save_every_s = 1
[[type]]
name = "rail"
vessel = "nitrogen-20l"
options = {{ fill_pressure_bar = 200, fill_temperature_degc = 15 }}
[[cylinder]]
name = "A"
type = "rail"
topic = "train/A"
options = {{ settled = true }}
[[cylinder]]
name = "B"
type = "rail"
topic = "train/B"
options = {{ settled = true }}
[[type]]
name = "settled"
vessel = "nitrogen-20l"
options = {{ fill_pressure_bar = 200, fill_temperature_degc = 15, settled = true }}
[pattern]
topic = "depot/+/gas"
type = "settled"
most = 1
[payload]
time = "/t"
[[payload.reading]]
name = "shoulder_degc"
at = "/temps/0"
[[payload.reading]]
name = "valve_degc"
at = "/temps/1"
[[payload.reading]]
name = "pressure_bar"
at = "/p"
"#
    )
}

/// Starts the gateway; what it says goes to a file.
fn gateway(folder: &Path) -> Process {
    let said = std::fs::File::options().create(true).append(true).open(folder.join("said.txt")).unwrap();
    let child = program(folder, &["serve", "gateway.toml"]).stdout(Stdio::null()).stderr(said).spawn();
    Process(child.unwrap())
}

fn said(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("said.txt")).unwrap_or_default()
}

/// Ends the gateway by a signal: exit code 0.
fn end(mut gateway: Process, folder: &Path) {
    signal(&gateway, "-TERM");
    assert_eq!(gateway.0.wait().unwrap().code(), Some(0), "{}", said(folder));
}

/// Waits until the estimate of a minute has been published of every cylinder.
fn wait_for(minute: u32, heard: &Heard, folder: &Path) {
    wait_until(&time(minute), heard, folder);
}

fn wait_until(time: &str, heard: &Heard, folder: &Path) {
    let is_there = |name: &str| {
        let topic = format!("cylwatch/{name}/estimate");
        let time = format!("\"time\":\"{time}\"");
        heard.lock().unwrap().iter().any(|(of, payload, _)| *of == topic && payload.contains(&time))
    };
    wait(&format!("{time}: {}", said(folder)), || NAMES.iter().all(|name| is_there(name)));
}

fn assert_same_states(folder: &Path) {
    for name in NAMES {
        let state = |of: &str| std::fs::read(folder.join(format!("{of}/states/{name}.state"))).unwrap();
        assert!(state("fleet") == state("store"), "the state of {name} differs: {}", said(folder));
    }
}

/// Sends a signal to the gateway.
fn signal(gateway: &Process, name: &str) {
    let pid = gateway.0.id().to_string();
    assert!(Command::new("kill").args([name, &pid]).status().unwrap().success());
}

/// Events and changes of alarms as they were heard, by cylinder.
fn heard_lines(heard: &Heard) -> BTreeMap<String, Vec<String>> {
    schema::assert_true_of(heard);
    let mut lines: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (topic, payload, _) in heard.lock().unwrap().iter() {
        let levels: Vec<&str> = topic.split('/').collect();
        if ["event", "alarm"].contains(&levels[2]) {
            lines.entry(levels[1].to_owned()).or_default().push(payload.clone());
        }
    }
    lines
}

/// No event is missing, and none is there that `fleet` does not tell, however often it came.
fn assert_same_events(heard: &Heard, folder: &Path) {
    let set = |lines: BTreeMap<String, Vec<String>>| -> BTreeSet<(String, String)> {
        lines
            .into_iter()
            .flat_map(|(name, lines)| lines.into_iter().map(move |line| (name.clone(), line)))
            .collect()
    };
    assert_eq!(set(heard_lines(heard)), set(fleet_lines(folder)), "{}", said(folder));
}

fn begun(protocol: &str) -> Option<(TempDir, Broker, Heard)> {
    begun_by(time, protocol)
}

/// The same by another clock.
fn begun_by(clock: fn(u32) -> String, protocol: &str) -> Option<(TempDir, Broker, Heard)> {
    let folder = tempdir().unwrap();
    let broker = Broker::begin(folder.path())?;
    drop(folder);
    let folder = with_fleet(clock);
    std::fs::write(folder.path().join("gateway.toml"), configuration(broker.port, protocol)).unwrap();
    let heard = listen(broker.port, "listener");
    Some((folder, broker, heard))
}

#[test]
fn rows_through_a_broker_give_the_events_and_states_of_fleet() {
    for protocol in ["5", "3.1.1"] {
        let Some((folder, broker, heard)) = begun(protocol) else { return };
        let gateway = gateway(folder.path());
        wait("connected", || said(folder.path()).contains("connected"));
        publish(broker.port, &messages(0..MINUTES));
        wait_for(MINUTES - 1, &heard, folder.path());
        end(gateway, folder.path());
        assert_same_states(folder.path());
        assert_eq!(heard_lines(&heard), fleet_lines(folder.path()), "in order and once");
        // Who comes later hears the last verdict and the alarms.
        let later = listen(broker.port, "later");
        wait("kept", || later.lock().unwrap().iter().any(|(topic, _, _)| topic == "cylwatch/B/alarm/leak"));
        assert!(later.lock().unwrap().iter().all(|(topic, _, kept)| *kept && !topic.ends_with("/event")));
    }
}

#[test]
fn a_gateway_that_is_killed_again_and_again_loses_no_row_and_no_event() {
    for protocol in ["5", "3.1.1"] {
        let Some((folder, broker, heard)) = begun(protocol) else { return };
        let mut running = gateway(folder.path());
        wait("connected", || said(folder.path()).contains("connected"));
        for (part, after_ms) in [40, 700, 5, 1300, 250, 90, 2100, 10].into_iter().enumerate() {
            let from = part as u32 * 100;
            publish(broker.port, &messages(from..from + 100));
            std::thread::sleep(Duration::from_millis(after_ms));
            running.kill();
            running = gateway(folder.path());
        }
        wait_for(MINUTES - 1, &heard, folder.path());
        end(running, folder.path());
        assert_same_events(&heard, folder.path());
        assert_same_states(folder.path());
    }
}

#[test]
fn a_broker_that_is_killed_and_has_forgotten_all_gets_everything_again() {
    let Some((folder, mut broker, heard)) = begun("5") else { return };
    let gateway = gateway(folder.path());
    wait("connected", || said(folder.path()).contains("connected"));
    for (part, minutes) in [0..300, 300..770, 770..MINUTES].into_iter().enumerate() {
        let last = minutes.end - 1;
        publish(broker.port, &messages(minutes));
        wait_for(last, &heard, folder.path());
        if part < 2 {
            broker.replace(folder.path());
            wait("connected again", || said(folder.path()).matches("connected to").count() == part + 2);
        }
    }
    let later = listen(broker.port, "later");
    wait("an alarm of before", || {
        later.lock().unwrap().iter().any(|(topic, _, _)| topic == "cylwatch/B/alarm/leak")
    });
    end(gateway, folder.path());
    assert_same_events(&heard, folder.path());
    assert_same_states(folder.path());
}
