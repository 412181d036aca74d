//! Memory: what the monitor allocates lies in the caller's arena.
//!
//! A call names its arena for as long as it runs ([`within`]), and the global allocator takes from it with a two-level segregated
//! fit, in bounded time. Without an arena, and while a panic is on its way, it takes from the system: what the standard
//! library keeps of a panic outlives the arena. Memory goes back to where its address says that it came from.
//!
//! An arena that is full is overdrawn: on an operating system the rest comes from the system until the call ends, which then
//! ends the monitor. Without one there is nothing to take it from, and the program panics.
use core::alloc::{GlobalAlloc, Layout};
use core::ptr::{self, NonNull};
use rlsf::Tlsf;

/// Largest block: 2^20 times four words, 32 MB on 64 bits. With sixteen sizes to each power of two the search wastes 6 % at most.
type Pool = Tlsf<'static, u32, u16, 20, 16>;

/// Memory of an arena.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct cw_memory {
    /// The arena, bytes.
    pub size_bytes: usize,
    /// From its start to the highest byte that has been in use, bytes: an arena as large would have been enough.
    pub reached_bytes: usize,
    /// In use now, bytes, without what blocks need for themselves.
    pub used_bytes: usize,
    /// Allocations since the monitor began.
    pub allocations: u64,
}

/// The memory behind a handle.
pub(crate) struct Arena {
    pool: Pool,
    /// Addresses.
    head: usize,
    end: usize,
    reached: usize,
    used: usize,
    allocations: u64,
    overdrawn: usize,
}

impl Arena {
    /// Of a block of memory, behind a head that begins at an address.
    ///
    /// # Safety
    /// The block can be read and written and belongs to the arena alone until a new one is laid over it.
    pub(crate) unsafe fn new(head: usize, block: NonNull<[u8]>) -> Self {
        let start = block.cast::<u8>().as_ptr() as usize;
        let mut pool = Pool::new();
        // SAFETY: as demanded of the caller. A block that is too small leaves the pool empty.
        unsafe { pool.insert_free_block_ptr(block) };
        Self { pool, head, end: start + block.len(), reached: start, used: 0, allocations: 0, overdrawn: 0 }
    }

    pub(crate) fn memory(&self) -> cw_memory {
        cw_memory {
            size_bytes: self.end - self.head,
            reached_bytes: self.reached - self.head,
            used_bytes: self.used,
            allocations: self.allocations,
        }
    }

    /// The monitor has begun.
    pub(crate) fn begin_count(&mut self) {
        self.allocations = 0;
    }

    /// Bytes that did not fit, since this was asked last.
    pub(crate) fn take_overdrawn(&mut self) -> usize {
        core::mem::take(&mut self.overdrawn)
    }

    fn holds(&self, pointer: *mut u8) -> bool {
        (self.head..self.end).contains(&(pointer as usize))
    }

    fn take(&mut self, layout: Layout) -> *mut u8 {
        self.allocations += 1;
        match self.pool.allocate(layout) {
            Some(pointer) => {
                self.used += layout.size();
                self.reached = self.reached.max(pointer.as_ptr() as usize + layout.size());
                pointer.as_ptr()
            }
            None => {
                self.overdrawn += layout.size();
                system::alloc(layout)
            }
        }
    }

    /// # Safety
    /// The pointer is of this arena or of the system, with this layout.
    unsafe fn give_back(&mut self, pointer: *mut u8, layout: Layout) {
        match NonNull::new(pointer).filter(|_| self.holds(pointer)) {
            Some(pointer) => {
                self.used -= layout.size();
                // SAFETY: what lies within was allocated by the pool.
                unsafe { self.pool.deallocate(pointer, layout.align()) };
            }
            // SAFETY: what lies outside came from the system.
            None => unsafe { system::dealloc(pointer, layout) },
        }
    }
}

/// Does work with an arena to allocate from.
///
/// # Safety
/// The pointer is null or that of an arena that stays where it is; nothing else refers to it meanwhile.
pub(crate) unsafe fn within<T>(arena: *mut Arena, work: impl FnOnce() -> T) -> T {
    struct Before(*mut Arena);
    impl Drop for Before {
        fn drop(&mut self) {
            current::replace(self.0);
        }
    }
    let _before = Before(current::replace(arena));
    work()
}

struct Allocator;

#[global_allocator]
static ALLOCATOR: Allocator = Allocator;

// SAFETY: the pool and the system keep the contract, and an address is either in the arena or not.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let arena = current::get();
        if arena.is_null() || system::is_panicking() {
            return system::alloc(layout);
        }
        // SAFETY: `within` has it from its caller that the arena is there and nothing else refers to it.
        unsafe { (*arena).take(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        let arena = current::get();
        if arena.is_null() {
            // SAFETY: what an arena holds is dropped within it alone; this came from the system.
            return unsafe { system::dealloc(pointer, layout) };
        }
        // SAFETY: as in `alloc`; the caller keeps the contract of the pointer.
        unsafe { (*arena).give_back(pointer, layout) }
    }
}

#[cfg(not(target_os = "none"))]
mod current {
    //! A thread has an arena of its own.
    use super::{Arena, ptr};
    use std::cell::Cell;

    thread_local! {
        static CURRENT: Cell<*mut Arena> = const { Cell::new(ptr::null_mut()) };
    }

    pub(super) fn get() -> *mut Arena {
        // A thread that is being taken down has none.
        CURRENT.try_with(Cell::get).unwrap_or(ptr::null_mut())
    }

    pub(super) fn replace(arena: *mut Arena) -> *mut Arena {
        CURRENT.try_with(|current| current.replace(arena)).unwrap_or(ptr::null_mut())
    }
}

#[cfg(target_os = "none")]
mod current {
    //! One caller at a time.
    use super::{Arena, ptr};
    use core::sync::atomic::{AtomicPtr, Ordering::Relaxed};

    static CURRENT: AtomicPtr<Arena> = AtomicPtr::new(ptr::null_mut());

    pub(super) fn get() -> *mut Arena {
        CURRENT.load(Relaxed)
    }

    pub(super) fn replace(arena: *mut Arena) -> *mut Arena {
        let before = get();
        CURRENT.store(arena, Relaxed);
        before
    }
}

#[cfg(not(target_os = "none"))]
mod system {
    use core::alloc::{GlobalAlloc, Layout};
    use std::alloc::System;

    pub(super) fn is_panicking() -> bool {
        std::thread::panicking()
    }

    pub(super) fn alloc(layout: Layout) -> *mut u8 {
        // SAFETY: `GlobalAlloc::alloc` is never asked for nothing.
        unsafe { System.alloc(layout) }
    }

    /// # Safety
    /// The pointer came from [`alloc`] with this layout.
    pub(super) unsafe fn dealloc(pointer: *mut u8, layout: Layout) {
        // SAFETY: as demanded of the caller.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[cfg(target_os = "none")]
mod system {
    use core::alloc::Layout;

    pub(super) fn is_panicking() -> bool {
        false
    }

    pub(super) fn alloc(_layout: Layout) -> *mut u8 {
        core::ptr::null_mut()
    }

    pub(super) unsafe fn dealloc(_pointer: *mut u8, _layout: Layout) {}
}
