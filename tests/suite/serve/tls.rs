//! TLS to the broker: rows in and verdicts out by both protocols, certificates that are demanded, and certificates that are wrong.
use super::*;

/// An authority, a broker for `localhost` and 127.0.0.1, and a gateway, for a hundred years; made by openssl for these tests.
const FILES: [(&str, &str); 6] = [
    ("authority.pem", include_str!("tls/authority.pem")),
    ("broker.pem", include_str!("tls/broker.pem")),
    ("broker_key.pem", include_str!("tls/broker_key.pem")),
    ("gateway.pem", include_str!("tls/gateway.pem")),
    ("gateway_key.pem", include_str!("tls/gateway_key.pem")),
    ("other.pem", include_str!("http/certificate.pem")),
];
const OWN: &str = "client_certificate_file = \"gateway.pem\"\nclient_key_file = \"gateway_key.pem\"\n";
const WITHIN: &str = "127.0.0.1\"\ntls = true\n";

/// A broker that also listens with TLS, and who listens to it in the clear.
fn private(more: &str) -> Option<(TempDir, Broker, u16, Heard)> {
    let folder = tempdir().unwrap();
    for (name, content) in FILES {
        std::fs::write(folder.path().join(name), content).unwrap();
    }
    let port = broker::free_port();
    let listener = format!(
        "listener {port} 127.0.0.1\ncafile authority.pem\ncertfile broker.pem\nkeyfile broker_key.pem\n{more}"
    );
    let broker = Broker::begin_with(folder.path(), &listener)?;
    let heard = listen(broker.port, "listener");
    Some((folder, broker, port, heard))
}

/// A configuration with TLS and some keys of `[broker]`.
fn configure(folder: &Path, port: u16, protocol: &str, keys: &str) {
    let text = configuration(port, protocol).replacen("127.0.0.1\"\n", &format!("{WITHIN}{keys}"), 1);
    std::fs::write(folder.join("gateway.toml"), text).unwrap();
}

/// Rows of some hours give estimates and a verdict.
fn assert_goes_through(part: u32, broker: &Broker, heard: &Heard, folder: &Path) {
    publish(broker.port, &messages(300 * part..300 * (part + 1)));
    wait_for(300 * (part + 1) - 1, heard, folder);
    let heard = heard.lock().unwrap();
    assert!(heard.iter().any(|(topic, _, _)| topic == "cylwatch/A/verdict"), "{heard:?}");
}

fn connected(times: usize, folder: &Path) {
    wait(&format!("connected: {}", said(folder)), || {
        said(folder).matches("connected to the broker").count() == times
    });
}

#[test]
fn rows_and_verdicts_go_through_tls_by_both_protocols() {
    for demand in ["", "require_certificate true\n"] {
        let Some((folder, broker, port, heard)) = private(demand) else { return };
        let folder = folder.path();
        for (i, protocol) in ["5", "3.1.1"].into_iter().enumerate() {
            let own = if demand.is_empty() { "" } else { OWN };
            configure(folder, port, protocol, &format!("ca_file = \"authority.pem\"\n{own}"));
            let running = gateway(folder);
            connected(i + 1, folder);
            assert_goes_through(i as u32, &broker, &heard, folder);
            end(running, folder);
        }
        assert!(!said(folder).contains("no connection"), "{}", said(folder));
    }
}

#[test]
fn a_certificate_of_an_unknown_authority_is_one_caution_until_its_authority_is_named() {
    let Some((folder, broker, port, heard)) = private("") else { return };
    let folder = folder.path();
    configure(folder, port, "5", "ca_file = \"other.pem\"\n");
    let running = gateway(folder);
    let words = "is from an authority that ca_file does not have";
    wait("a caution", || said(folder).contains(words));
    publish(broker.port, &messages(0..1));
    std::thread::sleep(Duration::from_millis(2500));
    let told = said(folder);
    assert_eq!(told.matches("no connection to the broker").count(), 1, "{told}");
    for words in [&format!("127.0.0.1:{port}"), "name the certificate of that authority in ca_file"] {
        assert!(told.contains(words), "`{words}` is missing in: {told}");
    }
    assert!(heard.lock().unwrap().is_empty() && !told.contains("connected"), "{told}");
    configure(folder, port, "5", "ca_file = \"authority.pem\"\n");
    signal(&running, "-HUP");
    connected(1, folder);
    assert_goes_through(0, &broker, &heard, folder);
    end(running, folder);
}

#[test]
fn a_file_that_has_another_authority_is_another_configuration() {
    let Some((folder, broker, port, heard)) = private("") else { return };
    let folder = folder.path();
    let authority = std::fs::read(folder.join("authority.pem")).unwrap();
    std::fs::copy(folder.join("other.pem"), folder.join("authority.pem")).unwrap();
    configure(folder, port, "5", "ca_file = \"authority.pem\"\n");
    let running = gateway(folder);
    wait("a caution", || said(folder).contains("no connection"));
    std::fs::write(folder.join("authority.pem"), authority).unwrap();
    signal(&running, "-HUP");
    connected(1, folder);
    assert_goes_through(0, &broker, &heard, folder);
    end(running, folder);
}

#[test]
fn what_else_goes_wrong_is_said_with_its_remedy() {
    let Some((folder, broker, port, _heard)) = private("require_certificate true\n") else { return };
    let folder = folder.path();
    let authority = "ca_file = \"authority.pem\"\n";
    let own =
        format!("{authority}client_certificate_file = \"other.pem\"\nclient_key_file = \"other_key.pem\"\n");
    std::fs::write(folder.join("other_key.pem"), include_str!("http/key.pem")).unwrap();
    for protocol in ["5", "3.1.1"] {
        for (port, keys, words) in [
            (port, authority, "give client_certificate_file and client_key_file"),
            (port, &own, "client_certificate_file one that is valid"),
            (broker.port, authority, "leave out tls = true"),
            (port, "", "an authority that this system does not have"),
        ] {
            std::fs::remove_file(folder.join("said.txt")).unwrap_or_default();
            configure(folder, port, protocol, keys);
            let running = gateway(folder);
            wait(words, || said(folder).contains("; it is called again"));
            std::thread::sleep(Duration::from_millis(1500));
            assert!(said(folder).contains(words), "`{words}` is missing in: {}", said(folder));
            assert!(!said(folder).contains("connected"), "{}", said(folder));
            end(running, folder);
        }
    }
}
