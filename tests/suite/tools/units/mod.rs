//! Exported functional mock-up units, driven through the functions of the standard as an importer
//! does, against exact solutions.

#![allow(unsafe_code, reason = "functions of a shared library can only be called so")]

mod events;
mod exported;
mod instances;

use gapilib::Session;
use gapilib::internals::script::models::exported::{Form, unit};
use gapilib::world::MemoryWorld;
use gapilib_fmi::description::{Causality, Description, Initial, Version};
use gapilib_fmi::export::{FILE, Kinds};
use libloading::{Library, Symbol};
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::sync::{Mutex, OnceLock};
use tempfile::TempDir;

const CLASSES: &str = include_str!("../../../data/models/units_classes.mo");

const BOTH: Kinds = Kinds { model_exchange: true, co_simulation: true };

/// A unit, unpacked.
struct Unpacked {
    folder: TempDir,
    description: Description,
}

fn export(class: &str, version: Version) -> Result<Unpacked, String> {
    let mut session = Session::new(Box::new(MemoryWorld::new()));
    session.load_text("Classes.mo", CLASSES).map_err(|errors| format!("{errors:?}"))?;
    let unit =
        unit(&mut session, class, Form { version, kinds: BOTH, name: None }).map_err(|errors| {
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

    /// Announces the end of a step; whether an event is to follow.
    fn complete(&self) -> bool {
        type Complete = unsafe extern "C" fn(*mut c_void, bool, *mut bool, *mut bool) -> c_int;
        let complete: Symbol<Complete> = function("fmi3CompletedIntegratorStep");
        let (mut event, mut terminates) = (false, false);
        let status = unsafe { complete(self.pointer, true, &raw mut event, &raw mut terminates) };
        assert_eq!((status, terminates), (0, false), "{:?}", MESSAGES.lock().unwrap());
        event
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
