//! A shared object in this process: the one place where C is called.
//!
//! One thread is in C at a time, in any of the objects: libraries do not promise more, and errors
//! and messages are kept in variables of the object.

#![allow(unsafe_code, reason = "functions of another language can only be called so")]

use crate::diag::Fault;
use crate::external::c::{CLibrary, Cell, Frame};
use crate::external::errors::EXTERNAL_COMPILER;
use crate::fault;
use libloading::Library;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Held while a thread is in C.
static IN_C: Mutex<()> = Mutex::new(());

/// A wrapper of a unit.
type Wrapper = unsafe extern "C" fn(*mut *mut c_void) -> c_int;
/// What a unit says: its error, its log.
type Text = unsafe extern "C" fn() -> *const c_char;
/// Frees what a call has allocated.
type Release = unsafe extern "C" fn();

/// A shared object; it stays loaded, because objects may hold pointers into it.
pub(super) struct Loaded {
    library: Library,
    key: String,
    error: Text,
    log: Text,
    release: Release,
}

impl Loaded {
    /// Loads a shared object that [`super::compiled`] made.
    pub(super) fn open(path: &Path, key: String) -> Result<Loaded, Fault> {
        let cannot = |error: libloading::Error| {
            fault!(EXTERNAL_COMPILER, "the compiled C code cannot be loaded: {error}";
                help: "libraries that it needs must be where the system finds them, or in the \
                       folder of `LibraryDirectory`")
        };
        // SAFETY: loading runs the constructors of the object, which the user has allowed. The
        // three functions have these types in `utilities.c`, which is part of every unit, and the
        // digest of the file was compared with that of the one that the compiler wrote.
        unsafe {
            let library = Library::new(path).map_err(cannot)?;
            let error = *library.get::<Text>(b"gapi_error\0").map_err(cannot)?;
            let log = *library.get::<Text>(b"gapi_log\0").map_err(cannot)?;
            let release = *library.get::<Release>(b"gapi_release\0").map_err(cannot)?;
            Ok(Loaded { library, key, error, log, release })
        }
    }
}

/// What the row of pointers points to, besides the numbers of the frame.
enum Held {
    Numbers,
    Strings(Vec<*const c_char>),
    Object(*mut c_void),
}

impl Held {
    fn of(cell: &Cell) -> Held {
        match cell {
            Cell::Strings(strings) => {
                Held::Strings(strings.iter().map(|text| text.as_ptr()).collect())
            }
            Cell::Object(address) => Held::Object(std::ptr::with_exposed_provenance_mut(*address)),
            Cell::Reals(_) | Cell::Wholes(_) | Cell::Size(_) => Held::Numbers,
        }
    }

    fn pointer(&mut self, cell: &mut Cell) -> *mut c_void {
        match (self, cell) {
            (Held::Strings(strings), _) => strings.as_mut_ptr().cast(),
            (Held::Object(object), _) => std::ptr::from_mut(object).cast(),
            (Held::Numbers, Cell::Reals(numbers)) => numbers.as_mut_ptr().cast(),
            (Held::Numbers, Cell::Wholes(numbers)) => numbers.as_mut_ptr().cast(),
            (Held::Numbers, Cell::Size(size)) => std::ptr::from_mut(size).cast(),
            (Held::Numbers, Cell::Strings(_) | Cell::Object(_)) => std::ptr::null_mut(),
        }
    }
}

impl CLibrary for Loaded {
    fn key(&self) -> &str {
        &self.key
    }

    fn invoke(&self, function: usize, frame: &mut Frame) -> Result<(), String> {
        let _alone = IN_C.lock().unwrap_or_else(PoisonError::into_inner);
        let name = format!("gapi_call_{function}\0");
        let mut held: Vec<Held> = frame.cells.iter().map(Held::of).collect();
        let mut row: Vec<*mut c_void> =
            held.iter_mut().zip(&mut frame.cells).map(|(held, cell)| held.pointer(cell)).collect();
        // SAFETY: the wrapper was made from the declaration that the frame was made from, so every
        // pointer of the row points to what the wrapper reads and writes there; all of it lives in
        // `held` and `frame` until the end of this function. `longjmp` ends in the wrapper: no frame
        // of Rust is left by it. What the function itself does with its arguments is up to the
        // library, whose code the user has allowed.
        let done = unsafe {
            let wrapper =
                self.library.get::<Wrapper>(name.as_bytes()).map_err(|error| error.to_string())?;
            wrapper(row.as_mut_ptr())
        };
        // SAFETY: both give strings that end with zero and live until `gapi_release`.
        let (log, error) = unsafe { (copied((self.log)()), copied((self.error)())) };
        frame.log = log.to_string_lossy().into_owned();
        let mut missing = false;
        for (cell, held) in frame.cells.iter_mut().zip(held) {
            match (cell, held) {
                (Cell::Object(address), Held::Object(object)) => {
                    *address = object.expose_provenance();
                }
                (Cell::Strings(strings), Held::Strings(pointers)) if done == 0 => {
                    for (text, pointer) in strings.iter_mut().zip(pointers) {
                        missing |= pointer.is_null();
                        if pointer != text.as_ptr() && !pointer.is_null() {
                            // SAFETY: a string of the call, alive until `gapi_release`.
                            *text = unsafe { copied(pointer) };
                        }
                    }
                }
                _ => {}
            }
        }
        // SAFETY: everything that the call has allocated was copied.
        unsafe { (self.release)() };
        match (done, missing) {
            (0, false) => Ok(()),
            (0, true) => Err("it returned a null pointer for a String".to_owned()),
            _ => Err(error.to_string_lossy().into_owned()),
        }
    }
}

/// A copy of a string of C.
///
/// # Safety
/// The pointer is that of a string that ends with zero.
unsafe fn copied(pointer: *const c_char) -> CString {
    // SAFETY: as promised by the caller.
    unsafe { CStr::from_ptr(pointer) }.to_owned()
}
