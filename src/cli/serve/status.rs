//! What the loop tells of itself, for those who look from outside: counts, gauges and times in atomics, so that the loop waits for no reader.
mod histogram;
mod reason;

use super::board::Board;
use super::mapping::Refusal;
pub(super) use histogram::{BOUNDS_S, Histogram};
use jiff::Timestamp;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicI64, AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The loop counts as stuck when it has not turned for so long.
pub(super) const STUCK: Duration = Duration::from_secs(10);
/// A row may be so far ahead of the clock and still be the newest, ns.
const AHEAD_NS: i64 = 60_000_000_000;
/// No time.
const NONE: i64 = i64::MIN;

/// A count that only grows.
#[derive(Default)]
pub(super) struct Counter(AtomicU64);

impl Counter {
    /// Counts one.
    pub(super) fn add(&self) {
        self.0.fetch_add(1, Relaxed);
    }

    pub(super) fn count(&self) -> u64 {
        self.0.load(Relaxed)
    }
}

/// What the loop sees at a turn.
pub(super) struct Turn {
    pub cylinders: usize,
    /// Messages that have not arrived at the broker.
    pub outbox: usize,
    pub is_connected: bool,
    pub is_writable: bool,
    /// When the most silent cylinder had a row, or was taken up; `None`: it was not looked for.
    pub most_silent: Option<Instant>,
}

/// All of it.
pub(super) struct Status {
    pub started: Timestamp,
    begun: Instant,
    /// Rows that were taken in.
    pub rows: Counter,
    pub states_saved: Counter,
    pub states_failed: Counter,
    /// Time that a row takes in its monitor.
    pub step: Histogram,
    /// Time until rows are in the journal, on disk.
    pub journal: Histogram,
    /// Time from the arrival of a message until what it leads to is handed to the connection.
    pub publish: Histogram,
    pub board: Board,
    refusals: Mutex<BTreeMap<Refusal, u64>>,
    cylinders: AtomicU64,
    outbox: AtomicU64,
    is_connected: AtomicBool,
    is_writable: AtomicBool,
    /// Since the begin, ns.
    turned_ns: AtomicU64,
    most_silent_ns: AtomicU64,
    /// Time of the newest row, ns since 1970.
    newest_ns: AtomicI64,
}

impl Default for Status {
    fn default() -> Self {
        Self {
            started: Timestamp::now(),
            begun: Instant::now(),
            rows: Counter::default(),
            states_saved: Counter::default(),
            states_failed: Counter::default(),
            step: Histogram::default(),
            journal: Histogram::default(),
            publish: Histogram::default(),
            board: Board::default(),
            refusals: Mutex::new(Refusal::ALL.map(|refusal| (refusal, 0)).into()),
            cylinders: AtomicU64::new(0),
            outbox: AtomicU64::new(0),
            is_connected: AtomicBool::new(false),
            is_writable: AtomicBool::new(true),
            turned_ns: AtomicU64::new(0),
            most_silent_ns: AtomicU64::new(0),
            newest_ns: AtomicI64::new(NONE),
        }
    }
}

impl Status {
    fn since_begin_ns(&self, instant: Instant) -> u64 {
        instant.saturating_duration_since(self.begun).as_nanos() as u64
    }

    /// The loop has turned.
    pub(super) fn turn(&self, turn: &Turn) {
        self.cylinders.store(turn.cylinders as u64, Relaxed);
        self.outbox.store(turn.outbox as u64, Relaxed);
        self.is_connected.store(turn.is_connected, Relaxed);
        self.is_writable.store(turn.is_writable, Relaxed);
        if let Some(instant) = turn.most_silent {
            self.most_silent_ns.store(self.since_begin_ns(instant), Relaxed);
        }
        self.turned_ns.store(self.since_begin_ns(Instant::now()), Relaxed);
    }

    /// A row with this time was taken in, ns since 1970.
    pub(super) fn row(&self, time_ns: i64) {
        self.rows.add();
        if time_ns <= Timestamp::now().as_nanosecond() as i64 + AHEAD_NS {
            self.newest_ns.fetch_max(time_ns, Relaxed);
        }
    }

    /// A message was left out.
    pub(super) fn refused(&self, refusal: Refusal) {
        *self.refusals.lock().unwrap_or_else(PoisonError::into_inner).entry(refusal).or_default() += 1;
    }

    /// How many messages were left out, by reason.
    pub(super) fn refusals(&self) -> BTreeMap<Refusal, u64> {
        self.refusals.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    pub(super) fn cylinders(&self) -> u64 {
        self.cylinders.load(Relaxed)
    }

    pub(super) fn outbox(&self) -> u64 {
        self.outbox.load(Relaxed)
    }

    pub(super) fn is_connected(&self) -> bool {
        self.is_connected.load(Relaxed)
    }

    pub(super) fn is_writable(&self) -> bool {
        self.is_writable.load(Relaxed)
    }

    /// Age of the newest row by its own time, s; `None`: there has been no row.
    pub(super) fn newest_row_age_s(&self) -> Option<f64> {
        let newest_ns = self.newest_ns.load(Relaxed);
        let age = || (Timestamp::now().as_nanosecond() - i128::from(newest_ns)) as f64 / 1e9;
        (newest_ns != NONE).then(age)
    }

    /// Time since the last row of the most silent cylinder, s.
    pub(super) fn most_silent_s(&self) -> f64 {
        let silent_ns = self.since_begin_ns(Instant::now()).saturating_sub(self.most_silent_ns.load(Relaxed));
        silent_ns as f64 / 1e9
    }

    /// What is amiss, in words; nothing: all is well.
    pub(super) fn amiss(&self) -> Vec<&'static str> {
        let now_ns = self.since_begin_ns(Instant::now());
        let is_stuck = now_ns.saturating_sub(self.turned_ns.load(Relaxed)) > STUCK.as_nanos() as u64;
        [
            (is_stuck, "the loop is stuck"),
            (!self.is_connected(), "the broker is not connected"),
            (!self.is_writable(), "the disk cannot be written"),
        ]
        .into_iter()
        .filter_map(|(is_so, words)| is_so.then_some(words))
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turn() -> Turn {
        Turn { cylinders: 2, outbox: 3, is_connected: true, is_writable: true, most_silent: None }
    }

    #[test]
    fn what_is_amiss_is_told_and_goes_away() {
        let mut status = Status::default();
        assert_eq!(status.amiss(), ["the broker is not connected"]);
        status.turn(&turn());
        assert!(status.amiss().is_empty());
        status.turn(&Turn { is_writable: false, is_connected: false, ..turn() });
        assert_eq!(status.amiss(), ["the broker is not connected", "the disk cannot be written"]);
        status.turn(&turn());
        status.begun -= STUCK + Duration::from_millis(1);
        assert_eq!(status.amiss(), ["the loop is stuck"]);
        status.turn(&turn());
        assert!(status.amiss().is_empty());
    }

    #[test]
    fn a_row_far_ahead_of_the_clock_is_not_the_newest() {
        let status = Status::default();
        assert_eq!(status.newest_row_age_s(), None);
        let now_ns = Timestamp::now().as_nanosecond() as i64;
        status.row(now_ns - 5_000_000_000);
        status.row(now_ns + 3_600_000_000_000);
        let age_s = status.newest_row_age_s().unwrap();
        assert!((5.0..6.0).contains(&age_s), "{age_s}");
        assert_eq!(status.rows.count(), 2);
    }
}
