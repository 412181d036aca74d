//! Handles in memory of any alignment, work that panics and work that needs too much; Miri runs these.
use super::*;
use alloc::vec::Vec;
use std::alloc::{Layout, alloc, dealloc};

/// Memory as C hands it over.
struct Memory(*mut u8, Layout);

impl Memory {
    fn of(size: usize) -> Self {
        let layout = Layout::from_size_align(size, 64).unwrap();
        // SAFETY: the size is not 0.
        Self(unsafe { alloc(layout) }, layout)
    }

    /// A handle behind so many bytes.
    fn handle(&self, skipped: usize) -> Result<NonNull<cw_handle>, Failure> {
        let start = self.0.wrapping_add(skipped).cast();
        let memory = places("memory", start, self.1.size() - skipped)?;
        // SAFETY: the memory is there, and ours.
        unsafe { lay(memory) }
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: from `alloc` with this layout.
        unsafe { dealloc(self.0, self.1) };
    }
}

fn code(handle: NonNull<cw_handle>, work: impl FnOnce(&mut Session) -> Result<cw_code, Failure>) -> cw_code {
    // SAFETY: the handle is whole, and the only one.
    unsafe { call(handle, work) }
}

fn detail(handle: NonNull<cw_handle>) -> String {
    // SAFETY: nothing else uses it now.
    str::from_utf8(unsafe { (*handle.as_ptr()).session.detail() }).unwrap().to_owned()
}

#[test]
fn a_handle_lies_at_the_head_of_memory_of_any_alignment() {
    let memory = Memory::of(64 << 10);
    for skipped in 0..64 {
        let handle = memory.handle(skipped).unwrap();
        assert!(handle.is_aligned());
        // SAFETY: it leads to memory.
        assert_eq!(unsafe { checked(handle.as_ptr()) }.unwrap(), handle);
        let mut at = 0;
        let done = code(handle, |_| {
            let numbers: Vec<u64> = (0..100).collect();
            at = numbers.as_ptr().addr();
            assert_eq!(numbers.iter().sum::<u64>(), 4950);
            Ok(cw_code::CW_OK)
        });
        assert_eq!(done, cw_code::CW_OK);
        assert!((handle.as_ptr().addr()..memory.0.addr() + memory.1.size()).contains(&at), "in the arena");
        // SAFETY: nothing else uses it now.
        let memory = unsafe { super::memory(handle) };
        assert_eq!((memory.allocations, memory.used_bytes), (1, 0));
    }
}

#[test]
fn what_is_too_small_for_a_handle_is_refused() {
    for size in [1, 64, size_of::<cw_handle>()] {
        assert!(matches!(Memory::of(size).handle(0), Err(Failure::ArenaTooSmall { .. })), "{size}");
    }
}

#[test]
fn a_panic_is_a_code_and_ends_the_monitor() {
    let memory = Memory::of(64 << 10);
    let handle = memory.handle(0).unwrap();
    let mut number = 0;
    let panicked = code(handle, |_| {
        let kept = alloc::vec![1_u8; 100];
        number = kept.len() + 1;
        assert_eq!(kept.len(), number, "on purpose");
        Ok(cw_code::CW_OK)
    });
    assert_eq!(panicked, cw_code::CW_PANICKED);
    assert!(detail(handle).contains("last saved state"), "{}", detail(handle));
    // SAFETY: nothing else uses it now.
    assert_eq!(unsafe { super::memory(handle) }.used_bytes, 0, "what had been taken has been given back");
    assert_eq!(code(handle, |session| session.rows().map(|_| cw_code::CW_OK)), cw_code::CW_ENDED);
}

#[test]
fn an_arena_that_is_full_is_a_code_and_ends_the_monitor() {
    let memory = Memory::of(16 << 10);
    let handle = memory.handle(0).unwrap();
    let full = code(handle, |_| {
        let large: Vec<u8> = (0..40_000_u32).map(|number| number as u8).collect();
        assert_eq!(large[39_999], 39_999_u32 as u8);
        Ok(cw_code::CW_OK)
    });
    assert_eq!(full, cw_code::CW_OUT_OF_MEMORY);
    assert!(detail(handle).contains("did not fit"), "{}", detail(handle));
    // SAFETY: nothing else uses it now.
    assert_eq!(unsafe { super::memory(handle) }.used_bytes, 0);
}

#[test]
fn handles_of_two_threads_have_arenas_of_their_own() {
    let threads: Vec<_> = (0..2_u64)
        .map(|thread| {
            std::thread::spawn(move || {
                let memory = Memory::of(32 << 10);
                let handle = memory.handle(0).unwrap();
                for round in 0..20 {
                    let done = code(handle, |_| {
                        let numbers: Vec<u64> = (0..50).map(|number| number + thread + round).collect();
                        assert_eq!(numbers[49], 49 + thread + round);
                        Ok(cw_code::CW_OK)
                    });
                    assert_eq!(done, cw_code::CW_OK);
                }
                // SAFETY: nothing else uses it now.
                assert_eq!(unsafe { super::memory(handle) }.allocations, 20);
            })
        })
        .collect();
    threads.into_iter().for_each(|thread| thread.join().unwrap());
}

#[test]
fn what_is_no_handle_or_has_been_moved_is_refused() {
    let memory = Memory::of(64 << 10);
    let handle = memory.handle(0).unwrap();
    let elsewhere = Memory::of(64 << 10);
    // SAFETY: both are as long, and apart.
    unsafe { elsewhere.0.copy_from_nonoverlapping(memory.0, size_of::<cw_handle>()) };
    // SAFETY: each leads to memory, is null or misaligned.
    unsafe {
        assert!(checked(handle.as_ptr()).is_ok());
        assert!(matches!(checked(elsewhere.0.cast()), Err(Failure::Handle)));
        elsewhere.0.write_bytes(0, size_of::<cw_handle>());
        assert!(matches!(checked(elsewhere.0.cast()), Err(Failure::Handle)));
        assert!(matches!(checked(handle.as_ptr().wrapping_byte_add(4)), Err(Failure::Misaligned { .. })));
        assert!(matches!(checked(ptr::null_mut()), Err(Failure::Null("handle"))));
    }
}
