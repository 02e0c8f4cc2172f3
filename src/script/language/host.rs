//! The session as the host of evaluation: it answers calls, dotted names and questions.

use super::workspace::check_type;
use crate::builtins;
use crate::builtins::{BuiltinId, Failure};
use crate::diag::{At, Diagnostic, Fault};
use crate::errors::{INTERRUPTED, OWN_FUNCTION};
use crate::eval::{Callee, Function, FunctionBody, Host, Scope, ScriptHost};
use crate::external::c::Request;
use crate::external::{Entry, Outside, Random};
use crate::name::{Ident, Name};
use crate::packages::FOLDER;
use crate::source::Span;
use crate::syntax::ast::{ComponentReference, Expression};
use crate::value::Value;
use crate::{Dialect, Echo, Session};
use std::path::Path;
use std::sync::Arc;

impl Host for Session {
    /// A function of a script or a loaded library first, then a command.
    fn callee(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic> {
        let revision = self.classes.revision();
        if let Some(known) = self.workspace.callees.get(name, revision, self.dialect()) {
            return Ok(known);
        }
        let callee = self.look_up_callee(name)?;
        self.workspace.callees.put(name, callee.as_ref());
        Ok(callee)
    }

    fn simple_callee(&mut self, name: Ident) -> Result<Option<Callee>, Diagnostic> {
        let revision = self.classes.revision();
        if let Some(known) = self.workspace.callees.get_simple(name, revision, self.dialect()) {
            return Ok(known);
        }
        let callee = self.callee(&Name::from(name))?;
        self.workspace.callees.put_simple(name, callee.as_ref());
        Ok(callee)
    }

    fn variable(&mut self, reference: &ComponentReference) -> Result<Option<Value>, Diagnostic> {
        if let Some(value) = self.workspace.flag_at(reference) {
            return Ok(Some(value));
        }
        if let Some(value) = self.constant(reference).at(reference.span)? {
            return Ok(Some(value));
        }
        let first = reference.parts[0].name;
        match self.follow_up(first, reference.span) {
            Some(note) => Err(note),
            None => self.model_value(reference),
        }
    }

    fn meaning_elsewhere(&mut self, name: &str) -> Option<String> {
        self.trajectory_help(name)
    }

    fn function_names(&mut self) -> Vec<String> {
        let mut names: Vec<String> = builtins::names().into_iter().map(str::to_owned).collect();
        names.extend(self.classes.read_names().iter().map(Name::to_string));
        names
    }

    fn outside(&mut self) -> Option<&mut dyn Outside> {
        Some(self)
    }

    fn c_companions(&mut self, function: &Function) -> Vec<Arc<Function>> {
        self.c_functions_near(function)
    }

    fn warn(&mut self, warning: Diagnostic) {
        self.report(warning);
    }

    fn interrupted(&mut self) -> Option<Fault> {
        match self.is_interrupted() || self.execution.stop().is_some() {
            true => Some(Fault::new(INTERRUPTED, "interrupted")),
            false => None,
        }
    }

    fn script(&mut self) -> Option<&mut dyn ScriptHost> {
        Some(self)
    }
}

impl ScriptHost for Session {
    /// Commands that run scripts work among the variables of the caller.
    fn call_builtin(
        &mut self,
        header: &Arc<Function>,
        arguments: Vec<Value>,
        span: Span,
        scope: &mut Scope,
    ) -> Result<Vec<Value>, Diagnostic> {
        let outer = self.execution.set_in_function(!scope.is_script());
        if !self.execution.is_in_function() {
            std::mem::swap(&mut self.workspace.variables, scope);
        }
        self.execution.descend();
        let result = self.run_command(header, arguments, span);
        self.execution.ascend();
        if !self.execution.is_in_function() {
            std::mem::swap(&mut self.workspace.variables, scope);
        }
        self.execution.set_in_function(outer);
        result
    }

    fn begin_command(&mut self, header: &Arc<Function>, given: &[Option<Value>]) -> bool {
        builtins::begin_writing(self, header, given)
    }

    fn end_command(&mut self, error: Option<&Diagnostic>) {
        builtins::end_writing(self, error);
    }

    fn is_looked_at(&self, name: Ident) -> bool {
        builtins::writes_files(name)
    }

    fn inputs_looked_at(&self, header: &Arc<Function>) -> &'static [&'static str] {
        builtins::inputs_of_files(header)
    }

    fn assign(
        &mut self,
        target: &ComponentReference,
        value: Value,
        span: Span,
    ) -> Result<bool, Diagnostic> {
        if let Some(note) = self.follow_up(target.parts[0].name, target.span)
            && target.parts.len() == 1
        {
            return Err(note);
        }
        self.assign_dotted(target, &value, span)
    }

    fn assigned(
        &mut self,
        name: Ident,
        before: Option<&Value>,
        value: &Value,
    ) -> Result<bool, Fault> {
        if self.dialect() == Dialect::Dymola {
            check_type(name, before, value)?;
        }
        self.follow_ups.found(name);
        match self.is_of_model(name) {
            true => self.assign_to_model(name, value),
            false => {
                if before.is_none() {
                    self.note_state(name, value);
                }
                self.keep_from_model(name);
                Ok(false)
            }
        }
    }

    /// At a prompt the user sees the error, and continues with the value before.
    fn loses_failed(&self) -> bool {
        let is_prompt = self.options.echo == Echo::Dialogue && self.execution.is_typed();
        !is_prompt && !self.is_interrupted() && self.execution.stop().is_none()
    }

    fn lose(&mut self, target: &ComponentReference) {
        self.lose_in_model(target);
    }

    fn begin_function(&mut self) {
        self.statuses.begin_function();
    }

    fn end_function(&mut self, function: &Function) {
        self.statuses.end_function(function.outputs.iter().map(|output| output.name));
    }

    fn iterates(&mut self, iterator: Ident, range: &Expression) {
        self.statuses.iterates(iterator, range);
    }

    fn begin_use(&mut self, value: &Expression) {
        self.statuses.begin_use(value);
    }

    fn keep_status(&mut self, target: &ComponentReference, value: &Value) {
        self.statuses.keep(target, value);
    }

    fn tested(&mut self) {
        let messages = &mut self.output.messages;
        self.statuses.used().into_iter().for_each(|numbers| messages.note_tested(numbers));
    }

    fn loop_iteration(&mut self, iteration: usize, iterations: Option<usize>) {
        self.execution.iterate((iteration, iterations));
    }
}

/// External functions read files, print and ask for the time as commands do.
impl Outside for Session {
    fn read(&mut self, path: &str) -> Result<Vec<u8>, Fault> {
        let path = self.resource(path)?;
        self.world.read_bytes(&path)
    }

    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<(), Fault> {
        let path = self.world.expanded(Path::new(path));
        self.world.write_file(&path, bytes)
    }

    fn append(&mut self, path: &str, bytes: &[u8]) -> Result<(), Fault> {
        let path = self.world.expanded(Path::new(path));
        self.world.append_file(&path, bytes)
    }

    fn remove(&mut self, path: &str) -> Result<(), Fault> {
        let path = self.world.expanded(Path::new(path));
        self.world.remove_file(&path)
    }

    fn make_folder(&mut self, path: &str) -> Result<(), Fault> {
        let path = self.world.expanded(Path::new(path));
        self.world.create_directory(&path)
    }

    fn print(&mut self, text: &str) -> Result<(), Fault> {
        self.print_of_script(&format!("{text}\n"));
        Ok(())
    }

    fn environment_variable(&mut self, name: &str) -> Result<Option<String>, Fault> {
        self.world.environment_variable(name)
    }

    fn unix_seconds(&mut self) -> Result<u64, Fault> {
        Ok(self.world.unix_seconds())
    }

    fn c_function(&mut self, request: &Request) -> Result<&'static Entry, Fault> {
        self.resources().c_function(request)
    }

    fn random(&mut self) -> Result<&mut Random, Fault> {
        Ok(&mut self.workspace.random)
    }

    fn is_folder(&mut self, path: &str) -> Result<Option<bool>, Fault> {
        self.world.kind_of(Path::new(path))
    }
}

impl Session {
    fn run_command(
        &mut self,
        header: &Arc<Function>,
        arguments: Vec<Value>,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        let Some(id) = BuiltinId::of(header) else {
            unreachable!("`callee` gives out headers of the table only")
        };
        let around = self.execution.begin_call(span);
        let before = self.output.messages.next_number();
        let result = id.run(self, arguments);
        self.execution.end_call(around);
        if let Ok(answer) = &result {
            self.statuses.answered(answer, before..self.output.messages.next_number());
        }
        if result.as_ref().is_ok_and(is_success) {
            self.output.messages.note_success();
        }
        match result {
            Ok(Value::Tuple(values)) => Ok(values),
            Ok(value) => Ok(vec![value]),
            Err(failure) => Err(self.last_of(failure, span)),
        }
    }

    /// The last diagnostic of a command that failed; the others are reported.
    pub(super) fn last_of(&mut self, failure: Failure, span: Span) -> Diagnostic {
        match failure {
            Failure::Here(fault) => fault.at(span),
            Failure::Elsewhere(mut diagnostics) => {
                let last = diagnostics.pop();
                // What has no place of its own was found by this call.
                diagnostics.into_iter().for_each(|diagnostic| self.report(diagnostic.or_at(span)));
                let last = last.map(|diagnostic| diagnostic.or_at(span));
                last.unwrap_or_else(|| Fault::new(crate::errors::SCRIPT_ERROR, "failed").at(span))
            }
        }
    }

    fn look_up_callee(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic> {
        let loaded = self.loaded_function(name)?;
        let replacing = self.replacing(name, loaded.as_deref())?;
        if let Some(function) = replacing.or(loaded) {
            let callee = self.loaded_callee(function);
            self.note_replaced(name, &callee);
            return Ok(Some(callee));
        }
        for candidate in self.workspace.candidates(name) {
            if let Some(id) = builtins::find(&candidate, self.dialect()) {
                return Ok(Some(Callee::Builtin(id.function())));
            }
        }
        for candidate in self.workspace.candidates(name) {
            let is_intrinsic = candidate.is_simple()
                && crate::functions::names().any(|intrinsic| candidate.parts[0] == intrinsic);
            if !is_intrinsic && self.class_exists(&Name::new(candidate.first())) {
                let function = self.loaded_function(name)?;
                return Ok(function.map(|function| self.loaded_callee(function)));
            }
        }
        Ok(None)
    }

    /// The loaded function that replaces a command called by its bare name: one of the command's full
    /// name, as long as no function of the bare name was loaded later.
    fn replacing(
        &mut self,
        name: &Name,
        bare: Option<&Function>,
    ) -> Result<Option<Arc<Function>>, Diagnostic> {
        let Some(command) = builtins::find(name, self.dialect()).filter(|_| name.is_simple())
        else {
            return Ok(None);
        };
        for package in command.packages() {
            let full = Name::parse(package).child(name.parts[0]);
            let root = Name::new(full.first());
            let is_shipped = self.is_shipped(&root);
            let library = self.library();
            let is_older = bare.is_some_and(|bare| {
                let other = Name::new(bare.name.first());
                library.find(&other).is_some_and(|other| Some(other) > library.find(&root))
            });
            if !is_shipped && !is_older && library.contains(&full) {
                return self.function_named(&full);
            }
        }
        Ok(None)
    }

    /// Whether a class is one of the program's own.
    fn is_shipped(&self, name: &Name) -> bool {
        self.source_file(name).is_some_and(|file| file.starts_with(FOLDER))
    }

    /// Says once that a function of a package is called in place of a command. That one of the
    /// script itself is called by its own name needs no word.
    fn note_replaced(&mut self, name: &Name, callee: &Callee) {
        let (Callee::Function(function), Some(command)) = (callee, name.last()) else { return };
        let is_own = function.name.is_simple() || self.is_shipped(&function.name);
        let replaces = builtins::find(name, self.dialect()).is_some();
        if replaces && self.workspace.replaces_newly(command, &function.name) && !is_own {
            let called = &function.name;
            let message = format!(
                "`{command}` is the function `{called}` that was loaded, not the built-in command"
            );
            self.report(Fault::new(OWN_FUNCTION, message).at(function.span).note());
        }
    }

    /// A loaded function, or the command that it declares with `external "builtin"`, or that is its
    /// implementation: the functions of `Modelica.Utilities` are commands, loaded or not.
    fn loaded_callee(&self, function: Arc<Function>) -> Callee {
        let is_utility = function.name.to_string().starts_with("Modelica.Utilities.");
        let own = builtins::find(&function.name, self.dialect()).filter(|_| is_utility);
        let command = own.or_else(|| match &function.body {
            FunctionBody::External(external) if external.language.as_deref() == Some("builtin") => {
                external
                    .function
                    .as_ref()
                    .and_then(|called| builtins::find(&Name::new([called.node]), self.dialect()))
            }
            _ => None,
        });
        command.map_or(Callee::Function(function), |id| Callee::Builtin(id.function()))
    }
}

/// Whether a command says that it succeeded.
fn is_success(answer: &Value) -> bool {
    let first = match answer {
        Value::Tuple(values) => values.first(),
        value => Some(value),
    };
    first == Some(&Value::Boolean(true))
}
