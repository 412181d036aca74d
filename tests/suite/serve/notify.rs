//! What the service manager hears: readiness, a watchdog that the loop alone feeds, a reload, the end.
use super::*;
use std::os::unix::net::UnixDatagram;
use std::time::Instant;

/// What comes within a time.
fn hear(socket: &UnixDatagram, time: Duration) -> Vec<String> {
    let (begin, mut heard) = (Instant::now(), Vec::new());
    while let Some(rest) = time.checked_sub(begin.elapsed()).filter(|rest| !rest.is_zero()) {
        socket.set_read_timeout(Some(rest)).unwrap();
        let mut bytes = [0; 100];
        if let Ok(length) = socket.recv(&mut bytes) {
            heard.push(String::from_utf8_lossy(&bytes[..length]).into_owned());
        }
    }
    heard
}

fn count(heard: &[String], words: &str) -> usize {
    heard.iter().filter(|said| *said == words).count()
}

#[test]
fn the_service_manager_hears_that_the_loop_turns_and_nothing_while_it_is_held_up() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    // No broker: that is no reason to be killed.
    std::fs::write(folder.join("gateway.toml"), configuration(1, "5")).unwrap();
    let socket = UnixDatagram::bind(folder.join("notify")).unwrap();
    let mut command = program(folder, &["serve", "gateway.toml"]);
    command.env("NOTIFY_SOCKET", folder.join("notify")).env("WATCHDOG_USEC", "600000");
    let mut running = Process(command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap());
    socket.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
    let mut bytes = [0; 100];
    let length = socket.recv(&mut bytes).unwrap();
    assert_eq!(&bytes[..length], b"READY=1");
    let turning = hear(&socket, Duration::from_secs(3));
    assert!((5..=16).contains(&count(&turning, "WATCHDOG=1")), "{turning:?}");
    signal(&running, "-STOP");
    _ = hear(&socket, Duration::from_millis(300));
    assert_eq!(hear(&socket, Duration::from_secs(2)), [""; 0]);
    signal(&running, "-CONT");
    assert!(count(&hear(&socket, Duration::from_secs(2)), "WATCHDOG=1") > 0);
    for (config, taken_over) in [("nonsense".to_owned(), false), (configuration(2, "5"), true)] {
        std::fs::write(folder.join("gateway.toml"), config).unwrap();
        signal(&running, "-HUP");
        let heard = hear(&socket, Duration::from_secs(2));
        let told: Vec<&str> = heard.iter().map(String::as_str).filter(|said| *said != "WATCHDOG=1").collect();
        assert_eq!(told, ["RELOADING=1", "READY=1"], "{taken_over}");
    }
    signal(&running, "-TERM");
    assert_eq!(running.0.wait().unwrap().code(), Some(0));
    assert_eq!(count(&hear(&socket, Duration::from_millis(200)), "STOPPING=1"), 1);
}

#[test]
fn without_a_watchdog_and_with_one_for_another_process_the_loop_says_nothing() {
    for (name, value) in [("WATCHDOG_PID", "1"), ("WATCHDOG_USEC", "no number")] {
        let folder = tempdir().unwrap();
        let folder = folder.path();
        std::fs::write(folder.join("gateway.toml"), configuration(1, "5")).unwrap();
        let socket = UnixDatagram::bind(folder.join("notify")).unwrap();
        let mut command = program(folder, &["serve", "gateway.toml"]);
        command.env("NOTIFY_SOCKET", folder.join("notify")).env("WATCHDOG_USEC", "300000").env(name, value);
        let running = Process(command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap());
        wait("it is ready", || count(&hear(&socket, Duration::from_millis(100)), "READY=1") > 0);
        assert_eq!(hear(&socket, Duration::from_secs(1)), [""; 0], "{name}");
        drop(running);
    }
}
