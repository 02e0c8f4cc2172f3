//! Executing a function: its components, its algorithm, its outputs (MLS §12.4).

use super::errors::MODEL_ONLY;
use super::variable::Variable;
use super::{Evaluator, Function, FunctionBody, FunctionComponent, Scope, ValueType, depth};
use crate::diag::{At, Diagnostic};
use crate::execute;
use crate::fault;
use crate::source::Span;
use crate::value::{RecordValue, Value};
use indexmap::IndexMap;
use std::sync::Arc;

impl Evaluator<'_> {
    /// Runs a function with values for its inputs, `None` where the default counts.
    pub(super) fn run(
        &mut self,
        function: &Arc<Function>,
        given: Vec<Option<Value>>,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        let _call = depth::Call::new(&function.name).at(span)?;
        self.host.check_interrupted(span)?;
        let mut scope = Scope::of_function(function.clone(), given, span);
        if let Some(script) = self.host.script() {
            script.begin_function();
        }
        let mut inner = Evaluator { scope: &mut scope, host: self.host };
        let done = inner.body(function);
        if let Some(script) = self.host.script() {
            script.end_function(function);
        }
        done.map_err(|error| traced(error, function, span))
    }

    /// Values for all inputs of a header, its defaults evaluated.
    pub(super) fn complete(
        &mut self,
        header: &Arc<Function>,
        given: Vec<Option<Value>>,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        let mut scope = Scope::of_function(header.clone(), given, span);
        let mut inner = Evaluator { scope: &mut scope, host: self.host };
        header
            .inputs
            .iter()
            .map(|input| {
                inner.prepare(input.name)?;
                inner.variable_value(input.name).cloned()
            })
            .collect()
    }

    fn body(&mut self, function: &Arc<Function>) -> Result<Vec<Value>, Diagnostic> {
        self.prepare_inputs(function)?;
        match &function.body {
            FunctionBody::RecordConstructor => return self.constructed(function),
            FunctionBody::PartialDerivative { .. } => return Err(partial_derivative(function)),
            FunctionBody::External(external) => self.external(function, external)?,
            FunctionBody::Algorithm(statements) => {
                if let Some(outputs) = self.run_compiled(function) {
                    return Ok(outputs);
                }
                self.prepare_variables(function)?;
                execute::statements(self, statements)?;
            }
        }
        let mut outputs = Vec::with_capacity(function.outputs.len());
        for output in &function.outputs {
            let Some(variable) = self.scope.variables.get_mut(&output.name) else {
                return Err(self.scope.unknown(output.name).at(output.span));
            };
            let value = std::mem::replace(&mut variable.value, Value::Boolean(false));
            let value = variable.assigned(output.name, &[], value);
            outputs.push(self.or_default(value, output.span)?);
        }
        Ok(outputs)
    }

    /// The outputs of a function whose inputs are declared, if the host has compiled it.
    fn run_compiled(&mut self, function: &Arc<Function>) -> Option<Vec<Value>> {
        if function.impure {
            return None;
        }
        let compiler = self.host.compiler()?;
        let value = |input: &FunctionComponent| self.scope.get(input.name);
        let inputs = function.inputs.iter().map(value).collect::<Option<Vec<_>>>()?;
        compiler.run_compiled(function, &inputs)
    }

    /// The record made of the inputs (MLS §12.6).
    fn constructed(&mut self, function: &Function) -> Result<Vec<Value>, Diagnostic> {
        let mut records = Vec::with_capacity(1);
        for output in &function.outputs {
            let ValueType::Record(type_name, components) = &output.value_type else { continue };
            let mut fields = IndexMap::with_capacity(components.len());
            for (name, component) in components.iter() {
                if !self.scope.variables.contains_key(name)
                    && let Some(binding) = &component.binding
                {
                    let value = self.expression(binding)?;
                    self.scope.variables.insert(*name, Variable::undeclared(value));
                }
                let value = self.scope.get(*name).cloned();
                let missing = || self.scope.unknown(*name).at(component.span);
                fields.insert(*name, value.ok_or_else(missing)?);
            }
            let record = RecordValue { type_name: type_name.clone(), fields };
            records.push(Value::Record(record));
        }
        Ok(records)
    }
}

/// A partial derivative has no body to carry out: equations differentiate that of its function.
fn partial_derivative(function: &Function) -> Diagnostic {
    fault!(
        MODEL_ONLY,
        "`{}` is a partial derivative of a function, which has values in equations of models only",
        function.name
    )
    .at(function.span)
}

/// The most calls that a trace shows.
const MAX_FRAMES: usize = 30;

/// Adds the call to the trace; a function calling itself from the same place is shown once.
fn traced(error: Diagnostic, function: &Function, span: Span) -> Diagnostic {
    let what = format!("function `{}`", function.name);
    let is_repeated = error.trace.last().is_some_and(|f| f.span == span && f.what == what);
    if is_repeated || error.trace.len() >= MAX_FRAMES {
        return error;
    }
    error.called_from(span, what)
}
