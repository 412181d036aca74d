//! An allocator that counts, and what a replay needs of it.
use core::alloc::{GlobalAlloc, Layout};
use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};

static USED: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
static COUNT: AtomicUsize = AtomicUsize::new(0);

/// Another allocator, counted. Bytes are those that are asked for, without what blocks need for themselves.
pub struct Counted<A>(pub A);

// SAFETY: every call is handed on as it came.
unsafe impl<A: GlobalAlloc> GlobalAlloc for Counted<A> {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.fetch_add(1, Relaxed);
        let used = USED.fetch_add(layout.size(), Relaxed).wrapping_add(layout.size());
        PEAK.fetch_max(used, Relaxed);
        // SAFETY: the caller keeps the contract of `GlobalAlloc::alloc`.
        unsafe { self.0.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        USED.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller keeps the contract of `GlobalAlloc::dealloc`.
        unsafe { self.0.dealloc(pointer, layout) }
    }
}

/// What a replay has allocated.
#[derive(Default)]
pub struct Arena {
    /// Allocations and bytes until the first row.
    begin: (usize, usize),
    /// Most bytes between rows.
    row_bytes: usize,
    /// Allocations while rows are taken, while it is saved and restored, and all when the present work began.
    row: usize,
    save: usize,
    restore: usize,
    before: usize,
}

impl Arena {
    /// What is there already is not counted.
    pub fn empty() -> Self {
        USED.store(0, Relaxed);
        PEAK.store(0, Relaxed);
        COUNT.store(0, Relaxed);
        Self::default()
    }

    pub fn begun(&mut self) {
        self.begin = (COUNT.load(Relaxed), PEAK.load(Relaxed));
    }

    pub fn saving(&mut self) {
        self.before = COUNT.load(Relaxed);
    }

    pub fn saved(&mut self) {
        self.save += self.since();
        self.before = COUNT.load(Relaxed);
    }

    pub fn restored(&mut self) {
        self.restore += self.since();
    }

    pub fn work(&mut self) {
        self.row_bytes = self.row_bytes.max(USED.load(Relaxed));
        self.before = COUNT.load(Relaxed);
    }

    pub fn rest(&mut self) {
        self.row += self.since();
    }

    /// Allocations since the present work began.
    fn since(&self) -> usize {
        COUNT.load(Relaxed) - self.before
    }

    /// Names and values.
    pub fn measured(&self) -> [(&'static str, usize); 7] {
        let (begin, begin_bytes) = self.begin;
        [
            ("arena_begin_bytes", begin_bytes),
            ("arena_row_bytes", self.row_bytes),
            ("arena_restore_bytes", PEAK.load(Relaxed)),
            ("allocations_begin", begin),
            ("allocations_row", self.row),
            ("allocations_save", self.save),
            ("allocations_restore", self.restore),
        ]
    }
}
