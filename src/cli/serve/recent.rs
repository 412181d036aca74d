//! The last rows that were accepted, so that one that the broker delivers again is known.
use std::collections::{HashSet, VecDeque};
use std::hash::{DefaultHasher, Hash, Hasher};

/// Rows that are remembered: more than a broker has on their way.
const MOST: usize = 4096;

/// Hashes of rows.
#[derive(Default)]
pub(super) struct Recent {
    order: VecDeque<u64>,
    hashes: HashSet<u64>,
}

impl Recent {
    /// Remembers a row.
    pub(super) fn note(&mut self, cylinder: &str, time_ns: i64, cells: &[f64]) {
        let hash = hash(cylinder, time_ns, cells);
        if self.hashes.insert(hash) {
            self.order.push_back(hash);
        }
        if self.order.len() > MOST
            && let Some(oldest) = self.order.pop_front()
        {
            self.hashes.remove(&oldest);
        }
    }

    /// Whether it is one of the last rows.
    pub(super) fn has(&self, cylinder: &str, time_ns: i64, cells: &[f64]) -> bool {
        self.hashes.contains(&hash(cylinder, time_ns, cells))
    }
}

fn hash(cylinder: &str, time_ns: i64, cells: &[f64]) -> u64 {
    let mut hasher = DefaultHasher::new();
    (cylinder, time_ns).hash(&mut hasher);
    cells.iter().for_each(|cell| cell.to_bits().hash(&mut hasher));
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_rows_are_known_by_every_bit() {
        let mut recent = Recent::default();
        for k in 0..MOST as i64 + 1 {
            recent.note("A", k, &[1.0]);
        }
        assert!(!recent.has("A", 0, &[1.0]) && recent.has("A", 1, &[1.0]));
        assert!(!recent.has("B", 1, &[1.0]) && !recent.has("A", 1, &[1.0 + f64::EPSILON]));
        assert_eq!(recent.order.len(), recent.hashes.len());
    }
}
