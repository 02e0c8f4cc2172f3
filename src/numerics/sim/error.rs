//! Why an evaluation or a simulation failed: numbers and indices, no names.

/// Why one evaluation of a system failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Failure {
    /// An argument outside a function's domain, a division by zero, or an overflow: numbers that the
    /// system can explain.
    Domain {
        /// Which equation.
        origin: u32,
        /// Which operation in it.
        operation: u32,
    },
    /// A function of the model failed: numbers that the system can explain.
    Function {
        /// Which function.
        function: u32,
        /// Where in it.
        at: u32,
        /// Why.
        reason: u8,
    },
    /// An `assert` of level error does not hold.
    Assertion {
        /// Which one.
        assertion: u32,
    },
    /// A nonlinear block did not converge.
    Newton {
        /// Which block.
        block: u32,
    },
    /// A linear block is singular.
    Singular {
        /// Which block.
        block: u32,
    },
    /// Initial values could not be found.
    Initialization {
        /// Which block of the initial system.
        block: u32,
    },
    /// The initial values contradict an initial equation that was not needed to find them.
    Inconsistent {
        /// Which one.
        check: u32,
    },
    /// Event iteration did not end.
    EventIteration {
        /// A variable that kept changing; the system can explain it.
        variable: u32,
    },
}

/// Why a simulation failed, and when.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{kind:?} at t = {time}")]
pub struct SimError {
    /// Simulated time, seconds.
    pub time: f64,
    /// Why.
    pub kind: SimErrorKind,
    /// What was in the way, if that is known.
    pub offending: Option<Offending>,
}

/// What was in the way of a simulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Offending {
    /// A component of (x, v): it or its derivative is not finite, or it changes faster than the
    /// others, relative to its nominal value.
    Unknown(u32),
    /// The crossing function that changed its sign last.
    Crossing(u32),
}

/// The kinds of failure of a simulation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SimErrorKind {
    /// Initial values could not be found.
    Initialization(Failure),
    /// An evaluation failed, also with the smallest step.
    Evaluation(Failure),
    /// The error test or the nonlinear solver kept failing down to the smallest step.
    StepSize,
    /// More steps than the budget allows.
    StepBudget,
    /// More wall-clock time than the budget allows.
    TimeBudget,
    /// [`Settings::cancel`](super::Settings::cancel) was set.
    Cancelled,
    /// Start or stop time is not finite, or the tolerance is not between 1e-14 and 1.
    Settings,
    /// The method is explicit and the system has algebraic unknowns.
    ExplicitMethod,
    /// The iteration matrix is singular at the smallest step.
    Singular,
    /// More events than make sense in this interval.
    Chattering,
    /// Infinitely many events up to a time, and no solution beyond it.
    Accumulation,
    /// A value became infinite or not a number.
    NotFinite,
}
