//! Who is answered: methods, hosts, tokens, TLS, and how many at once.
use super::client::{Answer, connection};
use super::*;
use std::io::{Read, Write};
use std::sync::Arc;
use std::time::{Duration, Instant};
use tempfile::tempdir;
use tokio_rustls::rustls::crypto::ring;
use tokio_rustls::rustls::pki_types::pem::PemObject;
use tokio_rustls::rustls::pki_types::{CertificateDer, ServerName};
use tokio_rustls::rustls::{ClientConfig, ClientConnection, RootCertStore, StreamOwned};

/// For `localhost` and 127.0.0.1, for a hundred years; made by openssl for these tests.
const CERTIFICATE: &str = include_str!("certificate.pem");
const KEY: &str = include_str!("key.pem");
pub(super) const TOKEN: &str = "correct-horse-battery-staple";

fn refused(page: u16, limit: &str) -> f64 {
    metric(page, &format!("cylwatch_http_refused_total{{limit=\"{limit}\"}}"))
}

#[test]
fn what_is_not_to_be_answered_is_refused_and_counted() {
    let folder = tempdir().unwrap();
    let (running, page) = alone(folder.path());
    for (bytes, status, limit) in [
        (request("POST", "/", ""), 405, "method"),
        (request("DELETE", "/metrics", ""), 405, "method"),
        (request("CONNECT", "x:1", ""), 405, "method"),
        (request("GET", "/", "Content-Length: 5\r\n"), 413, "body"),
        (request("GET", "/", "Transfer-Encoding: chunked\r\n"), 413, "body"),
        (b"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n".into(), 421, "host"),
        (b"GET / HTTP/1.1\r\n\r\n".into(), 421, "host"),
        (b"GET http://evil.example/ HTTP/1.1\r\nHost: localhost\r\n\r\n".into(), 421, "host"),
        (request("GET", "/../../etc/passwd", ""), 404, "path"),
        (request("GET", "/%2e%2e/gateway.toml", ""), 404, "path"),
        (request("GET", "/page.html", ""), 404, "path"),
        (request("GET", "/", &format!("X: {}\r\n", "x".repeat(20_000))), 431, "head_bytes"),
        (request("GET", "/", &"X: x\r\n".repeat(100)), 431, "head_bytes"),
        (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n".into(), 400, "form"),
    ] {
        let before = refused(page, limit);
        let answer = ask(page, &bytes);
        assert_eq!(answer.status, status, "{}", String::from_utf8_lossy(&bytes));
        assert_eq!(refused(page, limit), before + 1.0, "{limit}");
    }
    for path in ["/", "/metrics", "/events"] {
        let answer = ask(page, &request("HEAD", path, ""));
        assert!(answer.status == 200 && answer.body.is_empty(), "{answer:?}");
    }
    let head = get(page, "/").head;
    for field in [
        "content-security-policy: default-src 'none'",
        "frame-ancestors 'none'",
        "nosniff",
        "no-store",
        "no-referrer",
    ] {
        assert!(head.contains(field), "{field}: {head}");
    }
    assert!(!head.contains("unsafe-inline") && !head.contains("access-control"), "{head}");
    end(running, folder.path());
}

#[test]
fn slow_clients_keep_nobody_out() {
    let folder = tempdir().unwrap();
    let (running, page) = alone(folder.path());
    let mut slow = Vec::new();
    for _ in 0..200 {
        let mut stream = connection(page);
        _ = stream.write_all(b"GET / HTTP/1.1\r\nHost: loc");
        slow.push(stream);
        if slow.len() % 20 == 0 {
            let begin = Instant::now();
            assert_eq!(get(page, "/healthz").status, 503);
            assert!(begin.elapsed() < Duration::from_secs(2), "{:?}", begin.elapsed());
        }
    }
    assert!(refused(page, "connections") >= 130.0);
    // Those that are left are given up.
    wait("the slow ones are gone", || refused(page, "request_time") >= 50.0);
    assert!(slow.iter_mut().all(|stream| stream.read_to_end(&mut Vec::new()).is_ok_and(|bytes| bytes < 200)));
    end(running, folder.path());
}

#[test]
fn there_are_as_many_streams_as_may_be_and_others_when_one_has_gone() {
    let folder = tempdir().unwrap();
    let (running, page) = alone(folder.path());
    let mut streams: Vec<Events> = (0..16).map(|_| Events::begun(page, "")).collect();
    assert_eq!(get(page, "/events").status, 503);
    assert_eq!(refused(page, "streams"), 1.0);
    assert_eq!(get(page, "/").status, 200);
    streams.pop();
    wait("a stream is free", || {
        ask(page, &request("HEAD", "/events", "")).status == 200 && {
            let mut stream = connection(page);
            stream.write_all(&request("GET", "/events", "")).unwrap();
            let mut begin = [0; 12];
            stream.read_exact(&mut begin).unwrap();
            begin.ends_with(b"200")
        }
    });
    end(running, folder.path());
}

/// Asks over TLS.
fn ask_privately(port: u16, bytes: &[u8]) -> Answer {
    let mut roots = RootCertStore::empty();
    roots.add(CertificateDer::from_pem_slice(CERTIFICATE.as_bytes()).unwrap()).unwrap();
    let configuration = ClientConfig::builder_with_provider(Arc::new(ring::default_provider()))
        .with_safe_default_protocol_versions()
        .unwrap()
        .with_root_certificates(roots)
        .with_no_client_auth();
    let name = ServerName::try_from("localhost").unwrap();
    let session = ClientConnection::new(Arc::new(configuration), name).unwrap();
    let mut stream = StreamOwned::new(session, connection(port));
    stream.write_all(bytes).unwrap();
    let mut answer = Vec::new();
    _ = stream.read_to_end(&mut answer);
    Answer::of(&answer)
}

#[test]
fn beyond_this_machine_a_token_is_asked_for_and_nothing_goes_in_the_clear() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    for (name, content) in [("token", TOKEN), ("certificate.pem", CERTIFICATE), ("key.pem", KEY)] {
        std::fs::write(folder.join(name), format!("{content}\n")).unwrap();
    }
    let page = free_port();
    let listen = format!(
        "[page]\nlisten = \"0.0.0.0:{page}\"\ntoken_file = \"token\"\ntls_certificate_file = \"certificate.pem\"\ntls_key_file = \"key.pem\"\n"
    );
    let (running, _) = started(folder, &(configuration(free_port(), "5") + &listen), page);
    let asked = |path: &str, fields: &str| ask_privately(page, &request("GET", path, fields));
    let basic = "Authorization: Basic dXNlcjpjb3JyZWN0LWhvcnNlLWJhdHRlcnktc3RhcGxl\r\n";
    let bearer = format!("Authorization: Bearer {TOKEN}\r\n");
    for path in ["/", "/metrics", "/nowhere", "/events"] {
        let answer = asked(path, "");
        assert!(answer.status == 401 && answer.head.contains("www-authenticate: basic"), "{answer:?}");
    }
    assert_eq!(asked("/healthz", "").status, 503);
    for fields in [basic, &bearer] {
        assert_eq!(asked("/", fields).status, 200);
    }
    let begin = Instant::now();
    for fields in ["Authorization: Bearer correct-horse-battery-stapl\r\n", "Authorization: Basic !\r\n"] {
        assert_eq!(asked("/metrics", fields).status, 401);
    }
    assert!(begin.elapsed() >= Duration::from_secs(2), "{:?}", begin.elapsed());
    let metrics = asked("/metrics", &bearer).body;
    assert!(metrics.contains("cylwatch_http_refused_total{limit=\"token\"} 2\n"), "{metrics}");
    // In the clear there is no answer.
    assert_eq!(ask(page, &request("GET", "/healthz", "")).status, 0);
    let metrics = asked("/metrics", &bearer).body;
    assert!(!metrics.contains("cylwatch_http_refused_total{limit=\"tls\"} 0\n"), "{metrics}");
    end(running, folder);
}
