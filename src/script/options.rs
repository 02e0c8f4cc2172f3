//! How a session behaves: dialect, echo, strictness, permissions.

use super::access::permissions::Permissions;
use crate::identify::Probe;

/// The tool whose rules hold where the two differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Dialect {
    /// Dymola's.
    #[default]
    Dymola,
    /// OpenModelica's.
    OpenModelica,
}

impl Dialect {
    /// The tool whose it is.
    pub fn name(self) -> &'static str {
        match self {
            Dialect::Dymola => "Dymola",
            Dialect::OpenModelica => "OpenModelica",
        }
    }
}

/// What is shown without being asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Echo {
    /// In Dymola's dialect the values of expressions alone; in OpenModelica's everything.
    #[default]
    Usual,
    /// As the dialect's tool answers at its prompt: values and declared variables, not the
    /// statements, which stand there already.
    Dialogue,
    /// Statements and values, as the dialect's tool shows them.
    Everything,
    /// Nothing.
    Nothing,
}

/// What an error does to a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Strictness {
    /// The script continues; the run ends with exit code 1 if the error was not read.
    #[default]
    Usual,
    /// The first error ends the run.
    Strict,
    /// The script continues and the run ends with exit code 0.
    Lenient,
}

/// Whether a run of scripts ends with the report of its identification.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Reporting {
    /// A table is printed, and files are written.
    #[default]
    Usual,
    /// Neither.
    Off,
}

/// How a session behaves.
///
/// ```
/// use gapilib_modelica::value::Value;
/// use gapilib_script::world::MemoryWorld;
/// use gapilib_script::{Dialect, Options, Session, Strictness};
///
/// let options = Options {
///     dialect: Some(Dialect::OpenModelica),
///     strictness: Strictness::Strict,
///     ..Options::default()
/// };
/// let mut session = Session::new(Box::new(MemoryWorld::new())).with_options(options);
/// // The first error ends the run.
/// session.run_text("input", "x := 1; y := nothing + 1; x := 2;");
/// assert_eq!(session.variable("x"), Some(&Value::Integer(1)));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Options {
    /// The dialect; `None` to recognize it from the script.
    pub dialect: Option<Dialect>,
    /// What is shown.
    pub echo: Echo,
    /// What an error does.
    pub strictness: Strictness,
    /// Whether only errors are written to standard error, no warnings and notes.
    pub quiet: bool,
    /// What scripts may do outside, from [`Session::with_options`](crate::Session::with_options) on: later
    /// changes have no effect.
    pub permissions: Permissions,
    /// Whether what the simulations answer is kept on the way.
    pub journaling: Journaling,
    /// What ends an identification after the script's own search.
    pub probe: Probe,
    /// Whether an identification is reported at the end.
    pub reporting: Reporting,
}

/// Whether a run of scripts keeps a journal of its simulations in the output folder, from which it
/// can go on when it was killed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Journaling {
    /// It does not.
    #[default]
    Off,
    /// It does, rewritten after this many seconds each time, and begins from the start.
    Fresh(f64),
    /// It does, and continues from what an earlier run has left.
    Resume(f64),
}
