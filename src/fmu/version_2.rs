//! The functions of FMI 2.0.

#![allow(unsafe_code, reason = "importers find functions by their names alone")]
#![allow(non_snake_case, reason = "the names are those of the standard")]

use crate::boundary::{
    DISCARD, Handle, Log, Logger, Logger2, call, folder, free_state, get, get_strings, hand_over,
    keep_state, read_state, restore_state, set, set_strings, slice, slice_mut, state_size, strings,
    take_back, text, write, write_state,
};
use crate::fmi::export::ValueKind;
use crate::instance::{Instance, InterfaceKind, Wrong};
use crate::loading::load;
use crate::signatures::{filled, plain, states};
use crate::sim::Ended;
use std::ffi::{CString, c_char, c_int, c_uint, c_void};

const REAL: &[ValueKind] = &[ValueKind::Real];
const INTEGER: &[ValueKind] = &[ValueKind::Integer, ValueKind::Enumeration];
const BOOLEAN: &[ValueKind] = &[ValueKind::Boolean];

/// `fmi2CoSimulation`
const CO_SIMULATION: c_int = 1;

/// `fmi2CallbackFunctions`
#[repr(C)]
struct Callbacks {
    logger: Option<Logger2>,
    allocate: *const c_void,
    free: *const c_void,
    step_finished: *const c_void,
    environment: *mut c_void,
}

/// `fmi2EventInfo`
#[repr(C)]
struct EventInfo {
    needs_update: c_int,
    terminates: c_int,
    nominals_changed: c_int,
    states_changed: c_int,
    next_event_defined: c_int,
    next_event: f64,
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
extern "C" fn fmi2SetDebugLogging(
    instance: *mut c_void,
    logging_on: c_int,
    n: usize,
    categories: *const *const c_char,
) -> c_int {
    call(instance, "fmi2SetDebugLogging", |handle| {
        handle.log.is_on = logging_on != 0;
        handle.log.categories = strings(categories, n)?;
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    token: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: c_int,
    logging_on: c_int,
) -> *mut c_void {
    let Ok([callbacks]) = slice(callbacks, 1) else { return std::ptr::null_mut() };
    let kind = match kind {
        CO_SIMULATION => {
            InterfaceKind::CoSimulation { has_event_mode: false, returns_early: false }
        }
        _ => InterfaceKind::ModelExchange,
    };
    let log = Log {
        logger: Logger::Version2(callbacks.logger),
        environment: callbacks.environment,
        name: CString::new(text(name)).unwrap_or_default(),
        is_on: logging_on != 0,
        categories: Vec::new(),
    };
    hand_over(log, "fmi2Instantiate", || {
        let model = load(&folder(&text(resources)), &text(token))?;
        Ok(Instance::new(model, kind))
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2FreeInstance(instance: *mut c_void) {
    take_back(instance);
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetupExperiment(
    instance: *mut c_void,
    tolerance_defined: c_int,
    tolerance: f64,
    start: f64,
    stop_defined: c_int,
    stop: f64,
) -> c_int {
    call(instance, "fmi2SetupExperiment", |handle| {
        let tolerance = Some(tolerance).filter(|_| tolerance_defined != 0);
        handle.instance.set_experiment(tolerance, start, Some(stop).filter(|_| stop_defined != 0))
    })
}

plain! {
    fmi2EnterInitializationMode = |handle| handle.instance.enter_initialization();
    fmi2ExitInitializationMode = |handle| handle.instance.exit_initialization();
    fmi2Terminate = |handle| handle.instance.terminate();
    fmi2Reset = |handle| {
        handle.instance.reset();
        handle.is_terminated = false;
        Ok(())
    };
    fmi2EnterEventMode = |handle| handle.instance.enter_event_mode();
    fmi2EnterContinuousTimeMode = |handle| handle.instance.enter_continuous_mode();
    fmi2CancelStep = |_| Err("no step is in progress: steps end before their functions".into());
}

/// Getters and setters of a type.
macro_rules! values {
    ($($get:ident, $set:ident: $type:ty = $kinds:expr, $of:expr, $to:expr;)*) => {
        $(
            #[unsafe(no_mangle)]
            extern "C" fn $get(
                instance: *mut c_void,
                references: *const c_uint,
                n: usize,
                values: *mut $type,
            ) -> c_int {
                call(instance, stringify!($get), |handle| {
                    let (references, values) = (slice(references, n)?, slice_mut(values, n)?);
                    get(handle, $kinds, $of, (references, values))
                })
            }

            #[unsafe(no_mangle)]
            extern "C" fn $set(
                instance: *mut c_void,
                references: *const c_uint,
                n: usize,
                values: *const $type,
            ) -> c_int {
                call(instance, stringify!($set), |handle| {
                    let (references, values) = (slice(references, n)?, slice(values, n)?);
                    set(handle, $kinds, $to, (references, values))
                })
            }
        )*
    };
}

values! {
    fmi2GetReal, fmi2SetReal: f64 = REAL, Ok, |value| value;
    fmi2GetInteger, fmi2SetInteger: c_int = INTEGER, integer, f64::from;
    fmi2GetBoolean, fmi2SetBoolean: c_int = BOOLEAN,
        |value| Ok(c_int::from(value != 0.0)), |value| f64::from(u8::from(value != 0));
}

fn integer(value: f64) -> Result<c_int, Wrong> {
    match value as c_int {
        whole if f64::from(whole) == value => Ok(whole),
        _ => Err(Wrong::Error(format!("{value} is too large for an Integer of FMI 2.0"))),
    }
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetString(
    instance: *mut c_void,
    references: *const c_uint,
    n: usize,
    values: *mut *const c_char,
) -> c_int {
    call(instance, "fmi2GetString", |handle| {
        get_strings(handle, (slice(references, n)?, slice_mut(values, n)?))
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetString(
    instance: *mut c_void,
    _references: *const c_uint,
    n: usize,
    _values: *const *const c_char,
) -> c_int {
    call(instance, "fmi2SetString", |_| set_strings(n))
}

states!(
    fmi2GetFMUstate,
    fmi2SetFMUstate,
    fmi2FreeFMUstate,
    fmi2SerializedFMUstateSize,
    fmi2SerializeFMUstate,
    fmi2DeSerializeFMUstate
);

#[unsafe(no_mangle)]
extern "C" fn fmi2GetDirectionalDerivative(
    instance: *mut c_void,
    unknowns: *const c_uint,
    n_unknowns: usize,
    knowns: *const c_uint,
    n_knowns: usize,
    seed: *const f64,
    sensitivity: *mut f64,
) -> c_int {
    call(instance, "fmi2GetDirectionalDerivative", |handle| {
        let (unknowns, knowns) = (slice(unknowns, n_unknowns)?, slice(knowns, n_knowns)?);
        let (seed, out) = (slice(seed, n_knowns)?, slice_mut(sensitivity, n_unknowns)?);
        handle.instance.along((unknowns, knowns), seed, out)
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2NewDiscreteStates(instance: *mut c_void, info: *mut EventInfo) -> c_int {
    call(instance, "fmi2NewDiscreteStates", |handle| {
        let updated = handle.instance.update()?;
        handle.log.say(0, "logEvents", &format!("event at t = {}", handle.instance.state.time));
        write(
            info,
            EventInfo {
                needs_update: updated.needs_update.into(),
                terminates: updated.terminates.into(),
                nominals_changed: 0,
                states_changed: updated.states_changed.into(),
                next_event_defined: updated.next_event.is_some().into(),
                next_event: updated.next_event.unwrap_or(0.0),
            },
        );
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2CompletedIntegratorStep(
    instance: *mut c_void,
    _no_set_state_before: c_int,
    enter_event_mode: *mut c_int,
    terminates: *mut c_int,
) -> c_int {
    call(instance, "fmi2CompletedIntegratorStep", |handle| {
        write(enter_event_mode, 0);
        write(terminates, 0);
        let is_due = handle.instance.complete_step()?;
        write(enter_event_mode, c_int::from(is_due));
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetTime(instance: *mut c_void, time: f64) -> c_int {
    call(instance, "fmi2SetTime", |handle| handle.instance.set_time(time))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2SetContinuousStates(
    instance: *mut c_void,
    states: *const f64,
    n: usize,
) -> c_int {
    call(instance, "fmi2SetContinuousStates", |handle| {
        handle.instance.set_states(slice(states, n)?)
    })
}

filled! {
    fmi2GetDerivatives = derivatives;
    fmi2GetEventIndicators = event_indicators;
    fmi2GetContinuousStates = states;
    fmi2GetNominalsOfContinuousStates = nominals;
}

const NO_INPUT_DERIVATIVES: &str = "inputs are held between communication points";

#[unsafe(no_mangle)]
extern "C" fn fmi2SetRealInputDerivatives(
    instance: *mut c_void,
    _references: *const c_uint,
    _n: usize,
    _orders: *const c_int,
    _values: *const f64,
) -> c_int {
    call(instance, "fmi2SetRealInputDerivatives", |_| Err(NO_INPUT_DERIVATIVES.into()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetRealOutputDerivatives(
    instance: *mut c_void,
    _references: *const c_uint,
    _n: usize,
    _orders: *const c_int,
    _values: *mut f64,
) -> c_int {
    call(instance, "fmi2GetRealOutputDerivatives", |_| {
        Err("derivatives of outputs are not offered (maxOutputDerivativeOrder is 0)".into())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi2DoStep(
    instance: *mut c_void,
    from: f64,
    length: f64,
    _no_set_state_before: c_int,
) -> c_int {
    let mut terminates = false;
    let status = call(instance, "fmi2DoStep", |handle| {
        let stepped = handle.instance.do_step(from, length);
        handle.last_successful_time = handle.instance.state.time;
        terminates = stepped? == Ended::Terminated;
        handle.is_terminated = terminates;
        Ok(())
    });
    // A step that the model has ended is not complete.
    if terminates { DISCARD } else { status }
}

/// `fmi2Terminated`
const TERMINATED: c_int = 3;
/// `fmi2LastSuccessfulTime`
const LAST_SUCCESSFUL_TIME: c_int = 2;

/// Functions that say how the last step ended.
macro_rules! statuses {
    ($($name:ident: $type:ty = $kind:pat, $value:expr;)*) => {
        $(
            #[unsafe(no_mangle)]
            extern "C" fn $name(instance: *mut c_void, kind: c_int, value: *mut $type) -> c_int {
                call(instance, stringify!($name), |handle| match kind {
                    $kind => {
                        let of: fn(&Handle) -> $type = $value;
                        write(value, of(handle));
                        Ok(())
                    }
                    _ => Err("nothing is known of this: no step is in progress".into()),
                })
            }
        )*
    };
}

statuses! {
    fmi2GetRealStatus: f64 = LAST_SUCCESSFUL_TIME, |handle| handle.last_successful_time;
    fmi2GetBooleanStatus: c_int = TERMINATED, |handle| c_int::from(handle.is_terminated);
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetStatus(instance: *mut c_void, _kind: c_int, _value: *mut c_int) -> c_int {
    call(instance, "fmi2GetStatus", |_| Err("no step is in progress".into()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetIntegerStatus(
    instance: *mut c_void,
    _kind: c_int,
    _value: *mut c_int,
) -> c_int {
    call(instance, "fmi2GetIntegerStatus", |_| Err("no step is in progress".into()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetStringStatus(
    instance: *mut c_void,
    _kind: c_int,
    _value: *mut *const c_char,
) -> c_int {
    call(instance, "fmi2GetStringStatus", |_| Err("no step is in progress".into()))
}
