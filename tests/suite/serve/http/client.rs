//! A client that sends what it is told, byte by byte.
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Longest wait for an answer.
const PATIENCE: Duration = Duration::from_secs(20);

/// An answer.
#[derive(Debug)]
pub(super) struct Answer {
    pub status: u16,
    pub head: String,
    pub body: String,
}

impl Answer {
    /// Of all bytes of a connection; status 0: there was no answer.
    pub(super) fn of(bytes: &[u8]) -> Self {
        let text = String::from_utf8_lossy(bytes);
        let (head, body) = text.split_once("\r\n\r\n").unwrap_or((&text, ""));
        let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0);
        Self { status, head: head.to_ascii_lowercase(), body: body.to_owned() }
    }
}

pub(super) fn connection(port: u16) -> TcpStream {
    let stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    stream.set_write_timeout(Some(PATIENCE)).unwrap();
    stream
}

/// What comes back for some bytes, if anything does.
pub(super) fn ask(port: u16, bytes: &[u8]) -> Answer {
    let mut stream = connection(port);
    // A connection that is refused may end while it is written to.
    _ = stream.write_all(bytes);
    let (mut answer, mut piece, begin) = (Vec::new(), [0; 8192], Instant::now());
    // A stream does not end by itself.
    while begin.elapsed() < PATIENCE
        && let Ok(count @ 1..) = stream.read(&mut piece)
    {
        answer.extend_from_slice(&piece[..count]);
    }
    Answer::of(&answer)
}

/// A request as browsers send it, with fields of its own.
pub(super) fn request(method: &str, path: &str, fields: &str) -> Vec<u8> {
    format!("{method} {path} HTTP/1.1\r\nHost: localhost\r\n{fields}\r\n").into_bytes()
}

pub(super) fn get(port: u16, path: &str) -> Answer {
    ask(port, &request("GET", path, ""))
}

/// The value of a sample of `/metrics`, which must be there.
pub(super) fn metric(port: u16, sample: &str) -> f64 {
    let text = get(port, "/metrics").body;
    let line = text.lines().find_map(|line| line.strip_prefix(sample)?.strip_prefix(' '));
    line.unwrap_or_else(|| panic!("{sample} is missing in {text}")).parse().unwrap()
}

/// Events with their data.
pub(super) struct Events(BufReader<TcpStream>);

impl Events {
    pub(super) fn begun(port: u16, after: &str) -> Self {
        Self::begun_with(port, after, "")
    }

    pub(super) fn begun_with(port: u16, after: &str, fields: &str) -> Self {
        let mut stream = connection(port);
        stream.write_all(&request("GET", &format!("/events?after={after}"), fields)).unwrap();
        let mut reader = BufReader::new(stream);
        let mut line = String::new();
        reader.read_line(&mut line).unwrap();
        assert!(line.contains(" 200 "), "{line}");
        Self(reader)
    }

    /// The next event: name, data, and the place after it.
    pub(super) fn next(&mut self) -> (String, serde_json::Value, String) {
        let (mut name, mut id) = (String::new(), String::new());
        loop {
            let mut line = String::new();
            assert!(self.0.read_line(&mut line).unwrap() > 0, "the stream ended");
            match line.trim_end().split_once(": ") {
                Some(("event", event)) => event.clone_into(&mut name),
                Some(("id", place)) => place.clone_into(&mut id),
                Some(("data", data)) => return (name, serde_json::from_str(data).unwrap(), id),
                _ => {}
            }
        }
    }
}
