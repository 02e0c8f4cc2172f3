//! Enumerations and Boolean as ranges, sizes and subscripts (MLS §10.1, §10.5, §11.2.2.2), and
//! their conversions (§4.9.5.2, §4.9.5.3). In the flat model the literals are their ordinals.

use crate::diag::Diagnostic;
use crate::eval::ValueType;
use crate::fault;
use crate::flatten::BaseType;
use crate::flatten::errors::TYPE_MISMATCH;
use crate::flatten::expressions::local::Local;
use crate::flatten::flat_expression::{call, subscripted};
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::types::Predefined;
use crate::flatten::lookup::types::Type;
use crate::flatten::types::Types;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::symbolic::function::LITERAL_BY_NUMBER;
use crate::syntax::ast::{
    Arguments, ClassSpecifier, ComponentReference, Expression, ExpressionKind, ReferencePart,
    Subscript,
};
use crate::value::EnumerationDefinition;
use std::sync::Arc;

/// How many short classes a type may lead through.
const MAX_CHAIN: usize = 100;

impl Classes<'_> {
    /// All values of the type that an expression names, as a vector; `None` if it names none.
    pub(crate) fn type_range(
        &mut self,
        e: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<Expression>, Diagnostic> {
        let integer = |n: usize| Expression::new(ExpressionKind::Integer(n as i64), e.span);
        Ok(match self.type_of_range(e, context, local)? {
            Some(ValueType::Boolean) => Some(all_booleans(e.span)),
            Some(ValueType::Enumeration(definition)) => {
                let ordinals = (1..=definition.literals.len()).map(integer).collect();
                Some(Expression::new(ExpressionKind::Array(ordinals), e.span))
            }
            _ => None,
        })
    }

    /// Boolean or the enumeration that an expression names; `None` if it names none.
    pub(crate) fn type_of_range(
        &mut self,
        e: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<ValueType>, Diagnostic> {
        let ExpressionKind::Reference(reference) = &e.kind else { return Ok(None) };
        let first = reference.parts[0].name;
        if local.names.iter().any(|(name, _)| *name == first)
            || (!reference.global && self.has_component(context, first)?)
        {
            return Ok(None);
        }
        let Some(found) = self.lookup(context, &reference.name())? else { return Ok(None) };
        if self.is_boolean(found)? {
            return Ok(Some(ValueType::Boolean));
        }
        Ok(self.enumeration(found, e.span)?.map(ValueType::Enumeration))
    }

    /// The type whose values are the subscripts of one dimension of a component, as its values; `None`
    /// where the size is a number.
    pub(crate) fn subscript_type(
        &mut self,
        node: NodeId,
        name: Ident,
        dimension: usize,
    ) -> Result<Option<Expression>, Diagnostic> {
        let Some(declared) = self.tree.declaration_of(node, name) else { return Ok(None) };
        match declared.dims.get(dimension) {
            Some((Subscript::Index(size), scope)) => {
                self.type_range(size, *scope, &Local::default())
            }
            _ => Ok(None),
        }
    }

    /// A dimension that is sized by an enumeration or by Boolean has subscripts of that type alone
    /// (MLS §10.5).
    pub(crate) fn check_subscript_types(
        &mut self,
        node: NodeId,
        part: &ReferencePart,
    ) -> Result<(), Diagnostic> {
        for (at, subscript) in part.subscripts.iter().enumerate() {
            let Subscript::Index(index) = subscript else { continue };
            if matches!(index.kind, ExpressionKind::Integer(_))
                && self.subscript_type(node, part.name, at)?.is_some()
            {
                return Err(fault!(
                    TYPE_MISMATCH,
                    "`{}` has enumeration or Boolean subscripts, not Integer ones",
                    part.name;
                    help: "write a literal of the index type in its declaration")
                .at(index.span));
            }
        }
        Ok(())
    }

    /// Whether a type is Boolean, through short classes.
    fn is_boolean(&mut self, mut found: Type) -> Result<bool, Diagnostic> {
        for _ in 0..MAX_CHAIN {
            let Type::Class(id) = found else {
                return Ok(found == Type::Predefined(Predefined::Boolean));
            };
            let text = self.text(id).clone();
            let ClassSpecifier::Short(short) = &text.definition.specifier else { break };
            let parent = self.scope(id).parent.unwrap_or(ScopeId::TOP);
            found = self.lookup_type(parent, &short.target)?;
        }
        Ok(false)
    }
}

impl Instantiation<'_> {
    /// `E(i)`, `Integer(e)` and `String(e)` of enumerations; `None` for any other call.
    pub(crate) fn conversion(
        &mut self,
        span: Span,
        function: &ComponentReference,
        arguments: &Arguments,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<Expression>, Diagnostic> {
        let [argument] = arguments.positional.as_slice() else { return Ok(None) };
        if !arguments.named.is_empty() || !arguments.iterators.is_empty() {
            return Ok(None);
        }
        match self.classes.lookup(context, &function.name())? {
            Some(Type::Predefined(Predefined::Integer)) => {
                let value = self.resolve(argument, context, local)?;
                Ok(Some(match self.types().type_of(&value) {
                    Some(BaseType::Integer) => value,
                    // Also where the type is not known here, as that of a record's component.
                    _ => ordinal(value),
                }))
            }
            Some(Type::Predefined(Predefined::String)) => {
                self.literal_name(argument, context, local)
            }
            Some(found @ Type::Class(_)) => {
                let Some(definition) = self.classes.enumeration(found, span)? else {
                    return Ok(None);
                };
                let value = self.resolve(argument, context, local)?;
                let count = definition.literals.len() as i64;
                match value.kind {
                    ExpressionKind::Integer(n) if !(1..=count).contains(&n) => Err(fault!(
                        TYPE_MISMATCH,
                        "`{}` has {count} literals; there is no literal number {n}",
                        definition.name
                    )
                    .at(span)),
                    ExpressionKind::Integer(_) => Ok(Some(value)),
                    _ => Ok(Some(literal_by_number(value, count))),
                }
            }
            _ => Ok(None),
        }
    }

    /// The enumeration of a range that one of its literals is written in: `E.a:E.b`, `E.a:e`.
    pub(crate) fn enumeration_of_range(
        &mut self,
        range: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<Arc<EnumerationDefinition>>, Diagnostic> {
        let ExpressionKind::Range { start, step: None, stop } = &range.kind else {
            return Ok(None);
        };
        match self.enumeration_of(start, context, local)? {
            None => self.enumeration_of(stop, context, local),
            found => Ok(found),
        }
    }

    /// `min` and `max` of the values of an iterator over literals, `min(e for e in E.a:E.b)`, with the
    /// literal that they have where there are none (MLS §10.3.4.1): the literals have become
    /// Integers, whose extremes are others.
    pub(crate) fn bounded_by_literals(
        &mut self,
        reduction: Expression,
        written: &Arguments,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &reduction.kind else {
            return Ok(reduction);
        };
        let (Some(name), [_, ..], [element]) = (
            function.as_ident().filter(|name| *name == "min" || *name == "max"),
            &written.iterators[..],
            &arguments.positional[..],
        ) else {
            return Ok(reduction);
        };
        let outer_first: Vec<_> = written.iterators.iter().rev().cloned().collect();
        let (_, inner) = self.iterators(&outer_first, context, local)?;
        let types = self.types();
        let Some(ValueType::Enumeration(definition)) = types.value_type_of(element, &inner) else {
            return Ok(reduction);
        };
        if types.value_type_of(&reduction, local) != Some(ValueType::Integer) {
            return Ok(reduction);
        }
        let bound = if name == "min" { definition.literals.len() as i64 } else { 1 };
        let span = reduction.span;
        let bound = Expression::new(ExpressionKind::Integer(bound), span);
        Ok(call(&Name::from(name), vec![reduction, bound], span))
    }

    /// The name of a literal, or of a value of an enumeration.
    fn literal_name(
        &mut self,
        argument: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<Expression>, Diagnostic> {
        match &argument.kind {
            ExpressionKind::If { branches, otherwise } => {
                return self.chosen_name((branches, otherwise), context, local, argument.span);
            }
            ExpressionKind::Reference(reference) => {
                let first = reference.parts[0].name;
                let has_type = local.types.iter().any(|(name, _)| *name == first);
                if local.get(first).is_some() && !has_type {
                    return Ok(None);
                }
            }
            ExpressionKind::Call { .. } => {}
            _ => return Ok(None),
        }
        let resolved = self.resolve(argument, context, local)?;
        let definition = match self.types().value_type_of(&resolved, local) {
            Some(ValueType::Enumeration(definition)) => definition,
            Some(ValueType::Integer) => match self.enumeration_of(argument, context, local)? {
                Some(definition) => definition,
                None => return Ok(None),
            },
            _ => return Ok(None),
        };
        let span = argument.span;
        let name = |literal: &Ident| {
            let text = literal.as_str().trim_matches('\'');
            Expression::new(ExpressionKind::String(text.into()), span)
        };
        let names = ExpressionKind::Array(definition.literals.iter().map(name).collect());
        let base = Expression::new(names, span);
        Ok(Some(subscripted(base, vec![Subscript::Index(resolved)], span)))
    }

    /// The names of the values of an expression with conditions; `None` unless all are of an
    /// enumeration.
    fn chosen_name(
        &mut self,
        (branches, otherwise): (&[(Expression, Expression)], &Expression),
        context: ScopeId,
        local: &Local,
        span: Span,
    ) -> Result<Option<Expression>, Diagnostic> {
        let mut names = Vec::with_capacity(branches.len());
        for (condition, value) in branches {
            let Some(name) = self.literal_name(value, context, local)? else { return Ok(None) };
            names.push((self.resolve(condition, context, local)?, name));
        }
        let otherwise = self.literal_name(otherwise, context, local)?;
        let chosen = otherwise
            .map(Box::new)
            .map(|otherwise| ExpressionKind::If { branches: names, otherwise });
        Ok(chosen.map(|kind| Expression::new(kind, span)))
    }

    /// The enumeration of a literal that is written as such; it is an Integer when it is resolved.
    fn enumeration_of(
        &mut self,
        argument: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<Arc<EnumerationDefinition>>, Diagnostic> {
        let ExpressionKind::Reference(reference) = &argument.kind else { return Ok(None) };
        let first = reference.parts[0].name;
        let prefix = Name { parts: reference.name().parent().parts, global: reference.global };
        if prefix.parts.is_empty()
            || local.get(first).is_some()
            || self.classes.has_component(context, first)?
        {
            return Ok(None);
        }
        match self.classes.lookup(context, &prefix)? {
            Some(found) => self.classes.enumeration(found, argument.span),
            None => Ok(None),
        }
    }
}

impl Types<'_> {
    /// The ordinal of a variable of an enumeration, with which old libraries compute; any other
    /// expression as it is.
    pub(crate) fn number_of_enumeration(&self, e: Expression, local: &Local) -> Expression {
        let is_enumeration = matches!(e.kind, ExpressionKind::Reference(_))
            && matches!(self.value_type_of(&e, local), Some(ValueType::Enumeration(_)));
        if is_enumeration { ordinal(e) } else { e }
    }

    /// Subscripts of Boolean as places: `false` is the first (MLS §10.5).
    pub(crate) fn boolean_subscript(&self, index: Expression, local: &Local) -> Expression {
        if self.value_type_of(&index, local) != Some(ValueType::Boolean) {
            return index;
        }
        let span = index.span;
        let place = |n| Expression::new(ExpressionKind::Integer(n), span);
        match index.kind {
            ExpressionKind::Boolean(truth) => place(1 + i64::from(truth)),
            ExpressionKind::Array(elements) => {
                let places =
                    elements.into_iter().map(|e| self.boolean_subscript(e, local)).collect();
                Expression::new(ExpressionKind::Array(places), span)
            }
            _ => {
                let kind = ExpressionKind::If {
                    branches: vec![(index, place(2))],
                    otherwise: Box::new(place(1)),
                };
                Expression::new(kind, span)
            }
        }
    }
}

/// `false` and `true` as a vector.
pub(crate) fn all_booleans(span: Span) -> Expression {
    let truth = |truth| Expression::new(ExpressionKind::Boolean(truth), span);
    Expression::new(ExpressionKind::Array(vec![truth(false), truth(true)]), span)
}

/// A number as a literal of an enumeration with so many; another number is a fault.
fn literal_by_number(number: Expression, count: i64) -> Expression {
    let span = number.span;
    let count = Expression::new(ExpressionKind::Integer(count), span);
    call(&Name::from(Ident::new(LITERAL_BY_NUMBER)), vec![number, count], span)
}

/// A value of Integer or of an enumeration as the Integer that stands for it in the flat model.
fn ordinal(value: Expression) -> Expression {
    let span = value.span;
    let function = ComponentReference::from_name(&Name::parse("Integer"), span);
    let arguments = Box::new(Arguments { positional: vec![value], ..Arguments::default() });
    Expression::new(ExpressionKind::Call { function, arguments }, span)
}
