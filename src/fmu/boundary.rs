//! Instances as pointers, and what errors and panics become there.

#![allow(unsafe_code, reason = "callers in other languages hand over pointers")]

use crate::fmi::export::ValueKind;
use crate::instance::{Instance, State, Wrong};
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

/// The statuses of both versions.
pub(crate) const OK: c_int = 0;
pub(crate) const DISCARD: c_int = 2;
pub(crate) const ERROR: c_int = 3;

/// The logger of FMI 2.0.
pub(crate) type Logger2 =
    unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);
/// The logger of FMI 3.0.
pub(crate) type Logger3 = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

/// Where messages go.
#[derive(Clone, Copy)]
pub(crate) enum Logger {
    Version2(Option<Logger2>),
    Version3(Option<Logger3>),
}

/// Messages to the importer.
pub(crate) struct Log {
    pub(crate) logger: Logger,
    pub(crate) environment: *mut c_void,
    pub(crate) name: CString,
    pub(crate) is_on: bool,
    /// Categories that are asked for; all where none is named.
    pub(crate) categories: Vec<String>,
}

/// What the pointer to an instance points to.
pub(crate) struct Handle {
    pub(crate) instance: Instance,
    pub(crate) log: Log,
    /// When the last step of co-simulation ended, and whether the model ended the simulation.
    pub(crate) last_successful_time: f64,
    pub(crate) is_terminated: bool,
}

impl Log {
    /// Errors are always said, other messages where they are asked for.
    pub(crate) fn say(&self, status: c_int, category: &str, message: &str) {
        let is_named = self.categories.is_empty() || self.categories.iter().any(|c| c == category);
        if status < DISCARD && !(self.is_on && is_named) {
            return;
        }
        let text = |text: &str| CString::new(text.replace('\0', " ")).unwrap_or_default();
        let category = text(category);
        match self.logger {
            Logger::Version2(Some(logger)) => {
                // The message is a format, without arguments: importers that cannot take any, such as
                // those in other languages than C, show it as it is.
                let message = text(&message.replace('%', "%%"));
                // SAFETY: the importer's function has this signature by the standard.
                unsafe {
                    logger(
                        self.environment,
                        self.name.as_ptr(),
                        status,
                        category.as_ptr(),
                        message.as_ptr(),
                    );
                }
            }
            Logger::Version3(Some(logger)) => {
                let message = text(message);
                // SAFETY: the importer's function has this signature by the standard.
                unsafe {
                    logger(self.environment, status, category.as_ptr(), message.as_ptr());
                }
            }
            Logger::Version2(None) | Logger::Version3(None) => {}
        }
    }

    /// Why a function failed, and its status.
    pub(crate) fn failed(&self, function: &str, wrong: &Wrong) -> c_int {
        let (status, message) = match wrong {
            Wrong::Error(message) => (ERROR, message),
            Wrong::Discard(message) => (DISCARD, message),
        };
        self.say(status, "logStatusError", &format!("{function}: {message}"));
        status
    }
}

/// Runs a function on an instance; its status.
pub(crate) fn call(
    instance: *mut c_void,
    function: &str,
    run: impl FnOnce(&mut Handle) -> Result<(), Wrong>,
) -> c_int {
    if instance.is_null() {
        return ERROR;
    }
    // SAFETY: the pointer came from `hand_over`; the standard forbids calls from several threads at
    // once, and calls after the instance was freed.
    let handle = unsafe { &mut *instance.cast::<Handle>() };
    let done = catch_unwind(AssertUnwindSafe(|| run(handle)));
    for (is_warning, message) in handle.instance.new_messages() {
        match is_warning {
            true => handle.log.say(1, "logStatusWarning", &message),
            false => handle.log.say(OK, "logEvents", &message),
        }
    }
    match done {
        Ok(Ok(())) => OK,
        Ok(Err(wrong)) => handle.log.failed(function, &wrong),
        Err(_) => {
            let wrong = Wrong::from("a fault of the program: please report it with the model");
            handle.log.failed(function, &wrong)
        }
    }
}

/// Makes an instance a pointer; null where it could not be made.
pub(crate) fn hand_over(
    log: Log,
    function: &str,
    make: impl FnOnce() -> Result<Instance, Wrong>,
) -> *mut c_void {
    let made = catch_unwind(AssertUnwindSafe(make));
    let made = made.unwrap_or_else(|_| Err("a fault of the program: please report it".into()));
    match made {
        Ok(instance) => {
            let handle = Handle { instance, log, last_successful_time: 0.0, is_terminated: false };
            Box::into_raw(Box::new(handle)).cast()
        }
        Err(wrong) => {
            log.failed(function, &wrong);
            std::ptr::null_mut()
        }
    }
}

/// Frees what [`hand_over`] has made.
pub(crate) fn take_back(instance: *mut c_void) {
    if !instance.is_null() {
        // SAFETY: the pointer came from `hand_over` and is used no more, by the standard.
        drop(unsafe { Box::from_raw(instance.cast::<Handle>()) });
    }
}

/// The text at a pointer; empty for null.
pub(crate) fn text(pointer: *const c_char) -> String {
    if pointer.is_null() {
        return String::new();
    }
    // SAFETY: a string of C by the standard.
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
}

/// The strings at an array of pointers.
pub(crate) fn strings(pointers: *const *const c_char, n: usize) -> Result<Vec<String>, Wrong> {
    Ok(slice(pointers, n)?.iter().map(|pointer| text(*pointer)).collect())
}

/// The numbers at a pointer.
pub(crate) fn slice<'a, T>(pointer: *const T, n: usize) -> Result<&'a [T], Wrong> {
    match (n, pointer.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err("an array is missing".into()),
        // SAFETY: an array of this length by the standard.
        (_, false) => Ok(unsafe { std::slice::from_raw_parts(pointer, n) }),
    }
}

/// The numbers at a pointer, to be written.
pub(crate) fn slice_mut<'a, T>(pointer: *mut T, n: usize) -> Result<&'a mut [T], Wrong> {
    match (n, pointer.is_null()) {
        (0, _) => Ok(&mut []),
        (_, true) => Err("an array is missing".into()),
        // SAFETY: an array of this length by the standard, which no one else uses meanwhile.
        (_, false) => Ok(unsafe { std::slice::from_raw_parts_mut(pointer, n) }),
    }
}

/// Writes a result, if there is a place for it.
pub(crate) fn write<T>(place: *mut T, value: T) {
    if !place.is_null() {
        // SAFETY: a place for one value by the standard.
        unsafe { place.write(value) };
    }
}

/// Reads variables of some types by their value references.
pub(crate) fn get<T>(
    handle: &mut Handle,
    kinds: &[ValueKind],
    convert: fn(f64) -> Result<T, Wrong>,
    (references, values): (&[u32], &mut [T]),
) -> Result<(), Wrong> {
    for (value, reference) in values.iter_mut().zip(references) {
        *value = convert(handle.instance.value(*reference, kinds)?)?;
    }
    Ok(())
}

/// Sets variables of some types by their value references.
pub(crate) fn set<T: Copy>(
    handle: &mut Handle,
    kinds: &[ValueKind],
    convert: fn(T) -> f64,
    (references, values): (&[u32], &[T]),
) -> Result<(), Wrong> {
    for (value, reference) in values.iter().zip(references) {
        handle.instance.set(*reference, convert(*value), kinds)?;
    }
    Ok(())
}

/// Reads Strings by their value references.
pub(crate) fn get_strings(
    handle: &Handle,
    (references, values): (&[u32], &mut [*const c_char]),
) -> Result<(), Wrong> {
    for (value, reference) in values.iter_mut().zip(references) {
        *value = handle.instance.string(*reference)?.as_ptr();
    }
    Ok(())
}

/// Refuses to set Strings.
pub(crate) fn set_strings(n: usize) -> Result<(), Wrong> {
    match n {
        0 => Ok(()),
        _ => Err("Strings of the unit are constants: export the model with other ones".into()),
    }
}

/// Keeps the state of an instance: a new one, or in the place of one that was kept.
pub(crate) fn keep_state(handle: &Handle, place: *mut *mut c_void) -> Result<(), Wrong> {
    put_state(handle.instance.state.clone(), place)
}

fn put_state(state: State, place: *mut *mut c_void) -> Result<(), Wrong> {
    let place = slice_mut(place, 1)?;
    let state = Box::new(state);
    match place[0].is_null() {
        true => place[0] = Box::into_raw(state).cast(),
        // SAFETY: it came from here by the standard.
        false => unsafe { *place[0].cast::<State>() = *state },
    }
    Ok(())
}

/// Restores a state that was kept.
pub(crate) fn restore_state(handle: &mut Handle, kept: *mut c_void) -> Result<(), Wrong> {
    if kept.is_null() {
        return Err("there is no state".into());
    }
    // SAFETY: it came from `keep_state` by the standard.
    handle.instance.state = unsafe { &*kept.cast::<State>() }.clone();
    handle.instance.derivatives.forget();
    Ok(())
}

/// How many bytes a state becomes.
pub(crate) fn state_size(
    handle: &Handle,
    kept: *mut c_void,
    size: *mut usize,
) -> Result<(), Wrong> {
    write(size, state_bytes(handle, kept)?.len());
    Ok(())
}

/// Writes a state that was kept as bytes.
pub(crate) fn write_state(
    handle: &Handle,
    kept: *mut c_void,
    (bytes, size): (*mut u8, usize),
) -> Result<(), Wrong> {
    let own = state_bytes(handle, kept)?;
    let out = slice_mut(bytes, size)?;
    match out.get_mut(..own.len()) {
        Some(out) => out.copy_from_slice(&own),
        None => return Err(Wrong::Error(format!("the state has {} bytes", own.len()))),
    }
    Ok(())
}

fn state_bytes(handle: &Handle, kept: *mut c_void) -> Result<Vec<u8>, Wrong> {
    if kept.is_null() {
        return Err("there is no state".into());
    }
    // SAFETY: it came from `keep_state` or `read_state` by the standard.
    handle.instance.bytes_of(unsafe { &*kept.cast::<State>() })
}

/// Makes a state of bytes: a new one, or in the place of one that was kept.
pub(crate) fn read_state(
    handle: &Handle,
    (bytes, size): (*const u8, usize),
    place: *mut *mut c_void,
) -> Result<(), Wrong> {
    let state = handle.instance.state_in(slice(bytes, size)?)?;
    put_state(state, place)
}

/// Frees a state that was kept.
pub(crate) fn free_state(place: *mut *mut c_void) -> Result<(), Wrong> {
    let place = slice_mut(place, 1)?;
    if !place[0].is_null() {
        // SAFETY: it came from `keep_state` by the standard.
        drop(unsafe { Box::from_raw(place[0].cast::<State>()) });
        place[0] = std::ptr::null_mut();
    }
    Ok(())
}

/// The folder of the resources: a path, or a URI of a file.
pub(crate) fn folder(location: &str) -> PathBuf {
    let Some(rest) = location.strip_prefix("file:") else { return PathBuf::from(location) };
    let path = rest.strip_prefix("//").map_or(rest, |rest| match rest.find('/') {
        Some(slash) => &rest[slash..],
        None => rest,
    });
    let mut bytes = Vec::new();
    let mut rest = path.bytes();
    while let Some(byte) = rest.next() {
        let mut ahead = rest.clone();
        let digit = |byte: Option<u8>| (byte? as char).to_digit(16);
        match (byte, digit(ahead.next()), digit(ahead.next())) {
            (b'%', Some(high), Some(low)) => {
                bytes.push((16 * high + low) as u8);
                rest = ahead;
            }
            _ => bytes.push(byte),
        }
    }
    let path = String::from_utf8_lossy(&bytes).into_owned();
    // `file:///C:/folder` of Windows.
    match path.strip_prefix('/') {
        Some(drive) if drive.as_bytes().get(1) == Some(&b':') => PathBuf::from(drive),
        _ => PathBuf::from(path),
    }
}

#[cfg(test)]
mod tests {
    use super::folder;
    use std::path::PathBuf;

    #[test]
    fn resources_are_where_paths_and_uris_say() {
        for (location, path) in [
            ("/tmp/a b/resources/", "/tmp/a b/resources/"),
            ("file:///tmp/a%20b/resources", "/tmp/a b/resources"),
            ("file:/tmp/r", "/tmp/r"),
            ("file://localhost/tmp/r", "/tmp/r"),
            ("file:///C:/r", "C:/r"),
            ("file:///tmp/100%", "/tmp/100%"),
        ] {
            assert_eq!(folder(location), PathBuf::from(path), "{location}");
        }
    }
}
