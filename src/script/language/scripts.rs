//! Scripts that run scripts: finding them, reading each once, and the trace through them.

use super::parsed_scripts::Parsed;
use crate::bail;
use crate::builtins::Failure;
use crate::diag::{Diagnostic, Fault};
use crate::errors::{INTERRUPTED, LIMIT_REACHED, SCRIPTS_TOO_DEEP};
use crate::eval;
use crate::language::execution::Stop;
use crate::source::Span;
use crate::syntax::{ScriptParts, ast};
use crate::{Dialect, RunStatus, Session};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Scripts may call each other this deep.
const MAX_DEPTH: usize = 64;

impl Session {
    /// Runs a script from the command line as the outermost one.
    pub fn run_file(&mut self, path: &Path) -> RunStatus {
        self.world.grant_script(path);
        self.execution.set_file(true);
        let name = path.to_string_lossy().into_owned();
        if let Err(diagnostics) = self.run_named(&name) {
            diagnostics.into_iter().for_each(|diagnostic| self.report(diagnostic));
        }
        self.execution.set_file(false);
        self.finish()
    }

    /// Runs a text as the outermost script; `name` is shown in diagnostics.
    pub fn run_text(&mut self, name: &str, text: &str) -> RunStatus {
        let source = self.sources.add(name, text);
        match Parsed::read(source, text) {
            Ok(script) => {
                self.note_continuing_signs(source, text);
                let folder = self.world.current_dir();
                let done = self.run_script_statements(&script, folder);
                debug_assert!(done.is_ok(), "the outermost script reports its own errors");
            }
            Err(diagnostic) => self.report(diagnostic),
        }
        self.finish()
    }

    /// Runs a script that another one names; its errors end it and come back with a trace.
    pub(crate) fn run_nested(&mut self, name: &str) -> Result<(), Failure> {
        if self.execution.scripts() >= MAX_DEPTH {
            // Each level may run others: without an end here there would be exponentially many.
            self.execution.stop_for(Stop::Error);
            bail!(
                SCRIPTS_TOO_DEEP,
                "scripts call each other more than {MAX_DEPTH} levels deep; the last one is \
                 `{name}`";
                help: "end the recursion with a condition"
            );
        }
        let call = self.call_site();
        let frame_name = format!("script `{name}`");
        let traced = |diagnostics: Vec<Diagnostic>| {
            // A script that calls itself is one line of the trace, however often it does.
            let frame = |diagnostic: Diagnostic| match diagnostic.trace.last() {
                Some(last) if last.span == call && last.what == frame_name => diagnostic,
                _ => diagnostic.called_from(call, &*frame_name),
            };
            diagnostics.into_iter().map(frame).collect::<Vec<_>>()
        };
        if let Err(fault) = self.find_script(name) {
            self.script_not_run();
            return Err(fault.into());
        }
        self.run_named(name).map_err(|diagnostics| Failure::Elsewhere(traced(diagnostics)))
    }

    /// What scripts that are not run would have defined is not missed.
    pub(crate) fn script_not_run(&mut self) {
        self.follow_ups.script_not_run();
    }

    fn run_named(&mut self, name: &str) -> Result<(), Vec<Diagnostic>> {
        let at = |fault: Fault| vec![fault.at(Span::NONE)];
        let path = self.find_script(name).map_err(at)?;
        let script = self.parsed_script(&path);
        if script.is_err() {
            self.script_not_run();
        }
        let script = script?;
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        self.run_script_statements(&script, folder).map_err(|diagnostic| vec![diagnostic])
    }

    /// Executes the statements of a script. Errors of the outermost one are reported where they
    /// happen; in Dymola's dialect the first ends a nested one.
    fn run_script_statements(
        &mut self,
        script: &Parsed,
        folder: PathBuf,
    ) -> Result<(), Diagnostic> {
        let outermost = self.execution.scripts() == 0;
        if outermost && self.options.dialect.is_none() {
            let shown = self.shown_dialect(script, &folder, &mut HashSet::new());
            self.recognized = shown.unwrap_or_default();
        }
        self.execution.enter();
        self.world.enter(folder);
        let result = self.parts(&script.parts, outermost);
        self.world.leave();
        self.execution.leave();
        result
    }

    fn parts(&mut self, script: &ScriptParts, outermost: bool) -> Result<(), Diagnostic> {
        for at in 0..script.count() {
            let statements = script.part(at)?;
            if let Err(diagnostic) = self.statements(&statements, outermost) {
                for later in at + 1..script.count() {
                    self.leave_out(&script.part(later)?, &diagnostic);
                }
                return Err(diagnostic);
            }
        }
        Ok(())
    }

    fn statements(
        &mut self,
        statements: &[ast::InteractiveStatement],
        outermost: bool,
    ) -> Result<(), Diagnostic> {
        for (at, statement) in statements.iter().enumerate() {
            if self.execution.stop().is_some() {
                return Ok(());
            }
            if self.world.is_interrupted() {
                self.interrupt(statement.span);
                return Ok(());
            }
            let Err(diagnostic) = self.top_level(statement, outermost) else { continue };
            if diagnostic.code == INTERRUPTED {
                self.interrupt(statement.span);
                return Ok(());
            }
            self.follow_ups.failed(statement);
            // OpenModelica also continues scripts that scripts run.
            if !outermost && self.dialect() == Dialect::Dymola {
                self.leave_out(&statements[at + 1..], &diagnostic);
                return Err(diagnostic);
            }
            self.report_failed(diagnostic);
            self.echo_nothing();
        }
        // A command that was interrupted may have answered with what it had.
        if let (Some(last), true) = (statements.last(), outermost && self.world.is_interrupted()) {
            self.interrupt(last.span);
        }
        Ok(())
    }

    /// These statements are not executed because of an error: what they would have assigned has no
    /// value, and what they would have written is out of date.
    fn leave_out(&mut self, statements: &[ast::InteractiveStatement], error: &Diagnostic) {
        self.follow_ups.not_done(statements);
        let all: Vec<ast::Statement> = statements
            .iter()
            .filter_map(|statement| match &statement.kind {
                ast::InteractiveKind::Statement(statement) => Some(statement.clone()),
                ast::InteractiveKind::Expression(call) => Some(ast::Statement {
                    kind: ast::StatementKind::Call(call.clone()),
                    comment: ast::Comment::default(),
                    span: statement.span,
                }),
                _ => None,
            })
            .collect();
        self.with_scope(|scope, session| eval::leave_out(&all, scope, session, error));
    }

    fn report_failed(&mut self, diagnostic: Diagnostic) {
        if diagnostic.code == crate::errors::FOLLOW_UP && !self.follow_ups.is_first() {
            return;
        }
        self.report(diagnostic);
    }

    fn interrupt(&mut self, span: Span) {
        if let (None, Some(reason)) = (self.execution.stop(), self.world.stop_reason()) {
            self.execution.stop_for(Stop::Error);
            self.report(Fault::new(LIMIT_REACHED, reason).at(span));
            return;
        }
        if self.execution.stop().is_none() {
            self.execution.stop_for(Stop::Interrupt);
            let message = "interrupted; results found so far are kept";
            self.report(Fault::new(INTERRUPTED, message).at(span).warning());
        }
    }
}
