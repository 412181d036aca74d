//! `serve --replay`: recorded logs go through the broker, and the results are those of `fleet`.
use super::*;
use crate::support::refused;
use std::io::Write;
use std::time::Instant;

fn replay(folder: &Path, arguments: &[&str]) -> Process {
    let said = std::fs::File::options().create(true).append(true).open(folder.join("said.txt")).unwrap();
    let all = [&["serve", "gateway.toml", "--replay"], arguments].concat();
    Process(program(folder, &all).stdout(Stdio::null()).stderr(said).spawn().unwrap())
}

#[test]
fn a_folder_of_logs_gives_the_events_and_states_of_fleet() {
    let Some((folder, _broker, heard)) = begun("5") else { return };
    let mut gateway = replay(folder.path(), &["logs", "--speed", "max"]);
    assert_eq!(gateway.0.wait().unwrap().code(), Some(0), "{}", said(folder.path()));
    let said = said(folder.path());
    assert!(said.contains(&format!("replay: {} rows of 3 cylinders, 13.3 h", 3 * MINUTES)), "{said}");
    assert!(said.contains("the replay has ended") && said.contains("the states are saved"), "{said}");
    assert_same_events(&heard, folder.path());
    assert_same_states(folder.path());
}

/// All rows in one log, packed, with a column of cylinders.
fn one_log(folder: &Path) {
    let file = std::fs::File::create(folder.join("all.csv.gz")).unwrap();
    let mut packed = flate2::write::GzEncoder::new(file, flate2::Compression::fast());
    writeln!(packed, "time,cylinder,shoulder_degc,valve_degc,pressure_bar").unwrap();
    for minute in 0..MINUTES {
        for name in NAMES {
            let [shoulder, valve, pressure] = readings(name, minute);
            writeln!(packed, "{},{name},{shoulder},{valve},{pressure}", time(minute)).unwrap();
        }
    }
    packed.finish().unwrap();
}

#[test]
fn one_packed_log_of_all_cylinders_in_the_older_protocol_gives_the_same() {
    let Some((folder, _broker, heard)) = begun("3.1.1") else { return };
    one_log(folder.path());
    let mut gateway = replay(folder.path(), &["all.csv.gz", "--speed", "max"]);
    assert_eq!(gateway.0.wait().unwrap().code(), Some(0), "{}", said(folder.path()));
    assert_same_events(&heard, folder.path());
    assert_same_states(folder.path());
}

#[test]
fn rows_come_in_the_time_that_the_speed_says_and_the_gateway_stays_if_it_is_asked_to() {
    let Some((folder, broker, heard)) = begun("5") else { return };
    let begin = Instant::now();
    // 799 min in 2 s.
    let gateway = replay(folder.path(), &["logs", "--speed", "24000", "--stay"]);
    wait_for(MINUTES - 1, &heard, folder.path());
    assert!(begin.elapsed() > Duration::from_millis(1990), "{:?}", begin.elapsed());
    wait("it is through", || said(folder.path()).contains("the replay is through"));
    publish(broker.port, &[("cylwatch/B/acknowledge".to_owned(), "seen".to_owned())]);
    wait("an acknowledged alarm", || {
        heard.lock().unwrap().iter().any(|(_, payload, _)| payload.contains("\"Comment\":\"seen\""))
    });
    end(gateway, folder.path());
}

#[test]
fn a_log_without_dates_ends_now() {
    let Some((folder, _broker, heard)) = begun("5") else { return };
    let log = "time_min,shoulder_degc,pressure_bar\n0,15,200\n5,15.1,200.1\n10,15,200\n";
    std::fs::write(folder.path().join("A.csv"), log).unwrap();
    let mut gateway = replay(folder.path(), &["A.csv", "--speed", "max"]);
    assert_eq!(gateway.0.wait().unwrap().code(), Some(0), "{}", said(folder.path()));
    let heard = heard.lock().unwrap();
    let estimate = heard.iter().rfind(|(topic, _, _)| topic == "cylwatch/A/estimate").unwrap();
    let estimate: serde_json::Value = serde_json::from_str(&estimate.1).unwrap();
    let last: jiff::Timestamp = estimate["time"].as_str().unwrap().parse().unwrap();
    let ago_s = (jiff::Timestamp::now().as_second() - last.as_second()) as f64;
    assert!((0.0..60.0).contains(&ago_s), "{ago_s}");
}

#[test]
fn a_log_that_cannot_be_played_is_one_message_with_a_remedy() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("gateway.toml"), configuration(1883, "5")).unwrap();
    std::fs::write(folder.join("x y+.csv"), "time_s,shoulder_degc\n0,1\n1,1\n").unwrap();
    std::fs::write(folder.join("A.csv"), "time_s,wall_top_degc\n0,1\n1,1\n").unwrap();
    std::fs::write(folder.join("B.csv"), "time_s,shoulder\n0,1\n").unwrap();
    for (log, words) in [
        ("x y+.csv", &["x y+.csv", "no topic", "[[cylinder]]"][..]),
        ("A.csv", &["A.csv", "no column", "[[payload.reading]]"]),
        ("B.csv", &["B.csv", "shoulder", "unit"]),
        ("C.csv", &["C.csv"]),
    ] {
        refused(folder, &["serve", "gateway.toml", "--replay", log], words);
    }
    refused(folder, &["serve", "gateway.toml", "--replay", "A.csv", "--speed", "0"], &["--speed", "max"]);
    refused(folder, &["serve", "gateway.toml", "--speed", "2"], &["--replay"]);
    let text = configuration(1883, "5").replace("time = \"/t\"", "clock = \"arrival\"");
    std::fs::write(folder.join("gateway.toml"), text).unwrap();
    refused(folder, &["serve", "gateway.toml", "--replay", "A.csv"], &["arrival", "name a time"]);
}
