//! The session: the parts that last from one statement to the next.
//!
//! Its methods lie in layers, of which none calls one above it. From bottom to top:
//! 1. reports and notes, here, over the outside as scripts may use it (`access`);
//! 2. libraries, the loading of classes, documents and resources (`models`);
//! 3. translated models and values of their parameters (`models`);
//! 4. constants, what called names stand for, commands, expressions, declarations, statements and
//!    scripts (`language`);
//! 5. the session as evaluation sees it (`language::host`); commands and runs are reached through it.

use super::access::SessionWorld;
use super::access::faults::cannot;
use super::builtins::extensions::Extensions;
use super::language::compiled_functions::ScriptFunctions;
use super::language::execution::{Execution, Iteration, RunStatus, Stop};
use super::language::follow_up::FollowUps;
use super::language::output::Output;
use super::language::parsed_scripts::ParsedScripts;
use super::language::statuses::Statuses;
use super::language::workspace::Workspace;
use super::models::classes::Classes;
use super::models::compiled::CompiledModels;
use super::models::translated::Translated;
use super::options::{Dialect, Options, Strictness};
use super::world::{Store, World};
use crate::diag::{Code, Diagnostic, Fault};
use crate::errors::INTERRUPTED;
use crate::name::Ident;
use crate::source::{SourceId, SourceMap, Span};
use crate::syntax;
use crate::value::Value;
use std::path::Path;
use std::sync::Arc;

/// Work that is done when the outermost script ends.
type AtEnd = fn(&mut Session) -> Result<(), Diagnostic>;

/// A session. It owns its world; nothing else reaches the outside.
pub struct Session {
    /// The outside, as scripts may use it.
    pub world: SessionWorld,
    /// The text of all files read so far.
    pub sources: SourceMap,
    /// Where translated models are kept from one process to the next, if they are.
    pub storage: Option<Arc<dyn Store>>,
    /// What it answers.
    pub output: Output,
    /// How it behaves.
    pub options: Options,
    pub(super) workspace: Workspace,
    pub(super) execution: Execution,
    pub(super) parsed: ParsedScripts,
    pub(super) follow_ups: FollowUps,
    pub(super) statuses: Statuses,
    pub(super) classes: Classes,
    pub(super) models: CompiledModels,
    pub(super) functions: ScriptFunctions,
    /// The dialect that the outermost script shows, where none was asked for.
    pub(crate) recognized: Dialect,
    extensions: Extensions,
    at_end: Vec<AtEnd>,
}

impl Session {
    /// A session in a world, without variables or classes.
    pub fn new(world: Box<dyn World>) -> Session {
        Session {
            world: SessionWorld::new(world),
            sources: SourceMap::default(),
            storage: None,
            output: Output::default(),
            options: Options::default(),
            workspace: Workspace::default(),
            execution: Execution::default(),
            parsed: ParsedScripts::default(),
            follow_ups: FollowUps::default(),
            statuses: Statuses::default(),
            classes: Classes::default(),
            models: CompiledModels::default(),
            functions: ScriptFunctions::default(),
            recognized: Dialect::default(),
            extensions: Extensions::default(),
            at_end: Vec::new(),
        }
    }

    /// The same with these options.
    #[must_use]
    pub fn with_options(mut self, options: Options) -> Session {
        self.options = options;
        self.recognized = Dialect::default();
        self.world.permit(options.permissions);
        self
    }

    /// Data that a family of commands keeps in the session, made when first asked for.
    pub fn extension<T: Default + 'static>(&mut self) -> &mut T {
        self.extensions.get()
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
        self.execution.stop() == Some(Stop::Interrupt) || self.world.is_interrupted()
    }

    /// The value of a script's variable.
    pub fn variable(&self, name: &str) -> Option<&Value> {
        self.workspace.variables.get(Ident::new(name))
    }

    /// The iteration of the outermost loop that is being run: what a progress bar shows.
    pub(crate) fn loop_iteration(&self) -> Option<Iteration> {
        self.execution.iteration()
    }

    /// Where the command that is being run was called.
    pub(crate) fn call_site(&self) -> Span {
        self.execution.call()
    }

    /// The model translated last.
    pub fn last_model(&self) -> Option<Arc<Translated>> {
        self.models.last().cloned()
    }

    /// The dialect in force.
    pub fn dialect(&self) -> Dialect {
        self.options.dialect.unwrap_or(self.recognized)
    }

    /// Follows another dialect from here on.
    pub fn set_dialect(&mut self, dialect: Dialect) {
        self.options.dialect = Some(dialect);
        self.workspace.callees.clear();
    }

    /// Text for standard output and the transcript.
    pub fn print(&mut self, text: &str) {
        self.world.print(text);
        self.output.record(text);
    }

    /// As [`Session::print`], for what a script prints: a quiet session shows it, too.
    pub fn print_of_script(&mut self, text: &str) {
        self.world.print_of_script(text);
        self.output.record(text);
    }

    /// As [`Session::print`], for a report of which the screen shows `shown`; `brief` is what a brief
    /// transcript has of it.
    pub(crate) fn print_report(&mut self, shown: &str, whole: &str, brief: &str) {
        self.world.print(shown);
        self.output.record_report(whole, brief);
    }

    /// The one place where a diagnostic is reported to the user without ending a statement: it goes
    /// to standard error, to the transcript, and to the messages that the script can ask for.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        let quiet = self.options.quiet;
        let diagnostic = self.classes.in_users_terms(diagnostic);
        let is_error = self.output.report(&mut *self.world, &self.sources, quiet, diagnostic);
        if is_error && self.options.strictness == Strictness::Strict {
            self.execution.stop_for(Stop::Error);
        }
    }

    /// Reports the negative answer of a command: an error with the place of the call.
    pub(crate) fn report_fault(&mut self, fault: Fault) {
        let diagnostic = fault.at(self.call_site());
        self.report(diagnostic);
    }

    /// A negative answer: `true`, or `false` and the fault reported.
    pub fn succeeded(&mut self, result: Result<(), Fault>) -> Value {
        Value::Boolean(self.or_report(result).is_some())
    }

    /// The value, or `None` and the fault reported.
    pub(crate) fn or_report<T>(&mut self, result: Result<T, Fault>) -> Option<T> {
        result.map_err(|fault| self.report_fault(fault)).ok()
    }

    /// The same where several things may be wrong.
    pub(crate) fn or_report_all<T>(&mut self, result: Result<T, Vec<Diagnostic>>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(errors) => {
                // The script that is being stopped says that it was interrupted.
                let reported = errors.into_iter().filter(|error| error.code != INTERRUPTED);
                reported.for_each(|error| self.report(error));
                None
            }
        }
    }

    /// Says something once that is no error, with the place of the call.
    pub fn note(&mut self, code: Code, message: String) {
        let diagnostic = Fault::new(code, message).at(self.call_site()).note();
        self.report(diagnostic);
    }

    /// Says something that may change the result, with the place of the call.
    pub fn warn(&mut self, code: Code, message: String) {
        let diagnostic = Fault::new(code, message).at(self.call_site()).warning();
        self.report(diagnostic);
    }

    /// Reads a text file among the sources, under its path relative to the working directory.
    pub(crate) fn add_file(&mut self, path: &Path) -> Result<(SourceId, Arc<str>), Fault> {
        self.world.check_current(path)?;
        let bytes = self.world.bytes_of(path).map_err(|error| cannot("read", path, &error))?;
        let (text, warning) = syntax::decode(&bytes);
        let current = self.world.current_dir();
        let shown = path.strip_prefix(&current).unwrap_or(path).display().to_string();
        let text: Arc<str> = text.into();
        let source = self.sources.add(shown, text.clone());
        if let Some(warning) = warning {
            self.report(warning.at(Span::new(source, 0, 0)).warning());
        }
        Ok((source, text))
    }

    /// What remains to be done when the outermost script ends, and how it ended.
    pub fn finish(&mut self) -> RunStatus {
        for work in std::mem::take(&mut self.at_end) {
            if let Err(diagnostic) = work(self) {
                self.report(diagnostic);
            }
        }
        let errors = self.output.messages.unread_errors();
        self.execution.end(errors, self.options.strictness)
    }
}
