//! Calls: user functions, and those of the language.

use super::{Lowered, Lowering, Target, placed};
use crate::diag::{Diagnostic, suggest};
use crate::eval::{Function, FunctionBody, ValueType};
use crate::fault;
use crate::lower::errors::{
    ARRAY_MISMATCH, NO_CONSTANT_VALUE, NOT_SUPPORTED, UNRESOLVED_REFERENCE,
};
use crate::lower::shape::UNKNOWN_TEXT;
use crate::source::Span;
use crate::symbolic::function;
use crate::syntax::ast::{Arguments, ComponentReference};

impl<T: Target> Lowering<'_, T> {
    pub(super) fn call(
        &mut self,
        callee: &ComponentReference,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let name = callee.name();
        if let Some(user) = self.target.function(&name) {
            if let Some((builtin, placed)) = placed::of_builtin(&user, arguments) {
                return self.builtin(builtin, &placed, span);
            }
            let mut outputs = self.user_call(&user, arguments, span)?;
            if outputs.is_empty() {
                return Err(fault!(ARRAY_MISMATCH, "`{name}` has no output").at(span));
            }
            return Ok(outputs.swap_remove(0));
        }
        let text = name.to_string();
        let short = text.strip_prefix('.').unwrap_or(&text);
        let short = short.strip_prefix("Modelica.Math.").unwrap_or(short);
        self.builtin_call(short, callee, arguments, span)
    }

    /// A user function with its arguments in order, all outputs.
    pub(crate) fn user_call(
        &mut self,
        user: &std::sync::Arc<Function>,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Vec<Lowered<T::Scalar>>, Diagnostic> {
        let outputs = self.call_with_known_strings(user, arguments, span);
        let has_strings = || {
            let mut all = user.inputs.iter().chain(&user.outputs);
            all.any(|component| component.value_type == ValueType::String)
        };
        match &outputs {
            Err(error)
                if [NOT_SUPPORTED, NO_CONSTANT_VALUE].contains(&error.code)
                    && !self.composes
                    && has_strings()
                    && !self.target.gives_up() =>
            {
                let made = self.composing(|own| match own.composes {
                    true => own.call_with_known_strings(user, arguments, span).ok(),
                    false => None,
                });
                let found = made.or_else(|| {
                    self.with_string_parameters(|own| {
                        own.call_with_known_strings(user, arguments, span)
                    })?
                    .ok()
                });
                found.map_or(outputs, Ok)
            }
            _ => outputs,
        }
    }

    /// The outputs of a call for variables, of which Strings are made at run time.
    pub(crate) fn outputs_for<V>(
        &mut self,
        targets: &[Option<V>],
        user: &std::sync::Arc<Function>,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Vec<Lowered<T::Scalar>>, Diagnostic> {
        let outputs = self.user_call(user, arguments, span)?;
        let is_unknown = |(target, output): (&Option<V>, &Lowered<_>)| match output {
            Lowered::Text(text) => target.is_some() && text.contains(UNKNOWN_TEXT),
            _ => false,
        };
        match !self.composes && targets.iter().zip(&outputs).any(is_unknown) {
            true => self.composing(|own| own.user_call(user, arguments, span)),
            false => Ok(outputs),
        }
    }

    fn call_with_known_strings(
        &mut self,
        user: &std::sync::Arc<Function>,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Vec<Lowered<T::Scalar>>, Diagnostic> {
        let values = self.inputs(user, arguments, span)?;
        self.check_sizes(user, &values, arguments, span)?;
        if matches!(user.body, FunctionBody::RecordConstructor) {
            let fields = user.inputs.iter().map(|i| i.name).zip(values).collect();
            return Ok(vec![Lowered::Record(fields)]);
        }
        if let Some(output) = self.declared_again(user, &values, span)? {
            return Ok(vec![output]);
        }
        if let Some(outputs) = self.vectorized_call(user, &values, span)? {
            return Ok(outputs);
        }
        if let Some(outputs) = self.string_call(user, &values, span)? {
            return Ok(outputs);
        }
        self.target.needs_string_outputs(self.composes);
        match self.target.call(user, values.clone(), span) {
            Err(error)
                if [NOT_SUPPORTED, NO_CONSTANT_VALUE].contains(&error.code)
                    && !self.target.gives_up() =>
            {
                self.evaluated_or_interpreted(user, (&values, arguments), (error, span))
            }
            outputs => outputs,
        }
    }

    /// The outputs of a function that cannot be compiled: run now, as its arguments are known, or by the
    /// interpreter whenever it is called. What an impure function does, it does to the simulation.
    fn evaluated_or_interpreted(
        &mut self,
        user: &std::sync::Arc<Function>,
        (values, arguments): (&[Lowered<T::Scalar>], &Arguments),
        (error, span): (Diagnostic, Span),
    ) -> Result<Vec<Lowered<T::Scalar>>, Diagnostic> {
        if user.impure
            && let Some(outputs) = self.interpreted_call(user, (values, arguments), span)
        {
            return Ok(outputs);
        }
        let why = match self.evaluated_call(user, values, span) {
            Ok(outputs) => return Ok(outputs),
            Err(why) => why,
        };
        let interpreted = self.interpreted_call(user, (values, arguments), span);
        interpreted.ok_or_else(|| match why {
            Some(why) => error.or_else("evaluated at translation", &why),
            None => error,
        })
    }

    /// The outputs of a function that the interpreter executes whenever it is called; Strings among
    /// its arguments that are not known now are made then.
    fn interpreted_call(
        &mut self,
        user: &std::sync::Arc<Function>,
        (values, arguments): (&[Lowered<T::Scalar>], &Arguments),
        span: Span,
    ) -> Option<Vec<Lowered<T::Scalar>>> {
        let is_unknown = |value: &Lowered<T::Scalar>| match value {
            Lowered::Text(text) => text.contains(UNKNOWN_TEXT),
            _ => false,
        };
        let values = match values.iter().any(is_unknown) {
            true => self.composing(|own| own.inputs(user, arguments, span)).ok()?,
            false => values.to_vec(),
        };
        self.target.interpreted_call(user, &values, span)
    }

    /// The values of the inputs: arguments by position, by name, or defaults.
    pub(super) fn inputs(
        &mut self,
        user: &Function,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Vec<Lowered<T::Scalar>>, Diagnostic> {
        let name = &user.name;
        if !arguments.iterators.is_empty() || arguments.positional.len() > user.inputs.len() {
            return Err(
                fault!(ARRAY_MISMATCH, "`{name}` takes {} arguments", user.inputs.len()).at(span)
            );
        }
        if let Some(unknown) =
            arguments.named.iter().find(|a| user.inputs.iter().all(|i| i.name != a.name.node))
        {
            return Err(fault!(
                UNRESOLVED_REFERENCE,
                "`{name}` has no input `{}`",
                unknown.name.node
            )
            .help_if(suggest::did_you_mean(
                unknown.name.node.as_str(),
                user.inputs.iter().map(|i| i.name.as_str()),
            ))
            .at(unknown.name.span));
        }
        let mut values = Vec::with_capacity(user.inputs.len());
        for (position, input) in user.inputs.iter().enumerate() {
            let named = arguments.named.iter().find(|a| a.name.node == input.name);
            let given = arguments.positional.get(position).or(named.map(|a| &a.value));
            let value = match (given, &input.binding) {
                (Some(given), _) => self.lower(given)?,
                (None, Some(default)) => self.lower(default)?,
                (None, None) => {
                    return Err(fault!(
                        UNRESOLVED_REFERENCE,
                        "the input `{}` of `{name}` has no value",
                        input.name
                    )
                    .at(span));
                }
            };
            values.push(value);
        }
        Ok(values)
    }

    /// The value of a function of the language that a library declares again as an external one.
    fn declared_again(
        &mut self,
        user: &Function,
        values: &[Lowered<T::Scalar>],
        span: Span,
    ) -> Result<Option<Lowered<T::Scalar>>, Diagnostic> {
        if let FunctionBody::External(clause) = &user.body
            && !crate::eval::c_function::brings_code(clause)
            && let [output] = user.outputs.as_slice()
            && output.dims.is_empty()
            && let Some(id) = clause.function.as_ref().and_then(|n| function::find(n.node.as_str()))
            && id.get().arity() == values.len()
        {
            let mut scalars = Vec::with_capacity(values.len());
            for value in values {
                value.append_scalars(&mut scalars);
            }
            if scalars.len() == values.len() {
                let value = self.target.apply(id, &scalars, self.live, span)?;
                return Ok(Some(Lowered::scalar(value)));
            }
        }
        Ok(None)
    }
}
