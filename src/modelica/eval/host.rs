//! Who answers what an expression cannot answer by itself.

use super::{Function, Scope};
use crate::diag::{Diagnostic, Fault};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast;
use crate::value::Value;
use std::sync::Arc;

/// What a called name stands for.
pub enum Callee {
    /// A function written in Modelica.
    Function(Arc<Function>),
    /// A command of scripts, which [`ScriptHost::call_builtin`] runs.
    Builtin(Arc<Function>),
}

/// Runs functions in a quicker way than statement by statement.
pub trait RunCompiled {
    /// The outputs of a pure function for values of all its inputs, the same that its statements give;
    /// `None` where they have to be executed, which gives the errors and the warnings.
    fn run_compiled(&mut self, function: &Arc<Function>, inputs: &[&Value]) -> Option<Vec<Value>>;
}

/// Answers calls and names that are not local to the function or script being evaluated.
pub trait Host {
    /// The function of this name, as seen from where the evaluated text stands; `None` if there is
    /// none, an error if it is malformed. Functions of MLS §3.7 and §10.3 are answered by `eval` itself after the host declined.
    fn callee(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic>;

    /// As [`Host::callee`], for a name of one identifier.
    fn simple_callee(&mut self, name: Ident) -> Result<Option<Callee>, Diagnostic> {
        self.callee(&Name::from(name))
    }

    /// The value of a global variable, package constant or enumeration literal; `None` if there is
    /// none.
    fn variable(
        &mut self,
        reference: &ast::ComponentReference,
    ) -> Result<Option<Value>, Diagnostic>;

    /// What a name that is not a variable means elsewhere, as a help.
    fn meaning_elsewhere(&mut self, _name: &str) -> Option<String> {
        None
    }

    /// Names of functions, for "did you mean".
    fn function_names(&mut self) -> Vec<String> {
        Vec::new()
    }

    /// Answers external functions that access files or the screen; without it they are refused.
    fn outside(&mut self) -> Option<&mut dyn crate::external::Outside> {
        None
    }

    /// External functions that are compiled together with this one, which is in C: all that share
    /// variables with it. Its object's destructor at least.
    fn c_companions(&mut self, function: &Function) -> Vec<Arc<Function>> {
        match self.callee(&super::c_function::destructor(function)) {
            Ok(Some(Callee::Function(destructor))) => vec![destructor],
            _ => Vec::new(),
        }
    }

    /// Takes a warning: an `assert` of level `AssertionLevel.warning` whose condition is false.
    fn warn(&mut self, warning: Diagnostic) {
        let _ = warning;
    }

    /// Called when a function uses or returns a variable before it is assigned: whether the default of
    /// its type is taken (MLS §4.9).
    fn takes_default(&mut self, warning: Diagnostic) -> bool {
        let _ = warning;
        false
    }

    /// Whether results beyond the largest Real are infinite, as in compiled functions, and not faults.
    fn overflows(&self) -> bool {
        false
    }

    /// Who may have compiled a pure function that has become worth it; `None` by default.
    fn compiler(&mut self) -> Option<&mut dyn RunCompiled> {
        None
    }

    /// Called between statements and loop iterations: whether to stop (the user pressed Ctrl-C),
    /// and the error to stop with.
    fn interrupted(&mut self) -> Option<Fault> {
        None
    }

    /// The script among whose statements this is evaluated; `None` in models, whose hosts give out
    /// no builtin.
    fn script(&mut self) -> Option<&mut dyn ScriptHost> {
        None
    }
}

impl dyn Host + '_ {
    /// Ends the evaluation where the host stops it.
    pub(super) fn check_interrupted(&mut self, span: Span) -> Result<(), Diagnostic> {
        match self.interrupted() {
            Some(fault) => Err(fault.at(span)),
            None => Ok(()),
        }
    }

    /// This value is going to be assigned or tested.
    pub(super) fn begin_use(&mut self, value: &ast::Expression) {
        if let Some(script) = self.script() {
            script.begin_use(value);
        }
    }
}

/// Runs the commands of a script, and learns what its statements do with their results.
pub trait ScriptHost {
    /// Runs a builtin: `arguments` are complete, in the order of the header's inputs, defaults
    /// filled in. Returns its outputs, as many as the header declares. Builtins that execute
    /// statements do so among the variables of the caller.
    fn call_builtin(
        &mut self,
        header: &Arc<Function>,
        arguments: Vec<Value>,
        span: Span,
        scope: &mut Scope,
    ) -> Result<Vec<Value>, Diagnostic>;

    /// Called before the inputs of a builtin are checked, with what it is given; `None` where the
    /// default counts. Whether [`ScriptHost::end_command`] is to be called.
    fn begin_command(&mut self, header: &Arc<Function>, given: &[Option<Value>]) -> bool {
        let _ = (header, given);
        false
    }

    /// Called when a builtin has ended, with its error, or was refused for its arguments.
    fn end_command(&mut self, error: Option<&Diagnostic>) {
        let _ = error;
    }

    /// Whether [`ScriptHost::begin_command`] looks at the inputs of builtins of this name.
    fn is_looked_at(&self, name: Ident) -> bool {
        let _ = name;
        false
    }

    /// The inputs of a builtin that [`ScriptHost::begin_command`] looks at.
    fn inputs_looked_at(&self, header: &Arc<Function>) -> &'static [&'static str] {
        let _ = header;
        &[]
    }

    /// Assigns to a dotted or global name that is not a variable of the scope, such as a parameter
    /// of the model translated last or a flag; `false` if there is nothing of that name.
    fn assign(
        &mut self,
        target: &ast::ComponentReference,
        value: Value,
        span: Span,
    ) -> Result<bool, Diagnostic> {
        let _ = (target, value, span);
        Ok(false)
    }

    /// Called when a script assigns a value to a simple name; `before` is the value that a variable
    /// without a declared type had. Whether the name is one of the host's, which has taken the value:
    /// then the script has no variable of the name.
    fn assigned(
        &mut self,
        name: Ident,
        before: Option<&Value>,
        value: &Value,
    ) -> Result<bool, Fault> {
        let _ = (name, before, value);
        Ok(false)
    }

    /// Whether the variables of a script lose their values where an assignment to them fails.
    fn loses_failed(&self) -> bool {
        false
    }

    /// Called when an assignment of a script to what is not a variable of it fails, or is not
    /// reached.
    fn lose(&mut self, target: &ast::ComponentReference) {
        let _ = target;
    }

    /// Called before the statements of a function are executed.
    fn begin_function(&mut self) {}

    /// Called after that.
    fn end_function(&mut self, function: &Function) {
        let _ = function;
    }

    /// Called before an iterator takes the values of a range.
    fn iterates(&mut self, iterator: Ident, range: &ast::Expression) {
        let _ = (iterator, range);
    }

    /// Called before what is assigned to a variable or tested in a condition is evaluated.
    fn begin_use(&mut self, value: &ast::Expression) {
        let _ = value;
    }

    /// Called when a value is assigned to a variable or to a part of one.
    fn keep_status(&mut self, target: &ast::ComponentReference, value: &Value) {
        let _ = (target, value);
    }

    /// Called when a condition has been evaluated.
    fn tested(&mut self) {}

    /// Called before each iteration of an outermost loop of a script, not of a function:
    /// `iteration` counts from 0, `count` is `None` in a `while` loop.
    fn loop_iteration(&mut self, iteration: usize, count: Option<usize>) {
        let _ = (iteration, count);
    }
}
