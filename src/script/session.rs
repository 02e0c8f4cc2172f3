//! The session: everything that lasts from one statement to the next.

use super::access::policy::Grant;
use super::language::callees::Callees;
use super::language::follow_up::FollowUps;
use super::language::log::Log;
use super::language::scripts::{Frame, ParsedScripts};
use super::models::classes::Classes;
use super::models::simulation::{Models, Translated};
use super::world::World;
use super::{Messages, Permissions, Transcript};
use crate::diag::{Code, Diagnostic, Fault, render};
use crate::eval::Scope;
use crate::external::Random;
use crate::identify::Probe;
use crate::name::{Ident, Name};
use crate::source::{SourceMap, Span};
use crate::value::Value;
use indexmap::IndexMap;
use std::any::{Any, TypeId};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::sync::Arc;

/// Whose habits a script follows where the two tools differ.
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
    /// The script goes on; the run ends with exit code 1 if nobody read the error.
    #[default]
    Usual,
    /// The first error ends the run.
    Strict,
    /// The script goes on and the run ends with exit code 0.
    Lenient,
}

/// How a session behaves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Options {
    /// The dialect; `None` to recognise it from the script.
    pub dialect: Option<Dialect>,
    /// What is shown.
    pub echo: Echo,
    /// What an error does.
    pub strictness: Strictness,
    /// Whether errors alone are told on standard error, no warnings and notes.
    pub quiet: bool,
    /// What scripts may do outside.
    pub permissions: Permissions,
    /// Whether what the simulations answer is kept on the way.
    pub journaling: Journaling,
    /// What ends an identification behind the script's own search.
    pub probe: Probe,
}

/// Whether a run of scripts keeps a journal of its simulations in the output folder, from which it
/// can go on when it was killed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Journaling {
    /// It does not.
    #[default]
    Off,
    /// It does, written again whenever so many seconds have passed, and begins anew.
    Fresh(f64),
    /// It does, and goes on from what an earlier run has left.
    Resume(f64),
}

/// How a run ended.
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
pub(super) enum Stop {
    /// `exit` was called.
    Exit(i32),
    /// Ctrl-C.
    Interrupt,
    /// An error with [`Strictness::Strict`].
    Error,
}

/// Work that is done when the outermost script ends.
type AtEnd = fn(&mut Session) -> Result<(), Diagnostic>;

/// A session. It owns its world; nothing else reaches the outside.
pub struct Session {
    /// The outside.
    pub world: Box<dyn World>,
    /// All texts read so far.
    pub sources: SourceMap,
    /// What `getErrorString()` and `getLastError()` will tell.
    pub messages: Messages,
    /// What was said and answered, if it is recorded.
    pub transcript: Option<Transcript>,
    /// How the session behaves.
    pub options: Options,
    /// The variables of the scripts.
    pub(super) scope: Scope,
    /// Flags such as `Advanced.StoreProtectedVariables`.
    pub(super) flags: BTreeMap<String, Value>,
    /// What imports in scripts made visible: a name and what it stands for.
    pub(super) imports: IndexMap<Ident, Name>,
    /// Packages whose content an import `P.*` made visible.
    pub(super) open_packages: Vec<Name>,
    /// The dialect that was asked for or recognised.
    pub(super) dialect: Dialect,
    /// The scripts that are being run, outermost first.
    pub(super) frames: Vec<Frame>,
    pub(super) parsed: ParsedScripts,
    pub(super) follow_ups: FollowUps,
    pub(super) stop: Option<Stop>,
    /// Where the command that is being run was called.
    pub(super) call: Span,
    /// Whether that was in a function, whose variables the command does not see.
    pub(super) in_function: bool,
    /// Environment variables that scripts set.
    pub(super) environment: BTreeMap<String, String>,
    /// What was said and answered so far, for `savelog`.
    pub(super) log: Log,
    /// Names of script variables that were said to be parameters of the model too.
    pub(super) shared: BTreeSet<Ident>,
    /// Warnings told, where each is told once.
    told: Option<HashSet<(Span, String)>>,
    /// Commands that said that they have no window.
    pub(super) windowless: BTreeSet<&'static str>,
    /// How deep the statement being executed lies in loops, branches and nested scripts: answers
    /// are echoed at depth 0.
    pub(super) silent: usize,
    /// `echo(false)` was called.
    pub(super) muted: bool,
    pub(super) classes: Classes,
    pub(super) models: Models,
    pub(super) callees: Callees,
    /// The turn of the outermost loop being run, and how many there are.
    pub(super) loop_turn: Option<(usize, Option<usize>)>,
    /// The hidden state of `Modelica.Math.Random.Utilities.impureRandom`.
    pub(super) random: Random,
    extensions: HashMap<TypeId, Box<dyn Any>>,
    at_end: Vec<AtEnd>,
}

impl Session {
    /// A session in a world, without variables or classes.
    pub fn new(world: Box<dyn World>) -> Session {
        Session {
            environment: BTreeMap::new(),
            log: Log::default(),
            world,
            sources: SourceMap::default(),
            messages: Messages::default(),
            transcript: None,
            options: Options::default(),
            scope: Scope::script(),
            flags: BTreeMap::new(),
            imports: IndexMap::new(),
            open_packages: Vec::new(),
            dialect: Dialect::default(),
            frames: Vec::new(),
            parsed: ParsedScripts::default(),
            follow_ups: FollowUps::default(),
            stop: None,
            call: Span::NONE,
            in_function: false,
            shared: BTreeSet::new(),
            told: None,
            windowless: BTreeSet::new(),
            silent: 0,
            muted: false,
            classes: Classes::default(),
            models: Models::default(),
            callees: Callees::default(),
            loop_turn: None,
            random: Random::default(),
            extensions: HashMap::new(),
            at_end: Vec::new(),
        }
    }

    /// The same with these options.
    #[must_use]
    pub fn with_options(mut self, options: Options) -> Session {
        self.dialect = options.dialect.unwrap_or_default();
        self.options = options;
        if options.permissions.read {
            self.world.grant(Grant::ReadAll);
        }
        if options.permissions.write {
            self.world.grant(Grant::WriteAll);
        }
        self
    }

    /// Data that a family of commands keeps in the session, made when first asked for.
    pub fn extension<T: Default + 'static>(&mut self) -> &mut T {
        let boxed = self.extensions.entry(TypeId::of::<T>()).or_insert_with(|| Box::<T>::default());
        match boxed.downcast_mut() {
            Some(data) => data,
            None => unreachable!("the key is the type of the data"),
        }
    }

    /// Runs `work` once when the outermost script ends, whether it came to its end, was stopped or
    /// interrupted. The same function is noted once.
    pub fn at_end(&mut self, work: AtEnd) {
        if !self.at_end.iter().any(|known| std::ptr::fn_addr_eq(*known, work)) {
            self.at_end.push(work);
        }
    }

    /// Whether the user asked to stop; sticky.
    pub fn is_interrupted(&self) -> bool {
        self.stop == Some(Stop::Interrupt) || self.world.interrupted()
    }

    /// The value of a script's variable.
    pub fn variable(&self, name: &str) -> Option<&Value> {
        self.scope.get(Ident::new(name))
    }

    /// The turn, from 0, of the outermost loop that is being run, and the number of turns if it is
    /// known: what a progress bar shows.
    pub fn loop_turn(&self) -> Option<(usize, Option<usize>)> {
        self.loop_turn
    }

    /// Where the command that is being run was called.
    pub fn call_site(&self) -> Span {
        self.call
    }

    /// The model translated last.
    pub fn last_model(&self) -> Option<Arc<Translated>> {
        self.models.last().cloned()
    }

    /// The dialect in force.
    pub fn dialect(&self) -> Dialect {
        self.dialect
    }

    /// Follows another dialect from here on.
    pub fn set_dialect(&mut self, dialect: Dialect) {
        self.dialect = dialect;
        self.options.dialect = Some(dialect);
        self.callees.clear();
    }

    /// Text for standard output and the transcript.
    pub fn print(&mut self, text: &str) {
        self.world.print(text);
        self.record(text);
    }

    /// Notes what is printed in the transcript and in the log.
    pub(super) fn record(&mut self, text: &str) {
        if let Some(transcript) = &mut self.transcript {
            transcript.print(text);
        }
        self.log.answer(text);
    }

    /// The one place where a diagnostic is told to the user without ending a statement: it goes to
    /// standard error, to the transcript, and to the messages that the script can ask for.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        let diagnostic = diagnostic.shortened();
        let told = self.told.as_mut().filter(|_| !diagnostic.is_error());
        if told.is_some_and(|told| !told.insert((diagnostic.span(), diagnostic.message.clone()))) {
            return;
        }
        let plain = render::render(&diagnostic, &self.sources, false);
        match (self.options.quiet && !diagnostic.is_error(), self.world.colour()) {
            (true, _) => {}
            (false, true) => {
                self.world.eprint(&render::render(&diagnostic, &self.sources, true));
            }
            (false, false) => self.world.eprint(&plain),
        }
        if let Some(transcript) = &mut self.transcript {
            transcript.report(&plain, diagnostic.code);
        }
        self.log.answer(&plain);
        if diagnostic.is_error() && self.options.strictness == Strictness::Strict {
            self.stop.get_or_insert(Stop::Error);
        }
        self.messages.push(diagnostic);
    }

    /// From here on a warning at the same place is told once, however many models it concerns.
    pub fn tell_warnings_once(&mut self) {
        self.told.get_or_insert_default();
    }

    /// Reports the negative answer of a command: an error with the place of the call.
    pub fn report_fault(&mut self, fault: Fault) {
        let diagnostic = fault.at(self.call);
        self.report(diagnostic);
    }

    /// Says something once that is no error, with the place of the call.
    pub fn note(&mut self, code: Code, message: String) {
        let diagnostic = Fault::new(code, message).at(self.call).note();
        self.report(diagnostic);
    }

    /// What remains to be done when the outermost script ends, and how it ended.
    pub(super) fn finish(&mut self) -> RunStatus {
        for work in std::mem::take(&mut self.at_end) {
            if let Err(diagnostic) = work(self) {
                self.report(diagnostic);
            }
        }
        let errors = self.messages.unread_errors();
        let stop = self.stop.take();
        let interrupted = stop == Some(Stop::Interrupt);
        let exit = match stop {
            Some(Stop::Exit(status)) => Some(status),
            _ => None,
        };
        let code = match (stop, self.options.strictness) {
            (Some(Stop::Interrupt), _) => 130,
            (_, Strictness::Lenient) => 0,
            (Some(Stop::Exit(status)), _) if status != 0 => status.clamp(1, 255) as u8,
            (Some(Stop::Error), _) => 1,
            _ => u8::from(errors > 0),
        };
        RunStatus { errors, interrupted, exit, code }
    }
}
