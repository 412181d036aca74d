//! A real broker on a free port, who publishes to it, and who listens.
use rumqttc::{Client, Connection, Event, MqttOptions, Packet, QoS};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Longest wait for anything.
pub(super) const PATIENCE: Duration = Duration::from_secs(60);

/// Waits until something holds.
pub(super) fn wait(what: &str, mut holds: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !holds() {
        assert!(begin.elapsed() < PATIENCE, "{what}: not within {PATIENCE:?}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// A port that is free.
pub(super) fn free_port() -> u16 {
    TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

/// A process that ends with the test.
pub(super) struct Process(pub Child);

impl Process {
    /// Ends it at once.
    pub(super) fn kill(&mut self) {
        _ = self.0.kill();
        _ = self.0.wait();
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.kill();
    }
}

/// A broker.
pub(super) struct Broker {
    pub port: u16,
    process: Process,
    /// Lines of its configuration beside those of the port.
    more: String,
}

impl Broker {
    /// Begins on a free port; `None`, and a message, where Mosquitto is not installed.
    pub(super) fn begin(folder: &Path) -> Option<Self> {
        Self::begin_with(folder, "")
    }

    /// The same with more lines of configuration.
    #[allow(clippy::print_stderr)]
    pub(super) fn begin_with(folder: &Path, more: &str) -> Option<Self> {
        let port = free_port();
        let Some(process) = broker(folder, port, more) else {
            eprintln!("skipped: mosquitto is not installed");
            return None;
        };
        Some(Self { port, process, more: more.to_owned() })
    }

    /// Kills it.
    pub(super) fn kill(&mut self) {
        self.process.kill();
    }

    /// Kills it and begins another one in its place, which knows nothing.
    pub(super) fn replace(&mut self, folder: &Path) {
        self.pause(folder, Duration::from_millis(500));
    }

    /// The same after a time.
    pub(super) fn pause(&mut self, folder: &Path, time: Duration) {
        self.process.kill();
        std::thread::sleep(time);
        self.process = broker(folder, self.port, &self.more).unwrap();
    }
}

fn broker(folder: &Path, port: u16, more: &str) -> Option<Process> {
    let text = format!(
        "listener {port} 127.0.0.1\nallow_anonymous true\nmax_queued_messages 0\nmax_inflight_messages 200\n{more}"
    );
    std::fs::write(folder.join("mosquitto.conf"), text).unwrap();
    let child = ["mosquitto", "/usr/sbin/mosquitto"].iter().find_map(|program| {
        let mut command = Command::new(program);
        command.args(["-c", "mosquitto.conf"]).current_dir(folder);
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().ok()
    })?;
    let process = Process(child);
    wait("the broker listens", || TcpStream::connect(("127.0.0.1", port)).is_ok());
    Some(process)
}

fn client(port: u16, name: &str) -> (Client, Connection) {
    let mut options = MqttOptions::new(name, "127.0.0.1", port);
    options.set_clean_session(false).set_max_packet_size(1 << 20, 1 << 26).set_keep_alive(PATIENCE);
    Client::new(options, 1 << 16)
}

/// Publishes messages, which the broker has when this returns.
pub(super) fn publish<T: AsRef<[u8]>>(port: u16, messages: &[(String, T)]) {
    let (client, mut connection) = client(port, "publisher");
    for (topic, payload) in messages {
        client.publish(topic, QoS::AtLeastOnce, false, payload.as_ref()).unwrap();
    }
    let mut missing = messages.len();
    while missing > 0 {
        let said = connection.recv_timeout(PATIENCE).unwrap().unwrap();
        missing -= usize::from(matches!(said, Event::Incoming(Packet::PubAck(_))));
    }
    client.disconnect().unwrap();
    while connection.recv_timeout(PATIENCE).is_ok_and(|said| said.is_ok()) {}
}

/// What was published: topic, payload, and whether it came from the broker's memory.
pub(super) type Heard = Arc<Mutex<Vec<(String, String, bool)>>>;

/// Listens to all below `cylwatch` until the test ends, through every loss of the broker.
pub(super) fn listen(port: u16, name: &str) -> Heard {
    let heard = Heard::default();
    let (client, mut connection) = client(port, name);
    let (sink, (sender, subscribed)) = (Arc::clone(&heard), std::sync::mpsc::channel());
    std::thread::spawn(move || {
        for said in connection.iter() {
            match said {
                Ok(Event::Incoming(Packet::ConnAck(_))) => {
                    client.try_subscribe("cylwatch/#", QoS::AtLeastOnce).unwrap();
                }
                Ok(Event::Incoming(Packet::SubAck(_))) => _ = sender.send(()),
                // Not from the gateway, and of any bytes.
                Ok(Event::Incoming(Packet::Publish(publish))) if publish.topic.ends_with("/acknowledge") => {}
                Ok(Event::Incoming(Packet::Publish(publish))) => {
                    let payload = String::from_utf8(publish.payload.to_vec()).unwrap();
                    sink.lock().unwrap().push((publish.topic, payload, publish.retain));
                }
                Ok(_) => {}
                Err(_) => std::thread::sleep(Duration::from_millis(100)),
            }
        }
    });
    subscribed.recv_timeout(PATIENCE).unwrap();
    heard
}
