//! Functions of FMI 2.0, co-simulation.
use crate::border::{self, Component, ERROR, Status, Tell};
use crate::place;
use cylwatch_cosimulation::Access;
use std::ffi::{CString, c_char, c_int, c_void};

type Boolean = c_int;
type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// `fmi2CoSimulation` of `fmi2Type`.
const CO_SIMULATION: c_int = 1;
/// `fmi2LastSuccessfulTime` of `fmi2StatusKind`.
const LAST_SUCCESSFUL_TIME: c_int = 2;

/// `fmi2CallbackFunctions`.
#[repr(C)]
pub(crate) struct Callbacks {
    logger: Option<Logger>,
    allocate_memory: *const c_void,
    free_memory: *const c_void,
    step_finished: *const c_void,
    environment: *mut c_void,
}

/// # Safety
/// `callbacks` is null or points to a master's callbacks.
unsafe fn teller(name: CString, callbacks: *const Callbacks) -> Tell {
    // SAFETY: the caller's promise.
    let callbacks = unsafe { callbacks.as_ref() };
    let Some((logger, environment)) = callbacks.and_then(|of| Some((of.logger?, of.environment))) else {
        return Box::new(|_| ());
    };
    Box::new(move |message| {
        // The message is a format of printf.
        let message = border::for_c(&message.replace('%', "%%"));
        // SAFETY: the master's own function with its own environment; the texts live until it returns.
        unsafe {
            logger(environment, name.as_ptr(), ERROR, c"logStatusError".as_ptr(), message.as_ptr());
        }
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    token: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: Boolean,
    _logging_on: Boolean,
) -> *mut c_void {
    // SAFETY: a master hands over strings and callbacks of its own.
    unsafe {
        let name = border::text(name).map(border::for_c).unwrap_or_default();
        let tell = teller(name, callbacks);
        let component = border::guarded(None, &*tell, || {
            if kind != CO_SIMULATION {
                return Err("this is a unit for co-simulation, not for model exchange".to_owned());
            }
            let folder = place::folder_of(border::text(resources)?)?;
            place::unit(&folder, border::text(token)?).map(Some)
        });
        component.map_or(std::ptr::null_mut(), |unit| Component::handed_over(unit, tell))
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2FreeInstance(component: *mut c_void) {
    // SAFETY: a master hands over a component of its own.
    unsafe { border::free(component) }
}

on_unit! {
    // Only errors are told, always.
    fn fmi2SetDebugLogging(_on: Boolean, _count: usize, _categories: *const *const c_char) |_unit| {
        Ok::<(), String>(())
    };
    // The tolerance of the solver is a parameter of its own.
    fn fmi2SetupExperiment(
        _tolerance_defined: Boolean, _tolerance: f64, start_s: f64, _stop_defined: Boolean, _stop_s: f64
    ) |unit| unit.start_at(start_s);
    fn fmi2EnterInitializationMode() |unit| unit.enter_initialization();
    fn fmi2ExitInitializationMode() |unit| unit.exit_initialization();
    fn fmi2Terminate() |unit| unit.terminate();
    fn fmi2Reset() |unit| unit.reset();
    fn fmi2DoStep(from_s: f64, step_s: f64, _no_state_before: Boolean) |unit| unit.step(from_s, step_s);
}

refused! {
    fn fmi2GetDirectionalDerivative(*const u32, usize, *const u32, usize, *const f64, *mut f64)
        "there are no directional derivatives";
    fn fmi2SetRealInputDerivatives(*const u32, usize, *const c_int, *const f64)
        "inputs hold for a step: there are no derivatives of inputs";
    fn fmi2GetRealOutputDerivatives(*const u32, usize, *const c_int, *mut f64)
        "there are no derivatives of outputs";
    fn fmi2CancelStep() "a step is done when it returns: there is none to cancel";
    fn fmi2GetStatus(c_int, *mut c_int) "a step is done when it returns: there is no status of one";
    fn fmi2GetIntegerStatus(c_int, *mut c_int) "there is no such status";
    fn fmi2GetBooleanStatus(c_int, *mut Boolean) "there is no such status";
    fn fmi2GetStringStatus(c_int, *mut *const c_char) "there is no such status";
}

none_of! {
    fn fmi2GetBoolean(*mut Boolean) "there are no booleans";
    fn fmi2SetBoolean(*const Boolean) "there are no booleans";
    fn fmi2GetString(*mut *const c_char) "there are no strings";
    fn fmi2SetString(*const *const c_char) "there are no strings";
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetRealStatus(component: *mut c_void, kind: c_int, value: *mut f64) -> Status {
    if kind != LAST_SUCCESSFUL_TIME {
        // SAFETY: a master hands over a component of its own.
        return unsafe { border::with(component, |_| Err("there is no such status".to_owned())) };
    }
    // SAFETY: a master hands over a component of its own, and a place for a number. The time is the first variable.
    unsafe { border::get(component, (&raw const TIME, 1), (value, 1), Access::Real) }
}

static TIME: u32 = 0;

macro_rules! values {
    ($(fn $get:ident, $set:ident($kind:ty) $access:expr;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $get(
            component: *mut c_void,
            references: *const u32,
            count: usize,
            values: *mut $kind,
        ) -> Status {
            // SAFETY: a master hands over a component of its own and arrays of so many.
            unsafe { border::get(component, (references, count), (values, count), $access) }
        }

        #[unsafe(no_mangle)]
        unsafe extern "C" fn $set(
            component: *mut c_void,
            references: *const u32,
            count: usize,
            values: *const $kind,
        ) -> Status {
            // SAFETY: a master hands over a component of its own and arrays of so many.
            unsafe { border::set(component, (references, count), (values, count), $access) }
        }
    )*};
}

values! {
    fn fmi2GetReal, fmi2SetReal(f64) Access::Real;
    fn fmi2GetInteger, fmi2SetInteger(c_int) Access::IntegerOrEnumeration;
}

states! {
    fmi2GetFMUstate, fmi2SetFMUstate, fmi2FreeFMUstate, fmi2SerializedFMUstateSize, fmi2SerializeFMUstate,
    fmi2DeSerializeFMUstate
}
