//! Saved states in a master's hands.
use crate::border::{Status, array, array_mut, with};
use std::ffi::c_void;

/// A saved state in a master's hands.
pub(crate) struct SavedState(Vec<u8>);

/// Puts a state where a master wants it, in place of the one that is there.
///
/// # Safety
/// `place` is null or points to null or to what this function has put there.
unsafe fn put(place: *mut *mut c_void, state: SavedState) -> Result<(), String> {
    // SAFETY: the caller's promise.
    let place = unsafe { place.as_mut() }.ok_or("the place for a state is null")?;
    // SAFETY: the caller's promise.
    match unsafe { place.cast::<SavedState>().as_mut() } {
        Some(held) => *held = state,
        None => *place = Box::into_raw(Box::new(state)).cast(),
    }
    Ok(())
}

/// Saves a state.
///
/// # Safety
/// As [`with`] and [`put`].
pub(crate) unsafe fn save(component: *mut c_void, state: *mut *mut c_void) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        with(component, |unit| {
            let saved = SavedState(unit.save().map_err(|error| error.to_string())?);
            put(state, saved)
        })
    }
}

/// Goes back to a state.
///
/// # Safety
/// As [`with`]; `state` is null or comes from [`save`] or [`deserialize`].
pub(crate) unsafe fn restore(component: *mut c_void, state: *mut c_void) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        with(component, |unit| {
            let state = state.cast::<SavedState>().as_ref().ok_or("the state is null")?;
            unit.restore(&state.0).map_err(|error| error.to_string())
        })
    }
}

/// Frees a state; none is free already.
///
/// # Safety
/// As [`save`].
pub(crate) unsafe fn free_state(component: *mut c_void, state: *mut *mut c_void) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        with(component, |_| {
            if !state.is_null() && !(*state).is_null() {
                drop(Box::from_raw((*state).cast::<SavedState>()));
                *state = std::ptr::null_mut();
            }
            Ok(())
        })
    }
}

/// Size of a state as bytes.
///
/// # Safety
/// As [`restore`]; `size` is null or can be written to.
pub(crate) unsafe fn state_size(component: *mut c_void, state: *mut c_void, size: *mut usize) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        with(component, |_| {
            let state = state.cast::<SavedState>().as_ref().ok_or("the state is null")?;
            *size.as_mut().ok_or("the place for the size is null")? = state.0.len();
            Ok(())
        })
    }
}

/// A state as bytes.
///
/// # Safety
/// As [`restore`]; so many bytes can be written to.
pub(crate) unsafe fn serialize(
    component: *mut c_void,
    state: *mut c_void,
    bytes: *mut u8,
    room: usize,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        with(component, |_| {
            let state = state.cast::<SavedState>().as_ref().ok_or("the state is null")?;
            let length = state.0.len();
            if room < length {
                return Err(format!("the state has {length} bytes, and there is room for {room}"));
            }
            array_mut(bytes, length, "the array for the state")?.copy_from_slice(&state.0);
            Ok(())
        })
    }
}

/// A state from bytes.
///
/// # Safety
/// As [`save`]; so many bytes can be read.
pub(crate) unsafe fn deserialize(
    component: *mut c_void,
    bytes: *const u8,
    count: usize,
    state: *mut *mut c_void,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        with(component, |unit| {
            let bytes = array(bytes, count, "the array of a state")?;
            unit.check(bytes).map_err(|error| error.to_string())?;
            put(state, SavedState(bytes.to_vec()))
        })
    }
}
