//! The state of execution: the scripts being run, the command that was called, and why execution
//! stops.

use crate::options::Strictness;
use crate::source::Span;

/// How a run ended.
///
/// ```
/// use gapilib_script::Session;
/// use gapilib_script::world::MemoryWorld;
///
/// let mut session = Session::new(Box::new(MemoryWorld::new()));
/// let status = session.run_text("input", "x = 1/0");
/// assert_eq!((status.errors, status.code), (1, 1));
/// let status = session.run_text("input", "exit(3)");
/// assert_eq!((status.exit, status.code), (Some(3), 3));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct RunStatus {
    /// Errors that happened and that the script did not ask for.
    pub errors: usize,
    /// Whether Ctrl-C ended it.
    pub interrupted: bool,
    /// The argument of `exit`, if it was called.
    pub exit: Option<i32>,
    /// The exit code of the process: what `exit` said, 130 when interrupted, 1 with unread
    /// errors, else 0.
    pub code: u8,
}

/// Why statements are no longer executed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stop {
    /// `exit` was called.
    Exit(i32),
    /// Ctrl-C.
    Interrupt,
    /// An error with [`Strictness::Strict`].
    Error,
}

/// The iteration of a loop, from 0, and the number of iterations if it is known.
pub(crate) type Iteration = (usize, Option<usize>);

/// Where the execution of scripts is.
#[derive(Debug, Default)]
pub(crate) struct Execution {
    /// How many scripts have called each other.
    scripts: usize,
    stop: Option<Stop>,
    /// Whether the outermost script is a file, not what was typed at a prompt.
    is_file: bool,
    /// Where the command that is being run was called.
    call: Option<Span>,
    /// Whether that was in a function, whose variables the command does not see.
    in_function: bool,
    /// How deep the statement being executed lies in loops, branches and nested scripts: answers
    /// are echoed at depth 0.
    depth: usize,
    /// The iteration of the outermost loop being run.
    iteration: Option<Iteration>,
}

impl Execution {
    /// A script begins.
    pub(crate) fn enter(&mut self) {
        self.scripts += 1;
    }

    /// The innermost script ends.
    pub(crate) fn leave(&mut self) {
        self.scripts -= 1;
    }

    /// Whether the outermost script is a file from here on.
    pub(crate) fn set_file(&mut self, is_file: bool) {
        self.is_file = is_file;
    }

    /// Whether a statement of a text that is no file is being executed, not one of a script that it runs.
    pub(crate) fn is_typed(&self) -> bool {
        !self.is_file && self.scripts <= 1
    }

    /// How many scripts have called each other.
    pub(crate) fn scripts(&self) -> usize {
        self.scripts
    }

    /// Why execution stops, if it does.
    pub(crate) fn stop(&self) -> Option<Stop> {
        self.stop
    }

    /// Execution stops, for the first reason that is given.
    pub(crate) fn stop_for(&mut self, reason: Stop) {
        self.stop.get_or_insert(reason);
    }

    /// The script asks to end with this status.
    pub(crate) fn exit(&mut self, status: i32) {
        self.stop = Some(Stop::Exit(status));
    }

    /// Where the command that is being run was called.
    pub(crate) fn call(&self) -> Span {
        self.call.unwrap_or(Span::NONE)
    }

    /// A command is called here; where the one around it was.
    pub(crate) fn begin_call(&mut self, call: Span) -> Option<Span> {
        self.call.replace(call)
    }

    /// The command has ended.
    pub(crate) fn end_call(&mut self, around: Option<Span>) {
        self.call = around;
    }

    /// Whether the command that is being run was called in a function.
    pub(crate) fn is_in_function(&self) -> bool {
        self.in_function
    }

    /// Calls are in a function from here on, or not; how it was before.
    pub(crate) fn set_in_function(&mut self, in_function: bool) -> bool {
        std::mem::replace(&mut self.in_function, in_function)
    }

    /// Whether answers are echoed: at the top level.
    pub(crate) fn is_at_top(&self) -> bool {
        self.depth == 0
    }

    /// Statements below the top level begin.
    pub(crate) fn descend(&mut self) {
        self.depth += 1;
    }

    /// Statements below the top level end.
    pub(crate) fn ascend(&mut self) {
        self.depth -= 1;
    }

    /// Statements are at the top level from here on; the depth until now.
    pub(crate) fn go_to_top(&mut self) -> usize {
        std::mem::take(&mut self.depth)
    }

    /// Statements are as deep as they were before.
    pub(crate) fn return_to(&mut self, depth: usize) {
        self.depth = depth;
    }

    /// The iteration of the outermost loop being run.
    pub(crate) fn iteration(&self) -> Option<Iteration> {
        self.iteration
    }

    /// The outermost loop is in this iteration.
    pub(crate) fn iterate(&mut self, iteration: Iteration) {
        self.iteration = Some(iteration);
    }

    /// How the run ended, with so many errors that the script did not ask for.
    pub(crate) fn end(&mut self, errors: usize, strictness: Strictness) -> RunStatus {
        let stop = self.stop.take();
        let interrupted = stop == Some(Stop::Interrupt);
        let exit = match stop {
            Some(Stop::Exit(status)) => Some(status),
            _ => None,
        };
        let code = match (stop, strictness) {
            (Some(Stop::Interrupt), _) => 130,
            (_, Strictness::Lenient) => 0,
            (Some(Stop::Exit(status)), _) if status != 0 => status.clamp(1, 255) as u8,
            (Some(Stop::Error), _) => 1,
            _ => u8::from(errors > 0),
        };
        RunStatus { errors, interrupted, exit, code }
    }
}
