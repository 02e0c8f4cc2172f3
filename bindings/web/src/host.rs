//! What the module asks of its host: a clock, an ear for events, and what the user wants meanwhile.
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
        pub(super) safe fn tell(place: *const u8, length: usize);
    }
}

/// What the user wants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wish {
    /// Nothing: the run goes on.
    Nothing,
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

/// Lets the host look for messages, and asks what they say.
pub(crate) fn poll() -> Wish {
    match imported::poll() {
        1 => Wish::Stop,
        2 => Wish::Change,
        _ => Wish::Nothing,
    }
}

/// The next statement that the user has typed, if there is one.
pub(crate) fn next_line() -> Option<String> {
    (imported::next_line() != 0)
        .then(|| String::from_utf8_lossy(&crate::take_request()).into_owned())
}

/// Tells the host something, as JSON.
pub(crate) fn tell(event: &serde_json::Value) {
    let text = event.to_string();
    imported::tell(text.as_ptr(), text.len());
}
