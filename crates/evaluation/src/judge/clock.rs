//! Time of computing of this thread.
//!
//! Where the system tells it (Linux: `/proc/thread-self/schedstat`), the time on a core, so that other work on the machine does not count;
//! elsewhere the time that has passed. The kernel renews its sum a few hundred times a second: single numbers are coarse, sums are right.
use std::time::Instant;

/// Runs from a beginning.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    begin: Instant,
    begin_on_core_s: Option<f64>,
}

impl Clock {
    /// Begin now.
    pub(crate) fn begin() -> Self {
        Self { begin: Instant::now(), begin_on_core_s: on_core_s() }
    }

    /// Time since the beginning, s.
    pub(crate) fn elapsed_s(&self) -> f64 {
        match (self.begin_on_core_s, on_core_s()) {
            (Some(begin_s), Some(now_s)) => now_s - begin_s,
            _ => self.begin.elapsed().as_secs_f64(),
        }
    }

    /// Time since the beginning, s, and begin anew now.
    pub(crate) fn lap_s(&mut self) -> f64 {
        let now = Self::begin();
        let elapsed_s = match (self.begin_on_core_s, now.begin_on_core_s) {
            (Some(begin_s), Some(now_s)) => now_s - begin_s,
            _ => (now.begin - self.begin).as_secs_f64(),
        };
        *self = now;
        elapsed_s
    }
}

fn on_core_s() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}
