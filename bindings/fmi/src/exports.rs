//! Shapes of exported functions.

/// A function that works on a unit.
macro_rules! on_unit {
    ($(fn $name:ident($($argument:ident: $kind:ty),*) |$unit:ident| $work:expr;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(component: *mut c_void $(, $argument: $kind)*) -> Status {
            // SAFETY: a master hands over a component of its own.
            unsafe {
                border::with(component, |$unit| $work.map_err(|error| error.to_string()))
            }
        }
    )*};
}

/// A function that the description does not announce.
macro_rules! refused {
    ($(fn $name:ident($($kind:ty),*) $words:literal;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(component: *mut c_void $(, _: $kind)*) -> Status {
            // SAFETY: a master hands over a component of its own.
            unsafe { border::with(component, |_| Err($words.to_owned())) }
        }
    )*};
}

/// A function on variables of a type that no variable has: none are fine.
macro_rules! none_of {
    ($(fn $name:ident($($kind:ty),*) $words:literal;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(
            component: *mut c_void,
            _: *const u32,
            count: usize
            $(, _: $kind)*
        ) -> Status {
            let none = || if count == 0 { Ok(()) } else { Err($words.to_owned()) };
            // SAFETY: a master hands over a component of its own.
            unsafe { border::with(component, |_| none()) }
        }
    )*};
}

/// The functions on saved states, which both versions have under their own names.
macro_rules! states {
    ($get:ident, $set:ident, $free:ident, $size:ident, $serialize:ident, $deserialize:ident) => {
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $get(component: *mut c_void, state: *mut *mut c_void) -> Status {
            // SAFETY: a master hands over a component and a place of its own.
            unsafe { crate::states::save(component, state) }
        }

        #[unsafe(no_mangle)]
        unsafe extern "C" fn $set(component: *mut c_void, state: *mut c_void) -> Status {
            // SAFETY: a master hands over a component and a state of its own.
            unsafe { crate::states::restore(component, state) }
        }

        #[unsafe(no_mangle)]
        unsafe extern "C" fn $free(component: *mut c_void, state: *mut *mut c_void) -> Status {
            // SAFETY: a master hands over a component and a state of its own.
            unsafe { crate::states::free_state(component, state) }
        }

        #[unsafe(no_mangle)]
        unsafe extern "C" fn $size(component: *mut c_void, state: *mut c_void, size: *mut usize) -> Status {
            // SAFETY: a master hands over a component, a state and a place of its own.
            unsafe { crate::states::state_size(component, state, size) }
        }

        #[unsafe(no_mangle)]
        unsafe extern "C" fn $serialize(
            component: *mut c_void,
            state: *mut c_void,
            bytes: *mut u8,
            room: usize,
        ) -> Status {
            // SAFETY: a master hands over a component, a state and room of its own.
            unsafe { crate::states::serialize(component, state, bytes, room) }
        }

        #[unsafe(no_mangle)]
        unsafe extern "C" fn $deserialize(
            component: *mut c_void,
            bytes: *const u8,
            count: usize,
            state: *mut *mut c_void,
        ) -> Status {
            // SAFETY: a master hands over a component, bytes and a place of its own.
            unsafe { crate::states::deserialize(component, bytes, count, state) }
        }
    };
}
