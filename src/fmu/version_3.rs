//! The functions of FMI 3.0.

#![allow(unsafe_code, reason = "importers find functions by their names alone")]
#![allow(non_snake_case, reason = "the names are those of the standard")]

use crate::boundary::{
    Handle, Log, Logger, Logger3, call, folder, free_state, get, get_strings, hand_over,
    keep_state, read_state, restore_state, set, set_strings, slice, slice_mut, state_size, strings,
    take_back, text, write, write_state,
};
use crate::fmi::export::ValueKind;
use crate::instance::{Instance, InterfaceKind, Wrong};
use crate::loading::load;
use crate::signatures::{filled, plain, states};
use crate::sim::Ended;
use std::ffi::{CString, c_char, c_int, c_void};

const FLOAT: &[ValueKind] = &[ValueKind::Real];
const INTEGER: &[ValueKind] = &[ValueKind::Integer, ValueKind::Enumeration];
const BOOLEAN: &[ValueKind] = &[ValueKind::Boolean];

#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetDebugLogging(
    instance: *mut c_void,
    logging_on: bool,
    n: usize,
    categories: *const *const c_char,
) -> c_int {
    call(instance, "fmi3SetDebugLogging", |handle| {
        handle.log.is_on = logging_on;
        handle.log.categories = strings(categories, n)?;
        Ok(())
    })
}

fn instantiate(
    function: &str,
    (name, token, resources): (*const c_char, *const c_char, *const c_char),
    logging_on: bool,
    (environment, logger): (*mut c_void, Option<Logger3>),
    kind: InterfaceKind,
) -> *mut c_void {
    let log = Log {
        logger: Logger::Version3(logger),
        environment,
        name: CString::new(text(name)).unwrap_or_default(),
        is_on: logging_on,
        categories: Vec::new(),
    };
    hand_over(log, function, || {
        let model = load(&folder(&text(resources)), &text(token))?;
        Ok(Instance::new(model, kind))
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateModelExchange(
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    logging_on: bool,
    environment: *mut c_void,
    logger: Option<Logger3>,
) -> *mut c_void {
    let function = "fmi3InstantiateModelExchange";
    let kind = InterfaceKind::ModelExchange;
    instantiate(function, (name, token, resources), logging_on, (environment, logger), kind)
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateCoSimulation(
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    logging_on: bool,
    has_event_mode: bool,
    returns_early: bool,
    _required: *const u32,
    _n_required: usize,
    environment: *mut c_void,
    logger: Option<Logger3>,
    _intermediate_update: *const c_void,
) -> *mut c_void {
    let function = "fmi3InstantiateCoSimulation";
    let kind = InterfaceKind::CoSimulation { has_event_mode, returns_early };
    instantiate(function, (name, token, resources), logging_on, (environment, logger), kind)
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging_on: bool,
    environment: *mut c_void,
    logger: Option<Logger3>,
    _clock_update: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> *mut c_void {
    let (name, categories) = (CString::default(), Vec::new());
    let logger = Logger::Version3(logger);
    let log = Log { logger, environment, name, is_on: false, categories };
    let wrong = Wrong::from("the unit does not offer scheduled execution");
    log.failed("fmi3InstantiateScheduledExecution", &wrong);
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
extern "C" fn fmi3FreeInstance(instance: *mut c_void) {
    take_back(instance);
}

#[unsafe(no_mangle)]
extern "C" fn fmi3EnterInitializationMode(
    instance: *mut c_void,
    tolerance_defined: bool,
    tolerance: f64,
    start: f64,
    stop_defined: bool,
    stop: f64,
) -> c_int {
    call(instance, "fmi3EnterInitializationMode", |handle| {
        let tolerance = tolerance_defined.then_some(tolerance);
        handle.instance.set_experiment(tolerance, start, stop_defined.then_some(stop))?;
        handle.instance.enter_initialization()
    })
}

plain! {
    fmi3ExitInitializationMode = |handle| handle.instance.exit_initialization();
    fmi3EnterEventMode = |handle| handle.instance.enter_event_mode();
    fmi3Terminate = |handle| handle.instance.terminate();
    fmi3EnterContinuousTimeMode = |handle| handle.instance.enter_continuous_mode();
    fmi3Reset = |handle| {
        handle.instance.reset();
        Ok(())
    };
    fmi3EnterConfigurationMode = |_| Err("there are no structural parameters".into());
    fmi3ExitConfigurationMode = |_| Err("there are no structural parameters".into());
    fmi3EvaluateDiscreteStates = |_| Err("discrete states are updated at events alone".into());
    fmi3EnterStepMode = |handle| handle.instance.enter_step_mode();
}

/// Getters and setters of a type.
macro_rules! values {
    ($($get:ident, $set:ident: $type:ty = $kinds:expr, $of:expr, $to:expr;)*) => {
        $(
            #[unsafe(no_mangle)]
            extern "C" fn $get(
                instance: *mut c_void,
                references: *const u32,
                n_references: usize,
                values: *mut $type,
                n: usize,
            ) -> c_int {
                call(instance, stringify!($get), |handle| {
                    let references = slice(references, n_references)?;
                    let values = slice_mut(values, same(n, n_references)?)?;
                    get(handle, $kinds, $of, (references, values))
                })
            }

            #[unsafe(no_mangle)]
            extern "C" fn $set(
                instance: *mut c_void,
                references: *const u32,
                n_references: usize,
                values: *const $type,
                n: usize,
            ) -> c_int {
                call(instance, stringify!($set), |handle| {
                    let references = slice(references, n_references)?;
                    let values = slice(values, same(n, n_references)?)?;
                    set(handle, $kinds, $to, (references, values))
                })
            }
        )*
    };
}

#[unsafe(no_mangle)]
extern "C" fn fmi3GetString(
    instance: *mut c_void,
    references: *const u32,
    n_references: usize,
    values: *mut *const c_char,
    n: usize,
) -> c_int {
    call(instance, "fmi3GetString", |handle| {
        let references = slice(references, n_references)?;
        get_strings(handle, (references, slice_mut(values, same(n, n_references)?)?))
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetString(
    instance: *mut c_void,
    _references: *const u32,
    n_references: usize,
    _values: *const *const c_char,
    _n: usize,
) -> c_int {
    call(instance, "fmi3SetString", |_| set_strings(n_references))
}

/// All variables are scalars.
fn same(n: usize, n_references: usize) -> Result<usize, Wrong> {
    match n == n_references {
        true => Ok(n),
        false => Err("there must be one value for each value reference".into()),
    }
}

values! {
    fmi3GetFloat64, fmi3SetFloat64: f64 = FLOAT, Ok, |value| value;
    fmi3GetInt64, fmi3SetInt64: i64 = INTEGER, |value| Ok(value as i64), |value| value as f64;
    fmi3GetBoolean, fmi3SetBoolean: bool = BOOLEAN,
        |value| Ok(value != 0.0), |value| f64::from(u8::from(value));
    fmi3GetFloat32, fmi3SetFloat32: f32 = &[], |value| Ok(value as f32), f64::from;
    fmi3GetInt8, fmi3SetInt8: i8 = &[], |value| Ok(value as i8), f64::from;
    fmi3GetUInt8, fmi3SetUInt8: u8 = &[], |value| Ok(value as u8), f64::from;
    fmi3GetInt16, fmi3SetInt16: i16 = &[], |value| Ok(value as i16), f64::from;
    fmi3GetUInt16, fmi3SetUInt16: u16 = &[], |value| Ok(value as u16), f64::from;
    fmi3GetInt32, fmi3SetInt32: i32 = &[], |value| Ok(value as i32), f64::from;
    fmi3GetUInt32, fmi3SetUInt32: u32 = &[], |value| Ok(value as u32), f64::from;
    fmi3GetUInt64, fmi3SetUInt64: u64 = &[], |value| Ok(value as u64), |value| value as f64;
}

/// Functions for what a unit does not have: fine where nothing is asked for.
macro_rules! absent {
    ($($name:ident($($argument:ident: $type:ty),*) = $what:literal;)*) => {
        $(
            #[unsafe(no_mangle)]
            extern "C" fn $name(
                instance: *mut c_void,
                _references: *const u32,
                count: usize,
                $($argument: $type),*
            ) -> c_int {
                $(let _ = $argument;)*
                call(instance, stringify!($name), |_| match count {
                    0 => Ok(()),
                    _ => Err(Wrong::from(concat!("the unit has no ", $what))),
                })
            }
        )*
    };
}

absent! {
    fmi3GetBinary(_sizes: *mut usize, _values: *mut *const u8, _values_count: usize) = "binary variables";
    fmi3SetBinary(_sizes: *const usize, _values: *const *const u8, _values_count: usize) = "binary variables";
    fmi3GetClock(_values: *mut bool) = "clocks";
    fmi3SetClock(_values: *const bool) = "clocks";
    fmi3GetIntervalDecimal(_values: *mut f64, _qualifiers: *mut c_int) = "clocks";
    fmi3GetIntervalFraction(_a: *mut u64, _b: *mut u64, _qualifiers: *mut c_int) = "clocks";
    fmi3GetShiftDecimal(_values: *mut f64) = "clocks";
    fmi3GetShiftFraction(_a: *mut u64, _b: *mut u64) = "clocks";
    fmi3SetIntervalDecimal(_values: *const f64) = "clocks";
    fmi3SetIntervalFraction(_a: *const u64, _b: *const u64) = "clocks";
    fmi3SetShiftDecimal(_values: *const f64) = "clocks";
    fmi3SetShiftFraction(_a: *const u64, _b: *const u64) = "clocks";
    fmi3GetOutputDerivatives(_orders: *const i32, _values: *mut f64, _values_count: usize) = "derivatives of outputs";
}

#[unsafe(no_mangle)]
extern "C" fn fmi3ActivateModelPartition(instance: *mut c_void, _clock: u32, _time: f64) -> c_int {
    call(instance, "fmi3ActivateModelPartition", |_| Err("the unit has no partitions".into()))
}

const NO_DEPENDENCIES: &str = "dependencies are those of the description";

#[unsafe(no_mangle)]
extern "C" fn fmi3GetNumberOfVariableDependencies(
    instance: *mut c_void,
    _reference: u32,
    _n: *mut usize,
) -> c_int {
    call(instance, "fmi3GetNumberOfVariableDependencies", |_| Err(NO_DEPENDENCIES.into()))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3GetVariableDependencies(
    instance: *mut c_void,
    _dependent: u32,
    _elements: *mut usize,
    _independents: *mut u32,
    _elements_of_independents: *mut usize,
    _kinds: *mut c_int,
    _n: usize,
) -> c_int {
    call(instance, "fmi3GetVariableDependencies", |_| Err(NO_DEPENDENCIES.into()))
}

states!(
    fmi3GetFMUState,
    fmi3SetFMUState,
    fmi3FreeFMUState,
    fmi3SerializedFMUStateSize,
    fmi3SerializeFMUState,
    fmi3DeserializeFMUState
);

/// Declares a function of derivatives: `$seeds` and `$results` are the numbers of values that it takes and
/// gives.
macro_rules! derivatives {
    ($name:ident, $run:ident, ($n_unknowns:ident, $n_knowns:ident), $seeds:ident, $results:ident) => {
        #[unsafe(no_mangle)]
        extern "C" fn $name(
            instance: *mut c_void,
            unknowns: *const u32,
            $n_unknowns: usize,
            knowns: *const u32,
            $n_knowns: usize,
            seed: *const f64,
            n_seed: usize,
            sensitivity: *mut f64,
            n_sensitivity: usize,
        ) -> c_int {
            call(instance, stringify!($name), |handle| {
                let (unknowns, knowns) = (slice(unknowns, $n_unknowns)?, slice(knowns, $n_knowns)?);
                let seed = slice(seed, same(n_seed, $seeds)?)?;
                let out = slice_mut(sensitivity, same(n_sensitivity, $results)?)?;
                handle.instance.$run((unknowns, knowns), seed, out)
            })
        }
    };
}

derivatives!(fmi3GetDirectionalDerivative, along, (n_unknowns, n_knowns), n_knowns, n_unknowns);
derivatives!(fmi3GetAdjointDerivative, backwards, (n_unknowns, n_knowns), n_unknowns, n_knowns);

#[unsafe(no_mangle)]
extern "C" fn fmi3UpdateDiscreteStates(
    instance: *mut c_void,
    needs_update: *mut bool,
    terminates: *mut bool,
    nominals_changed: *mut bool,
    states_changed: *mut bool,
    next_event_defined: *mut bool,
    next_event: *mut f64,
) -> c_int {
    call(instance, "fmi3UpdateDiscreteStates", |handle| {
        let updated = handle.instance.update()?;
        handle.log.say(0, "logEvents", &format!("event at t = {}", handle.instance.state.time));
        write(needs_update, updated.needs_update);
        write(terminates, updated.terminates);
        write(nominals_changed, false);
        write(states_changed, updated.states_changed);
        write(next_event_defined, updated.next_event.is_some());
        write(next_event, updated.next_event.unwrap_or(0.0));
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3CompletedIntegratorStep(
    instance: *mut c_void,
    _no_set_state_before: bool,
    enter_event_mode: *mut bool,
    terminates: *mut bool,
) -> c_int {
    call(instance, "fmi3CompletedIntegratorStep", |handle| {
        write(enter_event_mode, false);
        write(terminates, false);
        let is_due = handle.instance.complete_step()?;
        write(enter_event_mode, is_due);
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetTime(instance: *mut c_void, time: f64) -> c_int {
    call(instance, "fmi3SetTime", |handle| handle.instance.set_time(time))
}

#[unsafe(no_mangle)]
extern "C" fn fmi3SetContinuousStates(
    instance: *mut c_void,
    states: *const f64,
    n: usize,
) -> c_int {
    call(instance, "fmi3SetContinuousStates", |handle| {
        handle.instance.set_states(slice(states, n)?)
    })
}

filled! {
    fmi3GetContinuousStateDerivatives = derivatives;
    fmi3GetEventIndicators = event_indicators;
    fmi3GetContinuousStates = states;
    fmi3GetNominalsOfContinuousStates = nominals;
}

#[unsafe(no_mangle)]
extern "C" fn fmi3GetNumberOfEventIndicators(instance: *mut c_void, n: *mut usize) -> c_int {
    call(instance, "fmi3GetNumberOfEventIndicators", |handle| {
        write(n, handle.instance.model.program.n_indicators());
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3GetNumberOfContinuousStates(instance: *mut c_void, n: *mut usize) -> c_int {
    call(instance, "fmi3GetNumberOfContinuousStates", |handle| {
        write(n, handle.instance.model.content.states.len());
        Ok(())
    })
}

#[unsafe(no_mangle)]
extern "C" fn fmi3DoStep(
    instance: *mut c_void,
    from: f64,
    length: f64,
    _no_set_state_before: bool,
    event_handling_needed: *mut bool,
    terminates: *mut bool,
    early_return: *mut bool,
    last_successful_time: *mut f64,
) -> c_int {
    call(instance, "fmi3DoStep", |handle| {
        write(event_handling_needed, false);
        write(early_return, false);
        write(terminates, false);
        let stepped = handle.instance.do_step(from, length);
        let time = handle.instance.state.time;
        write(last_successful_time, time);
        let stepped = stepped?;
        write(terminates, stepped == Ended::Terminated);
        write(event_handling_needed, stepped == Ended::AtEvent);
        write(early_return, stepped == Ended::AtEvent && time < from + length);
        Ok(())
    })
}
