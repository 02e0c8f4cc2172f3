//! The shared library of a unit, and its instances.

#![allow(unsafe_code, reason = "functions of another language can only be called so")]

use super::calls::{CallError, CallWatch, Severity};
use super::functions::{Callbacks2, Functions2, Functions3, Handle, Status};
use super::log::Log;
use super::plan::InterfaceKind;
use crate::description::Version;
use libloading::Library;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::Path;
use std::sync::Arc;

/// The functions of a shared library.
pub(super) enum Functions {
    V2(Box<Functions2>),
    V3(Box<Functions3>),
}

/// A shared library of a unit; it stays loaded as long as this lives.
pub(crate) struct Binary {
    functions: Functions,
    watch: Arc<CallWatch>,
    _library: Library,
}

/// What an instance is made with.
#[derive(Debug, Clone)]
pub(super) struct Identity {
    /// The token or GUID of the description.
    pub token: String,
    /// The folder of resources as a path with a separator at its end (FMI 3.0).
    pub resource_path: String,
    /// The folder of resources as a URI (FMI 2.0).
    pub resource_uri: String,
    /// Whether events of co-simulation are handled by request.
    pub has_event_mode: bool,
    /// Whether steps of co-simulation may end early.
    pub may_return_early: bool,
}

unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(memory: *mut c_void);
    fn fflush(stream: *mut c_void) -> c_int;
}

/// Writes out what units have printed by the library of C and what is still in its buffers.
pub(super) fn flush_printed() {
    // SAFETY: without a stream it is for all of them, and may be called at any time.
    unsafe { fflush(std::ptr::null_mut()) };
}

impl Binary {
    /// Loads the library at a path; its calls are counted by `watch`.
    ///
    /// # Errors
    /// Why the system does not load it, in its own words.
    pub(crate) fn load(
        path: &Path,
        version: Version,
        watch: Arc<CallWatch>,
    ) -> Result<Binary, String> {
        watch.enter(watch.number_of("dlopen"));
        // SAFETY: loading runs code of the library, which the user has allowed.
        let library = unsafe { Library::new(path) }.map_err(|error| {
            let reason = std::error::Error::source(&error).map(ToString::to_string);
            reason.unwrap_or_else(|| error.to_string())
        });
        watch.leave();
        let library = library?;
        let functions = match version {
            Version::V2 => Functions::V2(Box::new(Functions2::of(&library, &watch))),
            Version::V3 => Functions::V3(Box::new(Functions3::of(&library, &watch))),
        };
        let (name, is_there) = match &functions {
            Functions::V2(f) => (f.version.name, f.version.pointer.is_some()),
            Functions::V3(f) => (f.version.name, f.version.pointer.is_some()),
        };
        match is_there {
            true => Ok(Binary { functions, watch, _library: library }),
            false => Err(format!("it has no function `{name}`")),
        }
    }
}

/// An instance, which is freed at its end.
pub(super) struct Component {
    binary: Arc<Binary>,
    handle: Handle,
    log: Box<Log>,
    _callbacks: Box<Callbacks2>,
}

/// A text for C; what follows a NUL is cut off.
pub(super) fn text(text: &str) -> CString {
    CString::new(text.split('\0').next().unwrap_or_default()).unwrap_or_default()
}

impl Component {
    /// Makes an instance.
    pub(crate) fn new(
        binary: &Arc<Binary>,
        kind: InterfaceKind,
        identity: &Identity,
    ) -> Result<Component, (CallError, Vec<super::LogMessage>)> {
        let log = Box::new(Log::default());
        let environment = std::ptr::from_ref::<Log>(&log).cast_mut().cast::<c_void>();
        let callbacks = Box::new(Callbacks2 {
            logger: log_2,
            allocate: calloc,
            free,
            step_finished: None,
            environment,
        });
        let function = maker(&binary.functions, kind);
        binary.watch.enter(binary.watch.number_of(function));
        let made = match &binary.functions {
            Functions::V2(f) => instance_2(f, kind, identity, &callbacks),
            Functions::V3(f) => instance_3(f, kind, identity, environment),
        };
        binary.watch.leave();
        match made {
            Ok(handle) if !handle.is_null() => {
                let binary = binary.clone();
                Ok(Component { binary, handle, log, _callbacks: callbacks })
            }
            Ok(_) => Err((CallError { function, severity: Severity::NoInstance }, log.take())),
            Err(error) => Err((error, log.take())),
        }
    }

    /// The functions of its library.
    pub(super) fn functions(&self) -> &Functions {
        &self.binary.functions
    }

    /// By which functions refer to it.
    pub(super) fn handle(&self) -> Handle {
        self.handle
    }

    /// What counts its calls.
    pub(super) fn watch(&self) -> &CallWatch {
        &self.binary.watch
    }

    /// Takes its messages out.
    pub(crate) fn messages(&self) -> Vec<super::LogMessage> {
        self.log.take()
    }
}

impl Drop for Component {
    fn drop(&mut self) {
        let (number, free) = match &self.binary.functions {
            Functions::V2(f) => (f.free_instance.number, f.free_instance.pointer),
            Functions::V3(f) => (f.free_instance.number, f.free_instance.pointer),
        };
        if let Some(free) = free {
            self.binary.watch.enter(number);
            // SAFETY: the instance lives, and nothing uses it afterwards.
            unsafe { free(self.handle) };
            self.binary.watch.leave();
        }
    }
}

/// The function that makes instances of a kind.
fn maker(functions: &Functions, kind: InterfaceKind) -> &'static str {
    match (functions, kind) {
        (Functions::V2(f), _) => f.instantiate.name,
        (Functions::V3(f), InterfaceKind::ModelExchange) => f.instantiate_exchange.name,
        (Functions::V3(f), InterfaceKind::CoSimulation) => f.instantiate_simulation.name,
        (Functions::V3(f), InterfaceKind::ScheduledExecution) => f.instantiate_scheduled.name,
    }
}

fn instance_2(
    f: &Functions2,
    kind: InterfaceKind,
    identity: &Identity,
    callbacks: &Callbacks2,
) -> Result<Handle, CallError> {
    let Some(make) = f.instantiate.pointer else {
        return Err(CallError { function: f.instantiate.name, severity: Severity::Missing });
    };
    let (name, token) = (text("gapi"), text(&identity.token));
    let resources = text(&identity.resource_uri);
    let kind = c_int::from(kind == InterfaceKind::CoSimulation);
    // SAFETY: the strings live during the call, the callbacks as long as the instance.
    Ok(unsafe {
        make(name.as_ptr(), kind, token.as_ptr(), resources.as_ptr(), &raw const *callbacks, 0, 0)
    })
}

fn instance_3(
    f: &Functions3,
    kind: InterfaceKind,
    identity: &Identity,
    log: Handle,
) -> Result<Handle, CallError> {
    let missing = |function| CallError { function, severity: Severity::Missing };
    let (name, token) = (text("gapi"), text(&identity.token));
    let resources = text(&identity.resource_path);
    let (name, token, resources) = (name.as_ptr(), token.as_ptr(), resources.as_ptr());
    let Identity { has_event_mode, may_return_early, .. } = identity;
    // SAFETY: the strings live during the call, the log as long as the instance.
    match kind {
        InterfaceKind::ModelExchange => {
            let make = f.instantiate_exchange;
            let make = make.pointer.ok_or(missing(make.name))?;
            Ok(unsafe { make(name, token, resources, false, false, log, log_3) })
        }
        InterfaceKind::ScheduledExecution => {
            let make = f.instantiate_scheduled;
            let make = make.pointer.ok_or(missing(make.name))?;
            // What has changed is asked for after each part, and none is interrupted.
            Ok(unsafe {
                make(name, token, resources, false, false, log, log_3, ignore, nothing, nothing)
            })
        }
        InterfaceKind::CoSimulation => {
            let make = f.instantiate_simulation;
            let make = make.pointer.ok_or(missing(make.name))?;
            let (events, early) = (*has_event_mode, *may_return_early);
            let none = std::ptr::null();
            Ok(unsafe {
                make(name, token, resources, false, false, events, early, none, 0, log, log_3, None)
            })
        }
    }
}

unsafe extern "C" fn ignore(_: Handle) {}

unsafe extern "C" fn nothing() {}

/// Keeps a message of FMI 3.0. Units do not unwind, and neither does this.
unsafe extern "C" fn log_3(
    log: Handle,
    status: Status,
    category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: the environment is the log of the instance, which lives longer than it; a unit that
    // gives none back has no messages.
    let log = unsafe { log.cast::<Log>().as_ref() };
    if let Some(log) = log {
        // SAFETY: the strings live during the call.
        let (category, message) = unsafe { (read(category), read(message)) };
        log.add(matches!(status, 1..=4), &category, &message);
    }
}

/// Keeps a message of FMI 2.0. The values of what it formats are in arguments that Rust cannot
/// read; the message is kept as it is.
unsafe extern "C" fn log_2(
    log: Handle,
    _instance: *const c_char,
    status: Status,
    category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: as the other one.
    unsafe { log_3(log, status, category, message) }
}

/// A text of C.
unsafe fn read(text: *const c_char) -> String {
    match text.is_null() {
        true => String::new(),
        // SAFETY: strings end with NUL.
        false => unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned(),
    }
}
