//! gapilib as a WebAssembly module without imports: `gapilib.js` puts a request into its memory and
//! takes the answer out of it, both JSON ([`protocol`]).
//!
//! ```text
//!   request(length) ─▶ where the host writes the request
//!   run()           ─▶ answers it; the answer is in memory then
//!   answer(), answer_length()
//! ```
//!
//! A panic is a trap: the host finds its message where the answer would be. The module must be
//! loaded anew after it.

mod protocol;

use std::sync::{Mutex, MutexGuard, PoisonError};

static REQUEST: Mutex<Vec<u8>> = Mutex::new(Vec::new());
static ANSWER: Mutex<Vec<u8>> = Mutex::new(Vec::new());

fn lock(buffer: &Mutex<Vec<u8>>) -> MutexGuard<'_, Vec<u8>> {
    buffer.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes room for a request of `length` bytes of UTF-8, and returns where it goes.
#[unsafe(no_mangle)]
pub extern "C" fn request(length: usize) -> *mut u8 {
    let mut request = lock(&REQUEST);
    *request = vec![0; length];
    request.as_mut_ptr()
}

/// Answers the request.
#[unsafe(no_mangle)]
pub extern "C" fn run() {
    std::panic::set_hook(Box::new(|panic| *lock(&ANSWER) = panic.to_string().into_bytes()));
    let request = std::mem::take(&mut *lock(&REQUEST));
    let answer = protocol::answer(&request);
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
