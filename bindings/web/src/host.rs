//! What the module asks of its host: a clock, a receiver of events, and the user's commands.
//!
//! `gapilib.js` gives the functions. [`poll`] may suspend the module while the host looks for
//! messages (JavaScript Promise Integration), where the engine can.

mod imported {
    #[link(wasm_import_module = "host")]
    unsafe extern "C" {
        pub(super) safe fn monotonic() -> f64;
        pub(super) safe fn unix() -> f64;
        pub(super) safe fn poll() -> i32;
        pub(super) safe fn next_line() -> i32;
        pub(super) safe fn send(place: *const u8, length: usize);
    }
}

/// A command of the user to a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Command {
    /// The run continues.
    Continue,
    /// The run is to end.
    Stop,
    /// There are statements to be executed.
    Change,
}

/// Seconds since an arbitrary moment.
pub(crate) fn monotonic() -> f64 {
    imported::monotonic()
}

/// Seconds since 1970-01-01 00:00 UTC.
pub(crate) fn unix() -> f64 {
    imported::unix()
}

/// Lets the host look for messages, and returns the command that came.
pub(crate) fn poll() -> Command {
    match imported::poll() {
        1 => Command::Stop,
        2 => Command::Change,
        _ => Command::Continue,
    }
}

/// The next statement that the user has typed, if there is one.
pub(crate) fn next_line() -> Option<String> {
    (imported::next_line() != 0)
        .then(|| String::from_utf8_lossy(&crate::take_request()).into_owned())
}

/// Sends the host an event, as JSON.
pub(crate) fn send(event: &serde_json::Value) {
    let text = event.to_string();
    imported::send(text.as_ptr(), text.len());
}
