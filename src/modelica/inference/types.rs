//! The type of the elements of a value.

use super::operators::{ResultType, result_type};
use crate::functions::{self, TypeRule};
use crate::name::Ident;
use crate::syntax::ast::{
    Arguments, BinaryOperator, ComponentReference, Expression, ExpressionKind, ForIndex, Operation,
    UnaryOperator,
};

/// The types that the language itself speaks of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Elementary {
    Real,
    Integer,
    Boolean,
    String,
    Clock,
}

/// A type of elements, as a caller has it: one of the language, an enumeration, a record.
pub(crate) trait ElementType: Clone + PartialEq {
    /// One of the language; `None` if the caller has none for it.
    fn elementary(which: Elementary) -> Option<Self>;
}

/// What a caller knows of names.
pub(crate) trait TypesOfNames {
    type Type: ElementType;

    /// The type of the elements of a variable, or of a literal of an enumeration.
    fn of_reference(&mut self, reference: &ComponentReference) -> Option<Self::Type>;
    /// The type of the first output of a declared function; `None` if none is declared.
    fn of_function(
        &mut self,
        function: &ComponentReference,
        arguments: &Arguments,
    ) -> Option<Option<Self::Type>>;
    /// How many dimensions an expression has, where it is known and matters: a matrix of Integers to
    /// a power has Integers (MLS §10.6.8), an Integer to a power is a Real.
    fn rank(&mut self, e: &Expression) -> Option<usize> {
        let _ = e;
        None
    }
    /// The type of a component of a record.
    fn of_component(&mut self, record: &Self::Type, name: Ident) -> Option<Self::Type> {
        let _ = (record, name);
        None
    }
}

/// The type of the elements of an expression; `None` where its text does not show it.
pub(crate) fn type_of<N: TypesOfNames>(names: &mut N, e: &Expression) -> Option<N::Type> {
    Walk { names, iterators: Vec::new() }.type_of(e)
}

/// The types of what is left of each operator in a chain of operations, and of the whole.
pub(crate) fn chain_types<N: TypesOfNames>(names: &mut N, e: &Expression) -> Vec<Option<N::Type>> {
    let mut walk = Walk { names, iterators: Vec::new() };
    let (first, operations) = e.chain();
    let mut types = vec![walk.type_of(first)];
    for one in operations {
        let left = types.last().cloned().flatten();
        types.push(walk.of_operation(&one, left));
    }
    types
}

fn elementary<T: ElementType>(which: Elementary) -> Option<T> {
    T::elementary(which)
}

/// The type that values of both types have together (MLS §6.7).
fn joined<T: ElementType>(one: T, other: T) -> Option<T> {
    if one == other {
        return Some(one);
    }
    is_number(&one).then_some(())?;
    is_number(&other).then_some(())?;
    elementary(Elementary::Real)
}

fn is_number<T: ElementType>(found: &T) -> bool {
    [Elementary::Real, Elementary::Integer].into_iter().any(|which| is(found, which))
}

fn is<T: ElementType>(found: &T, which: Elementary) -> bool {
    T::elementary(which).is_some_and(|known| known == *found)
}

struct Walk<'n, N: TypesOfNames> {
    names: &'n mut N,
    /// The iterators around, innermost last, which hide other names.
    iterators: Vec<(Ident, Option<N::Type>)>,
}

impl<N: TypesOfNames> Walk<'_, N> {
    fn type_of(&mut self, e: &Expression) -> Option<N::Type> {
        match &e.kind {
            ExpressionKind::Real(_) => elementary(Elementary::Real),
            ExpressionKind::Integer(_) | ExpressionKind::End => elementary(Elementary::Integer),
            ExpressionKind::Boolean(_) => elementary(Elementary::Boolean),
            ExpressionKind::String(_) => elementary(Elementary::String),
            ExpressionKind::Reference(reference) => self.of_reference(reference),
            ExpressionKind::Unary { operator: UnaryOperator::Not, .. } => {
                elementary(Elementary::Boolean)
            }
            ExpressionKind::Unary { operand, .. } => self.type_of(operand),
            ExpressionKind::Binary { .. } => {
                let (first, operations) = e.chain();
                let first = self.type_of(first);
                operations.iter().fold(first, |left, one| self.of_operation(one, left))
            }
            ExpressionKind::If { branches, otherwise } => {
                self.joined_type(branches.iter().map(|(_, value)| value).chain([&**otherwise]))
            }
            ExpressionKind::Range { start, step, stop } => {
                self.joined_type([&**start, &**stop].into_iter().chain(step.as_deref()))
            }
            ExpressionKind::Guarded { values, .. } => self.type_of(values),
            ExpressionKind::Array(elements) => self.joined_type(elements),
            ExpressionKind::Matrix(rows) => self.joined_type(rows.iter().flatten()),
            ExpressionKind::ArrayIteration { element, indices } => {
                self.iterated(indices, |own| own.type_of(element))
            }
            ExpressionKind::Subscripted { base, .. } => self.type_of(base),
            ExpressionKind::Field { base, name } => {
                let record = self.type_of(base)?;
                self.names.of_component(&record, *name)
            }
            ExpressionKind::Call { function, arguments } => {
                self.iterated(&arguments.iterators, |own| own.of_call(function, arguments))
            }
            ExpressionKind::PartialApplication { .. }
            | ExpressionKind::Tuple(_)
            | ExpressionKind::TypeName(_)
            | ExpressionKind::Code(_) => None,
        }
    }

    fn of_reference(&mut self, reference: &ComponentReference) -> Option<N::Type> {
        if let Some(name) = reference.as_ident() {
            if let Some((_, found)) = self.iterators.iter().rev().find(|(own, _)| *own == name) {
                return found.clone();
            }
            if name == "time" {
                return elementary(Elementary::Real);
            }
        }
        self.names.of_reference(reference)
    }

    /// What is known within expressions that iterators repeat. The last iterator is the outer one
    /// (MLS §10.4.1): the ranges of those before it may use it.
    fn iterated<R>(&mut self, indices: &[ForIndex], within: impl FnOnce(&mut Self) -> R) -> R {
        let outside = self.iterators.len();
        for index in indices.iter().rev() {
            let found = index.range.as_ref().and_then(|range| self.type_of(range));
            self.iterators.push((index.name.node, found));
        }
        let result = within(self);
        self.iterators.truncate(outside);
        result
    }

    fn of_operation(&mut self, one: &Operation<'_>, left: Option<N::Type>) -> Option<N::Type> {
        match result_type(one.operator) {
            ResultType::Boolean => elementary(Elementary::Boolean),
            ResultType::Real => {
                let is_integer = left.as_ref().is_some_and(|left| is(left, Elementary::Integer));
                let may_be_matrix = is_integer && one.operator == BinaryOperator::Power;
                match may_be_matrix && self.names.rank(one.left) == Some(2) {
                    true => left,
                    false => elementary(Elementary::Real),
                }
            }
            ResultType::OfOperands => {
                let all = joined(left?, self.type_of(one.right)?)?;
                let is_text = one.operator == BinaryOperator::Add && is(&all, Elementary::String);
                (is_number(&all) || is_text).then_some(all)
            }
        }
    }

    fn joined_type<'e>(
        &mut self,
        all: impl IntoIterator<Item = &'e Expression>,
    ) -> Option<N::Type> {
        let mut types = all.into_iter().map(|one| self.type_of(one));
        let first = types.next()??;
        types.try_fold(first, |all, one| joined(all, one?))
    }

    fn of_call(&mut self, function: &ComponentReference, arguments: &Arguments) -> Option<N::Type> {
        if let Some(declared) = self.names.of_function(function, arguments) {
            return declared;
        }
        match functions::find(function.as_ident()?.as_str())?.value_type {
            TypeRule::Real => elementary(Elementary::Real),
            TypeRule::Integer => elementary(Elementary::Integer),
            TypeRule::Boolean => elementary(Elementary::Boolean),
            TypeRule::String => elementary(Elementary::String),
            TypeRule::Clock => elementary(Elementary::Clock),
            TypeRule::Sampled => match self.is_sampled(arguments)? {
                true => self.type_of(arguments.positional.first()?),
                false => elementary(Elementary::Boolean),
            },
            TypeRule::As(at) => self.type_of(arguments.positional.get(at)?),
            TypeRule::Joined => self.joined_type(&arguments.positional),
            TypeRule::Unknown => None,
        }
    }

    /// Whether the arguments of `sample` are an expression and a clock, rather than two times
    /// (MLS §16.5.1); `None` if the text does not show it.
    fn is_sampled(&mut self, arguments: &Arguments) -> Option<bool> {
        match arguments.positional.get(1) {
            Some(second) => self.type_of(second).map(|found| !is_number(&found)),
            None => {
                let named = arguments.named.iter().any(|argument| argument.name.node == "clock");
                Some(named || arguments.named.is_empty())
            }
        }
    }
}
