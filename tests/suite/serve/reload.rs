//! SIGHUP: the configuration is read again, and taken over whole or refused whole.
use super::*;

#[test]
fn a_configuration_is_taken_over_while_rows_come_and_a_wrong_one_changes_nothing() {
    let Some((folder, broker, heard)) = begun("5") else { return };
    let path = folder.path().join("gateway.toml");
    let right = std::fs::read_to_string(&path).unwrap();
    let running = gateway(folder.path());
    wait("connected", || said(folder.path()).contains("connected"));
    publish(broker.port, &messages(0..300));
    wait_for(299, &heard, folder.path());
    for (wrong, words) in [
        (right.replace("client_id", "clint_id"), "clint_id"),
        (right.replacen("nitrogen-20l", "nitrogen-20l-paper", 1), "cannot go on with its new options"),
        (right.replace("folder = \"store\"", "folder = \"other\""), "start the gateway again"),
    ] {
        std::fs::write(&path, wrong).unwrap();
        signal(&running, "-HUP");
        wait(words, || said(folder.path()).contains(words));
    }
    assert_eq!(said(folder.path()).matches("the configuration stays as it was").count(), 3);
    publish(broker.port, &messages(300..500));
    wait_for(499, &heard, folder.path());
    let more = "[[cylinder]]\nname = \"D\"\ntype = \"rail\"\ntopic = \"train/D\"\n[pattern]";
    std::fs::write(&path, right.replace("[pattern]", more)).unwrap();
    signal(&running, "-HUP");
    wait("it is taken over", || said(folder.path()).contains("1 cylinders new, 0 with other"));
    let rows = messages(500..510).into_iter().filter(|(topic, _)| topic == "train/A");
    let of_d: Vec<_> = rows.map(|(_, payload)| ("train/D".to_owned(), payload)).collect();
    publish(broker.port, &of_d);
    publish(broker.port, &messages(500..MINUTES));
    wait_for(MINUTES - 1, &heard, folder.path());
    wait("the new cylinder", || {
        heard.lock().unwrap().iter().any(|(topic, _, _)| topic == "cylwatch/D/estimate")
    });
    // What leaves is forgotten by the broker.
    std::fs::write(&path, &right).unwrap();
    signal(&running, "-HUP");
    wait("it is taken over", || said(folder.path()).contains("1 left"));
    wait("an empty message", || {
        let empty = |(topic, payload, _): &(String, String, bool)| {
            topic == "cylwatch/D/verdict" && payload.is_empty()
        };
        heard.lock().unwrap().iter().any(empty)
    });
    end(running, folder.path());
    heard.lock().unwrap().retain(|(topic, _, _)| !topic.starts_with("cylwatch/D"));
    assert_same_events(&heard, folder.path());
    assert_same_states(folder.path());
}

#[test]
fn another_broker_is_called_when_the_configuration_names_it() {
    let Some((folder, broker, heard)) = begun("5") else { return };
    let path = folder.path().join("gateway.toml");
    let right = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, right.replace("127.0.0.1", "localhost").replace(&broker.port.to_string(), "1"))
        .unwrap();
    let running = gateway(folder.path());
    wait("nobody there", || said(folder.path()).contains("no connection to the broker"));
    std::fs::write(&path, right).unwrap();
    signal(&running, "-HUP");
    wait("connected", || said(folder.path()).contains("connected to the broker"));
    publish(broker.port, &messages(0..MINUTES));
    wait_for(MINUTES - 1, &heard, folder.path());
    end(running, folder.path());
    assert_same_states(folder.path());
}
