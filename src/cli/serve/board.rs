//! Cylinders as the loop has shown them. The loop shows them while somebody looks; readers take what is there, and hold the lock for no work.
use crate::report::fleet::{Cylinder, live_row};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// Between two looks at what has changed.
pub(super) const REFRESH: Duration = Duration::from_secs(2);
/// Rows of one event.
const CHUNK: usize = 100;

/// A cylinder with the number of its last change.
pub(super) struct Shown {
    version: u64,
    pub cylinder: Cylinder,
    json: OnceLock<String>,
}

impl Shown {
    /// As the script of the page takes it.
    pub(super) fn json(&self) -> &str {
        self.json.get_or_init(|| live_row(&self.cylinder).to_string())
    }
}

#[derive(Default)]
struct Content {
    /// The last change.
    version: u64,
    /// The change before which a reader has to begin anew.
    cleared: u64,
    rows: BTreeMap<String, Arc<Shown>>,
    /// When all were up to date.
    complete: Option<Instant>,
}

/// All of them.
#[derive(Default)]
pub(super) struct Board {
    watching: AtomicUsize,
    content: Mutex<Content>,
}

/// Somebody looks as long as it is there.
pub(super) struct Watching<'a>(&'a Board);

impl Drop for Watching<'_> {
    fn drop(&mut self) {
        self.0.watching.fetch_sub(1, Ordering::Relaxed);
    }
}

/// What has changed for a reader.
pub(super) struct Change {
    /// Whether what the reader had goes.
    pub is_all: bool,
    pub rows: Vec<Arc<Shown>>,
    /// What the reader knows then.
    pub version: u64,
    /// Whether there is more.
    pub has_more: bool,
}

impl Board {
    fn content(&self) -> MutexGuard<'_, Content> {
        self.content.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether somebody looks.
    pub(super) fn is_watched(&self) -> bool {
        self.watching.load(Ordering::Relaxed) > 0
    }

    /// Shows a cylinder.
    pub(super) fn put(&self, cylinder: Cylinder) {
        let mut content = self.content();
        content.version += 1;
        let (name, version) = (cylinder.name.clone(), content.version);
        content.rows.insert(name, Arc::new(Shown { version, cylinder, json: OnceLock::new() }));
    }

    /// All cylinders are up to date; those that are gone go here, too.
    pub(super) fn complete(&self, count: usize, is_there: impl Fn(&str) -> bool) {
        let mut content = self.content();
        content.complete = Some(Instant::now());
        if content.rows.len() != count {
            content.rows.retain(|name, _| is_there(name));
            content.version += 1;
            content.cleared = content.version;
        }
    }

    /// Looks from now on.
    pub(super) fn watch(&self) -> Watching<'_> {
        self.watching.fetch_add(1, Ordering::Relaxed);
        Watching(self)
    }

    /// Whether what is there is not older than pages are as a rule.
    pub(super) fn is_fresh(&self) -> bool {
        self.content().complete.is_some_and(|complete| complete.elapsed() < 3 * REFRESH)
    }

    /// The number of the last change.
    pub(super) fn version(&self) -> u64 {
        self.content().version
    }

    /// All that is there, and the number of the last change.
    pub(super) fn all(&self) -> (Vec<Arc<Shown>>, u64) {
        let content = self.content();
        (content.rows.values().cloned().collect(), content.version)
    }

    /// The next changes for a reader; `None`: it knows nothing.
    pub(super) fn after(&self, known: Option<u64>) -> Change {
        let content = self.content();
        let known = known.filter(|known| (content.cleared..=content.version).contains(known));
        let from = known.unwrap_or(0);
        let mut rows: Vec<_> = content.rows.values().filter(|shown| shown.version > from).cloned().collect();
        let version = content.version;
        drop(content);
        rows.sort_unstable_by_key(|shown| shown.version);
        let has_more = rows.len() > CHUNK;
        rows.truncate(CHUNK);
        let version = if has_more { rows[CHUNK - 1].version } else { version };
        Change { is_all: known.is_none(), rows, version, has_more }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cylinder(name: &str) -> Cylinder {
        Cylinder {
            name: name.to_owned(),
            vessel: String::new(),
            logs: Vec::new(),
            found: None,
            fault: "no row".to_owned(),
            cautions: Vec::new(),
            events: 0,
            last_events: Vec::new(),
        }
    }

    fn names(change: &Change) -> Vec<&str> {
        change.rows.iter().map(|shown| shown.cylinder.name.as_str()).collect()
    }

    #[test]
    fn a_reader_gets_what_changed_since_it_looked_and_nothing_twice() {
        let board = Board::default();
        ["A", "B", "C"].map(cylinder).into_iter().for_each(|one| board.put(one));
        let first = board.after(None);
        assert!(first.is_all && names(&first) == ["A", "B", "C"]);
        board.put(cylinder("B"));
        let second = board.after(Some(first.version));
        assert!(!second.is_all && names(&second) == ["B"]);
        assert!(board.after(Some(second.version)).rows.is_empty());
        assert!(board.after(Some(99)).is_all, "a number of another start");
    }

    #[test]
    fn a_cylinder_that_is_gone_makes_readers_begin_anew_once() {
        let board = Board::default();
        ["A", "B"].map(cylinder).into_iter().for_each(|one| board.put(one));
        let known = board.after(None).version;
        board.complete(2, |_| true);
        assert!(!board.after(Some(known)).is_all);
        board.complete(1, |name| name == "A");
        let change = board.after(Some(known));
        assert!(change.is_all && names(&change) == ["A"]);
        assert!(!board.after(Some(change.version)).is_all);
    }

    #[test]
    fn many_changes_come_in_parts_without_a_gap() {
        let board = Board::default();
        (0..250).for_each(|k| board.put(cylinder(&format!("{k}"))));
        let (mut known, mut seen) = (None, Vec::new());
        loop {
            let change = board.after(known);
            assert_eq!(change.is_all, known.is_none());
            known = Some(change.version);
            seen.extend(names(&change).into_iter().map(str::to_owned));
            // A change in between comes once, and last.
            if seen.len() == CHUNK {
                board.put(cylinder("7"));
            }
            if !change.has_more {
                break;
            }
        }
        assert_eq!((seen.len(), seen.last().map(String::as_str)), (251, Some("7")));
    }

    #[test]
    fn it_is_watched_as_long_as_somebody_looks() {
        let board = Board::default();
        let (one, other) = (board.watch(), board.watch());
        drop(one);
        assert!(board.is_watched());
        drop(other);
        assert!(!board.is_watched() && !board.is_fresh());
        board.complete(0, |_| true);
        assert!(board.is_fresh());
    }
}
