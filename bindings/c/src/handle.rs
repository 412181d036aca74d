//! The head of an arena: the handle, which the caller has a pointer to, with the allocator and the monitor behind it.
use crate::arena::{Arena, cw_memory, within};
use crate::code::{Failure, cw_code};
use crate::pointer::{place, places};
use crate::session::Session;
use core::mem::MaybeUninit;
use core::ptr::{self, NonNull};

/// A monitor in its arena. Whoever has it calls from one thread at a time.
pub struct cw_handle {
    magic: u64,
    /// Where it lies: an arena that has been moved is found out.
    address: usize,
    arena: Arena,
    session: Session,
}

/// Changes with whatever lies behind it.
const MAGIC: u64 = u64::from_le_bytes(*b"cw-hand1");

/// Lays a handle at the head of an arena, whatever its alignment.
///
/// # Safety
/// The memory can be written and belongs to the handle until another is laid over it.
pub(crate) unsafe fn lay(memory: NonNull<[MaybeUninit<u8>]>) -> Result<NonNull<cw_handle>, Failure> {
    let (start, size) = (memory.cast::<u8>(), memory.len());
    let skipped = start.align_offset(align_of::<cw_handle>());
    let head = skipped.saturating_add(size_of::<cw_handle>());
    let Some(rest) = size.checked_sub(head).filter(|&rest| rest > 0) else {
        return Err(Failure::ArenaTooSmall { size });
    };
    // SAFETY: head and rest lie within the memory, one behind the other.
    unsafe {
        let handle = start.add(skipped).cast::<cw_handle>();
        let arena = Arena::new(start.addr().get(), NonNull::slice_from_raw_parts(start.add(head), rest));
        handle.write(cw_handle {
            magic: MAGIC,
            address: handle.addr().get(),
            arena,
            session: Session::EMPTY,
        });
        Ok(handle)
    }
}

/// A pointer from outside, if it is that of a handle.
///
/// # Safety
/// Where it is aligned and not null, as many bytes as a handle has can be read from it.
pub(crate) unsafe fn checked(handle: *mut cw_handle) -> Result<NonNull<cw_handle>, Failure> {
    let checked = place("handle", handle)?;
    // SAFETY: as demanded of the caller; any bytes are numbers.
    let (magic, address) =
        unsafe { ((&raw const (*handle).magic).read(), (&raw const (*handle).address).read()) };
    if (magic, address) == (MAGIC, handle.addr()) { Ok(checked) } else { Err(Failure::Handle) }
}

/// Does work in the arena of a handle. What fails is explained there; a panic, or an arena that is full, ends the monitor.
///
/// # Safety
/// The handle is that of [`lay`], and nothing else uses it or its arena meanwhile.
pub(crate) unsafe fn call(
    handle: NonNull<cw_handle>,
    work: impl FnOnce(&mut Session) -> Result<cw_code, Failure>,
) -> cw_code {
    let handle = handle.as_ptr();
    // SAFETY: the handle is whole and ours. The two references are to different parts of it.
    let (arena, session) = unsafe { (&raw mut (*handle).arena, &mut (*handle).session) };
    // SAFETY: the arena stays at the head of its memory, and the session does not refer to it.
    let code = unsafe {
        within(arena, || {
            let done = guarded(|| work(session));
            if done.is_none() {
                // What is half done is not trusted; nor is dropping it.
                let _ = guarded(|| session.end());
            }
            // What a failure holds lies in the arena, so it is put into words here.
            done.unwrap_or_else(|| Err(broken())).unwrap_or_else(|failure| {
                session.explain(&failure);
                failure.code()
            })
        })
    };
    // SAFETY: no one refers to the arena now.
    let (short, size) = unsafe { ((*arena).take_overdrawn(), (*arena).memory().size_bytes) };
    if short == 0 {
        return code;
    }
    // SAFETY: as above.
    unsafe { within(arena, || guarded(|| session.end())) };
    session.explain(&Failure::OutOfMemory { size, short });
    cw_code::CW_OUT_OF_MEMORY
}

/// Begins a monitor at the head of an arena, and says where.
///
/// # Safety
/// The memory can be written and belongs to the monitor; a place for the handle that is aligned and not null can be written.
pub(crate) unsafe fn begin(
    arena: *mut u8,
    arena_size: usize,
    handle: *mut *mut cw_handle,
    work: impl FnOnce(&mut Session) -> Result<cw_code, Failure>,
) -> Result<cw_code, Failure> {
    let found = place("handle", handle)?;
    // SAFETY: checked, and as demanded of the caller.
    unsafe {
        found.write(ptr::null_mut());
        let memory = places("arena", arena.cast::<MaybeUninit<u8>>(), arena_size)?;
        let handle = lay(memory)?;
        found.write(handle.as_ptr());
        let code = call(handle, work);
        (*handle.as_ptr()).arena.begin_count();
        Ok(if code == cw_code::CW_OUT_OF_MEMORY { cw_code::CW_ARENA_TOO_SMALL } else { code })
    }
}

/// Memory of a handle.
///
/// # Safety
/// As [`call`].
pub(crate) unsafe fn memory(handle: NonNull<cw_handle>) -> cw_memory {
    // SAFETY: the handle is whole and ours.
    unsafe { (*handle.as_ptr()).arena.memory() }
}

/// None: it panicked.
#[cfg(not(target_os = "none"))]
pub(crate) fn guarded<T>(work: impl FnOnce() -> T) -> Option<T> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(work)).ok()
}

#[cfg(target_os = "none")]
fn guarded<T>(work: impl FnOnce() -> T) -> Option<T> {
    Some(work())
}

#[cfg(not(target_os = "none"))]
fn broken() -> Failure {
    Failure::Panicked
}

#[cfg(target_os = "none")]
fn broken() -> Failure {
    Failure::Ended
}

#[cfg(test)]
mod tests;
