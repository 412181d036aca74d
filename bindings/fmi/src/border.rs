//! Between C and Rust: pointers, panics, messages.
use cylwatch_cosimulation::{Access, Instance};
use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// `fmi2Status` and `fmi3Status` have the same numbers.
pub(crate) type Status = i32;
pub(crate) const OK: Status = 0;
pub(crate) const ERROR: Status = 3;

/// What a component begins with, to tell it from other pointers.
const MARK: u64 = 0x6379_6c77_6174_6368;

/// Tells a master a message.
pub(crate) type Tell = Box<dyn Fn(&str)>;

/// What a master holds: a unit and how it is told of refusals.
pub(crate) struct Component {
    mark: u64,
    unit: Instance,
    tell: Tell,
}

impl Component {
    /// Hands a unit over to a master.
    pub(crate) fn handed_over(unit: Instance, tell: Tell) -> *mut c_void {
        Box::into_raw(Box::new(Self { mark: MARK, unit, tell })).cast()
    }
}

/// Does something and lets no panic pass.
pub(crate) fn guarded<R>(fallback: R, tell: &dyn Fn(&str), work: impl FnOnce() -> Result<R, String>) -> R {
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(result)) => result,
        Ok(Err(refused)) => {
            tell(&refused);
            fallback
        }
        Err(_) => {
            tell("an error of cylwatch itself: please report what was done before");
            fallback
        }
    }
}

/// The component of a pointer; `None`: it is none.
///
/// # Safety
/// The pointer is null or comes from [`Component::handed_over`] and was not freed, or points to eight bytes that can be read; and nothing
/// else uses the component meanwhile.
unsafe fn ours<'a>(component: *mut c_void) -> Option<&'a mut Component> {
    let component = component.cast::<Component>();
    if component.is_null() || !component.is_aligned() {
        return None;
    }
    // SAFETY: not null and aligned; the caller's promise for eight bytes.
    let mark = unsafe { (&raw const (*component).mark).read() };
    // SAFETY: with its mark it is a component, and a master uses one from one thread at a time.
    (mark == MARK).then(|| unsafe { &mut *component })
}

/// Does something with the unit of a component.
///
/// # Safety
/// As [`ours`].
pub(crate) unsafe fn with(
    component: *mut c_void,
    work: impl FnOnce(&mut Instance) -> Result<(), String>,
) -> Status {
    // SAFETY: the caller's promise.
    match unsafe { ours(component) } {
        Some(Component { unit, tell, .. }) => guarded(ERROR, tell, || work(unit).map(|()| OK)),
        None => ERROR,
    }
}

/// Frees a component.
///
/// # Safety
/// As [`ours`].
pub(crate) unsafe fn free(component: *mut c_void) {
    // SAFETY: the caller's promise.
    if let Some(ours) = unsafe { ours(component) } {
        // SAFETY: a place of its own. Volatile, so that it is written although nothing of ours reads it again: a second call finds no mark
        // as long as the memory is not used for something else.
        unsafe { (&raw mut ours.mark).write_volatile(0) };
        // SAFETY: it came from a box.
        drop(unsafe { Box::from_raw(component.cast::<Component>()) });
    }
}

/// The text of a pointer.
///
/// # Safety
/// It is null or points to a string that ends with a zero and lives as long as the result.
pub(crate) unsafe fn text<'a>(pointer: *const c_char) -> Result<&'a str, String> {
    if pointer.is_null() {
        return Err("a string is null".to_owned());
    }
    // SAFETY: not null; the caller's promise for the rest.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| "a string is not UTF-8".to_owned())
}

/// A text for C.
pub(crate) fn for_c(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

/// An array of C.
///
/// # Safety
/// The pointer is null, or so many values can be read there for as long as the result lives.
pub(crate) unsafe fn array<'a, T>(pointer: *const T, count: usize, what: &str) -> Result<&'a [T], String> {
    match (pointer.is_null(), count) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(format!("{what} is null, and {count} are wanted")),
        // SAFETY: not null; the caller's promise for the rest.
        (false, _) => Ok(unsafe { std::slice::from_raw_parts(pointer, count) }),
    }
}

/// An array of C that is written to.
///
/// # Safety
/// As [`array`], and nothing else reads or writes there.
pub(crate) unsafe fn array_mut<'a, T>(
    pointer: *mut T,
    count: usize,
    what: &str,
) -> Result<&'a mut [T], String> {
    match (pointer.is_null(), count) {
        (_, 0) => Ok(&mut []),
        (true, _) => Err(format!("{what} is null, and {count} are wanted")),
        // SAFETY: not null; the caller's promise for the rest.
        (false, _) => Ok(unsafe { std::slice::from_raw_parts_mut(pointer, count) }),
    }
}

/// Values of variables as a type of C.
pub(crate) trait Value: Copy {
    /// From a value of the unit.
    fn of(value: f64) -> Self;
    /// As a value of the unit.
    fn number(self) -> f64;
}

macro_rules! value {
    ($($of:ty),*) => {$(
        impl Value for $of {
            fn of(value: f64) -> Self {
                value as Self
            }
            fn number(self) -> f64 {
                self as f64
            }
        }
    )*};
}
value!(f64, i32, i64);

/// Reads variables into an array.
///
/// # Safety
/// As [`with`] and [`array`].
pub(crate) unsafe fn get<T: Value>(
    component: *mut c_void,
    (references, count): (*const u32, usize),
    (values, room): (*mut T, usize),
    access: Access,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        with(component, |unit| {
            same_count(count, room)?;
            let references = array(references, count, "the array of value references")?;
            let values = array_mut(values, room, "the array of values")?;
            for (&reference, value) in references.iter().zip(values) {
                *value = T::of(unit.get(reference, access).map_err(|error| error.to_string())?);
            }
            Ok(())
        })
    }
}

/// Sets variables from an array.
///
/// # Safety
/// As [`with`] and [`array`].
pub(crate) unsafe fn set<T: Value>(
    component: *mut c_void,
    (references, count): (*const u32, usize),
    (values, given): (*const T, usize),
    access: Access,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        with(component, |unit| {
            same_count(count, given)?;
            let references = array(references, count, "the array of value references")?;
            let values = array(values, given, "the array of values")?;
            for (&reference, value) in references.iter().zip(values) {
                unit.set(reference, access, value.number()).map_err(|error| error.to_string())?;
            }
            Ok(())
        })
    }
}

fn same_count(references: usize, values: usize) -> Result<(), String> {
    if references == values {
        return Ok(());
    }
    Err(format!("{references} value references and {values} values: give one value each"))
}
