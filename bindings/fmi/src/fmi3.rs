//! Functions of FMI 3.0, co-simulation.
use crate::border::{self, Component, ERROR, Status, Tell};
use crate::place;
use cylwatch_cosimulation::Access;
use std::ffi::{c_char, c_int, c_void};
use std::path::Path;

/// `fmi3Boolean`: a master may hand over any byte.
type Boolean = u8;
type LogMessage = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

fn teller(environment: *mut c_void, log: Option<LogMessage>) -> Tell {
    let Some(log) = log else { return Box::new(|_| ()) };
    Box::new(move |message| {
        let message = border::for_c(message);
        // SAFETY: the master's own function with its own environment; the texts live until it returns.
        unsafe { log(environment, ERROR, c"logStatusError".as_ptr(), message.as_ptr()) }
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateCoSimulation(
    _name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: Boolean,
    _logging_on: Boolean,
    _event_mode_used: Boolean,
    _early_return_allowed: Boolean,
    _intermediate: *const u32,
    intermediate_count: usize,
    environment: *mut c_void,
    log: Option<LogMessage>,
    _update: *const c_void,
) -> *mut c_void {
    let tell = teller(environment, log);
    let component = border::guarded(None, &*tell, || {
        if intermediate_count > 0 {
            return Err("there are no values within a step: ask for no intermediate variables".to_owned());
        }
        // SAFETY: a master hands over strings of its own.
        let (resources, token) = unsafe { (border::text(resources)?, border::text(token)?) };
        place::unit(Path::new(resources), token).map(Some)
    });
    component.map_or(std::ptr::null_mut(), |unit| Component::handed_over(unit, tell))
}

fn not_of_this_kind(environment: *mut c_void, log: Option<LogMessage>) -> *mut c_void {
    teller(environment, log)("this is a unit for co-simulation and for nothing else");
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateModelExchange(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: Boolean,
    _logging_on: Boolean,
    environment: *mut c_void,
    log: Option<LogMessage>,
) -> *mut c_void {
    not_of_this_kind(environment, log)
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: Boolean,
    _logging_on: Boolean,
    environment: *mut c_void,
    log: Option<LogMessage>,
    _clock: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> *mut c_void {
    not_of_this_kind(environment, log)
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeInstance(component: *mut c_void) {
    // SAFETY: a master hands over a component of its own.
    unsafe { border::free(component) }
}

on_unit! {
    // Only errors are told, always.
    fn fmi3SetDebugLogging(_on: Boolean, _count: usize, _categories: *const *const c_char) |_unit| {
        Ok::<(), String>(())
    };
    // The tolerance of the solver is a parameter of its own.
    fn fmi3EnterInitializationMode(
        _tolerance_defined: Boolean, _tolerance: f64, start_s: f64, _stop_defined: Boolean, _stop_s: f64
    ) |unit| unit.start_at(start_s).and_then(|()| unit.enter_initialization());
    fn fmi3ExitInitializationMode() |unit| unit.exit_initialization();
    fn fmi3Terminate() |unit| unit.terminate();
    fn fmi3Reset() |unit| unit.reset();
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DoStep(
    component: *mut c_void,
    from_s: f64,
    step_s: f64,
    _no_state_before: Boolean,
    event_handling_needed: *mut Boolean,
    terminate_simulation: *mut Boolean,
    early_return: *mut Boolean,
    last_successful_s: *mut f64,
) -> Status {
    // SAFETY: a master hands over a component and places of its own.
    unsafe {
        border::with(component, |unit| {
            for place in [event_handling_needed, terminate_simulation, early_return] {
                if let Some(place) = place.as_mut() {
                    *place = 0;
                }
            }
            let done = unit.step(from_s, step_s);
            if let Some(last_s) = last_successful_s.as_mut() {
                *last_s = unit.get(0, Access::Real).unwrap_or(from_s);
            }
            done.map_err(|error| error.to_string())
        })
    }
}

macro_rules! values {
    ($(fn $get:ident, $set:ident($kind:ty) $access:expr;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $get(
            component: *mut c_void,
            references: *const u32,
            count: usize,
            values: *mut $kind,
            room: usize,
        ) -> Status {
            // SAFETY: a master hands over a component of its own and arrays of so many.
            unsafe { border::get(component, (references, count), (values, room), $access) }
        }

        #[unsafe(no_mangle)]
        unsafe extern "C" fn $set(
            component: *mut c_void,
            references: *const u32,
            count: usize,
            values: *const $kind,
            given: usize,
        ) -> Status {
            // SAFETY: a master hands over a component of its own and arrays of so many.
            unsafe { border::set(component, (references, count), (values, given), $access) }
        }
    )*};
}

values! {
    fn fmi3GetFloat64, fmi3SetFloat64(f64) Access::Real;
    fn fmi3GetInt32, fmi3SetInt32(i32) Access::Integer;
    fn fmi3GetInt64, fmi3SetInt64(i64) Access::Enumeration;
}

none_of! {
    fn fmi3GetFloat32(*mut f32, usize) "there are no variables of type Float32";
    fn fmi3SetFloat32(*const f32, usize) "there are no variables of type Float32";
    fn fmi3GetInt8(*mut i8, usize) "there are no variables of type Int8";
    fn fmi3SetInt8(*const i8, usize) "there are no variables of type Int8";
    fn fmi3GetUInt8(*mut u8, usize) "there are no variables of type UInt8";
    fn fmi3SetUInt8(*const u8, usize) "there are no variables of type UInt8";
    fn fmi3GetInt16(*mut i16, usize) "there are no variables of type Int16";
    fn fmi3SetInt16(*const i16, usize) "there are no variables of type Int16";
    fn fmi3GetUInt16(*mut u16, usize) "there are no variables of type UInt16";
    fn fmi3SetUInt16(*const u16, usize) "there are no variables of type UInt16";
    fn fmi3GetUInt32(*mut u32, usize) "there are no variables of type UInt32";
    fn fmi3SetUInt32(*const u32, usize) "there are no variables of type UInt32";
    fn fmi3GetUInt64(*mut u64, usize) "there are no variables of type UInt64";
    fn fmi3SetUInt64(*const u64, usize) "there are no variables of type UInt64";
    fn fmi3GetBoolean(*mut Boolean, usize) "there are no booleans";
    fn fmi3SetBoolean(*const Boolean, usize) "there are no booleans";
    fn fmi3GetString(*mut *const c_char, usize) "there are no strings";
    fn fmi3SetString(*const *const c_char, usize) "there are no strings";
    fn fmi3GetBinary(*mut usize, *mut *const u8, usize) "there are no variables of type Binary";
    fn fmi3SetBinary(*const usize, *const *const u8, usize) "there are no variables of type Binary";
    fn fmi3GetClock(*mut Boolean) "there are no clocks";
    fn fmi3SetClock(*const Boolean) "there are no clocks";
    fn fmi3GetIntervalDecimal(*mut f64, *mut c_int) "there are no clocks";
    fn fmi3GetIntervalFraction(*mut u64, *mut u64, *mut c_int) "there are no clocks";
    fn fmi3GetShiftDecimal(*mut f64) "there are no clocks";
    fn fmi3GetShiftFraction(*mut u64, *mut u64) "there are no clocks";
    fn fmi3SetIntervalDecimal(*const f64) "there are no clocks";
    fn fmi3SetIntervalFraction(*const u64, *const u64) "there are no clocks";
    fn fmi3SetShiftDecimal(*const f64) "there are no clocks";
    fn fmi3SetShiftFraction(*const u64, *const u64) "there are no clocks";
    fn fmi3GetOutputDerivatives(*const i32, *mut f64, usize) "there are no derivatives of outputs";
}

refused! {
    fn fmi3GetNumberOfVariableDependencies(u32, *mut usize) "dependencies are not told one by one";
    fn fmi3GetVariableDependencies(u32, *mut usize, *mut u32, *mut usize, *mut c_int, usize)
        "dependencies are not told one by one";
    fn fmi3GetDirectionalDerivative(
        *const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize
    ) "there are no directional derivatives";
    fn fmi3GetAdjointDerivative(
        *const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize
    ) "there are no adjoint derivatives";
    fn fmi3EnterConfigurationMode() "there are no structural parameters";
    fn fmi3ExitConfigurationMode() "there are no structural parameters";
    fn fmi3EnterEventMode() "there is no event mode: events are outputs";
    fn fmi3EnterStepMode() "there is no event mode: steps follow the initialization";
    fn fmi3EvaluateDiscreteStates() "there is no event mode";
    fn fmi3UpdateDiscreteStates(
        *mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut f64
    ) "there is no event mode";
    fn fmi3EnterContinuousTimeMode() "this is a unit for co-simulation";
    fn fmi3CompletedIntegratorStep(Boolean, *mut Boolean, *mut Boolean) "this is a unit for co-simulation";
    fn fmi3SetTime(f64) "this is a unit for co-simulation";
    fn fmi3SetContinuousStates(*const f64, usize) "this is a unit for co-simulation";
    fn fmi3GetContinuousStateDerivatives(*mut f64, usize) "this is a unit for co-simulation";
    fn fmi3GetEventIndicators(*mut f64, usize) "this is a unit for co-simulation";
    fn fmi3GetContinuousStates(*mut f64, usize) "this is a unit for co-simulation";
    fn fmi3GetNominalsOfContinuousStates(*mut f64, usize) "this is a unit for co-simulation";
    fn fmi3GetNumberOfEventIndicators(*mut usize) "this is a unit for co-simulation";
    fn fmi3GetNumberOfContinuousStates(*mut usize) "this is a unit for co-simulation";
    fn fmi3ActivateModelPartition(u32, f64) "this is a unit for co-simulation";
}

states! {
    fmi3GetFMUState, fmi3SetFMUState, fmi3FreeFMUState, fmi3SerializedFMUStateSize, fmi3SerializeFMUState,
    fmi3DeserializeFMUState
}
