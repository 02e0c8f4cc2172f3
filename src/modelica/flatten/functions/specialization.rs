//! Functions as arguments (MLS §12.4.2): a call that passes functions becomes a call of a copy of
//! the called function in which they are written out, with what a partial application binds as
//! further inputs.

use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionBody, FunctionComponent, ValueType};
use crate::fault;
use crate::flatten::errors::TYPE_MISMATCH;
use crate::flatten::functions::table::FunctionTable;
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, NamedArgument, Subscript,
};
use crate::syntax::visit::{Rewrite, Visit, rewrite_expression, walk_reference};
use std::sync::Arc;

/// How deep copies may need copies of other functions.
const MAX_DEPTH: usize = 50;

/// What is passed for an input that is a function.
#[derive(Debug, Clone)]
struct Passed {
    /// The input.
    input: Ident,
    function: Name,
    /// What a partial application binds: inputs of the passed function with their values.
    bound: Vec<NamedArgument>,
}

impl Passed {
    /// What a partial application binds, as arguments of the copy.
    fn arguments(&self) -> impl Iterator<Item = NamedArgument> {
        self.bound.iter().map(|bound| {
            let node = input_name(self.input, bound.name.node);
            let name = Spanned { node, span: bound.name.span };
            NamedArgument { name, value: bound.value.clone() }
        })
    }
}

impl FunctionTable {
    /// The function and the arguments of a call without functions among the arguments. A call
    /// inside a function that passes on an input of its own stays until that function is copied.
    pub(crate) fn specialized(
        &mut self,
        name: Name,
        arguments: Arguments,
        span: Span,
        depth: usize,
    ) -> Result<(Name, Arguments), Diagnostic> {
        let Some(Some(function)) = self.table.get(&name).cloned() else {
            return Ok((name, arguments));
        };
        let takes = |input: &FunctionComponent| input.value_type == ValueType::Function;
        if !function.inputs.iter().any(takes) {
            return Ok((name, arguments));
        }
        let mut passed = Vec::new();
        let mut left = Arguments { positional: Vec::new(), ..arguments.clone() };
        left.named.retain(|argument| {
            !function.inputs.iter().any(|i| takes(i) && i.name == argument.name.node)
        });
        for (at, input) in function.inputs.iter().enumerate() {
            let positional = arguments.positional.get(at);
            if !takes(input) {
                left.positional.extend(positional.cloned());
                continue;
            }
            let named = || arguments.named.iter().find(|a| a.name.node == input.name);
            let Some(value) = positional.or_else(|| named().map(|a| &a.value)) else {
                return Err(fault!(
                    TYPE_MISMATCH,
                    "`{name}` needs a function for its input `{}`",
                    input.name
                )
                .at(span));
            };
            match self.passed(input.name, value, depth)? {
                Some(one) => passed.push(one),
                None => return Ok((name, arguments)),
            }
        }
        left.named.extend(passed.iter().flat_map(Passed::arguments));
        let copy = self.copy_of(&name, &function, &passed, span, depth)?;
        Ok((copy, left))
    }

    /// The function that an argument names; `None` for a variable of a function.
    fn passed(
        &mut self,
        input: Ident,
        value: &Expression,
        depth: usize,
    ) -> Result<Option<Passed>, Diagnostic> {
        let (function, bound) = match &value.kind {
            ExpressionKind::Reference(reference) => (reference.name(), Vec::new()),
            ExpressionKind::PartialApplication { function, named } => {
                (function.clone(), named.clone())
            }
            _ => {
                return Err(fault!(TYPE_MISMATCH, "expected a function for the input `{input}`")
                    .at(value.span));
            }
        };
        if !self.table.contains_key(&function) {
            return Ok(None);
        }
        let bound = self.without_functions(function, bound, value.span, depth)?;
        Ok(bound.map(|(function, bound)| Passed { input, function, bound }))
    }

    /// A partial application that binds functions as one of a copy that binds none; `None` if one
    /// of them is a variable of a function.
    fn without_functions(
        &mut self,
        name: Name,
        bound: Vec<NamedArgument>,
        span: Span,
        depth: usize,
    ) -> Result<Option<(Name, Vec<NamedArgument>)>, Diagnostic> {
        let Some(Some(function)) = self.table.get(&name).cloned() else {
            return Ok(Some((name, bound)));
        };
        let is_function = |argument: &NamedArgument| {
            let name = argument.name.node;
            function.inputs.iter().any(|i| i.name == name && i.value_type == ValueType::Function)
        };
        let (functions, mut left): (Vec<_>, Vec<_>) = bound.into_iter().partition(is_function);
        if functions.is_empty() {
            return Ok(Some((name, left)));
        }
        let mut passed = Vec::new();
        for argument in functions {
            match self.passed(argument.name.node, &argument.value, depth)? {
                Some(one) => passed.push(one),
                None => return Ok(None),
            }
        }
        left.extend(passed.iter().flat_map(Passed::arguments));
        let copy = self.copy_of(&name, &function, &passed, span, depth)?;
        Ok(Some((copy, left)))
    }

    /// A copy of a function for what is passed to it, made once.
    fn copy_of(
        &mut self,
        name: &Name,
        function: &Function,
        passed: &[Passed],
        span: Span,
        depth: usize,
    ) -> Result<Name, Diagnostic> {
        let mut key = name.last().map_or("", Ident::as_str).trim_matches('\'').to_owned();
        for one in passed {
            key.push_str(&format!("({}", one.function));
            for bound in &one.bound {
                key.push_str(&format!(", {}", bound.name.node));
            }
            key.push(')');
        }
        let copy = name.parent().child(Ident::new(&format!("'{key}'")));
        if self.table.contains_key(&copy) {
            return Ok(copy);
        }
        if depth > MAX_DEPTH {
            return Err(fault!(
                TYPE_MISMATCH,
                "`{name}` passes functions in an infinite recursion"
            )
            .at(span));
        }
        self.table.insert(copy.clone(), None);
        let mut made = function.clone();
        made.name = copy.clone();
        made.inputs.retain(|input| passed.iter().all(|one| one.input != input.name));
        for one in passed {
            made.inputs.extend(self.bound_inputs(one, span)?);
        }
        let mut writing = Writing { functions: self, passed, depth, error: None };
        for component in made.inputs.iter_mut().chain(&mut made.outputs).chain(&mut made.locals) {
            if let Some(binding) = &mut component.binding {
                writing.expression(binding);
            }
        }
        if let FunctionBody::Algorithm(statements) = &mut made.body {
            statements.iter_mut().for_each(|statement| writing.statement(statement));
        }
        if let Some(error) = writing.error {
            return Err(error);
        }
        self.table.insert(copy.clone(), Some(Arc::new(made)));
        Ok(copy)
    }

    /// The inputs that a copy has for what a partial application binds.
    fn bound_inputs(
        &self,
        passed: &Passed,
        span: Span,
    ) -> Result<Vec<FunctionComponent>, Diagnostic> {
        let Some(Some(function)) = self.table.get(&passed.function) else {
            return Ok(Vec::new());
        };
        passed
            .bound
            .iter()
            .map(|bound| {
                let own = function.inputs.iter().find(|input| input.name == bound.name.node);
                let own = own.ok_or_else(|| {
                    fault!(
                        TYPE_MISMATCH,
                        "`{}` has no input `{}`",
                        passed.function,
                        bound.name.node
                    )
                    .at(span)
                })?;
                let name = input_name(passed.input, own.name);
                let dims = own.dims.iter().map(|size| size_outside(size, function)).collect();
                Ok(FunctionComponent { name, dims, binding: None, ..own.clone() })
            })
            .collect()
    }
}

/// The input of a copy for one that a partial application binds.
fn input_name(input: Ident, bound: Ident) -> Ident {
    let [input, bound] = [input, bound].map(|name| name.as_str().trim_matches('\''));
    Ident::new(&format!("'{input}.{bound}'"))
}

/// A size of an input where the other inputs of its function do not stand: that of the argument.
fn size_outside(size: &Subscript, function: &Function) -> Subscript {
    struct Inputs<'f>(&'f Function, bool);
    impl Visit for Inputs<'_> {
        fn reference(&mut self, reference: &ComponentReference) {
            walk_reference(self, reference);
            let first = reference.parts.first().map(|part| part.name);
            self.1 |= self.0.inputs.iter().any(|input| Some(input.name) == first);
        }
    }
    let Subscript::Index(e) = size else { return size.clone() };
    let mut inputs = Inputs(function, false);
    inputs.expression(e);
    match inputs.1 {
        true => Subscript::All(e.span),
        false => size.clone(),
    }
}

/// Writes passed functions in the place of the inputs that they are passed for.
struct Writing<'w> {
    functions: &'w mut FunctionTable,
    passed: &'w [Passed],
    depth: usize,
    error: Option<Diagnostic>,
}

impl Writing<'_> {
    fn bound(&self, one: &Passed, span: Span) -> Vec<NamedArgument> {
        let argument = |bound: &NamedArgument| {
            let name = Name::from(input_name(one.input, bound.name.node));
            let reference = ComponentReference::from_name(&name, span);
            let value = Expression::new(ExpressionKind::Reference(reference), span);
            NamedArgument { name: bound.name, value }
        };
        one.bound.iter().map(argument).collect()
    }

    /// The inputs of a passed function that a partial application leaves; none if there is no
    /// partial application.
    fn free_inputs(&self, one: &Passed) -> Vec<Ident> {
        let Some(Some(function)) = self.functions.table.get(&one.function) else {
            return Vec::new();
        };
        if one.bound.is_empty() {
            return Vec::new();
        }
        let is_free = |name: &Ident| one.bound.iter().all(|bound| bound.name.node != *name);
        function.inputs.iter().map(|input| input.name).filter(is_free).collect()
    }

    /// Writes a call of a passed function, and passes on the functions among its arguments.
    fn call(&mut self, function: &mut ComponentReference, arguments: &mut Arguments, span: Span) {
        if let Some(one) = self.input(function) {
            let bound = self.bound(one, span);
            let free = self.free_inputs(one);
            *function = ComponentReference::from_name(&one.function, span);
            // Arguments in order are those of the inputs that are left.
            let given = arguments.positional.drain(..free.len().min(arguments.positional.len()));
            let given = free.into_iter().zip(given).map(|(node, value)| NamedArgument {
                name: Spanned { node, span: value.span },
                value,
            });
            arguments.named.extend(given.collect::<Vec<_>>());
            arguments.named.extend(bound);
            let given = arguments.clone();
            *arguments = self.functions.with_defaults(&one.function, given, None, span);
        }
        let called =
            self.functions.specialized(function.name(), arguments.clone(), span, self.depth + 1);
        match called {
            Ok((name, left)) => {
                *function = ComponentReference::from_name(&name, span);
                *arguments = left;
            }
            Err(error) => self.error = Some(error),
        }
    }

    fn input(&self, reference: &ComponentReference) -> Option<&Passed> {
        let name = reference.as_ident()?;
        self.passed.iter().find(|one| one.input == name)
    }

    fn input_of_name(&self, name: &Name) -> Option<&Passed> {
        let [name] = name.parts.as_slice() else { return None };
        self.passed.iter().find(|one| one.input == *name)
    }
}

impl Rewrite for Writing<'_> {
    fn expression(&mut self, e: &mut Expression) {
        rewrite_expression(self, e);
        let span = e.span;
        let replaced = match &mut e.kind {
            ExpressionKind::Reference(reference) => self.input(reference).map(|one| {
                let named = self.bound(one, span);
                match named.is_empty() {
                    true => ExpressionKind::Reference(ComponentReference::from_name(
                        &one.function,
                        span,
                    )),
                    false => {
                        ExpressionKind::PartialApplication { function: one.function.clone(), named }
                    }
                }
            }),
            ExpressionKind::PartialApplication { function, named } => {
                if let Some(one) = self.input_of_name(function) {
                    let bound = self.bound(one, span);
                    *function = one.function.clone();
                    named.extend(bound);
                }
                None
            }
            ExpressionKind::Call { function, arguments } => {
                self.call(function, arguments, span);
                None
            }
            _ => None,
        };
        if let Some(kind) = replaced {
            e.kind = kind;
        }
    }
}
