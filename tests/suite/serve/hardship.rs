//! What a gateway meets in years: a full disk, a clock that is set, cylinders that fall silent, kills of everything in one run.
use super::*;
use std::time::Instant;

/// Seconds for which the disk is full; the environment may ask for more.
fn full_s() -> u64 {
    std::env::var("DISK_FULL_S").ok().and_then(|text| text.parse().ok()).unwrap_or(8)
}

/// A file system in memory that goes with the test.
struct SmallDisk<'a>(&'a Path);

impl<'a> SmallDisk<'a> {
    /// `None`, and a message, where mounting is not allowed.
    #[allow(clippy::print_stderr)]
    fn mounted(at: &'a Path) -> Option<Self> {
        std::fs::create_dir_all(at).unwrap();
        let done = Command::new("mount").args(["-t", "tmpfs", "-o", "size=1m", "tmpfs"]).arg(at).output();
        if done.is_ok_and(|done| done.status.success()) {
            return Some(Self(at));
        }
        eprintln!("skipped: a file system cannot be mounted here");
        None
    }

    /// Fills it to the last byte.
    fn fill(&self) {
        use std::io::Write;
        let mut file = std::fs::File::create(self.0.join("filling")).unwrap();
        while file.write_all(&[0; 4096]).is_ok() {}
        while file.write_all(&[0]).is_ok() {}
    }

    fn free(&self) {
        std::fs::remove_file(self.0.join("filling")).unwrap();
    }
}

impl Drop for SmallDisk<'_> {
    fn drop(&mut self) {
        _ = Command::new("umount").arg("-l").arg(self.0).status();
    }
}

#[test]
fn rows_wait_at_the_broker_while_the_disk_is_full_and_none_is_lost() {
    let Some((folder, broker, heard)) = begun("5") else { return };
    let store = folder.path().join("store");
    let Some(disk) = SmallDisk::mounted(&store) else { return };
    let running = gateway(folder.path());
    wait("connected", || said(folder.path()).contains("connected"));
    publish(broker.port, &messages(0..300));
    wait_for(299, &heard, folder.path());
    disk.fill();
    publish(broker.port, &messages(300..700));
    wait("the disk is full", || said(folder.path()).contains("it is tried again"));
    std::thread::sleep(Duration::from_secs(full_s()));
    let is_there = |minute: u32| {
        let time = format!("\"time\":\"{}\"", time(minute));
        heard.lock().unwrap().iter().any(|(_, payload, _)| payload.contains(&time))
    };
    assert!(!is_there(699), "a row was taken in that is not on disk");
    disk.free();
    publish(broker.port, &messages(700..MINUTES));
    wait_for(MINUTES - 1, &heard, folder.path());
    // States are tried again with the next round, which may come after the last row.
    wait("all can be written again", || said(folder.path()).contains("the disk can be written again"));
    end(running, folder.path());
    // Once of each kind of file.
    assert!(
        (1..=3).contains(&said(folder.path()).matches("No space left").count()),
        "{}",
        said(folder.path())
    );
    assert_same_events(&heard, folder.path());
    assert_same_states(folder.path());
    drop(disk);
}

/// The clock of the loggers is set back by an hour after 400 minutes, and forward by two after 600.
fn set_clock(minute: u32) -> String {
    match minute {
        ..400 => time(minute),
        400..600 => time(minute - 60),
        _ => time(minute + 60),
    }
}

#[test]
fn a_clock_that_is_set_back_and_forward_is_taken_as_fleet_takes_it() {
    let Some((folder, broker, heard)) = begun_by(set_clock, "5") else { return };
    let running = gateway(folder.path());
    wait("connected", || said(folder.path()).contains("connected"));
    publish(broker.port, &messages_by(set_clock, 0..MINUTES));
    wait_until(&set_clock(MINUTES - 1), &heard, folder.path());
    end(running, folder.path());
    let lines = fleet_lines(folder.path());
    assert!(lines["A"].iter().any(|line| line.contains("clock-jump")), "{lines:?}");
    assert_eq!(heard_lines(&heard), lines);
    assert_same_states(folder.path());
}

/// Ids of the changes of an alarm of the gateway, with those that came again.
fn changes(heard: &Heard, topic: &str) -> Vec<String> {
    let heard = heard.lock().unwrap();
    let lines = heard.iter().filter(|(of, _, _)| of == topic).map(|(_, payload, _)| payload);
    lines
        .map(|line| {
            serde_json::from_str::<serde_json::Value>(line).unwrap()["id"].as_str().unwrap().to_owned()
        })
        .collect()
}

#[test]
fn a_cylinder_that_falls_silent_is_told_once_whatever_is_killed_and_ends_with_its_next_row() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let Some(broker) = Broker::begin(folder) else { return };
    let quick = configuration(broker.port, "5").replacen("vessel =", "silent_after_s = 2\nvessel =", 1);
    std::fs::write(folder.join("gateway.toml"), quick).unwrap();
    let heard = listen(broker.port, "listener");
    let mut running = gateway(folder);
    wait("connected", || said(folder).contains("connected"));
    let of = |minutes: std::ops::Range<u32>, name: &str| {
        let topic = format!("train/{name}");
        messages(minutes).into_iter().filter(|(of, _)| *of == topic).collect::<Vec<_>>()
    };
    publish(broker.port, &of(0..10, "A"));
    let silent = "cylwatch/A/alarm/silent";
    let raised = "alarm-silent-active-1767226140000";
    wait("A is silent", || changes(&heard, silent).contains(&raised.to_owned()));
    // B has never sent anything.
    wait("B is silent", || !changes(&heard, "cylwatch/B/alarm/silent").is_empty());
    running.kill();
    running = gateway(folder);
    wait("it is told again after a kill", || changes(&heard, silent).len() >= 2);
    std::thread::sleep(Duration::from_secs(4));
    assert!(changes(&heard, silent).iter().all(|id| id == raised), "{:?}", changes(&heard, silent));
    let b: BTreeSet<String> = changes(&heard, "cylwatch/B/alarm/silent").into_iter().collect();
    assert_eq!(b.len(), 1, "{b:?}");
    publish(broker.port, &of(10..11, "A"));
    super::schema::assert_true_of(&heard);
    wait("it ends", || changes(&heard, silent).contains(&"alarm-silent-inactive-1767226200000".to_owned()));
    publish(broker.port, &[("cylwatch/A/acknowledge".to_owned(), "a broken cable".to_owned())]);
    wait("it is acknowledged", || {
        let heard = heard.lock().unwrap();
        heard.iter().any(|(of, line, _)| of == silent && line.contains("a broken cable"))
    });
    end(running, folder);
}

#[test]
fn a_broker_that_is_away_makes_no_cylinder_silent() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let Some(mut broker) = Broker::begin(folder) else { return };
    let quick = configuration(broker.port, "5").replace("vessel =", "silent_after_s = 4\nvessel =");
    std::fs::write(folder.join("gateway.toml"), quick).unwrap();
    let heard = listen(broker.port, "listener");
    let running = gateway(folder);
    wait("connected", || said(folder).contains("connected"));
    broker.pause(folder, Duration::from_secs(6));
    wait("connected again", || said(folder).matches("connected to").count() == 2);
    let back = Instant::now();
    publish(broker.port, &messages(0..1));
    while back.elapsed() < Duration::from_secs(2) {
        assert!(heard.lock().unwrap().iter().all(|(topic, _, _)| !topic.ends_with("silent")));
        std::thread::sleep(Duration::from_millis(50));
    }
    end(running, folder);
}

#[test]
fn a_gateway_killed_20_times_and_a_broker_10_times_in_one_run_lose_no_event() {
    let Some((folder, mut broker, heard)) = begun("5") else { return };
    let mut running = gateway(folder.path());
    wait("connected", || said(folder.path()).contains("connected"));
    for part in 0..20 {
        let from = part * MINUTES / 20;
        publish(broker.port, &messages(from..(part + 1) * MINUTES / 20));
        // From a moment before the first row is taken in to one after the states are saved.
        std::thread::sleep(Duration::from_millis(u64::from(part * part * 397 % 1500)));
        running.kill();
        running = gateway(folder.path());
        if part % 2 == 1 {
            // The broker forgets what it has not delivered.
            wait_for((part + 1) * MINUTES / 20 - 1, &heard, folder.path());
            let connections = said(folder.path()).matches("connected to").count();
            broker.replace(folder.path());
            wait("connected again", || said(folder.path()).matches("connected to").count() > connections);
        }
    }
    wait_for(MINUTES - 1, &heard, folder.path());
    end(running, folder.path());
    assert_same_events(&heard, folder.path());
    assert_same_states(folder.path());
}
