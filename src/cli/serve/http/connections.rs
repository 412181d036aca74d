//! Places for connections: one that has not asked yet makes room for a new one, so that slow clients keep nobody out.
use super::limits::CONNECTIONS;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use tokio::task::AbortHandle;

#[derive(Default)]
struct Taken {
    next: u64,
    /// By their age.
    places: BTreeMap<u64, (Arc<Place>, AbortHandle)>,
}

/// All places.
#[derive(Default)]
pub(super) struct Connections(Mutex<Taken>);

/// A place that is taken.
#[derive(Default)]
pub(super) struct Place {
    has_asked: AtomicBool,
    is_stream: AtomicBool,
}

impl Place {
    /// Its request is there.
    pub(super) fn asked(&self) {
        self.has_asked.store(true, Ordering::Relaxed);
    }

    /// It listens to events.
    pub(super) fn streams(&self) {
        self.is_stream.store(true, Ordering::Relaxed);
    }

    pub(super) fn is_stream(&self) -> bool {
        self.is_stream.load(Ordering::Relaxed)
    }
}

/// Whether there is room.
#[derive(Debug, PartialEq)]
pub(super) enum Room {
    Free,
    /// The oldest that had not asked has gone.
    Made,
    /// All are being answered.
    Full,
}

impl Connections {
    fn taken(&self) -> MutexGuard<'_, Taken> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Makes room for one more.
    pub(super) fn room(&self) -> Room {
        let mut taken = self.taken();
        if taken.places.len() < CONNECTIONS {
            return Room::Free;
        }
        let idle = taken.places.iter().find(|(_, (place, _))| !place.has_asked.load(Ordering::Relaxed));
        let Some(number) = idle.map(|(number, _)| *number) else { return Room::Full };
        if let Some((_, task)) = taken.places.remove(&number) {
            task.abort();
        }
        Room::Made
    }

    /// Takes a place for a task, which gives it back with the number.
    pub(super) fn take(&self, begin: impl FnOnce(u64, Arc<Place>) -> AbortHandle) {
        let place = Arc::new(Place::default());
        let mut taken = self.taken();
        let number = taken.next;
        taken.next += 1;
        let task = begin(number, Arc::clone(&place));
        taken.places.insert(number, (place, task));
    }

    /// A place is free.
    pub(super) fn free(&self, number: u64) {
        self.taken().places.remove(&number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_that_has_not_asked_makes_room_and_none_that_has() {
        let runtime = tokio::runtime::Builder::new_current_thread().build().unwrap();
        let connections = Connections::default();
        let mut places = Vec::new();
        let take = |places: &mut Vec<Arc<Place>>| {
            connections.take(|_, place| {
                places.push(place);
                runtime.spawn(std::future::pending::<()>()).abort_handle()
            });
        };
        for _ in 0..CONNECTIONS {
            assert_eq!(connections.room(), Room::Free);
            take(&mut places);
        }
        places[0].asked();
        assert_eq!(connections.room(), Room::Made);
        assert!(!connections.taken().places.contains_key(&1) && connections.taken().places.contains_key(&0));
        take(&mut places);
        places.iter().for_each(|place| place.asked());
        assert_eq!(connections.room(), Room::Full);
        connections.free(0);
        assert_eq!(connections.room(), Room::Free);
    }
}
