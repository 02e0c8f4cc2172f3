//! What is wrong with a script before it runs: functions that nothing defines, and named arguments that
//! commands do not have. Scripts that it runs and models that it opens are read, never executed.

use crate::diag::{Diagnostic, suggest};
use crate::fault;
use crate::flatten::Library;
use crate::functions;
use crate::functions::errors::{UNKNOWN_FUNCTION, WRONG_ARGUMENTS};
use crate::name::Ident;
use crate::source::SourceId;
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, InteractiveKind, Script, Statement,
    StatementKind,
};
use crate::syntax::visit::{Visit, walk_expression, walk_statement};
use crate::{Session, builtins};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Scripts that are read for one script, at most.
const MOST_SCRIPTS: usize = 50;

/// Names that have a meaning in the arguments of some commands alone: `plotExpression(apply(…))`.
const SPECIAL: &[&str] = &["apply"];

/// What is wrong with the calls of a script that lies in a folder.
pub fn check_script(
    session: &mut Session,
    script: &Script,
    folder: Option<&Path>,
) -> Vec<Diagnostic> {
    let mut known = Known::default();
    known.add_script(session, script, folder);
    let calls = Calls::of(script);
    session.ask(|library| {
        let mut found = Vec::new();
        for (function, arguments) in &calls.found {
            found.extend(known.unknown(library, function));
            found.extend(known.wrong_arguments(library, function, arguments));
        }
        found
    })
}

/// What a script and those that it runs define.
#[derive(Default)]
struct Known {
    names: BTreeSet<Ident>,
    scripts: BTreeSet<PathBuf>,
    /// Something defines names that are known only when the script runs.
    is_open: bool,
}

impl Known {
    fn add_script(&mut self, session: &mut Session, script: &Script, folder: Option<&Path>) {
        for statement in &script.statements {
            match &statement.kind {
                InteractiveKind::Class(class) => _ = self.names.insert(class.name.node),
                // An import can make any name of a package visible.
                InteractiveKind::Import(_) => self.is_open = true,
                _ => {}
            }
        }
        let calls = Calls::of(script);
        self.names.extend(calls.assigned.iter().copied());
        for (function, arguments) in &calls.found {
            let name = function.parts.last().map_or("", |part| part.name.as_str());
            match name {
                "RunScript" | "runScript" => self.add_run(session, arguments, folder),
                "openModel" | "loadFile" => self.add_opened(session, arguments, folder),
                "loadString" | "loadFiles" | "openModelFile" | "setClassText" => {
                    self.is_open = true
                }
                _ => {}
            }
        }
    }

    /// The file that a literal first argument names.
    fn named(
        &mut self,
        session: &Session,
        arguments: &Arguments,
        folder: Option<&Path>,
    ) -> Option<PathBuf> {
        let first = arguments.positional.first().map(|first| &first.kind);
        let path = match (first, folder) {
            (Some(ExpressionKind::String(text)), Some(folder)) => folder.join(&**text),
            _ => PathBuf::new(),
        };
        let path = session.world.absolute(&path);
        let is_there = path.extension().is_some() && session.world.exists(&path);
        self.is_open |= !is_there;
        is_there.then_some(path)
    }

    fn add_run(&mut self, session: &mut Session, arguments: &Arguments, folder: Option<&Path>) {
        let Some(path) = self.named(session, arguments, folder) else { return };
        if self.scripts.len() >= MOST_SCRIPTS || !self.scripts.insert(path.clone()) {
            return;
        }
        let bytes = session.world.read(&path).unwrap_or_default();
        let text = crate::syntax::decode(&bytes).0;
        match crate::syntax::parse_script(SourceId::NONE, &text) {
            Ok(script) => self.add_script(session, &script, path.parent()),
            // What is wrong with it is shown where it is open.
            Err(_) => self.is_open = true,
        }
    }

    fn add_opened(&mut self, session: &mut Session, arguments: &Arguments, folder: Option<&Path>) {
        let Some(path) = self.named(session, arguments, folder) else { return };
        // What is wrong with the file is shown where it is open.
        self.is_open |= session.load_path_once(&path).is_err();
    }

    fn is_known(&self, library: &Library, function: &ComponentReference) -> bool {
        let Some(first) = function.parts.first().map(|part| part.name) else { return true };
        let name = function.name();
        let simple = name.is_simple().then_some(first.as_str());
        self.names.contains(&first)
            || simple.is_some_and(|name| functions::is_builtin(name) || SPECIAL.contains(&name))
            || name.last().is_some_and(|last| !builtins::declarations(last.as_str()).is_empty())
            || library.parts_of_reference(None, &name).pop().flatten().is_some()
    }

    fn unknown(&self, library: &Library, function: &ComponentReference) -> Option<Diagnostic> {
        if self.is_open || self.is_known(library, function) {
            return None;
        }
        let name = function.name().to_string();
        let own = self.names.iter().map(|name| name.as_str());
        let names = builtins::names();
        let known = own.chain(names.iter().copied()).chain(functions::names());
        Some(
            fault!(UNKNOWN_FUNCTION, "there is no function `{name}`")
                .help_if(suggest::did_you_mean(&name, known))
                .at(function.span),
        )
    }

    /// Named arguments of commands; those of functions that the script defines are not known here.
    fn wrong_arguments(
        &self,
        library: &Library,
        function: &ComponentReference,
        arguments: &Arguments,
    ) -> Vec<Diagnostic> {
        let name = function.name();
        let is_own = name.first().is_none_or(|first| self.names.contains(&first))
            || library.find(&name).is_some();
        let inputs = builtins::inputs(&name.to_string());
        if is_own || !name.is_simple() || inputs.is_empty() {
            return Vec::new();
        }
        let wrong = arguments.named.iter().filter(|one| !inputs.contains(&one.name.node.as_str()));
        let diagnostic = |one: &crate::syntax::ast::NamedArgument| {
            let input = one.name.node;
            let hint = suggest::did_you_mean(input.as_str(), inputs.iter().copied());
            fault!(WRONG_ARGUMENTS, "`{name}` has no input `{input}`")
                .help_if(hint)
                .help(format!("its inputs are `{}`", inputs.join("`, `")))
                .at(one.name.span)
        };
        wrong.map(diagnostic).collect()
    }
}

/// The calls of a script, and the variables that it assigns.
#[derive(Default)]
struct Calls {
    found: Vec<(ComponentReference, Arguments)>,
    assigned: BTreeSet<Ident>,
}

impl Calls {
    fn of(script: &Script) -> Calls {
        let mut calls = Calls::default();
        for statement in &script.statements {
            match &statement.kind {
                InteractiveKind::Statement(statement) => calls.statement(statement),
                InteractiveKind::Expression(expression) => calls.expression(expression),
                InteractiveKind::Declaration(clause) => {
                    for component in &clause.components {
                        calls.assigned.insert(component.name.node);
                        if let Some(modification) = &component.modification {
                            crate::syntax::visit::walk_modification(&mut calls, modification);
                        }
                    }
                }
                _ => {}
            }
        }
        calls
    }
}

impl Visit for Calls {
    fn expression(&mut self, expression: &Expression) {
        if let ExpressionKind::Call { function, arguments } = &expression.kind {
            self.found.push((function.clone(), (**arguments).clone()));
        }
        walk_expression(self, expression);
    }

    fn statement(&mut self, statement: &Statement) {
        match &statement.kind {
            StatementKind::Assign { target, .. } => _ = self.assigned.insert(target.parts[0].name),
            StatementKind::MultiAssign { targets, .. } => {
                self.assigned.extend(targets.iter().flatten().map(|target| target.parts[0].name));
            }
            _ => {}
        }
        walk_statement(self, statement);
    }
}
