//! Messages that nobody should send, many of them: the gateway stays, its memory is bounded, each is counted, and the other cylinders are not
//! disturbed.
use super::load::{asked, rss_mb};
use super::*;
use std::time::Instant;

/// Largest resident memory, MB.
const BOUND_MB: f64 = 400.0;
/// Hostile messages between rows of the others.
const TOGETHER: u64 = 10_000;

/// A hostile message; `H` is the cylinder that sends what is addressed well.
fn hostile(n: u64) -> (String, Vec<u8>) {
    let to_h = |payload: String| ("train/H".to_owned(), payload.into_bytes());
    let good = |time: &str| format!("{{\"t\":\"{time}\",\"p\":200,\"temps\":[15,15]}}");
    match n % 10 {
        0 => (format!("cylwatch/nobody{n}/acknowledge"), b"x".to_vec()),
        1 => (format!("depot/n{n}/gas"), good("2026-01-01T00:00:00Z").into_bytes()),
        2 if n % 100 == 2 => to_h(" ".repeat(70_000)),
        2 => to_h("{\"t\":\"2026-01-01T00:00:00Z\",\"p\":NaN}".to_owned()),
        3 => to_h("[".repeat(2000)),
        4 => to_h("{\"t\":\"2026-01-01T00:00:00Z\",\"p\":\"200\"}".to_owned()),
        5 => to_h(good(&format!("{:04}-01-01T00:00:00Z", n / 10 * 7919 % 10_000))),
        6 => to_h("{\"t\":\"2026-01-01T00:00:00Z\"}".to_owned()),
        7 => to_h(good("2026-01-01T00:00:00Z")),
        8 if n % 100 == 8 => ("cylwatch/H/acknowledge".to_owned(), vec![0xff; 70_000]),
        8 => ("cylwatch/H/acknowledge".to_owned(), (0..=255).collect()),
        _ => ("train/H".to_owned(), vec![0xff, 0, n as u8, 0xfe]),
    }
}

/// The number before some words.
fn number_before(said: &str, words: &str) -> u64 {
    said.split(words).next().and_then(|text| text.rsplit(' ').next()).unwrap().parse().unwrap()
}

/// Counts of messages that were left out, by reason, as the gateway tells them at its end.
fn left_out(said: &str) -> BTreeMap<String, u64> {
    let line = said.lines().rfind(|line| line.contains("messages left out: ")).unwrap();
    let list = line.split("messages left out: ").nth(1).unwrap().split(';').next().unwrap();
    let of = |part: &str| {
        let (words, count) = part.rsplit_once(" (").unwrap();
        (words.to_owned(), count.trim_end_matches(')').parse().unwrap())
    };
    list.split(", ").map(of).collect()
}

#[allow(clippy::print_stdout)]
fn withstands(protocol: &str, count: u64) {
    let Some((folder, broker, heard)) = begun(protocol) else { return };
    let folder = folder.path();
    let h = "[[cylinder]]\nname = \"H\"\ntype = \"rail\"\ntopic = \"train/H\"\n[pattern]";
    let text = configuration(broker.port, protocol).replacen("[pattern]", h, 1);
    std::fs::write(folder.join("gateway.toml"), text).unwrap();
    let running = gateway(folder);
    wait("connected", || said(folder).contains("connected"));
    // C comes before any other name does.
    publish(broker.port, &messages(0..10));
    wait_for(9, &heard, folder);
    let (begin, mut most_mb) = (Instant::now(), 0.0_f64);
    let parts = (count / TOGETHER).clamp(10, u64::from(MINUTES) - 10);
    let minute = |part: u64| 10 + ((u64::from(MINUTES) - 10) * part / parts) as u32;
    for part in 0..parts {
        let some: Vec<_> = (count * part / parts..count * (part + 1) / parts).map(hostile).collect();
        publish(broker.port, &some);
        publish(broker.port, &messages(minute(part)..minute(part + 1)));
        wait_for(minute(part + 1) - 1, &heard, folder);
        most_mb = most_mb.max(rss_mb(&running));
    }
    let took_s = begin.elapsed().as_secs_f64();
    end(running, folder);
    let said = said(folder);
    let reasons = left_out(&said);
    println!(
        "{count} in {took_s:.0} s, {:.0}/s; at most {most_mb:.0} MB; {reasons:?}",
        count as f64 / took_s
    );
    // The monitor was given a row that it did not take; it is one of the rows.
    let is_no_row =
        |words: &str| !["the monitor does not take it", "it was delivered before"].contains(&words);
    let refused: u64 = reasons.iter().filter(|(words, _)| is_no_row(words)).map(|(_, count)| count).sum();
    let rows = number_before(&said, " rows of ") - u64::from(MINUTES) * NAMES.len() as u64;
    let acknowledged = (0..count).filter(|n| n % 10 == 8 && n % 100 != 8).count() as u64;
    assert_eq!(refused + rows + acknowledged, count, "{said}");
    for words in ["no JSON", "too large", "rows_a_minute", "no number", "none of the readings", "as many"] {
        let words = if words == "too large" { "larger than message_bytes" } else { words };
        assert!(reasons.keys().any(|reason| reason.contains(words)), "{words}: {reasons:?}");
    }
    assert!(most_mb < BOUND_MB, "{most_mb} MB");
    let mut lines = heard_lines(&heard);
    lines.remove("H");
    let set =
        |lines: BTreeMap<String, Vec<String>>| -> BTreeSet<_> { lines.into_values().flatten().collect() };
    assert_eq!(set(lines), set(fleet_lines(folder)));
    assert_same_states(folder);
}

#[test]
fn hostile_messages_disturb_no_other_cylinder() {
    withstands("5", 20_000);
}

/// `HOSTILE=1000000 cargo test --features serve --test suite -- --ignored --nocapture serve::hostile`.
#[test]
#[ignore = "minutes: HOSTILE=1000000 cargo test --features serve --test suite -- --ignored --nocapture serve::hostile"]
fn a_million_hostile_messages_disturb_no_other_cylinder() {
    withstands("5", asked("HOSTILE", 1_000_000));
}

#[test]
fn a_message_of_32_mb_stops_the_gateway_with_neither_protocol() {
    for protocol in ["3.1.1", "5"] {
        let Some((folder, broker, heard)) = begun(protocol) else { return };
        let running = gateway(folder.path());
        wait("connected", || said(folder.path()).contains("connected"));
        publish(broker.port, &[("train/A".to_owned(), vec![b' '; 32 << 20])]);
        publish(broker.port, &messages(0..10));
        wait_for(9, &heard, folder.path());
        end(running, folder.path());
        let said = said(folder.path());
        assert_eq!(said.matches("connected to").count(), 1, "{said}");
        // A broker of MQTT 5 is told the bound, and discards it itself.
        assert_eq!(said.contains("larger than message_bytes (1)"), protocol == "3.1.1", "{said}");
    }
}
