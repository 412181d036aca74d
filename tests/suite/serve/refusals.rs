//! What is wrong with a configuration, a message or a state, and what becomes of it.
use super::{Broker, configuration, end, gateway, listen, publish, said, time, wait};
use crate::support::{refused, run};
use tempfile::tempdir;

#[test]
fn a_wrong_configuration_is_one_message_with_line_and_remedy() {
    let folder = tempdir().unwrap();
    let check = ["serve", "gateway.toml", "--check"];
    for (name, token) in [("long", "correct-horse-battery-staple"), ("short", "sesame")] {
        std::fs::write(folder.path().join(name), token).unwrap();
    }
    std::fs::write(folder.path().join("ca.pem"), include_str!("tls/authority.pem")).unwrap();
    let right = configuration(1883, "5");
    std::fs::write(folder.path().join("gateway.toml"), &right).unwrap();
    assert_eq!(run(folder.path(), &check).code, Some(0));
    for (from, to, words) in [
        ("client_id", "clint_id", &["gateway.toml:6", "clint_id", "client_id"][..]),
        ("\"5\"", "\"4\"", &["gateway.toml:5", "protocol", "3.1.1"]),
        ("client_id =", "password = \"sesame\"\nclient_id =", &["gateway.toml:6", "password_file"]),
        ("client_id =", "password_env = \"NOT_THERE\"\nclient_id =", &["NOT_THERE"]),
        ("client_id =", "ca_file = \"ca.pem\"\nclient_id =", &["gateway.toml:6", "ca.pem", "add tls = true"]),
        (
            "client_id =",
            "tls = false\nclient_key_file = \"long\"\nclient_id =",
            &["gateway.toml:7", "client_key_file", "add tls = true"],
        ),
        (
            "client_id =",
            "tls = true\nca_file = \"nowhere.pem\"\nclient_id =",
            &["gateway.toml:7", "nowhere.pem", "not usable"],
        ),
        (
            "client_id =",
            "tls = true\nca_file = \"long\"\nclient_id =",
            &["gateway.toml:7", "long", "not usable", "no certificate in PEM"],
        ),
        (
            "client_id =",
            "tls = true\nca_file = \"ca.pem\"\nclient_key_file = \"long\"\nclient_id =",
            &["gateway.toml:2", "client_certificate_file", "both or none"],
        ),
        (
            "client_id =",
            "tls = true\nca_file = \"ca.pem\"\nclient_certificate_file = \"ca.pem\"\nclient_key_file = \"short\"\nclient_id =",
            &["gateway.toml:9", "short", "not usable"],
        ),
        (
            "host = \"127.0.0.1\"",
            "host = \"[::1]\"\ntls = true\nca_file = \"ca.pem\"",
            &["gateway.toml:3", "[::1]", "a name or an IPv4 address"],
        ),
        ("client_id =", "keep_alive_h = 30\nclient_id =", &["gateway.toml:6", "keep_alive_h", "30"]),
        ("save_every_s = 1", "save_every_s = 0", &["gateway.toml:9", "save_every_s", "between"]),
        ("vessel =", "silent_after_min = 0\nvessel =", &["gateway.toml:12", "silent_after_min", "between"]),
        ("nitrogen-20l", "nitrogen-7l", &["nitrogen-7l"]),
        ("fill_pressure_bar = 200", "fill_pressure_l = 200", &["gateway.toml:13", "fill_pressure_l"]),
        ("fill_pressure_bar = 200", "fill_pressure_bar = -5", &["gateway.toml:1", "-5"]),
        ("type = \"rail\"", "type = \"rial\"", &["gateway.toml:16", "rial", "rail, settled"]),
        ("topic = \"train/A\"", "topic = \"train/+\"", &["gateway.toml:17", "[pattern]"]),
        ("topic = \"train/B\"", "topic = \"train/A\"", &["gateway.toml:22", "twice"]),
        ("name = \"B\"", "name = \"A\"", &["gateway.toml:20", "twice"]),
        ("name = \"B\"", "name = \"B/C\"", &["gateway.toml:20", "one level"]),
        ("depot/+/gas", "depot/#", &["gateway.toml:29", "one level +"]),
        ("time = \"/t\"\n", "", &["payload time", "arrival"]),
        ("time = \"/t\"", "format = \"sparkplug\"", &["gateway.toml:33", "sparkplug-b"]),
        ("time = \"/t\"", "format = \"sparkplug-b\"\ntime = \"/t\"", &["gateway.toml:32", "time and clock"]),
        ("time = \"/t\"", "format = \"sparkplug-b\"", &["gateway.toml:3", "name the metric in metric"]),
        ("at = \"/temps/0\"", "metric = \"T\"", &["gateway.toml:36", "format = \"sparkplug-b\""]),
        ("at = \"/temps/0\"", "", &["gateway.toml:3", "shoulder_degc has no place"]),
        ("/temps/0", "temps/0", &["gateway.toml:36", "begin it with /"]),
        (
            "[payload]",
            "[limits]\nmessage_bytes = 2000000\n[payload]",
            &["message_bytes", "between 1 and 1048576"],
        ),
        ("[payload]", "[limits]\nrows_a_minute = 0\n[payload]", &["rows_a_minute", "between 1"]),
        ("pressure_bar\"", "pressure_l\"", &["pressure_l"]),
        (
            "[payload]",
            "[page]\nlisten = \"localhost\"\n[payload]",
            &["gateway.toml:33", "localhost", "127.0.0.1:8742"],
        ),
        (
            "[payload]",
            "[page]\nlisten = \"0.0.0.0:8742\"\n[payload]",
            &["gateway.toml:33", "0.0.0.0", "a token and TLS"],
        ),
        (
            "[payload]",
            "[page]\nlisten = \"10.0.0.1:1\"\ntoken_file = \"long\"\n[payload]",
            &["gateway.toml:33", "10.0.0.1", "a token and TLS"],
        ),
        (
            "[payload]",
            "[page]\nlisten = \"127.0.0.1:1\"\ntoken = \"sesame\"\n[payload]",
            &["gateway.toml:34", "token_file"],
        ),
        (
            "[payload]",
            "[page]\nlisten = \"127.0.0.1:1\"\ntoken_file = \"short\"\n[payload]",
            &["gateway.toml:32", "shorter than 16"],
        ),
        (
            "[payload]",
            "[page]\nlisten = \"127.0.0.1:1\"\ntoken_file = \"nowhere\"\n[payload]",
            &["gateway.toml:34", "nowhere", "cannot be read"],
        ),
        (
            "[payload]",
            "[page]\nlisten = \"127.0.0.1:1\"\ntls_key_file = \"gateway.toml\"\n[payload]",
            &["gateway.toml:32", "both or none"],
        ),
        (
            "[payload]",
            "[page]\nlisten = \"127.0.0.1:1\"\ntls_key_file = \"gateway.toml\"\ntls_certificate_file = \"gateway.toml\"\n[payload]",
            &["gateway.toml:35", "not usable"],
        ),
    ] {
        let wrong = right.replacen(from, to, 1);
        assert_ne!(wrong, right, "{from}");
        std::fs::write(folder.path().join("gateway.toml"), wrong).unwrap();
        refused(folder.path(), &check, words);
        assert!(!run(folder.path(), &check).stderr.contains("sesame"));
    }
}

#[test]
fn what_cannot_be_used_is_said_once_and_counted_and_a_damaged_state_is_set_aside() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let Some(broker) = Broker::begin(folder) else { return };
    std::fs::write(folder.join("gateway.toml"), configuration(broker.port, "5")).unwrap();
    std::fs::create_dir_all(folder.join("store/states")).unwrap();
    std::fs::write(folder.join("store/states/A.state"), b"cylwatch-monitor-state 3 bytes 9 sha256 0\nx")
        .unwrap();
    let heard = listen(broker.port, "listener");
    let running = gateway(folder);
    wait("connected", || said(folder).contains("connected"));
    let row = |topic: &str, payload: &str| (topic.to_owned(), payload.to_owned());
    let good = |minute| format!("{{\"t\":\"{}\",\"p\":200,\"temps\":[15,15]}}", time(minute));
    let large = format!("{{\"t\":\"{}\"", " ".repeat(70_000));
    publish(
        broker.port,
        &[
            row("train/A", "no json"),
            row("train/A", "no json"),
            row("train/A", "{\"t\":1}"),
            row("train/B", &large),
            row("depot/C/gas", &good(0)),
            row("depot/D/gas", &good(0)),
            row("train/A", &good(0)),
            row("train/A", &good(5)),
        ],
    );
    wait("the last row", || heard.lock().unwrap().iter().any(|(topic, _, _)| topic == "cylwatch/A/estimate"));
    end(running, folder);
    let said = said(folder);
    for words in [
        "A.state: it is cut short",
        "begins anew",
        "3 rows of 3 cylinders",
        "it is no JSON (2)",
        "it has no time of the stated form (1)",
        "it is larger than message_bytes (1)",
        "there are as many cylinders as the configuration allows (1)",
    ] {
        assert!(said.contains(words), "`{words}` is missing in: {said}");
    }
    assert_eq!(said.matches("A: a message is left out: it is no JSON").count(), 1, "{said}");
    super::schema::assert_true_of(&heard);
    let heard = heard.lock().unwrap();
    let events: Vec<_> = heard.iter().filter(|(topic, _, _)| topic == "cylwatch/A/event").collect();
    assert!(events.len() == 1 && events[0].1.contains("cold-start"), "{events:?}");
    let mut states = crate::support::files(&folder.join("store/states"));
    states.retain(|name| name.starts_with('A'));
    assert!(states.len() == 2 && states[1].ends_with(".aside"), "{states:?}");
}
