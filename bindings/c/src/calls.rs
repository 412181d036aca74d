//! The functions. Each answers a code, and none keeps a pointer that it is given, but for the arena.
//!
//! Every pointer must lead to memory of the size and for the use that is said; null and misaligned ones are refused. A handle is
//! for one caller at a time; without an operating system all handles together are.
use crate::arena::cw_memory;
use crate::code::{Failure, TEXTS, cw_code};
use crate::event::{cw_alarm, cw_event};
use crate::handle::{begin, call, checked, cw_handle, memory};
use crate::output::cw_output;
use crate::pointer::{many, place, places};
use crate::session::{Rows, Session};
use core::ffi::{CStr, c_char};
use core::slice;

const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
    Ok(version) => version,
    Err(_) => panic!("a version has no end inside"),
};

fn coded(outcome: Result<cw_code, Failure>) -> cw_code {
    outcome.unwrap_or_else(|failure| failure.code())
}

/// Does work with a handle from outside.
unsafe fn with(
    handle: *mut cw_handle,
    work: impl FnOnce(&mut Session) -> Result<cw_code, Failure>,
) -> cw_code {
    // SAFETY: the caller says that the handle leads to memory, and calls from one thread at a time.
    coded(unsafe { checked(handle).map(|handle| call(handle, work)) })
}

/// Writes what there is.
unsafe fn put<T>(
    name: &'static str,
    to: *mut T,
    what: impl FnOnce() -> Result<Option<T>, Failure>,
) -> Result<cw_code, Failure> {
    let to = place(name, to)?;
    let Some(what) = what()? else { return Ok(cw_code::CW_NO_ROW) };
    // SAFETY: it is aligned and not null; the caller says that it can be written.
    unsafe { to.write(what) };
    Ok(cw_code::CW_OK)
}

/// Version of the library.
#[unsafe(no_mangle)]
pub extern "C" fn cw_version() -> *const c_char {
    VERSION.as_ptr()
}

/// Words for a code, which stay where they are.
#[unsafe(no_mangle)]
pub extern "C" fn cw_error_text(code: i32) -> *const c_char {
    let text = usize::try_from(code).ok().and_then(|at| TEXTS.get(at));
    text.unwrap_or(&c"there is no such code").as_ptr()
}

/// Size of an arena that a compiled cylinder (`cylwatch compile`) needs, bytes. It is found by trying, which takes a second, and on
/// an operating system alone; a machine with smaller pointers needs less.
///
/// # Safety
/// `blob_size` bytes can be read, a size can be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_size(blob: *const u8, blob_size: usize, size: *mut usize) -> cw_code {
    // SAFETY: as the caller says.
    coded(unsafe { put("size", size, || Ok(Some(needed(many("blob", blob, blob_size)?)?))) })
}

#[cfg(not(target_os = "none"))]
fn needed(blob: &[u8]) -> Result<usize, Failure> {
    crate::handle::guarded(|| crate::size::needed(blob)).unwrap_or(Err(Failure::Panicked))
}

#[cfg(target_os = "none")]
fn needed(_blob: &[u8]) -> Result<usize, Failure> {
    Err(Failure::HostedOnly)
}

/// Begins a monitor of a compiled cylinder. All that it needs lies in the arena, of any alignment, until the arena is used for
/// something else; there is nothing to free. The handle is null where the arena is too small for any; else it is there even when
/// the monitor is refused, for cw_detail to say why. The blob is not needed any more.
///
/// # Safety
/// `arena_size` bytes can be written and `blob_size` others read, a handle can be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_init(
    arena: *mut u8,
    arena_size: usize,
    blob: *const u8,
    blob_size: usize,
    handle: *mut *mut cw_handle,
) -> cw_code {
    // SAFETY: as the caller says.
    coded(unsafe {
        begin(arena, arena_size, handle, |session| {
            session.begin(Rows::of(many("blob", blob, blob_size)?, None)?);
            Ok(cw_code::CW_OK)
        })
    })
}

/// Begins a monitor that goes on from a saved state of the same cylinder, else as cw_init.
///
/// # Safety
/// As cw_init; `state_size` bytes can be read, too.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_restore(
    arena: *mut u8,
    arena_size: usize,
    blob: *const u8,
    blob_size: usize,
    state: *const u8,
    state_size: usize,
    handle: *mut *mut cw_handle,
) -> cw_code {
    // SAFETY: as the caller says.
    coded(unsafe {
        begin(arena, arena_size, handle, |session| {
            let state = many("state", state, state_size)?;
            session.begin(Rows::of(many("blob", blob, blob_size)?, Some(state))?);
            Ok(cw_code::CW_OK)
        })
    })
}

/// Takes in a row: its time, s, and a reading for each sensor in the order of `cylwatch compile`, K and Pa absolute, NaN where one
/// is missing. CW_OK: a row is ready and in the output; cw_next gives the others. CW_NO_ROW: none is. Rows that lie closer
/// together than a minute are united, and late ones wait for their place.
///
/// # Safety
/// The handle is that of cw_init or cw_restore, in an arena that is as they left it; `count` readings can be read, an output
/// written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_step(
    handle: *mut cw_handle,
    time_s: f64,
    readings: *const f64,
    count: usize,
    output: *mut cw_output,
) -> cw_code {
    // SAFETY: as the caller says.
    unsafe {
        with(handle, |session| {
            place("output", output)?;
            let readings = many("readings", readings, count)?;
            session.rows()?.take_in(time_s, readings)?;
            put("output", output, || session.next())
        })
    }
}

/// The next row that is ready, until CW_NO_ROW.
///
/// # Safety
/// The handle as for cw_step; an output can be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_next(handle: *mut cw_handle, output: *mut cw_output) -> cw_code {
    // SAFETY: as the caller says.
    unsafe { with(handle, |session| put("output", output, || session.next())) }
}

/// The rows have come to their end: what was held back, as cw_step.
///
/// # Safety
/// As cw_next.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_finish(handle: *mut cw_handle, output: *mut cw_output) -> cw_code {
    // SAFETY: as the caller says.
    unsafe {
        with(handle, |session| {
            place("output", output)?;
            session.rows()?.finish()?;
            put("output", output, || session.next())
        })
    }
}

/// An event of the last output, by its index.
///
/// # Safety
/// The handle as for cw_step; an event can be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_event_at(handle: *mut cw_handle, index: u32, event: *mut cw_event) -> cw_code {
    // SAFETY: as the caller says.
    unsafe { with(handle, |session| put("event", event, || session.event(index).map(Some))) }
}

/// A change of an alarm at the last output or by cw_acknowledge, by its index.
///
/// # Safety
/// The handle as for cw_step; an alarm can be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_alarm_at(handle: *mut cw_handle, index: u32, alarm: *mut cw_alarm) -> cw_code {
    // SAFETY: as the caller says.
    unsafe { with(handle, |session| put("alarm", alarm, || session.alarm(index).map(Some))) }
}

/// A person has seen the alarms, looked after the sensors and knows the filling. The comment is UTF-8 of so many bytes, without an
/// end; the count is that of the changes, which cw_alarm_at gives.
///
/// # Safety
/// The handle as for cw_step; `comment_size` bytes can be read, a count written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_acknowledge(
    handle: *mut cw_handle,
    comment: *const c_char,
    comment_size: usize,
    alarm_count: *mut u32,
) -> cw_code {
    // SAFETY: as the caller says.
    unsafe {
        with(handle, |session| {
            put("alarm_count", alarm_count, || {
                session.acknowledge(many("comment", comment.cast::<u8>(), comment_size)?).map(Some)
            })
        })
    }
}

/// An exchange of gas is announced between two times, s, as rows are stamped: what goes out then is no loss.
///
/// # Safety
/// The handle as for cw_step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_announce(handle: *mut cw_handle, from_s: f64, until_s: f64) -> cw_code {
    // SAFETY: as the caller says.
    unsafe { with(handle, |session| session.announce(from_s, until_s).map(|()| cw_code::CW_OK)) }
}

/// Everything that cw_restore needs, as bytes. Their number is written even when the buffer is too small; with a capacity of 0 the
/// buffer may be null.
///
/// # Safety
/// The handle as for cw_step; `capacity` bytes and a size can be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_save(
    handle: *mut cw_handle,
    buffer: *mut u8,
    capacity: usize,
    written: *mut usize,
) -> cw_code {
    // SAFETY: as the caller says.
    unsafe {
        with(handle, |session| {
            let written = place("written", written)?;
            let buffer = places("buffer", buffer, capacity)?;
            let room = slice::from_raw_parts_mut(buffer.cast::<u8>().as_ptr(), capacity);
            let needed = session.rows()?.save_into(room)?;
            written.write(needed);
            if needed > capacity {
                return Err(Failure::BufferTooSmall { needed, capacity });
            }
            Ok(cw_code::CW_OK)
        })
    }
}

/// Words for the last error of a handle, with its value, bound and remedy; cut to the buffer, and with an end.
///
/// # Safety
/// The handle as for cw_step; `capacity` bytes can be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_detail(handle: *mut cw_handle, buffer: *mut c_char, capacity: usize) -> cw_code {
    // SAFETY: as the caller says.
    unsafe {
        with(handle, |session| {
            let buffer = places("buffer", buffer.cast::<u8>(), capacity)?;
            let Some(room) = capacity.checked_sub(1) else {
                return Err(Failure::BufferTooSmall { needed: 1, capacity });
            };
            let buffer = slice::from_raw_parts_mut(buffer.cast::<u8>().as_ptr(), capacity);
            let length = session.detail().len().min(room);
            buffer[..length].copy_from_slice(&session.detail()[..length]);
            buffer[length] = 0;
            Ok(cw_code::CW_OK)
        })
    }
}

/// Memory of the arena.
///
/// # Safety
/// The handle as for cw_step; a cw_memory can be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cw_memory_of(handle: *mut cw_handle, to: *mut cw_memory) -> cw_code {
    // SAFETY: as the caller says.
    coded(unsafe { checked(handle).and_then(|handle| put("memory", to, || Ok(Some(memory(handle))))) })
}
