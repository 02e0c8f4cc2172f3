//! Exported functional mock-up units, driven through the functions of the standard as an importer
//! does, against exact solutions.

#![allow(unsafe_code, reason = "functions of a shared library can only be called so")]

use gapilib::Session;
use gapilib::internals::script::models::exported::unit;
use gapilib::world::MemoryWorld;
use gapilib_fmi::description::{Causality, Description, Initial, Version};
use gapilib_fmi::export::{FILE, Kinds};
use libloading::{Library, Symbol};
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::sync::{Mutex, OnceLock};
use tempfile::TempDir;

const CLASSES: &str = "\
model Decay
  parameter Real k = 1;
  output Real x(start = 1, fixed = true);
equation
  der(x) = -k*x;
end Decay;
model Ball
  parameter Real e = 0.7;
  Real h(start = 1, fixed = true), v(start = 0, fixed = true);
equation
  der(h) = v;
  der(v) = -9.81;
  when h <= 0 then
    reinit(v, -e*pre(v));
  end when;
end Ball;
model Limited
  Real x(start = 0, fixed = true);
  output Boolean full = x >= 1;
equation
  der(x) = if full then 0 else 1;
end Limited;
model Stair
  output Integer n(start = 1, fixed = true);
equation
  when sample(1, 1) then
    n = pre(n) + 1;
  end when;
  when n == 4 then
    terminate(\"done\");
  end when;
end Stair;
model Driven
  input Real u(start = 1);
  input Integer i(start = 2);
  input Boolean b;
  output Real y = 2*x + 3*u;
  output Integer j = i + 1;
  output Boolean c = not b;
  output Boolean high = u > 2;
  Real x(start = 0, fixed = true);
equation
  der(x) = u - x;
end Driven;
model Loop
  Real x(start = 1, fixed = true);
  output Real z(start = 1);
equation
  der(x) = -z;
  z + 0.1*z^3 + sin(z) = x;
end Loop;
model Late
  Real x(start = 1, fixed = true);
equation
  der(x) = -delay(x, 1);
end Late;
model Fast
  input Real u;
  output Real y = der(u);
end Fast;
model Bound
  parameter Real a = 1;
  parameter Real b = 2*a;
  final parameter Real c = b + 1;
  parameter Real d = c;
  parameter Real e(fixed = false);
  Real x(start = b, fixed = true);
  Real z(start = 4, fixed = true);
initial equation
  e = 3*a;
equation
  der(x) = -d*x;
  der(z) = e;
end Bound;
model Clocked
  output Real y = hold(n);
  discrete Real n(start = 0);
equation
  when Clock(1, 4) then
    n = previous(n) + interval(n);
  end when;
end Clocked;
model Triggered
  Real x(start = 0, fixed = true);
  output Integer k(start = 0, fixed = true);
  discrete Integer n(start = 0);
equation
  der(x) = 1;
  when Clock(sin(3*x) > 0.5) then
    n = previous(n) + 1;
  end when;
  k = hold(n);
end Triggered;
model Vector
  input Real u[3](start = {1, 2, 3});
  input Real v[2](each start = 0.5);
  output Real y = u[1] + 10*u[2] + 100*u[3] + v[1] - v[2];
  Real x(start = 0, fixed = true);
equation
  der(x) = u[2] - v[1];
end Vector;
connector Inlet
  input Real rate(start = 2);
  output Real level;
end Inlet;
model Tank
  Inlet inlet;
  Real v(start = 0, fixed = true);
equation
  der(v) = inlet.rate;
  inlet.level = 3*v;
end Tank;
model Stateless
  output Real z(start = 1);
equation
  z + 0.1*z^3 = 1 + time;
end Stateless;
connector Properties
  Real T(start = 3), c[2];
end Properties;
connector Port
  input Real rate(start = 2);
  input Properties forward;
  output Properties backward if true;
end Port;
function scaled
  input Real x;
  output Real y;
algorithm
  y := 2*x;
end scaled;
model Exchanger
  Port port;
  Real v(start = 1, fixed = true);
equation
  // The sizes of both sides follow from operators and a function.
  der(v)/2 = scaled(port.forward.T)*port.rate;
  port.backward.T = v + port.forward.c[1];
  port.backward.c = {v, port.forward.c[2]};
end Exchanger;
model Chain
  parameter Real a = 1;
  final parameter Real b = 2*a;
  parameter Real unused = 4;
  input Real u;
  output Real z(start = 1);
  output Real y = x + a*time;
  Real x(start = 1, fixed = true);
equation
  der(x) = -b*x + a*sin(time) + u;
  z + 0.1*z^3 + sin(z) = b*x + time;
end Chain;
model Smooth
  parameter Real a = 1;
  input Real u;
  output Real y = x + a*time;
  Real x(start = 1, fixed = true);
equation
  der(x) = -2*a*x + u;
end Smooth;
model Percent
  Real x(start = 1, fixed = true);
equation
  der(x) = -1;
  assert(x > 0.5, \"only 50 % are left: %s\", AssertionLevel.warning);
end Percent;
";

const BOTH: Kinds = Kinds { model_exchange: true, co_simulation: true };

/// A unit, unpacked.
struct Unpacked {
    folder: TempDir,
    description: Description,
}

fn export(class: &str, version: Version) -> Result<Unpacked, String> {
    let mut session = Session::new(Box::new(MemoryWorld::new()));
    session.load_text("Classes.mo", CLASSES).map_err(|errors| format!("{errors:?}"))?;
    let unit = unit(&mut session, class, version, BOTH).map_err(|errors| {
        errors.iter().map(|error| error.message.clone()).collect::<Vec<_>>().join("\n")
    })?;
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(FILE), unit.content.to_bytes().unwrap()).unwrap();
    Ok(Unpacked { folder, description: unit.description })
}

/// The runtime of units, as the build has left it.
fn library() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let here = std::env::current_exe().unwrap();
        let name =
            format!("{}gapilib_fmu{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
        unsafe { Library::new(here.with_file_name(name)) }.expect("the runtime was built")
    })
}

fn function<T>(name: &str) -> Symbol<'static, T> {
    unsafe { library().get(name.as_bytes()) }.unwrap_or_else(|error| panic!("{name}: {error}"))
}

type Plain = unsafe extern "C" fn(*mut c_void) -> c_int;
type Array = unsafe extern "C" fn(*mut c_void, *mut f64, usize) -> c_int;
type Derivative = unsafe extern "C" fn(
    *mut c_void,
    *const u32,
    usize,
    *const u32,
    usize,
    *const f64,
    usize,
    *mut f64,
    usize,
) -> c_int;
type Logger = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

static MESSAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

unsafe extern "C" fn note(_: *mut c_void, _: c_int, _: *const c_char, message: *const c_char) {
    let message = unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned();
    MESSAGES.lock().unwrap().push(message);
}

/// How an instance is made.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Exchange,
    CoSimulation,
    /// With event mode, and whether steps may end early.
    Events(bool),
}

/// How a step ended.
#[derive(Debug, PartialEq)]
struct Stepped {
    time: f64,
    needs_event: bool,
    is_early: bool,
    terminates: bool,
}

/// An instance of FMI 3.0 between the initialization and the end.
struct Instance<'u> {
    pointer: *mut c_void,
    unit: &'u Unpacked,
}

impl Drop for Instance<'_> {
    fn drop(&mut self) {
        let free: Symbol<unsafe extern "C" fn(*mut c_void)> = function("fmi3FreeInstance");
        unsafe { free(self.pointer) };
    }
}

#[derive(Debug, Default, PartialEq)]
struct Updated {
    again: bool,
    terminates: bool,
    states_changed: bool,
    next: Option<f64>,
}

impl<'u> Instance<'u> {
    fn new(unit: &'u Unpacked, is_co_simulation: bool) -> Instance<'u> {
        Instance::made(unit, if is_co_simulation { Kind::CoSimulation } else { Kind::Exchange })
    }

    fn made(unit: &'u Unpacked, kind: Kind) -> Instance<'u> {
        let token = unit.description.token.clone();
        let pointer = instantiate(unit, &token, kind);
        assert!(!pointer.is_null(), "{:?}", MESSAGES.lock().unwrap());
        Instance { pointer, unit }
    }

    fn initialize(&self) {
        self.begin();
        self.plain("fmi3ExitInitializationMode");
    }

    fn begin(&self) {
        type Enter = unsafe extern "C" fn(*mut c_void, bool, f64, f64, bool, f64) -> c_int;
        let enter: Symbol<Enter> = function("fmi3EnterInitializationMode");
        assert_eq!(unsafe { enter(self.pointer, true, 1e-8, 0.0, false, 0.0) }, 0);
    }

    fn plain(&self, name: &str) {
        let run: Symbol<Plain> = function(name);
        let status = unsafe { run(self.pointer) };
        assert_eq!(status, 0, "{name}: {:?}", MESSAGES.lock().unwrap());
    }

    fn fill(&self, name: &str, n: usize) -> Vec<f64> {
        let mut out = vec![f64::NAN; n];
        let run: Symbol<Array> = function(name);
        assert_eq!(unsafe { run(self.pointer, out.as_mut_ptr(), n) }, 0, "{name}");
        out
    }

    fn derivatives(&self, t: f64, x: &[f64]) -> Vec<f64> {
        self.place(t, x);
        self.fill("fmi3GetContinuousStateDerivatives", x.len())
    }

    fn place(&self, t: f64, x: &[f64]) {
        let time: Symbol<unsafe extern "C" fn(*mut c_void, f64) -> c_int> = function("fmi3SetTime");
        type Set = unsafe extern "C" fn(*mut c_void, *const f64, usize) -> c_int;
        let states: Symbol<Set> = function("fmi3SetContinuousStates");
        assert_eq!(unsafe { time(self.pointer, t) }, 0);
        assert_eq!(unsafe { states(self.pointer, x.as_ptr(), x.len()) }, 0);
    }

    fn update(&self) -> Updated {
        type Update = unsafe extern "C" fn(
            *mut c_void,
            *mut bool,
            *mut bool,
            *mut bool,
            *mut bool,
            *mut bool,
            *mut f64,
        ) -> c_int;
        let update: Symbol<Update> = function("fmi3UpdateDiscreteStates");
        let (mut flags, mut next) = ([false; 5], 0.0);
        let [again, terminates, nominals, states, defined] = &mut flags;
        let status = unsafe {
            update(self.pointer, again, terminates, nominals, states, defined, &raw mut next)
        };
        assert_eq!(status, 0, "{:?}", MESSAGES.lock().unwrap());
        let [again, terminates, _, states_changed, defined] = flags;
        Updated { again, terminates, states_changed, next: defined.then_some(next) }
    }

    fn reference(&self, name: &str) -> u32 {
        self.unit.description.find(name).unwrap_or_else(|| panic!("no {name}")).reference
    }

    fn get<T: Copy + Default + 'static>(&self, what: &str, name: &str) -> T {
        type Get<T> = unsafe extern "C" fn(*mut c_void, *const u32, usize, *mut T, usize) -> c_int;
        let get: Symbol<Get<T>> = function(&format!("fmi3Get{what}"));
        let (reference, mut value) = (self.reference(name), T::default());
        let status = unsafe { get(self.pointer, &raw const reference, 1, &raw mut value, 1) };
        assert_eq!(status, 0, "{name}: {:?}", MESSAGES.lock().unwrap());
        value
    }

    fn try_set<T: 'static>(&self, what: &str, reference: u32, value: T) -> c_int {
        type Set<T> =
            unsafe extern "C" fn(*mut c_void, *const u32, usize, *const T, usize) -> c_int;
        let set: Symbol<Set<T>> = function(&format!("fmi3Set{what}"));
        unsafe { set(self.pointer, &raw const reference, 1, &raw const value, 1) }
    }

    fn set<T: 'static>(&self, what: &str, name: &str, value: T) {
        let status = self.try_set(what, self.reference(name), value);
        assert_eq!(status, 0, "{name}: {:?}", MESSAGES.lock().unwrap());
    }

    /// The time reached, and whether the model has ended the simulation.
    fn step(&self, from: f64, length: f64) -> (f64, bool) {
        let stepped = self.stepped(from, length);
        assert!(!stepped.needs_event && !stepped.is_early, "{stepped:?}");
        (stepped.time, stepped.terminates)
    }

    fn stepped(&self, from: f64, length: f64) -> Stepped {
        type Step = unsafe extern "C" fn(
            *mut c_void,
            f64,
            f64,
            bool,
            *mut bool,
            *mut bool,
            *mut bool,
            *mut f64,
        ) -> c_int;
        let step: Symbol<Step> = function("fmi3DoStep");
        let (mut event, mut terminates, mut early, mut time) = (false, false, false, 0.0);
        let status = unsafe {
            step(
                self.pointer,
                from,
                length,
                true,
                &raw mut event,
                &raw mut terminates,
                &raw mut early,
                &raw mut time,
            )
        };
        assert_eq!(status, 0, "{:?}", MESSAGES.lock().unwrap());
        Stepped { time, needs_event: event, is_early: early, terminates }
    }

    fn derivative(&self, of: &str, by: &str, is_adjoint: bool) -> f64 {
        let name =
            if is_adjoint { "fmi3GetAdjointDerivative" } else { "fmi3GetDirectionalDerivative" };
        let run: Symbol<Derivative> = function(name);
        let (of, by, seed, mut out) = (self.reference(of), self.reference(by), 1.0, f64::NAN);
        let status = unsafe {
            run(
                self.pointer,
                &raw const of,
                1,
                &raw const by,
                1,
                &raw const seed,
                1,
                &raw mut out,
                1,
            )
        };
        assert_eq!(status, 0, "{:?}", MESSAGES.lock().unwrap());
        out
    }

    /// The names of what an unknown depends on, by the description.
    fn dependencies(&self, of: &str) -> Option<Vec<&str>> {
        let description = &self.unit.description;
        let structure = &description.structure;
        let all = structure.outputs.iter().chain(&structure.derivatives);
        let found = all.into_iter().find(|own| description.variables[own.variable].name == of);
        let on = found.unwrap_or_else(|| panic!("no {of}")).dependencies.as_ref()?;
        Some(on.iter().map(|(place, _)| description.variables[*place].name.as_str()).collect())
    }
}

fn instantiate(unit: &Unpacked, token: &str, kind: Kind) -> *mut c_void {
    type Exchange = unsafe extern "C" fn(
        *const c_char,
        *const c_char,
        *const c_char,
        bool,
        bool,
        *mut c_void,
        Option<Logger>,
    ) -> *mut c_void;
    type CoSimulation = unsafe extern "C" fn(
        *const c_char,
        *const c_char,
        *const c_char,
        bool,
        bool,
        bool,
        bool,
        *const u32,
        usize,
        *mut c_void,
        Option<Logger>,
        *const c_void,
    ) -> *mut c_void;
    let text = |text: &str| CString::new(text).unwrap();
    let (name, token) = (text("one"), text(token));
    let resources = text(unit.folder.path().to_str().unwrap());
    let (name, token, resources) = (name.as_ptr(), token.as_ptr(), resources.as_ptr());
    let nothing = std::ptr::null_mut();
    match kind {
        Kind::Exchange => {
            let make: Symbol<Exchange> = function("fmi3InstantiateModelExchange");
            unsafe { make(name, token, resources, false, false, nothing, Some(note)) }
        }
        Kind::CoSimulation | Kind::Events(_) => {
            let make: Symbol<CoSimulation> = function("fmi3InstantiateCoSimulation");
            let none = std::ptr::null();
            unsafe {
                make(
                    name,
                    token,
                    resources,
                    false,
                    false,
                    kind != Kind::CoSimulation,
                    kind == Kind::Events(true),
                    none,
                    0,
                    nothing,
                    Some(note),
                    std::ptr::null(),
                )
            }
        }
    }
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} instead of {expected}");
}

/// One step of the classical method of Runge and Kutta.
fn runge_kutta(instance: &Instance, t: f64, h: f64, x: &mut [f64]) {
    let moved = |x: &[f64], k: &[f64], h: f64| -> Vec<f64> {
        x.iter().zip(k).map(|(x, k)| x + h * k).collect()
    };
    let k1 = instance.derivatives(t, x);
    let k2 = instance.derivatives(t + h / 2.0, &moved(x, &k1, h / 2.0));
    let k3 = instance.derivatives(t + h / 2.0, &moved(x, &k2, h / 2.0));
    let k4 = instance.derivatives(t + h, &moved(x, &k3, h));
    for (at, x) in x.iter_mut().enumerate() {
        *x += h / 6.0 * (k1[at] + 2.0 * k2[at] + 2.0 * k3[at] + k4[at]);
    }
    instance.place(t + h, x);
}

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
    type Keep = unsafe extern "C" fn(*mut c_void, *mut *mut c_void) -> c_int;
    let (keep, free): (Symbol<Keep>, Symbol<Keep>) =
        (function("fmi3GetFMUState"), function("fmi3FreeFMUState"));
    let restore: Symbol<unsafe extern "C" fn(*mut c_void, *mut c_void) -> c_int> =
        function("fmi3SetFMUState");
    own.step(0.0, 0.5);
    let mut kept = std::ptr::null_mut();
    assert_eq!(unsafe { keep(own.pointer, &raw mut kept) }, 0);
    own.step(0.5, 0.5);
    let first: f64 = own.get("Float64", "x");
    assert_eq!(unsafe { restore(own.pointer, kept) }, 0);
    close(own.get("Float64", "x"), 3.0 * (-0.5f64).exp(), 1e-7);
    own.step(0.5, 0.5);
    assert_eq!(own.get::<f64>("Float64", "x"), first, "the same bits again");
    assert_eq!(unsafe { free(own.pointer, &raw mut kept) }, 0);
    assert!(kept.is_null());
    own.plain("fmi3Reset");
    own.initialize();
    assert_eq!(own.get::<f64>("Float64", "x"), 1.0, "nothing is left of what was set");
}

/// The bytes of the state of an instance.
fn state_bytes(own: &Instance) -> Vec<u8> {
    type Keep = unsafe extern "C" fn(*mut c_void, *mut *mut c_void) -> c_int;
    type Size = unsafe extern "C" fn(*mut c_void, *mut c_void, *mut usize) -> c_int;
    type Write = unsafe extern "C" fn(*mut c_void, *mut c_void, *mut u8, usize) -> c_int;
    let (mut kept, mut size) = (std::ptr::null_mut(), 0);
    unsafe {
        assert_eq!(function::<Keep>("fmi3GetFMUState")(own.pointer, &raw mut kept), 0);
        let measure = function::<Size>("fmi3SerializedFMUStateSize");
        assert_eq!(measure(own.pointer, kept, &raw mut size), 0);
        let mut bytes = vec![0; size];
        let write = function::<Write>("fmi3SerializeFMUState");
        assert_eq!(write(own.pointer, kept, bytes.as_mut_ptr(), size), 0);
        assert_eq!(function::<Keep>("fmi3FreeFMUState")(own.pointer, &raw mut kept), 0);
        bytes
    }
}

/// Takes over the state in these bytes; the status.
fn take_state(own: &Instance, bytes: &[u8]) -> c_int {
    type Read = unsafe extern "C" fn(*mut c_void, *const u8, usize, *mut *mut c_void) -> c_int;
    type Restore = unsafe extern "C" fn(*mut c_void, *mut c_void) -> c_int;
    type Free = unsafe extern "C" fn(*mut c_void, *mut *mut c_void) -> c_int;
    let mut kept = std::ptr::null_mut();
    unsafe {
        let read = function::<Read>("fmi3DeserializeFMUState");
        let status = read(own.pointer, bytes.as_ptr(), bytes.len(), &raw mut kept);
        if status == 0 {
            assert_eq!(function::<Restore>("fmi3SetFMUState")(own.pointer, kept), 0);
            assert_eq!(function::<Free>("fmi3FreeFMUState")(own.pointer, &raw mut kept), 0);
        }
        status
    }
}

/// A state goes as bytes from one instance to another, which continues with the same bits.
#[test]
fn a_state_becomes_bytes_and_a_state_again() {
    let begun = |unit: &'static Unpacked| {
        let own = Instance::new(unit, true);
        own.initialize();
        own
    };
    for (class, outputs) in
        [("Ball", vec!["h", "v"]), ("Driven", vec!["x", "y"]), ("Loop", vec!["x"])]
    {
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

/// When the ball reaches the ground first, and how fast it is after a time before the second impact.
fn ball(t: f64) -> (f64, f64, f64) {
    let (g, impact) = (9.81, (2.0f64 / 9.81).sqrt());
    let up = 0.7 * g * impact;
    let since = t - impact;
    (impact, up * since - g / 2.0 * since * since, up - g * since)
}

#[test]
fn a_ball_bounces_at_its_event_indicator() {
    let unit = export("Ball", Version::V3).unwrap();
    let exchange = Instance::new(&unit, false);
    exchange.initialize();
    exchange.update();
    exchange.plain("fmi3EnterContinuousTimeMode");
    let mut x = exchange.fill("fmi3GetContinuousStates", 2);
    let (impact, _, _) = ball(0.6);
    let indicator = |exchange: &Instance| exchange.fill("fmi3GetEventIndicators", 1)[0];
    runge_kutta(&exchange, 0.0, impact - 1e-6, &mut x);
    let before = indicator(&exchange);
    runge_kutta(&exchange, impact - 1e-6, 2e-6, &mut x);
    assert!(before > 0.0 && indicator(&exchange) < 0.0, "{before}");
    exchange.plain("fmi3EnterEventMode");
    let updated = exchange.update();
    assert_eq!((updated.again, updated.states_changed), (false, true));
    let after = exchange.fill("fmi3GetContinuousStates", 2);
    close(after[1], -0.7 * x[1], 1e-12);
    assert!(indicator(&exchange) > 0.0, "the relation holds now");
}

#[test]
fn a_ball_bounces_within_a_step() {
    let unit = export("Ball", Version::V3).unwrap();
    let own = Instance::new(&unit, true);
    own.initialize();
    assert_eq!(own.step(0.0, 0.6), (0.6, false));
    let (_, h, v) = ball(0.6);
    close(own.get("Float64", "h"), h, 1e-6);
    close(own.get("Float64", "v"), v, 1e-6);
}

/// The importer lets the ball bounce where steps may end early.
#[test]
fn a_step_ends_at_an_event_that_the_importer_handles() {
    let unit = export("Ball", Version::V3).unwrap();
    let interface = unit.description.co_simulation.as_ref().unwrap();
    assert!(interface.has_event_mode && interface.might_return_early);
    let own = Instance::made(&unit, Kind::Events(true));
    own.initialize();
    own.update();
    own.plain("fmi3EnterStepMode");
    let (impact, h, v) = ball(0.6);
    let stepped = own.stepped(0.0, 0.6);
    let expected = Stepped { needs_event: true, is_early: true, terminates: false, ..stepped };
    assert_eq!(stepped, expected);
    close(stepped.time, impact, 1e-7);
    close(own.get("Float64", "v"), -9.81 * impact, 1e-6);
    own.plain("fmi3EnterEventMode");
    assert!(own.update().states_changed);
    own.plain("fmi3EnterStepMode");
    close(own.get("Float64", "v"), 0.7 * 9.81 * impact, 1e-6);
    // That the ball leaves the ground is another event, at which nothing jumps.
    let leaves = own.stepped(stepped.time, 0.6 - stepped.time);
    assert!(leaves.needs_event && (leaves.time - impact).abs() < 1e-6, "{leaves:?}");
    own.plain("fmi3EnterEventMode");
    assert!(!own.update().states_changed);
    own.plain("fmi3EnterStepMode");
    assert_eq!(own.step(leaves.time, 0.6 - leaves.time), (0.6, false));
    close(own.get("Float64", "h"), h, 1e-6);
    close(own.get("Float64", "v"), v, 1e-6);

    // Without early returns it bounces within the step; without event mode there are no modes.
    let own = Instance::made(&unit, Kind::Events(false));
    own.initialize();
    own.update();
    own.plain("fmi3EnterStepMode");
    assert_eq!(own.step(0.0, 0.6), (0.6, false));
    close(own.get("Float64", "h"), h, 1e-6);
    let own = Instance::new(&unit, true);
    own.initialize();
    let enter: Symbol<Plain> = function("fmi3EnterEventMode");
    assert_eq!(unsafe { enter(own.pointer) }, 3);
    let said = |what: &str| MESSAGES.lock().unwrap().iter().any(|message| message.contains(what));
    assert!(said("the instance was made without event mode"));
}

/// A time event at the end of a step is the importer's, and so is one that an input has made due.
#[test]
fn events_between_steps_are_those_of_the_importer() {
    let unit = export("Stair", Version::V3).unwrap();
    let own = Instance::made(&unit, Kind::Events(true));
    own.initialize();
    assert_eq!(own.update().next, Some(1.0));
    own.plain("fmi3EnterStepMode");
    let at_one = Stepped { time: 1.0, needs_event: true, is_early: false, terminates: false };
    assert_eq!(own.stepped(0.0, 1.0), at_one);
    assert_eq!(own.get::<i64>("Int64", "n"), 1);
    own.plain("fmi3EnterEventMode");
    assert_eq!(own.update().next, Some(2.0));
    assert_eq!(own.get::<i64>("Int64", "n"), 2);
    own.plain("fmi3EnterStepMode");
    let at_two = Stepped { time: 2.0, needs_event: true, is_early: true, terminates: false };
    assert_eq!(own.stepped(1.0, 5.0), at_two);

    let unit = export("Driven", Version::V3).unwrap();
    let own = Instance::made(&unit, Kind::Events(true));
    own.initialize();
    own.update();
    own.plain("fmi3EnterStepMode");
    own.set("Float64", "u", 3.0);
    let due = own.stepped(0.0, 1.0);
    assert_eq!((due.time, due.needs_event, due.is_early), (0.0, true, true));
    own.plain("fmi3EnterEventMode");
    own.update();
    own.plain("fmi3EnterStepMode");
    assert!(own.get::<bool>("Boolean", "high"));
    assert_eq!(own.step(0.0, 1.0), (1.0, false));
    close(own.get("Float64", "x"), 3.0 * (1.0 - (-1.0f64).exp()), 1e-6);
}

#[test]
fn an_event_beside_the_end_of_a_step_is_not_missed() {
    let unit = export("Limited", Version::V3).unwrap();
    // The ramp reaches its limit at t = 1: just before the end of the first step, there, or after it.
    for first in [1.0 - 1e-13, 1.0, 1.0 + 1e-13, 1.0 + 1e-11] {
        let own = Instance::new(&unit, true);
        own.initialize();
        own.step(0.0, first);
        own.step(first, 1.0);
        own.step(first + 1.0, 1.0);
        close(own.get("Float64", "x"), 1.0, 1e-7);
        assert!(own.get::<bool>("Boolean", "full"));
    }
}

#[test]
fn time_events_come_when_they_are_announced() {
    let unit = export("Stair", Version::V3).unwrap();
    let exchange = Instance::new(&unit, false);
    exchange.initialize();
    let mut updated = exchange.update();
    for n in 1..=3 {
        assert_eq!(exchange.get::<i64>("Int64", "n"), n);
        assert_eq!(updated, Updated { next: Some(n as f64), ..Updated::default() });
        exchange.plain("fmi3EnterContinuousTimeMode");
        exchange.place(n as f64, &[]);
        exchange.plain("fmi3EnterEventMode");
        updated = exchange.update();
    }
    assert!(updated.terminates, "{updated:?}");

    let own = Instance::new(&unit, true);
    own.initialize();
    assert_eq!(own.step(0.0, 2.5), (2.5, false));
    assert_eq!(own.get::<i64>("Int64", "n"), 3);
    assert_eq!(own.step(2.5, 2.5), (3.0, true), "the model ends the simulation");
    let own = Instance::new(&unit, true);
    own.initialize();
    assert_eq!(own.step(0.0, 3.0), (3.0, true), "also where it is the end of a step");
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

/// A parameter that follows from others cannot be set, and changes with them; so does a start value.
#[test]
fn what_follows_from_parameters_is_calculated() {
    let unit = export("Bound", Version::V3).unwrap();
    let part = |name: &str| {
        let own = unit.description.find(name).unwrap();
        (own.causality, own.initial)
    };
    let calculated = (Causality::CalculatedParameter, Some(Initial::Calculated));
    assert_eq!(part("a"), (Causality::Parameter, Some(Initial::Exact)));
    assert_eq!(["b", "c", "d", "e"].map(part), [calculated; 4]);
    assert_eq!(part("x"), (Causality::Local, Some(Initial::Calculated)));
    assert_eq!(part("z"), (Causality::Local, Some(Initial::Exact)));
    let unknowns = &unit.description.structure.initial_unknowns;
    for name in ["b", "c", "d", "e", "x"] {
        let place = unit.description.variables.iter().position(|own| own.name == name);
        assert!(unknowns.iter().any(|own| Some(own.variable) == place), "{name}");
    }
    let own = Instance::new(&unit, true);
    own.set("Float64", "a", 3.0);
    assert_eq!(own.try_set("Float64", own.reference("b"), 5.0), 3);
    own.begin();
    assert_eq!(
        ["b", "c", "d", "e", "x"].map(|name| own.get::<f64>("Float64", name)),
        [6.0, 7.0, 7.0, 9.0, 6.0]
    );
    own.plain("fmi3ExitInitializationMode");
    own.step(0.0, 0.5);
    close(own.get("Float64", "x"), 6.0 * (-3.5f64).exp(), 1e-7);
    close(own.get("Float64", "z"), 8.5, 1e-7);
}

/// Periodic clocks tick at announced times, whatever the start time is; clocks of a condition at events.
#[test]
fn clocks_of_a_model_tick_in_its_unit() {
    let unit = export("Clocked", Version::V3).unwrap();
    let own = Instance::new(&unit, true);
    own.initialize();
    for (step, ticks) in [(1, 1), (2, 2), (3, 3), (4, 4), (5, 5), (6, 5), (7, 6)] {
        own.step(0.2 * f64::from(step - 1), 0.2);
        // The first tick, at the start, adds the interval, too.
        close(own.get("Float64", "y"), 0.25 * f64::from(ticks), 1e-12);
    }
    let exchange = Instance::new(&unit, false);
    exchange.initialize();
    let next = exchange.update().next;
    assert_eq!(next, Some(0.25));

    let unit = export("Triggered", Version::V3).unwrap();
    let own = Instance::new(&unit, true);
    own.initialize();
    // sin(3 t) rises through 0.5 at t = (pi/6 + 2 pi n)/3.
    for step in 0..50 {
        own.step(0.2 * f64::from(step), 0.2);
        let t = 0.2 * f64::from(step + 1);
        let rises = ((3.0 * t - std::f64::consts::FRAC_PI_6) / std::f64::consts::TAU).floor() + 1.0;
        assert_eq!(own.get::<i64>("Int64", "k"), rises as i64, "{t}");
    }
}

#[test]
fn signals_in_connectors_of_the_model_are_its_own() {
    let unit = export("Tank", Version::V3).unwrap();
    let causality = |name: &str| unit.description.find(name).unwrap().causality;
    assert_eq!(causality("inlet.rate"), Causality::Input);
    assert_eq!(causality("inlet.level"), Causality::Output);
    let own = Instance::new(&unit, true);
    own.initialize();
    own.step(0.0, 1.0);
    close(own.get("Float64", "inlet.level"), 6.0, 1e-9);
    own.set("Float64", "inlet.rate", -1.0);
    own.step(1.0, 1.0);
    close(own.get("Float64", "inlet.level"), 3.0, 1e-9);
}

/// Causalities of a connector are those of all that is in it, and an equation may have any form.
#[test]
fn connectors_in_connectors_are_inputs_and_outputs() {
    let unit = export("Exchanger", Version::V3).unwrap();
    let causality = |name: &str| unit.description.find(name).unwrap().causality;
    for name in ["port.rate", "port.forward.T", "port.forward.c[1]", "port.forward.c[2]"] {
        assert_eq!(causality(name), Causality::Input, "{name}");
    }
    for name in ["port.backward.T", "port.backward.c[1]", "port.backward.c[2]"] {
        assert_eq!(causality(name), Causality::Output, "{name}");
    }
    let own = Instance::new(&unit, true);
    own.set("Float64", "port.forward.c[2]", 5.0);
    own.initialize();
    own.step(0.0, 0.5);
    close(own.get("Float64", "port.backward.T"), 1.0 + 0.5 * 2.0 * 6.0 * 2.0, 1e-7);
    assert_eq!(own.get::<f64>("Float64", "port.backward.c[2]"), 5.0);
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
fn elements_of_array_inputs_are_inputs() {
    let unit = export("Vector", Version::V3).unwrap();
    let own = Instance::new(&unit, true);
    own.begin();
    assert_eq!(own.get::<f64>("Float64", "y"), 321.0);
    own.set("Float64", "u[3]", 0.25);
    own.set("Float64", "v[2]", 2.5);
    assert_eq!(own.get::<f64>("Float64", "y"), 44.0);
    own.plain("fmi3ExitInitializationMode");
    own.step(0.0, 1.0);
    close(own.get("Float64", "x"), 1.5, 1e-7);
    assert_eq!(own.derivative("y", "u[2]", false), 10.0);
    assert_eq!(own.derivative("der(x)", "v[1]", true), -1.0);
}

#[test]
fn derivatives_through_a_loop_are_exact() {
    let unit = export("Loop", Version::V3).unwrap();
    let exchange = Instance::new(&unit, false);
    exchange.initialize();
    let z: f64 = exchange.get("Float64", "z");
    close(z + 0.1 * z.powi(3) + z.sin(), 1.0, 1e-9);
    let expected = 1.0 / (1.0 + 0.3 * z * z + z.cos());
    close(exchange.derivative("z", "x", false), expected, 1e-9);
    close(exchange.derivative("der(x)", "x", false), -expected, 1e-9);
}

/// FMI 3.0 counts parameters and the time among what an unknown may depend on.
#[test]
fn derivatives_by_parameters_and_the_time_are_exact() {
    let unit = export("Chain", Version::V3).unwrap();
    let own = Instance::new(&unit, false);
    own.set("Float64", "a", 1.5);
    own.initialize();
    own.update();
    own.plain("fmi3EnterContinuousTimeMode");
    let (t, x, a) = (0.7f64, 2.0, 1.5);
    own.place(t, &[x]);
    let z: f64 = own.get("Float64", "z");
    let slope = 1.0 / (1.0 + 0.3 * z * z + z.cos());
    let cases = [
        ("der(x)", "a", -2.0 * x + t.sin()),
        ("der(x)", "time", a * t.cos()),
        ("der(x)", "x", -2.0 * a),
        ("der(x)", "u", 1.0),
        ("y", "a", t),
        ("y", "time", a),
        ("z", "a", slope * 2.0 * x),
        ("z", "time", slope),
        ("z", "unused", 0.0),
        ("x", "a", 0.0),
    ];
    for (of, by, expected) in cases {
        for is_adjoint in [false, true] {
            let found = own.derivative(of, by, is_adjoint);
            assert!((found - expected).abs() <= 1e-9, "∂{of}/∂{by} = {found}, not {expected}");
        }
    }
    // A loop may make everything of everything.
    assert_eq!(own.dependencies("der(x)"), None);

    let unit = export("Smooth", Version::V3).unwrap();
    let own = Instance::new(&unit, false);
    assert_eq!(own.dependencies("der(x)"), Some(vec!["a", "u", "x"]));
    assert_eq!(own.dependencies("y"), Some(vec!["time", "a", "x"]));
    let unit = export("Smooth", Version::V2).unwrap();
    let own = Instance { pointer: std::ptr::null_mut(), unit: &unit };
    assert_eq!(own.dependencies("der(x)"), Some(vec!["u", "x"]));
    assert_eq!(own.dependencies("y"), Some(vec!["time", "x"]));

    // Initial equations determine a parameter: what it follows from is not differentiated.
    let unit = export("Bound", Version::V3).unwrap();
    let own = Instance::new(&unit, false);
    own.initialize();
    let run: Symbol<Derivative> = function("fmi3GetDirectionalDerivative");
    let (of, by, seed, mut out) = (own.reference("der(z)"), own.reference("a"), 1.0, 0.0);
    let status = unsafe {
        run(own.pointer, &raw const of, 1, &raw const by, 1, &raw const seed, 1, &raw mut out, 1)
    };
    assert_eq!(status, 3);
    let said = |what: &str| MESSAGES.lock().unwrap().iter().any(|message| message.contains(what));
    assert!(said("initial equations determine parameters of the model"));
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

#[test]
fn what_a_unit_cannot_do_is_refused_with_its_place() {
    let refused = |class: &str| export(class, Version::V3).err().unwrap_or_default();
    let late = refused("Late");
    assert!(late.contains("`delay` (Classes.mo:55) needs values of the past"), "{late}");
    let fast = refused("Fast");
    assert!(fast.contains("depends on the derivative of its input `u`"), "{fast}");
}

#[test]
fn a_unit_has_the_same_bytes_again_and_no_path() {
    let bytes = |unit: &Unpacked| std::fs::read(unit.folder.path().join(FILE)).unwrap();
    let (one, two) = (export("Ball", Version::V2).unwrap(), export("Ball", Version::V2).unwrap());
    assert_eq!(bytes(&one), bytes(&two));
    assert_eq!(one.description, two.description);
    let content = String::from_utf8_lossy(&bytes(&one)).into_owned();
    assert!(!content.contains("Classes.mo"));
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
