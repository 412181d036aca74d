//! A cache of fixed size: what is made depends on its place alone, and never on what was asked before, so that forgetting costs time only.
use alloc::vec::Vec;

/// Place on a grid.
pub(crate) type GridIndex = (i32, i32);

/// Values by their places on a grid. Those that lie a multiple of its width or height apart share a slot, in which the latest stays.
#[derive(Clone, Debug)]
pub(crate) struct GridCache<T> {
    /// Powers of two.
    size: (i32, i32),
    slots: Vec<Option<(GridIndex, T)>>,
}

impl<T> GridCache<T> {
    /// An empty one of a size, powers of two.
    pub(crate) fn new(size: (i32, i32)) -> Self {
        let mut slots = Vec::new();
        slots.resize_with((size.0 * size.1) as usize, || None);
        Self { size, slots }
    }

    fn slot(&self, (i, j): GridIndex) -> usize {
        ((i & (self.size.0 - 1)) * self.size.1 + (j & (self.size.1 - 1))) as usize
    }

    /// The value of a place, if it is there.
    #[inline]
    pub(crate) fn get(&self, index: GridIndex) -> Option<&T> {
        self.slots[self.slot(index)].as_ref().filter(|(known, _)| *known == index).map(|(_, value)| value)
    }

    /// Puts the value of a place in.
    pub(crate) fn put(&mut self, index: GridIndex, value: T) -> &T {
        let slot = self.slot(index);
        &self.slots[slot].insert((index, value)).1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_of_a_slot_stays() {
        let mut cache = GridCache::new((4, 2));
        cache.put((-1, 3), 'a');
        assert_eq!((cache.get((-1, 3)), cache.get((3, 3)), cache.get((-1, 1))), (Some(&'a'), None, None));
        cache.put((3, 1), 'b');
        assert_eq!((cache.get((-1, 3)), cache.get((3, 1))), (None, Some(&'b')));
    }
}
