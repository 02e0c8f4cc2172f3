//! Why a function failed: numbers, explained by [`Functions::explain`](super::Functions::explain).

use std::cell::RefCell;

thread_local! {
    /// The function in C that failed last in this thread, and what it said: what it says depends on
    /// values that are gone when the failure is explained.
    pub(super) static LAST_C_MESSAGE: RefCell<(&'static str, String)> = const { RefCell::new(("", String::new())) };
}

/// What the function in C of this name said when it failed last in this thread.
pub(super) fn said(name: &str) -> Option<String> {
    LAST_C_MESSAGE.with_borrow(|(known, message)| (*known == name).then(|| message.clone()))
}

/// Why and where a function failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Failure {
    /// Which code.
    pub function: u32,
    /// Which instruction.
    pub at: u32,
    /// What happened there.
    pub reason: Reason,
}

/// What happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Reason {
    /// An operation without a finite value.
    NotFinite,
    /// A variable without value is used or returned.
    Unassigned,
    /// A subscript outside its array.
    Subscript,
    /// An `assert` that does not hold, or a call that ends the simulation.
    Assertion,
    /// A loop's range without end.
    Range,
    /// Too many instructions in one call.
    Budget,
    /// Calls nested too deep.
    Depth,
    /// An external function has no result; the machine knows why.
    External,
    /// The derivative does not exist or is not finite.
    Derivative,
}

impl Reason {
    /// All of them, in the order of their numbers.
    pub const ALL: [Reason; 9] = [
        Reason::NotFinite,
        Reason::Unassigned,
        Reason::Subscript,
        Reason::Assertion,
        Reason::Range,
        Reason::Budget,
        Reason::Depth,
        Reason::External,
        Reason::Derivative,
    ];

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Reason::NotFinite => "an operation has no finite value",
            Reason::Unassigned => "a variable has no value",
            Reason::Subscript => "a subscript lies outside its array",
            Reason::Assertion => "an assertion failed",
            Reason::Range => "the range of a loop never ends",
            Reason::Budget => "too many instructions",
            Reason::Depth => "calls are nested too deeply",
            Reason::External => "an external function has no result",
            Reason::Derivative => "the derivative is not finite",
        }
    }
}
