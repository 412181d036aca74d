//! Secrets are in nothing that comes out of the gateway.
use super::access::TOKEN;
use super::*;

const PASSWORD: &str = "tiger-lily-seventeen";

#[test]
fn secrets_are_in_nothing_that_is_said_published_kept_or_answered() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let Some(broker) = Broker::begin(folder) else { return };
    std::fs::write(folder.join("token"), TOKEN).unwrap();
    std::fs::write(folder.join("password"), PASSWORD).unwrap();
    let page = free_port();
    let text = format!("{}token_file = \"token\"\n", with_page(broker.port, page));
    let text = text.replacen("client_id", "user = \"gateway\"\npassword_file = \"password\"\nclient_id", 1);
    let heard = listen(broker.port, "listener");
    let (running, _) = started(folder, &text, page);
    wait("connected", || said(folder).contains("connected"));
    publish(broker.port, &messages(0..30));
    publish(broker.port, &[("train/A".to_owned(), format!("{TOKEN}{PASSWORD}"))]);
    wait_for(29, &heard, folder);
    let bearer = format!("Authorization: Bearer {TOKEN}\r\n");
    let mut all = String::new();
    for path in ["/", "/metrics", "/healthz", "/nowhere", &format!("/{TOKEN}")] {
        for fields in ["", &bearer, &format!("Authorization: Bearer {TOKEN}{PASSWORD}\r\n")] {
            let answer = ask(page, &request("GET", path, fields));
            all.push_str(&answer.head);
            all.push_str(&answer.body);
        }
    }
    let mut events = Events::begun_with(page, "", &bearer);
    (0..2).for_each(|_| all.push_str(&events.next().1.to_string()));
    drop(broker);
    wait("the loss is told", || said(folder).contains("no connection"));
    end(running, folder);
    heard
        .lock()
        .unwrap()
        .iter()
        .for_each(|(topic, payload, _)| all.push_str(&format!("{topic} {payload}\n")));
    all.push_str(&said(folder));
    for kept in ["states", "journal"] {
        for name in crate::support::files(&folder.join("store").join(kept)) {
            let bytes = std::fs::read(folder.join("store").join(kept).join(name)).unwrap();
            all.push_str(&String::from_utf8_lossy(&bytes));
        }
    }
    assert!(
        all.contains("rows_total 90")
            && all.contains("cylwatch/A/verdict")
            && all.contains("connected to the broker")
    );
    for secret in [TOKEN, PASSWORD] {
        assert!(!all.contains(secret), "{secret}");
    }
}
