//! The session as the host of evaluation: it answers calls, dotted names and questions.

use super::workspace::check_type;
use crate::builtins;
use crate::diag::{At, Diagnostic, Fault};
use crate::errors::INTERRUPTED;
use crate::eval::{Callee, Function, Host, RunCompiled, Scope, ScriptHost};
use crate::external::c::Request;
use crate::external::{Entry, Outside, Random};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{ComponentReference, Expression};
use crate::value::Value;
use crate::{Dialect, Echo, Session};
use std::path::Path;
use std::sync::Arc;

impl Host for Session {
    fn callee(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic> {
        self.callee_named(name)
    }

    fn simple_callee(&mut self, name: Ident) -> Result<Option<Callee>, Diagnostic> {
        let revision = self.classes.revision();
        if let Some(known) = self.workspace.callees.get_simple(name, revision, self.dialect()) {
            return Ok(known);
        }
        let callee = self.callee_named(&Name::from(name))?;
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
        match self.follow_ups.note(first, reference.span) {
            Some(note) => Err(note),
            None => self.model_value(reference),
        }
    }

    fn meaning_elsewhere(&mut self, name: &str) -> Option<String> {
        self.models.trajectory_help(name)
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

    fn compiler(&mut self) -> Option<&mut dyn RunCompiled> {
        Some(self)
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

impl RunCompiled for Session {
    fn run_compiled(&mut self, function: &Arc<Function>, inputs: &[&Value]) -> Option<Vec<Value>> {
        let dialect = self.dialect();
        self.functions.call(function, inputs, &mut self.classes, dialect)
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
        if let Some(note) = self.follow_ups.note(target.parts[0].name, target.span)
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
