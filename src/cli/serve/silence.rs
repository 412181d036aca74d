//! Which cylinders have sent no row for the time that the configuration states.
//!
//! Time is that of a clock that is never set, and runs only while the broker could deliver: a broker that is away, or a disk that is full, makes
//! no cylinder silent.
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// A cylinder.
struct Watch {
    /// When its last row came, or it was taken up.
    heard: Instant,
    /// The same, or when rows could come again.
    since: Instant,
    after: Duration,
    is_told: bool,
}

/// Between two looks at all of them.
const PAUSE: Duration = Duration::from_secs(1);

/// All cylinders.
#[derive(Default)]
pub(super) struct Silence {
    watches: BTreeMap<String, Watch>,
    looked: Option<Instant>,
}

impl Silence {
    /// Watches a cylinder from now on.
    pub(super) fn watch(&mut self, name: &str, after: Duration, now: Instant) {
        let watch = self.watches.entry(name.to_owned()).or_insert(Watch {
            heard: now,
            since: now,
            after,
            is_told: false,
        });
        watch.after = after;
    }

    /// Does not watch it any more.
    pub(super) fn forget(&mut self, name: &str) {
        self.watches.remove(name);
    }

    /// A row of a cylinder has come.
    pub(super) fn heard(&mut self, name: &str, now: Instant) {
        if let Some(watch) = self.watches.get_mut(name) {
            (watch.heard, watch.since, watch.is_told) = (now, now, false);
        }
    }

    /// Rows can come again: nobody has been silent before.
    pub(super) fn begin(&mut self, now: Instant) {
        self.watches.values_mut().for_each(|watch| watch.since = watch.since.max(now));
    }

    /// When the most silent one had a row, or was taken up.
    pub(super) fn longest(&self) -> Option<Instant> {
        self.watches.values().map(|watch| watch.heard).min()
    }

    /// Those that have fallen silent since this was asked last.
    pub(super) fn fallen(&mut self, now: Instant) -> Vec<String> {
        if self.looked.is_some_and(|looked| now.saturating_duration_since(looked) < PAUSE) {
            return Vec::new();
        }
        self.looked = Some(now);
        let due = |watch: &Watch| !watch.is_told && now.saturating_duration_since(watch.since) >= watch.after;
        let fallen = self.watches.iter_mut().filter(|(_, watch)| due(watch));
        fallen
            .map(|(name, watch)| {
                watch.is_told = true;
                name.clone()
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cylinder_falls_silent_once_and_not_while_nothing_could_come() {
        let (mut silence, begin) = (Silence::default(), Instant::now());
        let at = |minutes: u64| begin + Duration::from_secs(60 * minutes);
        for (name, after) in [("A", 10), ("B", 30)] {
            silence.watch(name, Duration::from_secs(60 * after), begin);
        }
        assert!(silence.fallen(at(9)).is_empty());
        silence.heard("A", at(9));
        assert!(silence.fallen(at(18)).is_empty());
        assert_eq!(silence.fallen(at(19)), ["A"]);
        assert!(silence.fallen(at(20)).is_empty());
        silence.heard("A", at(21));
        silence.begin(at(29));
        assert!(silence.fallen(at(38)).is_empty());
        assert_eq!(silence.fallen(at(59)), ["A", "B"]);
        assert_eq!(silence.longest(), Some(begin), "that it could not be heard is no row");
        silence.forget("B");
        assert_eq!(silence.longest(), Some(at(21)));
        silence.watch("A", Duration::from_secs(1), at(59));
        silence.heard("A", at(60));
        assert_eq!(silence.fallen(at(61)), ["A"]);
    }
}
