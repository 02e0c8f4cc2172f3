//! References to variables and their parts: `a[2].b[1, :]`, read and assigned without copying the
//! array that they reach into.

use super::Evaluator;

use super::errors::{ASSIGN_BEFORE, NO_VALUE_YET, UNKNOWN_VARIABLE};
use super::scalar::MAX_DEPTH;
use super::variable::{Variable, named};
use crate::diag::{At, Diagnostic, Fault};
use crate::fault;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{
    BinaryOperator, ComponentReference, Expression, ExpressionKind, ReferencePart, Subscript,
};
use crate::syntax::foreign;
use crate::value::errors::INDEX_OUT_OF_RANGE;
use crate::value::{Elements, Index, Step, Value};

impl Evaluator<'_> {
    /// The value of `a`, `a[i]`, `a.b[i].c`, ….
    pub(super) fn reference(
        &mut self,
        reference: &ComponentReference,
    ) -> Result<Value, Diagnostic> {
        if let ([part], false) = (reference.parts.as_slice(), reference.global) {
            let found = match part.subscripts.as_slice() {
                [] => self.scope.get(part.name).cloned(),
                _ => self.element(part, reference.span)?,
            };
            if let Some(value) = found {
                return Ok(value);
            }
        }
        let Some(first) = self.local(reference)? else { return self.global(reference) };
        let path = self.path(first.name, &reference.parts)?;
        let value = self.variable_value(first.name)?.part(&path);
        let value = value.map_err(|fault| named(first.name, fault).at(reference.span))?;
        if let Some(variable) = self.scope.variables.get(&first.name)
            && !self.is_iterator(first.name)
        {
            let value = variable.assigned(first.name, &path, value);
            return self.or_default(value, reference.span);
        }
        Ok(value)
    }

    /// The default of its type for a variable that has no value yet, where the host takes it.
    pub(super) fn or_default(
        &mut self,
        value: Result<Value, Box<(Fault, Value)>>,
        span: Span,
    ) -> Result<Value, Diagnostic> {
        let (fault, default) = match value {
            Ok(value) => return Ok(value),
            Err(missing) => *missing,
        };
        let Some(function) = self.scope.function_name().filter(|_| fault.code == NO_VALUE_YET)
        else {
            return Err(fault.at(span));
        };
        let warning = fault!(
            NO_VALUE_YET,
            "{} in the function `{function}`: zero is taken",
            fault.message;
            help: "{ASSIGN_BEFORE}"
        );
        match self.host.takes_default(warning.at(span).warning()) {
            true => Ok(default),
            false => Err(fault.at(span)),
        }
    }

    /// The sizes of a variable or a part of one, which need not have a value yet; `None` for a
    /// global name.
    pub(super) fn sizes_of(
        &mut self,
        reference: &ComponentReference,
    ) -> Result<Option<Vec<usize>>, Diagnostic> {
        let Some(first) = self.local(reference)? else { return Ok(None) };
        if reference.as_ident().is_some() {
            return Ok(Some(self.variable_value(first.name)?.dims().to_vec()));
        }
        let path = self.path(first.name, &reference.parts)?;
        let part = self.variable_value(first.name)?.part(&path).at(reference.span)?;
        Ok(Some(part.dims().to_vec()))
    }

    /// Assigns to a variable or a part of one.
    pub(super) fn assign(
        &mut self,
        target: &ComponentReference,
        value: Value,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let first = &target.parts[0];
        self.prepare(first.name)?;
        let known = !target.global && self.scope.variables.contains_key(&first.name);
        if let (Some(name), true) = (target.as_ident(), known || self.may_declare(target)) {
            if self.scope.is_script() {
                let before = self.scope.variables.get(&name);
                let undeclared = before.filter(|variable| variable.declared.is_none());
                let before = undeclared.map(|variable| &variable.value);
                if let Some(script) = self.host.script()
                    && script.assigned(name, before, &value).at(span)?
                {
                    return Ok(());
                }
            }
            return self.scope.set(name, value).at(span);
        }
        if !known {
            return self.assign_global(target, value, span);
        }
        // A number has no components: `x.start` is that of the model's `x`.
        if self.scope.is_script() && target.parts.len() > 1 && self.is_scalar(first.name) {
            let literal = self.with_literal_subscripts(target)?;
            if let Some(script) = self.host.script()
                && script.assign(&literal, value.clone(), span)?
            {
                return Ok(());
            }
        }
        self.assign_part(target, value).map_err(|error| match error.code == INDEX_OUT_OF_RANGE {
            true => error.help(format!(
                "arrays do not grow by assignment: give `{name}` its size first, as in `{name} := \
                 zeros(3)`, or join arrays: `{name} := cat(1, {name}, {{5}})`",
                name = first.name
            )),
            false => error,
        })
    }

    fn assign_part(&mut self, target: &ComponentReference, value: Value) -> Result<(), Diagnostic> {
        if let Some(done) = self.assign_element(target, &value)? {
            return Ok(done);
        }
        let name = target.parts[0].name;
        let path = self.path(name, &target.parts)?;
        let variable = self.variable_mut(name, target.span)?;
        variable.set_part(name, &path, value).map_err(|fault| named(name, fault).at(target.span))
    }

    fn is_scalar(&self, name: Ident) -> bool {
        let is_scalar = |value: &Value| {
            matches!(
                value,
                Value::Real(_) | Value::Integer(_) | Value::Boolean(_) | Value::String(_)
            )
        };
        self.scope.get(name).is_some_and(is_scalar)
    }

    /// Whether an assignment to an unknown name declares a variable.
    fn may_declare(&self, target: &ComponentReference) -> bool {
        self.scope.is_script() && target.as_ident().is_some()
    }

    fn assign_global(
        &mut self,
        target: &ComponentReference,
        value: Value,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let literal = self.with_literal_subscripts(target)?;
        if let Some(script) = self.host.script()
            && script.assign(&literal, value, span)?
        {
            return Ok(());
        }
        Err(self.scope.unknown(target.parts[0].name).at(target.span))
    }

    /// The first part of a reference, if it names a variable of this scope.
    fn local<'r>(
        &mut self,
        reference: &'r ComponentReference,
    ) -> Result<Option<&'r ReferencePart>, Diagnostic> {
        let first = &reference.parts[0];
        if reference.global {
            return Ok(None);
        }
        if self.is_iterator(first.name) || self.scope.variables.contains_key(&first.name) {
            return Ok(Some(first));
        }
        self.prepare(first.name)?;
        Ok(self.scope.variables.contains_key(&first.name).then_some(first))
    }

    fn is_iterator(&self, name: Ident) -> bool {
        self.scope.iterators.iter().any(|(iterator, _)| *iterator == name)
    }

    fn global(&mut self, reference: &ComponentReference) -> Result<Value, Diagnostic> {
        if let Some(value) = self.host.variable(reference)? {
            return Ok(value);
        }
        if let Some(value) = self.part_of_global(reference)? {
            return Ok(value);
        }
        if reference.parts.iter().any(|part| !part.subscripts.is_empty()) {
            let literal = self.with_literal_subscripts(reference)?;
            if let Some(value) = self.host.variable(&literal)? {
                return Ok(value);
            }
        }
        let name = reference.name().to_string();
        let elsewhere = self.host.meaning_elsewhere(&name);
        let fault = match reference.as_ident() {
            Some(ident) => {
                let help = elsewhere.or_else(|| self.meant_otherwise(&name));
                self.scope.unknown(ident).help_if(help)
            }
            None => {
                fault!(UNKNOWN_VARIABLE, "there is no variable `{name}` here").help_if(elsewhere)
            }
        };
        Err(fault.at(reference.span))
    }

    /// What a name that is not a variable is otherwise.
    fn meant_otherwise(&mut self, name: &str) -> Option<String> {
        if let Some(inner) = name.strip_prefix('\'').and_then(|rest| rest.strip_suffix('\'')) {
            return Some(format!("strings are in double quotes: `\"{inner}\"`"));
        }
        let is_function = self.host.function_names().iter().any(|known| known == name);
        let call = is_function.then(|| format!("`{name}` is a function: write `{name}(...)`"));
        call.or_else(|| foreign::name_help(name))
    }

    /// A part of a global array, such as `Package.table[2, 1]`.
    fn part_of_global(
        &mut self,
        reference: &ComponentReference,
    ) -> Result<Option<Value>, Diagnostic> {
        const ROOT: &str = "'an array'";
        let with_subscripts = |part: &ReferencePart| !part.subscripts.is_empty();
        let Some(at) = reference.parts.iter().position(with_subscripts) else { return Ok(None) };
        let mut whole = ComponentReference { parts: reference.parts[..=at].to_vec(), ..*reference };
        whole.parts[at].subscripts.clear();
        let Some(value) = self.host.variable(&whole)? else { return Ok(None) };
        let root = Ident::new(ROOT);
        self.scope.variables.insert(root, Variable::undeclared(value));
        let path = self.path(root, &reference.parts[at..]);
        let root = self.scope.variables.shift_remove(&root);
        let (path, Some(root)) = (path?, root) else { return Ok(None) };
        root.value.part(&path).map(Some).at(reference.span)
    }

    /// The reference with the values of its subscripts in their place.
    fn with_literal_subscripts(
        &mut self,
        reference: &ComponentReference,
    ) -> Result<ComponentReference, Diagnostic> {
        let mut literal = ComponentReference { parts: Vec::new(), ..reference.clone() };
        for part in &reference.parts {
            let name = part.name;
            literal.parts.push(ReferencePart { name, subscripts: Vec::new() });
            let is_literal = part.subscripts.iter().all(is_literal);
            let subscripts = match is_literal {
                true => part.subscripts.clone(),
                false => {
                    let dims = self.sizes_of_global(&literal, &part.subscripts)?;
                    let indices = self.subscripts(&part.subscripts, &dims)?;
                    let pairs = indices.into_iter().zip(&part.subscripts);
                    pairs.map(|(index, own)| index_literal(index, own.span())).collect()
                }
            };
            if let Some(last) = literal.parts.last_mut() {
                last.subscripts = subscripts;
            }
        }
        Ok(literal)
    }

    /// The sizes of a global array whose subscripts may ask for them: `a[end]`.
    fn sizes_of_global(
        &mut self,
        array: &ComponentReference,
        subscripts: &[Subscript],
    ) -> Result<Vec<usize>, Diagnostic> {
        let is_name = |subscript: &Subscript| match subscript {
            Subscript::All(_) => true,
            Subscript::Index(expression) => {
                matches!(expression.kind, ExpressionKind::Integer(_) | ExpressionKind::Reference(_))
            }
        };
        if subscripts.iter().all(is_name) {
            return Ok(Vec::new());
        }
        Ok(self.host.variable(array)?.map_or(Vec::new(), |value| value.dims().to_vec()))
    }

    /// The stored value, whether complete or not.
    pub(super) fn variable_value(&self, name: Ident) -> Result<&Value, Diagnostic> {
        let iterator = self.scope.iterators.iter().rev().find(|(iterator, _)| *iterator == name);
        match iterator {
            Some((_, value)) => Ok(value),
            None => match self.scope.variables.get(&name) {
                Some(variable) => Ok(&variable.value),
                None => Err(self.scope.unknown(name).at(Span::NONE)),
            },
        }
    }

    fn variable_mut(&mut self, name: Ident, span: Span) -> Result<&mut Variable, Diagnostic> {
        if self.is_iterator(name) || !self.scope.variables.contains_key(&name) {
            let code = super::errors::NOT_ASSIGNABLE;
            return Err(fault!(code, "the loop variable `{name}` cannot be assigned").at(span));
        }
        match self.scope.variables.get_mut(&name) {
            Some(variable) => Ok(variable),
            None => Err(fault!(UNKNOWN_VARIABLE, "there is no variable `{name}` here").at(span)),
        }
    }

    /// The quick way to a single element: `x[i]`, `x[i, j]` with Integer subscripts. `None` where
    /// the general way has to be taken.
    fn element(&mut self, part: &ReferencePart, span: Span) -> Result<Option<Value>, Diagnostic> {
        let Some(positions) = self.positions(part)? else { return Ok(None) };
        let positions = positions.as_slice();
        if let Some(variable) = self.scope.variables.get(&part.name)
            && variable.unassigned.is_none()
            && !self.is_iterator(part.name)
            && let Value::Array(array) = &variable.value
            && array.rank() == positions.len()
        {
            let offset = array.offset(positions).map_err(|f| named(part.name, f).at(span))?;
            return Ok(Some(array.elements.get(offset)));
        }
        Ok(None)
    }

    /// The quick way to overwrite a single element of an array of numbers.
    fn assign_element(
        &mut self,
        target: &ComponentReference,
        value: &Value,
    ) -> Result<Option<()>, Diagnostic> {
        let [part] = target.parts.as_slice() else { return Ok(None) };
        let Some(positions) = self.positions(part)? else { return Ok(None) };
        let positions = positions.as_slice();
        if self.is_iterator(part.name) {
            return Ok(None);
        }
        let Some(variable) = self.scope.variables.get_mut(&part.name) else { return Ok(None) };
        if variable.read_only || variable.unassigned.is_some() {
            return Ok(None);
        }
        let Value::Array(array) = &mut variable.value else { return Ok(None) };
        if array.rank() != positions.len() {
            return Ok(None);
        }
        let offset = array.offset(positions).map_err(|f| named(part.name, f).at(target.span))?;
        array.unmark(offset);
        match (&mut array.elements, value) {
            (Elements::Real(values), Value::Real(value)) => values[offset] = *value,
            (Elements::Real(values), Value::Integer(value)) => values[offset] = *value as f64,
            (Elements::Integer(values), Value::Integer(value)) => values[offset] = *value,
            (Elements::Boolean(values), Value::Boolean(value)) => values[offset] = *value,
            _ => return Ok(None),
        }
        Ok(Some(()))
    }

    /// The values of at most four subscripts that are literals or names of Integers. Nothing with
    /// an effect is evaluated, so that the general way may evaluate them again.
    fn positions(&mut self, part: &ReferencePart) -> Result<Option<Positions>, Diagnostic> {
        let mut positions = Positions { values: [0; 4], count: 0 };
        for subscript in &part.subscripts {
            let Subscript::Index(expression) = subscript else { return Ok(None) };
            let Some(position) = self.quick_integer(expression, MAX_DEPTH) else { return Ok(None) };
            if positions.count == positions.values.len() {
                return Ok(None);
            }
            positions.values[positions.count] = position;
            positions.count += 1;
        }
        Ok(Some(positions))
    }

    fn quick_integer(&self, expression: &Expression, depth: usize) -> Option<i64> {
        match &expression.kind {
            ExpressionKind::Integer(value) => Some(*value),
            ExpressionKind::Reference(reference) => match self.scope.get(reference.as_ident()?)? {
                Value::Integer(value) => Some(*value),
                _ => None,
            },
            ExpressionKind::Binary { operator, left, right } => {
                let depth = depth.checked_sub(1)?;
                let (a, b) = (self.quick_integer(left, depth)?, self.quick_integer(right, depth)?);
                match operator {
                    BinaryOperator::Add => a.checked_add(b),
                    BinaryOperator::Subtract => a.checked_sub(b),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// The way from a variable to the part that a reference names, its subscripts evaluated.
    fn path(&mut self, root: Ident, parts: &[ReferencePart]) -> Result<Vec<Step>, Diagnostic> {
        let mut path = Vec::with_capacity(2 * parts.len());
        for (at, part) in parts.iter().enumerate() {
            if at > 0 {
                path.push(Step::Field(part.name));
            }
            if part.subscripts.is_empty() {
                continue;
            }
            let dims = self.dims_of(root, &path, part)?;
            path.push(Step::Index(self.subscripts(&part.subscripts, &dims)?));
        }
        Ok(path)
    }

    /// Sizes of what the subscripts of a part apply to. For a field of an array of records these
    /// are the sizes of one record's field.
    fn dims_of(
        &self,
        root: Ident,
        path: &[Step],
        part: &ReferencePart,
    ) -> Result<Vec<usize>, Diagnostic> {
        let value = self.variable_value(root)?;
        if path.is_empty() {
            return Ok(value.dims().to_vec());
        }
        let reached = value.part(path).at(part.subscripts[0].span())?;
        let outer = path[..path.len() - 1].to_vec();
        let slices = value.part(&outer).at(part.subscripts[0].span())?.rank();
        Ok(reached.dims()[slices.min(reached.rank())..].to_vec())
    }

    /// Evaluates subscripts of something with these sizes: `end` is the size of its dimension.
    pub(super) fn subscripts(
        &mut self,
        subscripts: &[Subscript],
        dims: &[usize],
    ) -> Result<Vec<Index>, Diagnostic> {
        let mut indices = Vec::with_capacity(subscripts.len());
        for (dimension, subscript) in subscripts.iter().enumerate() {
            indices.push(match subscript {
                Subscript::All(_) => Index::All,
                Subscript::Index(expression) => {
                    self.scope.ends.push(dims.get(dimension).copied().unwrap_or(0));
                    let value = self.expression(expression);
                    self.scope.ends.pop();
                    Index::from_value(value?).at(expression.span)?
                }
            });
        }
        Ok(indices)
    }
}

fn is_literal(subscript: &Subscript) -> bool {
    match subscript {
        Subscript::All(_) => true,
        Subscript::Index(expression) => matches!(expression.kind, ExpressionKind::Integer(_)),
    }
}

fn index_literal(index: Index, span: Span) -> Subscript {
    let integer = |at: i64| Expression::new(ExpressionKind::Integer(at), span);
    match index {
        Index::One(at) => Subscript::Index(integer(at)),
        Index::Many(all) => {
            let elements = all.into_iter().map(integer).collect();
            Subscript::Index(Expression::new(ExpressionKind::Array(elements), span))
        }
        Index::All => Subscript::All(span),
    }
}

/// The values of a few subscripts, without a vector on the heap.
struct Positions {
    values: [i64; 4],
    count: usize,
}

impl Positions {
    fn as_slice(&self) -> &[i64] {
        &self.values[..self.count]
    }
}
