//! Requests that mean no good: the gateway answers the others, and takes no more memory.
use super::client::connection;
use super::*;
use std::io::{Read, Write};
use std::time::{Duration, Instant};

/// Requests of a run that is not asked for more by `HOSTILE`.
const FEW: usize = 3000;
/// Connections at once.
const AT_ONCE: usize = 8;
/// Growth that is allowed, kB: buffers of all connections, and rows in the page.
const ROOM_KB: u64 = 32_768;

/// Numbers that look random and are the same in each run.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % bound
    }

    fn bytes(&mut self, most: usize) -> Vec<u8> {
        (0..self.below(most)).map(|_| self.below(256) as u8).collect()
    }
}

fn hostile(random: &mut Random) -> Vec<u8> {
    const PATHS: [&str; 8] =
        ["/", "/metrics", "/events?after=x", "/../../etc/passwd", "//", "/%00", "/events?after=\u{ff}", "*"];
    let path = PATHS[random.below(PATHS.len())];
    match random.below(9) {
        0 => random.bytes(600),
        1 => request("GET", path, &format!("X: {}\r\n", "x".repeat(random.below(40_000)))),
        2 => request("GET", path, &"Y: y\r\n".repeat(random.below(300))),
        3 => request(
            ["POST", "PUT", "BREW", "get", ""][random.below(5)],
            path,
            "Content-Length: 99999999999\r\n",
        ),
        4 => request("GET", &format!("/{}", "../".repeat(random.below(3000))), ""),
        5 => {
            let mut half = request("GET", path, "Accept: */*\r\n");
            half.truncate(random.below(half.len()));
            half
        }
        6 => {
            let mut damaged = request("GET", path, "Authorization: Basic AAAA\r\n");
            let at = random.below(damaged.len());
            damaged[at] = random.below(256) as u8;
            damaged
        }
        7 => [request("GET", path, "Transfer-Encoding: chunked\r\n"), random.bytes(2000)].concat(),
        _ => {
            format!("GET {path} HTTP/1.1\r\nHost: {}\r\n\r\n", "evil.".repeat(random.below(50))).into_bytes()
        }
    }
}

/// Resident memory of a process, kB.
fn rss_kb(process: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    line.trim().trim_end_matches(" kB").parse().unwrap()
}

/// Sends one; some do not wait for the answer, and some take only the beginning of it.
fn send(page: u16, random: &mut Random) {
    let mut stream = connection(page);
    stream.set_read_timeout(Some(Duration::from_millis(200))).unwrap();
    _ = stream.write_all(&hostile(random));
    match random.below(4) {
        0 => {}
        1 => _ = stream.read(&mut [0; 10]),
        _ => {
            _ = stream.shutdown(std::net::Shutdown::Write);
            _ = stream.read_to_end(&mut Vec::new());
        }
    }
}

#[allow(clippy::print_stdout)]
fn survives(count: usize) {
    let folder = tempfile::tempdir().unwrap();
    let (mut running, page) = alone(folder.path());
    let process = running.0.id();
    let send_all = |count: usize, seed: u64| {
        std::thread::scope(|scope| {
            for k in 0..AT_ONCE as u64 {
                scope.spawn(move || {
                    let mut random = Random(seed + k);
                    (0..count / AT_ONCE).for_each(|_| send(page, &mut random));
                });
            }
        });
    };
    send_all(count / 10, 1);
    let (before_kb, begin) = (rss_kb(process), Instant::now());
    send_all(count, 1000);
    let (after_kb, time) = (rss_kb(process), begin.elapsed());
    assert!(after_kb < before_kb + ROOM_KB, "{before_kb} kB before, {after_kb} kB after");
    assert!(running.0.try_wait().unwrap().is_none() && !said(folder.path()).contains("panicked"));
    wait("answers", || get(page, "/").status == 200);
    let metrics = get(page, "/metrics").body;
    let refused = metrics.lines().filter(|line| line.starts_with("cylwatch_http_refused_total"));
    let refused: f64 = refused.map(|line| line.rsplit(' ').next().unwrap().parse::<f64>().unwrap()).sum();
    assert!(refused > 0.4 * count as f64, "{refused} of {count}: {metrics}");
    println!(
        "{count} requests in {time:?}: {before_kb} kB before, {after_kb} kB after, {refused} refused\n{metrics}"
    );
    end(running, folder.path());
}

#[test]
fn a_few_thousand_hostile_requests_do_no_harm() {
    survives(FEW);
}

#[test]
#[ignore = "takes minutes: HOSTILE=100000 cargo test --features serve --test suite -- --ignored hostile --nocapture"]
fn as_many_hostile_requests_as_are_wanted_do_no_harm() {
    survives(std::env::var("HOSTILE").map_or(100_000, |count| count.parse().unwrap()));
}
