//! Scripts that run scripts: finding them, reading each once, and the trace through them.

use super::parsed_scripts::Parsed;
use crate::access::faults::{escape_help, shown};
use crate::access::policy::Access;
use crate::bail;
use crate::builtins::Failure;
use crate::diag::{Diagnostic, Fault, suggest};
use crate::errors::{INTERRUPTED, LIMIT_REACHED, SCRIPT_NOT_FOUND, SCRIPTS_TOO_DEEP};
use crate::eval;
use crate::language::execution::Stop;
use crate::models::imported::refuse_as_text;
use crate::source::{SourceId, Span};
use crate::syntax::{ScriptParts, ast};
use crate::world::normalized;
use crate::{Dialect, RunStatus, Session};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

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
                let folder = self.world.current_dir();
                let done = self.run_script_statements(&script, folder);
                debug_assert!(done.is_ok(), "the outermost script reports its own errors");
            }
            Err(diagnostic) => self.report(diagnostic),
        }
        self.finish()
    }

    /// The dialect that a text shows by what only one of them has.
    pub fn looks_like(&self, text: &str) -> Option<Dialect> {
        let script = Parsed::read(SourceId::NONE, text).ok()?;
        script.dialect().or(script.dialect_of_running())
    }

    /// The dialect that a script in a folder shows, or else the scripts that it runs.
    fn shown_dialect(
        &mut self,
        script: &Parsed,
        folder: &Path,
        seen: &mut HashSet<PathBuf>,
    ) -> Option<Dialect> {
        if let Some(dialect) = script.dialect() {
            return Some(dialect);
        }
        for name in script.scripts_run() {
            let plain = self.world.expanded(Path::new(&**name));
            let Some(path) = self.exact_script(folder, &plain) else { continue };
            if !seen.insert(path.clone()) {
                continue;
            }
            // What is wrong with it is reported where it is run.
            let Ok(inner) = self.parsed_script(&path) else { continue };
            let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
            let found = self.shown_dialect(&inner, &folder, seen);
            if found.is_some() {
                return found;
            }
        }
        script.dialect_of_running()
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
            if self.world.interrupted() {
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
        if let (Some(last), true) = (statements.last(), outermost && self.world.interrupted()) {
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

    /// The script of this name: in the folder of the calling script, then in the working
    /// directory; with and without the ending; at last with other letter cases.
    pub(crate) fn find_script(&mut self, name: &str) -> Result<PathBuf, Fault> {
        let folder = self.world.folders().next().map(Path::to_path_buf).unwrap_or_default();
        let key = (folder, self.world.current_dir(), name.to_owned());
        if let Some(path) = self.parsed.found(&key)
            && self.world.sees(path)
        {
            return Ok(path.clone());
        }
        let path = self.search_script(&key.0, name)?;
        self.parsed.keep_found(key, path.clone());
        Ok(path)
    }

    fn search_script(&mut self, folder: &Path, name: &str) -> Result<PathBuf, Fault> {
        let plain = self.world.expanded(Path::new(name));
        if let Some(path) = self.exact_script(folder, &plain) {
            return Ok(path);
        }
        let candidates = self.script_candidates(folder, &plain);
        let other_case = candidates.iter().find_map(|path| self.other_case(path));
        if let Some(path) = other_case {
            let found = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into());
            let message =
                format!("`{name}` is interpreted as `{found}`: upper and lower case differ");
            self.note(SCRIPT_NOT_FOUND, message);
            return Ok(path);
        }
        // Whether there is a file that may not be read stays unknown.
        for place in &candidates {
            self.world.may(Access::Read, place)?;
        }
        let folders = [self.world.absolute(folder), self.world.current_dir()];
        let written = Path::new(name);
        let message = format!("there is no script `{}`", shown(written));
        let fault = Fault::new(SCRIPT_NOT_FOUND, message).help_if(escape_help(written));
        let [own, working] = folders.each_ref().map(|folder| folder.display());
        let is_one = normalized(&folders[0]) == normalized(&folders[1]);
        let searched = match Path::new(name).is_absolute() {
            true => "an absolute path is not searched for elsewhere".to_owned(),
            false if is_one => format!("searched in the working directory `{working}`"),
            false => format!("searched in `{own}` and in the working directory `{working}`"),
        };
        Err(fault.help_if(self.similar_script(&folders[0].join(&plain))).help(searched))
    }

    /// Where a script of this name may lie, in the order of precedence.
    fn script_candidates(&self, folder: &Path, name: &Path) -> [PathBuf; 4] {
        let mut with_ending = name.to_path_buf().into_os_string();
        with_ending.push(".mos");
        let (own, working) = (self.world.absolute(folder), self.world.current_dir());
        let path =
            |folder: &Path, name: &Path| normalized(&self.world.absolute(&folder.join(name)));
        let with_ending = Path::new(&with_ending);
        [
            path(&own, name),
            path(&own, with_ending),
            path(&working, name),
            path(&working, with_ending),
        ]
    }

    /// The script of exactly this name, with or without the ending.
    fn exact_script(&self, folder: &Path, name: &Path) -> Option<PathBuf> {
        let is_file = |path: &PathBuf| self.world.sees(path) && !self.world.is_dir(path);
        self.script_candidates(folder, name).into_iter().find(is_file)
    }

    fn similar_script(&self, path: &Path) -> Option<String> {
        let nearby = self.world.list_dir(path.parent()?).ok()?;
        let scripts: Vec<&str> = nearby.iter().filter_map(|e| e.strip_suffix(".mos")).collect();
        suggest::did_you_mean(&path.file_stem()?.to_string_lossy(), scripts)
    }

    /// The file of this path, letter case not counted in any of its parts.
    fn other_case(&self, path: &Path) -> Option<PathBuf> {
        let mut found = PathBuf::new();
        for component in normalized(&self.world.absolute(path)).components() {
            let exact = found.join(component);
            if self.world.exists(&exact) {
                found = exact;
                continue;
            }
            let name = component.as_os_str().to_string_lossy().into_owned();
            let entries = self.world.list_dir(&found).ok()?;
            found.push(entries.iter().find(|entry| entry.eq_ignore_ascii_case(&name))?);
        }
        (self.world.sees(&found) && !self.world.is_dir(&found)).then_some(found)
    }

    fn parsed_script(&mut self, path: &Path) -> Result<Arc<Parsed>, Vec<Diagnostic>> {
        let stamp = self.world.stamp(path);
        if let Some(script) = self.parsed.get(path, stamp) {
            return Ok(script);
        }
        let refused = refuse_as_text(path, "a script");
        let added = refused.and_then(|()| self.add_file(path));
        let (source, text) = added.map_err(|fault| vec![fault.at(Span::NONE)])?;
        let script = Arc::new(Parsed::read(source, &text).map_err(|error| vec![error])?);
        self.parsed.keep(path, stamp, &script);
        Ok(script)
    }
}
