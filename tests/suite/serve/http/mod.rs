//! The page, metrics and health checks of a running gateway.
mod access;
mod client;
mod hostile;
mod secret;

use super::broker::{Broker, Process, free_port, listen, publish, wait};
use super::{MINUTES, NAMES, begun, configuration, end, gateway, messages, said, time, wait_for};
use client::{Events, ask, get, metric, request};
use serde_json::Value;
use std::path::Path;

/// A configuration with a page.
fn with_page(broker: u16, page: u16) -> String {
    format!("{}[page]\nlisten = \"127.0.0.1:{page}\"\n", configuration(broker, "5"))
}

/// A gateway with a page that answers, whose broker is not there.
fn alone(folder: &Path) -> (Process, u16) {
    let page = free_port();
    started(folder, &with_page(free_port(), page), page)
}

fn started(folder: &Path, configuration: &str, page: u16) -> (Process, u16) {
    std::fs::write(folder.join("gateway.toml"), configuration).unwrap();
    let running = gateway(folder);
    wait(&format!("the page is there: {}", said(folder)), || {
        std::net::TcpStream::connect(("127.0.0.1", page)).is_ok()
    });
    (running, page)
}

/// The data inside a page.
fn data(page: &str) -> Value {
    let (_, data) = page.split_once("<script id=\"data\" type=\"application/json\">").unwrap();
    serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap()
}

/// A cylinder of rows, without its files and what it is sorted by.
fn row<'a>(rows: impl IntoIterator<Item = &'a Value>, name: &str) -> Value {
    let mut row = rows.into_iter().find(|row| row["n"] == name).unwrap().clone();
    row.as_object_mut().unwrap().remove("u");
    row["f"].as_array_mut().unwrap().retain(|fact| fact[0] != "read from");
    row
}

fn rows(page: &Value) -> &Vec<Value> {
    page["rows"].as_array().unwrap()
}

#[test]
fn the_page_says_what_fleet_says_and_follows_the_rows_without_a_reload() {
    let Some((folder, broker, heard)) = begun("5") else { return };
    let folder = folder.path();
    let page = free_port();
    let (running, _) = started(folder, &with_page(broker.port, page), page);
    let empty = data(&get(page, "/").body);
    assert!(
        rows(&empty).len() == 2
            && row(rows(&empty), "A")["w"][4].as_str().unwrap().contains("no row has come")
    );
    wait("connected", || said(folder).contains("connected"));
    publish(broker.port, &messages(0..700));
    wait_for(699, &heard, folder);
    wait("three cylinders", || rows(&data(&get(page, "/").body)).len() == 3);
    let first = data(&get(page, "/").body);
    let mut events = Events::begun(page, first["version"].as_str().unwrap());
    publish(broker.port, &messages(700..MINUTES));
    let (mut followed, mut last) = (first.clone(), String::new());
    let until = format!("to {}", time(MINUTES - 1));
    let is_there =
        |page: &Value| NAMES.iter().all(|name| row(rows(page), name)["f"].to_string().contains(&until));
    while !is_there(&followed) {
        let (name, fresh, id) = events.next();
        assert_ne!(name, "all", "the page knew all");
        for one in fresh.as_array().into_iter().flatten() {
            let rows = followed["rows"].as_array_mut().unwrap();
            *rows.iter_mut().find(|row| row["n"] == one["n"]).unwrap() = one.clone();
            id.clone_into(&mut last);
        }
    }
    let fleet = data(&std::fs::read_to_string(folder.join("fleet/page.html")).unwrap());
    for name in NAMES {
        assert_eq!(row(rows(&followed), name), row(rows(&fleet), name), "{name}");
    }
    assert!(row(rows(&followed), "B")["e"][0].as_str().unwrap().contains("leak"));
    // Who was here before gets nothing twice, and who was not gets all.
    let (name, _, _) = Events::begun(page, &last).next();
    assert_eq!(name, "state");
    let (name, all, _) = Events::begun(page, "an-other").next();
    assert!(name == "all" && all.as_array().unwrap().len() == 3);
    end(running, folder);
    // C came by the pattern: it is known without its rows in the journal.
    std::fs::remove_dir_all(folder.join("store/journal")).unwrap();
    let (_running, _) = started(folder, &with_page(broker.port, page), page);
    let again = data(&get(page, "/").body);
    for name in NAMES {
        let (now, before) = (row(rows(&again), name), row(rows(&followed), name));
        assert_eq!((&now["w"], &now["l"], &now["m"]), (&before["w"], &before["l"], &before["m"]), "{name}");
        assert!(
            now["c"][0].as_str().unwrap().contains("not known here")
                && now["p"].as_array().unwrap().is_empty()
        );
    }
}

#[test]
fn metrics_count_what_was_sent_and_health_follows_the_broker() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let Some(mut broker) = Broker::begin(folder) else { return };
    let page = free_port();
    let (running, _) = started(folder, &with_page(broker.port, page), page);
    wait("well", || get(page, "/healthz").status == 200);
    let heard = listen(broker.port, "listener");
    let bad = |topic: &str, payload: &str| (topic.to_owned(), payload.to_owned());
    publish(broker.port, &messages(0..20));
    publish(
        broker.port,
        &[
            bad("train/A", "no json"),
            bad("train/A", "{}"),
            bad("train/B", "{}"),
            bad("depot/X/gas", "no json"),
        ],
    );
    publish(broker.port, &messages(20..21));
    wait_for(20, &heard, folder);
    wait("all has arrived", || metric(page, "cylwatch_outbox_messages") == 0.0);
    wait("states", || metric(page, "cylwatch_states_saved_total") >= 3.0);
    for (sample, expected) in [
        ("cylwatch_rows_total", 63.0),
        ("cylwatch_messages_refused_total{reason=\"no_json\"}", 2.0),
        ("cylwatch_messages_refused_total{reason=\"no_time\"}", 2.0),
        ("cylwatch_messages_refused_total{reason=\"too_large\"}", 0.0),
        ("cylwatch_cylinders", 3.0),
        ("cylwatch_step_seconds_count", 63.0),
        ("cylwatch_broker_connected", 1.0),
        ("cylwatch_disk_writable", 1.0),
        ("cylwatch_states_failed_total", 0.0),
    ] {
        assert_eq!(metric(page, sample), expected, "{sample}");
    }
    let published = metric(page, "cylwatch_publish_seconds_count");
    let arrived = heard.lock().unwrap().len() as f64;
    assert!(published >= 6.0 && published == arrived, "{published} of {arrived}");
    assert!(
        metric(page, "cylwatch_journal_bytes") > 1000.0
            && metric(page, "cylwatch_most_silent_seconds") < 60.0
    );
    assert!(metric(page, "cylwatch_newest_row_age_seconds") > 1e6);
    for _ in 0..2 {
        broker.kill();
        wait("unwell", || get(page, "/healthz").status == 503);
        let words: Value = serde_json::from_str(&get(page, "/healthz").body).unwrap();
        assert_eq!(words["reasons"][0], "the broker is not connected");
        assert_eq!(metric(page, "cylwatch_broker_connected"), 0.0);
        broker.replace(folder);
        wait("well again", || get(page, "/healthz").status == 200);
    }
    end(running, folder);
}
