//! gapilib as a WebAssembly module: `gapilib.js` puts a request into its memory and takes the answer
//! out of it, both JSON ([`protocol`]). While it works it may ask its host ([`host`]).
//!
//! ```text
//!   request(length) ─▶ where the host writes the request
//!   run()           ─▶ answers it; the answer is in memory then
//!   answer(), answer_length()
//! ```
//!
//! A panic is a trap: the host finds its message where the answer would be. The module must be
//! loaded again after it.

mod host;
mod lessons;
mod protocol;
mod runs;
mod steps;
mod world;

use std::sync::{Mutex, MutexGuard, Once, PoisonError};

static REQUEST: Mutex<Vec<u8>> = Mutex::new(Vec::new());
static ANSWER: Mutex<Vec<u8>> = Mutex::new(Vec::new());

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What the host has written, once.
fn take_request() -> Vec<u8> {
    std::mem::take(&mut *lock(&REQUEST))
}

/// Keeps the message of a panic for the host.
fn keep_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        std::panic::set_hook(Box::new(|panic| *lock(&ANSWER) = panic.to_string().into_bytes()));
    });
}

/// Makes room for a request of `length` bytes of UTF-8, and returns where it goes.
#[unsafe(no_mangle)]
pub extern "C" fn request(length: usize) -> *mut u8 {
    keep_panics();
    let room = vec![0; length];
    let mut request = lock(&REQUEST);
    *request = room;
    request.as_mut_ptr()
}

/// Answers the request.
#[unsafe(no_mangle)]
pub extern "C" fn run() {
    keep_panics();
    lock(&ANSWER).clear();
    let answer = protocol::answer(&take_request());
    *lock(&ANSWER) = answer;
}

/// Where the answer is, or the message of a panic.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    lock(&ANSWER).as_ptr()
}

/// How many bytes of UTF-8 it has.
#[unsafe(no_mangle)]
pub extern "C" fn answer_length() -> usize {
    lock(&ANSWER).len()
}
