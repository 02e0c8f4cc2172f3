//! Values, states and steps of instances, by the functions of both versions.

use super::*;

#[test]
fn a_decay_is_integrated_by_the_importer_and_by_itself() {
    let unit = export("Decay", Version::V3).unwrap();
    let exchange = Instance::new(&unit, false);
    exchange.set("Float64", "k", 2.0);
    exchange.initialize();
    assert_eq!(exchange.update(), Updated::default());
    exchange.plain("fmi3EnterContinuousTimeMode");
    let mut x = exchange.fill("fmi3GetContinuousStates", 1);
    assert_eq!(x, [1.0]);
    for step in 0..100 {
        runge_kutta(&exchange, f64::from(step) * 0.01, 0.01, &mut x);
    }
    close(exchange.get("Float64", "x"), (-2.0f64).exp(), 1e-9);
    assert_eq!(exchange.derivative("der(x)", "x", false), -2.0);
    assert_eq!(exchange.derivative("der(x)", "x", true), -2.0);

    let own = Instance::new(&unit, true);
    own.set("Float64", "k", 2.0);
    own.initialize();
    for step in 0..10 {
        assert!(!own.step(f64::from(step) * 0.1, 0.1).1);
    }
    close(own.get("Float64", "x"), (-2.0f64).exp(), 1e-7);
}

#[test]
fn a_start_value_is_set_and_a_state_is_kept_restored_and_reset() {
    let unit = export("Decay", Version::V3).unwrap();
    let own = Instance::new(&unit, true);
    own.set("Float64", "x", 3.0);
    own.initialize();
    assert_eq!(own.get::<f64>("Float64", "x"), 3.0);
    own.step(0.0, 0.5);
    let kept = kept(&own);
    own.step(0.5, 0.5);
    let first: f64 = own.get("Float64", "x");
    restore(&own, kept);
    close(own.get("Float64", "x"), 3.0 * (-0.5f64).exp(), 1e-7);
    own.step(0.5, 0.5);
    assert_eq!(own.get::<f64>("Float64", "x"), first, "the same bits again");
    free(&own, kept);
    own.plain("fmi3Reset");
    own.initialize();
    assert_eq!(own.get::<f64>("Float64", "x"), 1.0, "nothing is left of what was set");
}

/// The state of an instance, kept.
fn kept(own: &Instance) -> *mut c_void {
    let mut kept = std::ptr::null_mut();
    assert_eq!(unsafe { function::<Keep>("fmi3GetFMUState")(own.pointer, &raw mut kept) }, 0);
    kept
}

type Keep = unsafe extern "C" fn(*mut c_void, *mut *mut c_void) -> c_int;

/// Frees a state that was kept.
fn free(own: &Instance, mut kept: *mut c_void) {
    assert_eq!(unsafe { function::<Keep>("fmi3FreeFMUState")(own.pointer, &raw mut kept) }, 0);
    assert!(kept.is_null());
}

/// Takes over a state that was kept.
fn restore(own: &Instance, kept: *mut c_void) {
    type Restore = unsafe extern "C" fn(*mut c_void, *mut c_void) -> c_int;
    assert_eq!(unsafe { function::<Restore>("fmi3SetFMUState")(own.pointer, kept) }, 0);
}

/// The bytes of the state of an instance.
fn state_bytes(own: &Instance) -> Vec<u8> {
    type Size = unsafe extern "C" fn(*mut c_void, *mut c_void, *mut usize) -> c_int;
    type Write = unsafe extern "C" fn(*mut c_void, *mut c_void, *mut u8, usize) -> c_int;
    let (kept, mut size) = (kept(own), 0);
    let measure = function::<Size>("fmi3SerializedFMUStateSize");
    assert_eq!(unsafe { measure(own.pointer, kept, &raw mut size) }, 0);
    let mut bytes = vec![0; size];
    let write = function::<Write>("fmi3SerializeFMUState");
    assert_eq!(unsafe { write(own.pointer, kept, bytes.as_mut_ptr(), size) }, 0);
    free(own, kept);
    bytes
}

/// Takes over the state in these bytes; the status.
fn take_state(own: &Instance, bytes: &[u8]) -> c_int {
    type Read = unsafe extern "C" fn(*mut c_void, *const u8, usize, *mut *mut c_void) -> c_int;
    let read = function::<Read>("fmi3DeserializeFMUState");
    let mut kept = std::ptr::null_mut();
    let status = unsafe { read(own.pointer, bytes.as_ptr(), bytes.len(), &raw mut kept) };
    if status == 0 {
        restore(own, kept);
        free(own, kept);
    }
    status
}

/// A state goes as bytes from one instance to another, which continues with the same bits.
#[test]
fn a_state_becomes_bytes_and_a_state_again() {
    let begun = |unit: &'static Unpacked| {
        let own = Instance::new(unit, true);
        own.initialize();
        own
    };
    for (class, outputs) in [
        ("Ball", vec!["h", "v"]),
        ("Driven", vec!["x", "y"]),
        ("Loop", vec!["x"]),
        ("Late", vec!["x", "y"]),
        ("Pipe", vec!["w", "z"]),
    ] {
        let unit: &'static Unpacked = Box::leak(Box::new(export(class, Version::V3).unwrap()));
        assert!(unit.description.co_simulation.as_ref().unwrap().can_serialize_state);
        let one = begun(unit);
        if class == "Driven" {
            one.set("Float64", "u", 3.0);
            one.set("Int64", "i", 7i64);
        }
        one.step(0.0, 0.6);
        let bytes = state_bytes(&one);
        let two = Instance::new(unit, true);
        assert_eq!(take_state(&two, &bytes), 0, "{class}: {:?}", MESSAGES.lock().unwrap());
        let values = |of: &Instance| -> Vec<f64> {
            outputs.iter().map(|name| of.get("Float64", name)).collect()
        };
        assert_eq!(values(&one), values(&two), "{class}");
        for own in [&one, &two] {
            own.step(0.6, 0.4);
        }
        assert_eq!(values(&one), values(&two), "{class}");
        if class == "Driven" {
            assert_eq!(two.get::<i64>("Int64", "j"), 8);
        }
        let mut wrong = bytes.clone();
        wrong.truncate(bytes.len() / 2);
        assert_eq!(take_state(&two, &wrong), 3);
    }
    let stair = export("Stair", Version::V3).unwrap();
    let own = Instance::new(&stair, true);
    own.initialize();
    own.step(0.0, 1.5);
    let other = Instance::new(&stair, true);
    assert_eq!(take_state(&other, &state_bytes(&own)), 0);
    assert_eq!(other.step(1.5, 2.0), (3.0, true), "the clock continues, and the model ends it");
    let decay = export("Decay", Version::V3).unwrap();
    assert_eq!(take_state(&Instance::new(&decay, true), &state_bytes(&own)), 3, "of another unit");
}

#[test]
fn a_model_of_a_loop_alone_goes_from_step_to_step() {
    let unit = export("Stateless", Version::V3).unwrap();
    let own = Instance::new(&unit, true);
    own.initialize();
    for step in 0..5 {
        own.step(f64::from(step), 1.0);
        let z: f64 = own.get("Float64", "z");
        close(z + 0.1 * z.powi(3), 2.0 + f64::from(step), 1e-7);
    }
}

#[test]
fn inputs_of_every_type_are_followed() {
    let unit = export("Driven", Version::V3).unwrap();
    let causality = |name: &str| unit.description.find(name).unwrap().causality;
    assert_eq!((causality("u"), causality("y")), (Causality::Input, Causality::Output));
    let exchange = Instance::new(&unit, false);
    exchange.begin();
    exchange.set("Float64", "u", 0.5);
    assert_eq!(exchange.get::<f64>("Float64", "y"), 1.5, "what is set counts at once");
    exchange.plain("fmi3ExitInitializationMode");
    assert_eq!(exchange.get::<i64>("Int64", "j"), 3);
    assert!(exchange.get::<bool>("Boolean", "c"));
    exchange.set("Int64", "i", 7i64);
    exchange.set("Boolean", "b", true);
    exchange.update();
    assert_eq!(exchange.get::<i64>("Int64", "j"), 8);
    assert!(!exchange.get::<bool>("Boolean", "c"));
    exchange.plain("fmi3EnterContinuousTimeMode");
    assert_eq!(exchange.derivatives(0.0, &[0.25]), [0.25]);
    let n = unit.description.structure.event_indicators.len();
    assert!(exchange.fill("fmi3GetEventIndicators", n).iter().all(|z| *z > 0.0));
    exchange.set("Float64", "u", 4.0);
    assert!(exchange.fill("fmi3GetEventIndicators", n).iter().any(|z| *z < 0.0));
    assert_eq!(exchange.get::<f64>("Float64", "y"), 12.5);
    exchange.plain("fmi3EnterEventMode");
    exchange.update();
    assert!(exchange.get::<bool>("Boolean", "high"));
    assert_eq!(exchange.derivative("y", "u", false), 3.0);
    assert_eq!(exchange.derivative("y", "x", true), 2.0);

    let own = Instance::new(&unit, true);
    own.initialize();
    own.step(0.0, 1.0);
    own.set("Float64", "u", 5.0);
    own.set("Int64", "i", 10i64);
    own.step(1.0, 1.0);
    let x = 5.0 + (1.0 - (-1.0f64).exp() - 5.0) * (-1.0f64).exp();
    close(own.get("Float64", "x"), x, 1e-7);
    assert_eq!(own.get::<i64>("Int64", "j"), 11);
    assert!(own.get::<bool>("Boolean", "high"));
}

#[test]
fn what_is_wrong_is_an_error_with_a_message() {
    let unit = export("Decay", Version::V3).unwrap();
    assert!(instantiate(&unit, "{another}", Kind::Exchange).is_null());
    let said = |what: &str| MESSAGES.lock().unwrap().iter().any(|message| message.contains(what));
    assert!(said("but {another} was requested"));
    let own = Instance::new(&unit, true);
    assert_eq!(own.try_set("Float64", 99, 1.0), 3);
    assert!(said("there is no variable of this type with value reference 99"));
    assert_eq!(own.try_set("Float64", own.reference("der(x)"), 1.0), 3);
    assert!(said("`der(x)` cannot be set"));
    own.initialize();
    assert_eq!(own.try_set("Float64", own.reference("k"), 1.0), 3);
    assert!(said("`k` can be set before the end of the initialization only"));
}

/// `fmi2CallbackFunctions`, with the logger at most.
#[repr(C)]
struct Callbacks([*mut c_void; 5]);

static FORMATS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// The messages of FMI 2.0 are formats: what an importer in C hands to `printf`.
unsafe extern "C" fn note_format(
    _: *mut c_void,
    _: *const c_char,
    _: c_int,
    _: *const c_char,
    format: *const c_char,
) {
    let format = unsafe { CStr::from_ptr(format) }.to_string_lossy().into_owned();
    FORMATS.lock().unwrap().push(format);
}

#[test]
fn messages_of_fmi_2_are_formats_without_arguments() {
    type Instantiate = unsafe extern "C" fn(
        *const c_char,
        c_int,
        *const c_char,
        *const c_char,
        *const Callbacks,
        c_int,
        c_int,
    ) -> *mut c_void;
    type Setup = unsafe extern "C" fn(*mut c_void, c_int, f64, f64, c_int, f64) -> c_int;
    type Step = unsafe extern "C" fn(*mut c_void, f64, f64, c_int) -> c_int;
    let unit = export("Percent", Version::V2).unwrap();
    let text = |text: &str| CString::new(text).unwrap();
    let (token, resources) =
        (text(&unit.description.token), text(unit.folder.path().to_str().unwrap()));
    let nothing = std::ptr::null_mut();
    let callbacks = Callbacks([note_format as *mut c_void, nothing, nothing, nothing, nothing]);
    let instantiate: Symbol<Instantiate> = function("fmi2Instantiate");
    let (setup, step): (Symbol<Setup>, Symbol<Step>) =
        (function("fmi2SetupExperiment"), function("fmi2DoStep"));
    unsafe {
        let (token, resources) = (token.as_ptr(), resources.as_ptr());
        let one = instantiate(c"one".as_ptr(), 1, token, resources, &raw const callbacks, 0, 1);
        assert_eq!(setup(one, 1, 1e-6, 0.0, 0, 0.0), 0);
        for name in ["fmi2EnterInitializationMode", "fmi2ExitInitializationMode"] {
            assert_eq!(function::<Plain>(name)(one), 0, "{name}");
        }
        assert_eq!(step(one, 0.0, 0.8, 1), 0);
        function::<unsafe extern "C" fn(*mut c_void)>("fmi2FreeInstance")(one);
    }
    let formats = FORMATS.lock().unwrap().join("\n");
    assert!(formats.contains("only 50 %% are left: %%s"), "{formats}");
}

#[test]
fn the_functions_of_fmi_2_simulate_as_well() {
    type Instantiate = unsafe extern "C" fn(
        *const c_char,
        c_int,
        *const c_char,
        *const c_char,
        *const Callbacks,
        c_int,
        c_int,
    ) -> *mut c_void;
    type Setup = unsafe extern "C" fn(*mut c_void, c_int, f64, f64, c_int, f64) -> c_int;
    type Step = unsafe extern "C" fn(*mut c_void, f64, f64, c_int) -> c_int;
    type Get = unsafe extern "C" fn(*mut c_void, *const u32, usize, *mut f64) -> c_int;
    type Status = unsafe extern "C" fn(*mut c_void, c_int, *mut c_int) -> c_int;
    let unit = export("Decay", Version::V2).unwrap();
    let text = |text: &str| CString::new(text).unwrap();
    let token = text(&unit.description.token);
    let resources = text(&format!("file://{}", unit.folder.path().display()));
    let callbacks = Callbacks([std::ptr::null_mut(); 5]);
    let instantiate: Symbol<Instantiate> = function("fmi2Instantiate");
    let (setup, step): (Symbol<Setup>, Symbol<Step>) =
        (function("fmi2SetupExperiment"), function("fmi2DoStep"));
    let (get, status): (Symbol<Get>, Symbol<Status>) =
        (function("fmi2GetReal"), function("fmi2GetBooleanStatus"));
    let plain = |name: &str, one: *mut c_void| {
        let run: Symbol<Plain> = function(name);
        assert_eq!(unsafe { run(one) }, 0, "{name}");
    };
    let reference = unit.description.find("x").unwrap().reference;
    let (mut x, mut terminated) = (f64::NAN, -1);
    unsafe {
        let one = instantiate(
            c"one".as_ptr(),
            1,
            token.as_ptr(),
            resources.as_ptr(),
            &raw const callbacks,
            0,
            0,
        );
        assert!(!one.is_null());
        assert_eq!(setup(one, 1, 1e-8, 0.0, 1, 1.0), 0);
        plain("fmi2EnterInitializationMode", one);
        plain("fmi2ExitInitializationMode", one);
        assert_eq!(step(one, 0.0, 0.5, 1), 0);
        assert_eq!(step(one, 0.5, 0.6, 1), 3, "past the stop time");
        assert_eq!(step(one, 0.5, 0.5, 1), 0);
        assert_eq!(get(one, &raw const reference, 1, &raw mut x), 0);
        assert_eq!(status(one, 3, &raw mut terminated), 0);
        let free: Symbol<unsafe extern "C" fn(*mut c_void)> = function("fmi2FreeInstance");
        free(one);
    }
    close(x, (-1.0f64).exp(), 1e-7);
    assert_eq!(terminated, 0);
}

/// Strings are constants: they are read, and not set.
#[test]
fn strings_are_read() {
    let unit = export("Named", Version::V3).unwrap();
    let own = Instance::new(&unit, true);
    own.initialize();
    type Get =
        unsafe extern "C" fn(*mut c_void, *const u32, usize, *mut *const c_char, usize) -> c_int;
    type Set =
        unsafe extern "C" fn(*mut c_void, *const u32, usize, *const *const c_char, usize) -> c_int;
    let (reference, other) = (own.reference("label"), own.reference("x"));
    let mut text: *const c_char = std::ptr::null();
    let read = |reference: &u32, text: &mut *const c_char| unsafe {
        function::<Get>("fmi3GetString")(own.pointer, reference, 1, text, 1)
    };
    assert_eq!(read(&reference, &mut text), 0);
    assert_eq!(unsafe { CStr::from_ptr(text) }, c"two words");
    let set = function::<Set>("fmi3SetString");
    assert_eq!(unsafe { set(own.pointer, &reference, 1, &text, 1) }, 3);
    assert_eq!(read(&other, &mut text), 3);
}
