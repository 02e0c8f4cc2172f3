//! The functions of a shared library as the standards declare them: FMI 2.0.5, chapter 2 to 4, and
//! FMI 3.0.2, chapter 2 to 4. A library need not have what a kind does not use: what is missing is
//! refused when it is called.

#![allow(unsafe_code, reason = "functions of another language have no safe types")]

use super::calls::CallWatch;
use libloading::Library;
use std::ffi::{c_char, c_int, c_void};

/// An instance of the library.
pub(super) type Handle = *mut c_void;
/// What a function says of itself.
pub(super) type Status = c_int;
/// `fmi2Boolean`.
pub(super) type Truth2 = c_int;

/// A function with its name.
#[derive(Clone, Copy)]
pub(super) struct Function<F> {
    pub name: &'static str,
    /// By which the watch of calls knows it.
    pub number: u64,
    /// `None` where the library does not have it.
    pub pointer: Option<F>,
}

/// Declares a table of functions, each of which a library may have or not.
macro_rules! table {
    ($(#[$about:meta])* $table:ident { $($field:ident = $symbol:literal ($($argument:ty),*) -> $result:ty;)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy)]
        pub(super) struct $table {
            $(pub $field: Function<unsafe extern "C" fn($($argument),*) -> $result>,)*
        }

        impl $table {
            /// The functions that the library has.
            pub(crate) fn of(library: &Library, watch: &CallWatch) -> $table {
                // SAFETY: the standard gives these functions these types.
                unsafe {
                    $table {
                        $($field: Function {
                            name: $symbol,
                            number: watch.number_of($symbol),
                            pointer: library.get($symbol).ok().map(|symbol| *symbol),
                        },)*
                    }
                }
            }
        }
    };
}

/// What an importer gives to an instance of FMI 2.0. The logger takes further arguments, which
/// its message refers to like those of `printf`; they are left where they are.
#[repr(C)]
pub(super) struct Callbacks2 {
    pub logger: unsafe extern "C" fn(Handle, *const c_char, Status, *const c_char, *const c_char),
    pub allocate: unsafe extern "C" fn(usize, usize) -> *mut c_void,
    pub free: unsafe extern "C" fn(*mut c_void),
    pub step_finished: Option<unsafe extern "C" fn(Handle, Status)>,
    pub environment: *mut c_void,
}

/// `fmi2EventInfo`.
#[repr(C)]
#[derive(Default)]
pub(super) struct EventInfo2 {
    pub needs_update: Truth2,
    pub terminates: Truth2,
    pub nominals_changed: Truth2,
    pub states_changed: Truth2,
    pub has_next_event: Truth2,
    pub next_event: f64,
}

/// Takes a message of FMI 3.0: environment, status, category, message.
pub(super) type Logger3 = unsafe extern "C" fn(Handle, Status, *const c_char, *const c_char);
/// Is called by parts of scheduled execution: that a clock has changed, and around what must not be
/// interrupted.
pub(super) type ClockUpdate3 = unsafe extern "C" fn(Handle);
pub(super) type Lock3 = unsafe extern "C" fn();
/// Is called within steps of co-simulation.
pub(super) type Intermediate3 = Option<unsafe extern "C" fn()>;

table! {
    /// FMI 2.0.
    Functions2 {
        version = "fmi2GetVersion" () -> *const c_char;
        instantiate = "fmi2Instantiate" (*const c_char, c_int, *const c_char, *const c_char, *const Callbacks2, Truth2, Truth2) -> Handle;
        free_instance = "fmi2FreeInstance" (Handle) -> ();
        setup_experiment = "fmi2SetupExperiment" (Handle, Truth2, f64, f64, Truth2, f64) -> Status;
        enter_initialization = "fmi2EnterInitializationMode" (Handle) -> Status;
        exit_initialization = "fmi2ExitInitializationMode" (Handle) -> Status;
        terminate = "fmi2Terminate" (Handle) -> Status;
        get_real = "fmi2GetReal" (Handle, *const u32, usize, *mut f64) -> Status;
        get_integer = "fmi2GetInteger" (Handle, *const u32, usize, *mut c_int) -> Status;
        get_boolean = "fmi2GetBoolean" (Handle, *const u32, usize, *mut c_int) -> Status;
        set_real = "fmi2SetReal" (Handle, *const u32, usize, *const f64) -> Status;
        set_integer = "fmi2SetInteger" (Handle, *const u32, usize, *const c_int) -> Status;
        set_boolean = "fmi2SetBoolean" (Handle, *const u32, usize, *const c_int) -> Status;
        set_string = "fmi2SetString" (Handle, *const u32, usize, *const *const c_char) -> Status;
        enter_event_mode = "fmi2EnterEventMode" (Handle) -> Status;
        new_discrete_states = "fmi2NewDiscreteStates" (Handle, *mut EventInfo2) -> Status;
        enter_continuous_mode = "fmi2EnterContinuousTimeMode" (Handle) -> Status;
        completed_step = "fmi2CompletedIntegratorStep" (Handle, Truth2, *mut Truth2, *mut Truth2) -> Status;
        set_time = "fmi2SetTime" (Handle, f64) -> Status;
        set_states = "fmi2SetContinuousStates" (Handle, *const f64, usize) -> Status;
        get_states = "fmi2GetContinuousStates" (Handle, *mut f64, usize) -> Status;
        get_derivatives = "fmi2GetDerivatives" (Handle, *mut f64, usize) -> Status;
        get_indicators = "fmi2GetEventIndicators" (Handle, *mut f64, usize) -> Status;
        directional = "fmi2GetDirectionalDerivative" (Handle, *const u32, usize, *const u32, usize, *const f64, *mut f64) -> Status;
        boolean_status = "fmi2GetBooleanStatus" (Handle, c_int, *mut Truth2) -> Status;
        real_status = "fmi2GetRealStatus" (Handle, c_int, *mut f64) -> Status;
        set_input_derivatives = "fmi2SetRealInputDerivatives" (Handle, *const u32, usize, *const c_int, *const f64) -> Status;
        do_step = "fmi2DoStep" (Handle, f64, f64, Truth2) -> Status;
    }
}

table! {
    /// FMI 3.0.
    Functions3 {
        version = "fmi3GetVersion" () -> *const c_char;
        instantiate_exchange = "fmi3InstantiateModelExchange" (*const c_char, *const c_char, *const c_char, bool, bool, Handle, Logger3) -> Handle;
        instantiate_simulation = "fmi3InstantiateCoSimulation" (*const c_char, *const c_char, *const c_char, bool, bool, bool, bool, *const u32, usize, Handle, Logger3, Intermediate3) -> Handle;
        instantiate_scheduled = "fmi3InstantiateScheduledExecution" (*const c_char, *const c_char, *const c_char, bool, bool, Handle, Logger3, ClockUpdate3, Lock3, Lock3) -> Handle;
        free_instance = "fmi3FreeInstance" (Handle) -> ();
        enter_initialization = "fmi3EnterInitializationMode" (Handle, bool, f64, f64, bool, f64) -> Status;
        exit_initialization = "fmi3ExitInitializationMode" (Handle) -> Status;
        enter_configuration = "fmi3EnterConfigurationMode" (Handle) -> Status;
        exit_configuration = "fmi3ExitConfigurationMode" (Handle) -> Status;
        terminate = "fmi3Terminate" (Handle) -> Status;
        get_float32 = "fmi3GetFloat32" (Handle, *const u32, usize, *mut f32, usize) -> Status;
        get_float64 = "fmi3GetFloat64" (Handle, *const u32, usize, *mut f64, usize) -> Status;
        get_int8 = "fmi3GetInt8" (Handle, *const u32, usize, *mut i8, usize) -> Status;
        get_uint8 = "fmi3GetUInt8" (Handle, *const u32, usize, *mut u8, usize) -> Status;
        get_int16 = "fmi3GetInt16" (Handle, *const u32, usize, *mut i16, usize) -> Status;
        get_uint16 = "fmi3GetUInt16" (Handle, *const u32, usize, *mut u16, usize) -> Status;
        get_int32 = "fmi3GetInt32" (Handle, *const u32, usize, *mut i32, usize) -> Status;
        get_uint32 = "fmi3GetUInt32" (Handle, *const u32, usize, *mut u32, usize) -> Status;
        get_int64 = "fmi3GetInt64" (Handle, *const u32, usize, *mut i64, usize) -> Status;
        get_uint64 = "fmi3GetUInt64" (Handle, *const u32, usize, *mut u64, usize) -> Status;
        get_boolean = "fmi3GetBoolean" (Handle, *const u32, usize, *mut u8, usize) -> Status;
        set_float32 = "fmi3SetFloat32" (Handle, *const u32, usize, *const f32, usize) -> Status;
        set_float64 = "fmi3SetFloat64" (Handle, *const u32, usize, *const f64, usize) -> Status;
        set_int8 = "fmi3SetInt8" (Handle, *const u32, usize, *const i8, usize) -> Status;
        set_uint8 = "fmi3SetUInt8" (Handle, *const u32, usize, *const u8, usize) -> Status;
        set_int16 = "fmi3SetInt16" (Handle, *const u32, usize, *const i16, usize) -> Status;
        set_uint16 = "fmi3SetUInt16" (Handle, *const u32, usize, *const u16, usize) -> Status;
        set_int32 = "fmi3SetInt32" (Handle, *const u32, usize, *const i32, usize) -> Status;
        set_uint32 = "fmi3SetUInt32" (Handle, *const u32, usize, *const u32, usize) -> Status;
        set_int64 = "fmi3SetInt64" (Handle, *const u32, usize, *const i64, usize) -> Status;
        set_uint64 = "fmi3SetUInt64" (Handle, *const u32, usize, *const u64, usize) -> Status;
        set_boolean = "fmi3SetBoolean" (Handle, *const u32, usize, *const u8, usize) -> Status;
        set_string = "fmi3SetString" (Handle, *const u32, usize, *const *const c_char, usize) -> Status;
        enter_event_mode = "fmi3EnterEventMode" (Handle) -> Status;
        update_discrete_states = "fmi3UpdateDiscreteStates" (Handle, *mut bool, *mut bool, *mut bool, *mut bool, *mut bool, *mut f64) -> Status;
        enter_continuous_mode = "fmi3EnterContinuousTimeMode" (Handle) -> Status;
        completed_step = "fmi3CompletedIntegratorStep" (Handle, bool, *mut bool, *mut bool) -> Status;
        set_time = "fmi3SetTime" (Handle, f64) -> Status;
        set_states = "fmi3SetContinuousStates" (Handle, *const f64, usize) -> Status;
        get_states = "fmi3GetContinuousStates" (Handle, *mut f64, usize) -> Status;
        get_derivatives = "fmi3GetContinuousStateDerivatives" (Handle, *mut f64, usize) -> Status;
        get_indicators = "fmi3GetEventIndicators" (Handle, *mut f64, usize) -> Status;
        count_indicators = "fmi3GetNumberOfEventIndicators" (Handle, *mut usize) -> Status;
        count_states = "fmi3GetNumberOfContinuousStates" (Handle, *mut usize) -> Status;
        directional = "fmi3GetDirectionalDerivative" (Handle, *const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize) -> Status;
        enter_step_mode = "fmi3EnterStepMode" (Handle) -> Status;
        get_interval = "fmi3GetIntervalDecimal" (Handle, *const u32, usize, *mut f64, *mut c_int) -> Status;
        activate_partition = "fmi3ActivateModelPartition" (Handle, u32, f64) -> Status;
        do_step = "fmi3DoStep" (Handle, f64, f64, bool, *mut bool, *mut bool, *mut bool, *mut f64) -> Status;
    }
}
