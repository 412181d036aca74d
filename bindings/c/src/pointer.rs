//! Pointers from outside: neither null nor misaligned, and of a size that can be.
use crate::code::Failure;
use core::ptr::NonNull;
use core::slice;

/// Somewhere to write one to.
pub(crate) fn place<T>(name: &'static str, pointer: *mut T) -> Result<NonNull<T>, Failure> {
    let place = NonNull::new(pointer).ok_or(Failure::Null(name))?;
    if !pointer.is_aligned() {
        return Err(Failure::Misaligned { name, address: pointer.addr(), needed: align_of::<T>() });
    }
    Ok(place)
}

/// Many, to read from or to write to; none where the count is 0, wherever the pointer leads.
pub(crate) fn places<T>(name: &'static str, pointer: *mut T, count: usize) -> Result<NonNull<[T]>, Failure> {
    if count == 0 {
        return Ok(NonNull::slice_from_raw_parts(NonNull::dangling(), 0));
    }
    let start = place(name, pointer)?;
    let bytes = count.saturating_mul(size_of::<T>());
    if bytes > isize::MAX as usize || pointer.addr().checked_add(bytes).is_none() {
        return Err(Failure::Size { name, bytes });
    }
    Ok(NonNull::slice_from_raw_parts(start, count))
}

/// Many to read.
///
/// # Safety
/// They can be read, and nothing writes them meanwhile.
pub(crate) unsafe fn many<'a, T>(
    name: &'static str,
    pointer: *const T,
    count: usize,
) -> Result<&'a [T], Failure> {
    let many = places(name, pointer.cast_mut(), count)?;
    // SAFETY: checked above; that they can be read the caller says.
    Ok(unsafe { slice::from_raw_parts(many.cast::<T>().as_ptr(), count) })
}
