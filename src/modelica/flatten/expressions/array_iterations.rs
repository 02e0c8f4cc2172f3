//! Iterators in array constructors and reductions (MLS §10.4.1, §10.3.4): they stay as they are
//! where the element is an expression of the loop variables, and are written out where a loop
//! variable chooses a component of an array of components, which only a number can.

use crate::diag::Diagnostic;
use crate::eval::ValueType;
use crate::fault;
use crate::flatten::BaseType;
use crate::flatten::errors::TOO_LARGE;
use crate::flatten::expressions::local::Local;
use crate::flatten::flat_expression::literal;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    Arguments, BinaryOperator, ComponentReference, Expression, ExpressionKind, ForIndex,
};
use crate::syntax::visit::Visit;
use crate::value::{ArrayValue, Elements, Value};
use std::rc::Rc;

/// The most arrays that are added one by one, in expressions nested as deep.
const MAX_SUMMANDS: usize = 1000;

/// The most elements that are written out.
const MAX_ELEMENTS: usize = 100_000;

/// `sum(e for i in 1:0)` of components of an array without elements, or a multiple of it: nothing tells
/// the sizes of e (MLS §10.3.4.1), and added to an array it is that array of zeros.
pub(crate) fn is_sum_of_nothing(mut e: &Expression) -> bool {
    while let ExpressionKind::Binary { operator: BinaryOperator::Multiply, left, right } = &e.kind {
        if is_sum_of_nothing(right) {
            return true;
        }
        e = left;
    }
    match &e.kind {
        ExpressionKind::Call { function, arguments } => {
            function.as_ident().is_some_and(|name| name == "sum")
                && arguments.iterators.is_empty()
                && matches!(&arguments.positional[..], [array] if has_no_elements(array))
        }
        _ => false,
    }
}

/// `{}` or `zeros(0)`.
fn has_no_elements(e: &Expression) -> bool {
    match &e.kind {
        ExpressionKind::Array(elements) => elements.is_empty(),
        ExpressionKind::Call { function, arguments } => {
            let is_zero = |size: &Expression| size.kind == ExpressionKind::Integer(0);
            function.as_ident().is_some_and(|name| name == "zeros")
                && matches!(&arguments.positional[..], [size] if is_zero(size))
        }
        _ => false,
    }
}

/// The elements of nested array constructors so many levels below.
fn elements_below(e: &Expression, levels: usize) -> Vec<&Expression> {
    match (&e.kind, levels) {
        (ExpressionKind::Array(elements), 1..) => {
            elements.iter().flat_map(|element| elements_below(element, levels - 1)).collect()
        }
        _ => vec![e],
    }
}

impl Instantiation<'_> {
    /// `{element for i in range}`.
    pub(crate) fn array_iteration(
        &mut self,
        element: &Expression,
        indices: &[ForIndex],
        span: Span,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let visit = |uses: &mut dyn Visit| uses.expression(element);
        let indices = self.with_ranges(indices, context, local, &visit)?;
        match self.iterated(element, &indices, context, local) {
            Ok((resolved, iterators)) => {
                // Records are distinguished element by element.
                if self.has_records(&resolved, &iterators, local)
                    && let Some(written) = self.unrolled(element, &indices, context, local)
                {
                    return written;
                }
                let (element, indices) = (Box::new(resolved), iterators);
                Ok(Expression::new(ExpressionKind::ArrayIteration { element, indices }, span))
            }
            Err(error) => self.unrolled(element, &indices, context, local).unwrap_or(Err(error)),
        }
    }

    /// The arguments of a call, the element of a reduction among them.
    pub(crate) fn arguments(
        &mut self,
        arguments: &Arguments,
        context: ScopeId,
        local: &Local,
    ) -> Result<Arguments, Diagnostic> {
        let ([element], false) = (arguments.positional.as_slice(), arguments.iterators.is_empty())
        else {
            return Ok(Arguments {
                positional: self.all(&arguments.positional, context, local)?,
                named: self.named_arguments(&arguments.named, context, local)?,
                iterators: Vec::new(),
            });
        };
        let visit = |uses: &mut dyn Visit| uses.expression(element);
        let indices = self.with_ranges(&arguments.iterators, context, local, &visit)?;
        let (element, iterators) = match self.iterated(element, &indices, context, local) {
            Ok((resolved, iterators)) if self.has_records(&resolved, &iterators, local) => {
                match self.unrolled(element, &indices, context, local) {
                    Some(elements) => (elements?, Vec::new()),
                    None => (resolved, iterators),
                }
            }
            Ok(iterated) => iterated,
            Err(error) => match self.unrolled(element, &indices, context, local) {
                Some(elements) => (elements?, Vec::new()),
                None => return Err(error),
            },
        };
        Ok(Arguments { positional: vec![element], named: Vec::new(), iterators })
    }

    /// Whether elements are records, or iterators run over records.
    fn has_records(&self, element: &Expression, iterators: &[ForIndex], local: &Local) -> bool {
        let of_records = |index: &ForIndex| {
            let range = index.range.as_ref();
            range.is_some_and(|range| self.elements_of_records(range, local).is_some())
        };
        self.types().record_of(element, local).is_some() || iterators.iter().any(of_records)
    }

    /// `sum(e for i in …)` of arrays e where its elements had to be written out, or where there are
    /// none: the arrays are added one by one (MLS §10.3.4.1). `None` for other sums.
    pub(crate) fn sum_of_arrays(
        &mut self,
        written: &Arguments,
        resolved: &Arguments,
        span: Span,
    ) -> Option<Expression> {
        let ([element], false) = (&resolved.positional[..], written.iterators.is_empty()) else {
            return None;
        };
        if let (ExpressionKind::Array(_), true) = (&element.kind, resolved.iterators.is_empty()) {
            let elements = elements_below(element, written.iterators.len());
            let (first, rest) = elements.split_first()?;
            if rest.len() > MAX_SUMMANDS || self.shape_of(first)?.is_empty() {
                return None;
            }
            let add = |left: Expression, right: &&Expression| {
                Expression::operation(BinaryOperator::Add, left, (*right).clone(), span)
            };
            return Some(rest.iter().fold((*first).clone(), add));
        }
        let mut ranges = resolved.iterators.iter().filter_map(|index| index.range.as_ref());
        let is_empty = |range| self.shape_of(range).is_some_and(|dims| dims == [0]);
        if !ranges.any(is_empty) {
            return None;
        }
        let dims = self.element_shape(element, &resolved.iterators)?;
        if dims.is_empty() {
            return None;
        }
        let size = |size: usize| Expression::new(ExpressionKind::Integer(size as i64), span);
        let zero = Expression::new(ExpressionKind::Real(0.0), span);
        let positional = std::iter::once(zero).chain(dims.into_iter().map(size)).collect();
        let function = ComponentReference::from_name(&Name::from(Ident::new("fill")), span);
        let arguments = Box::new(Arguments { positional, ..Arguments::default() });
        Some(Expression::new(ExpressionKind::Call { function, arguments }, span))
    }

    fn iterated(
        &mut self,
        element: &Expression,
        indices: &[ForIndex],
        context: ScopeId,
        local: &Local,
    ) -> Result<(Expression, Vec<ForIndex>), Diagnostic> {
        // The last iterator is the outer one (MLS §10.4.1).
        let outer_first: Vec<ForIndex> = indices.iter().rev().cloned().collect();
        let (mut indices, inner) = self.iterators(&outer_first, context, local)?;
        indices.reverse();
        Ok((self.resolve(element, context, &inner)?, indices))
    }

    /// The iterators, the outer one first, with resolved ranges, and what their body knows.
    pub(crate) fn iterators(
        &mut self,
        indices: &[ForIndex],
        context: ScopeId,
        local: &Local,
    ) -> Result<(Vec<ForIndex>, Local), Diagnostic> {
        let mut inner = local.clone();
        let mut resolved = Vec::with_capacity(indices.len());
        for index in indices {
            let mut named = None;
            let range = match &index.range {
                Some(range) => {
                    named = self.classes.type_of_range(range, context, &inner)?;
                    if named.is_none() {
                        let literals = self.enumeration_of_range(range, context, &inner)?;
                        named = literals.map(ValueType::Enumeration);
                    }
                    match self.classes.type_range(range, context, &inner)? {
                        Some(values) => Some(values),
                        None => Some(self.resolve(range, context, &inner)?),
                    }
                }
                None => None,
            };
            let found = range.as_ref().and_then(|range| self.types().type_of(range));
            let is_boolean = found == Some(BaseType::Boolean);
            if let Some(found) = named.or(is_boolean.then_some(ValueType::Boolean)) {
                Rc::make_mut(&mut inner.types).push((index.name.node, found));
            }
            resolved.push(ForIndex { name: index.name, range });
            inner.names.push((index.name.node, None));
        }
        Ok((resolved, inner))
    }

    /// All elements, the last iterator outermost; `None` where a range is not known at translation.
    fn unrolled(
        &mut self,
        element: &Expression,
        indices: &[ForIndex],
        context: ScopeId,
        local: &Local,
    ) -> Option<Result<Expression, Diagnostic>> {
        let Some((last, before)) = indices.split_last() else {
            return Some(self.resolve(element, context, local));
        };
        let mut iterations = Vec::new();
        self.iterations(std::slice::from_ref(last), context, local, &mut iterations).ok()?;
        if iterations.len() > MAX_ELEMENTS {
            let error = fault!(TOO_LARGE, "the array has more than {MAX_ELEMENTS} elements");
            return Some(Err(error.at(last.name.span)));
        }
        let mut elements = Vec::with_capacity(iterations.len());
        for iteration in &iterations {
            match self.unrolled(element, before, context, iteration)? {
                Ok(one) => elements.push(one),
                error => return Some(error),
            }
        }
        let span = element.span;
        if elements.is_empty() {
            return Some(Ok(literal(
                &Value::Array(ArrayValue::vector(Elements::Real(vec![]))),
                span,
            )));
        }
        Some(Ok(Expression::new(ExpressionKind::Array(elements), span)))
    }
}
