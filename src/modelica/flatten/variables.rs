//! The variables of the flat model: bindings and attributes with their names resolved, split over
//! the elements of arrays (MLS §4.4, §4.9, §7.2).

use super::FlatModel;
use super::errors::{NOT_CONSTANT, SIZE_MISMATCH, TYPE_MISMATCH};
use super::flat_expression::{indices_of, literal};
use super::instantiate::instance::Leaf;
use super::instantiate::instance::MemberState;
use super::instantiate::instance::NodeKind;
use super::lookup::modification::Bound;
use super::record_values::is_computed;
use super::types::type_name;
use super::{Attribute, BaseType, Variability, Variable};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::expressions::local::Local;
use crate::flatten::flat_expression::picked;
use crate::flatten::ids::{NodeId, ScopeId};
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::lookup::types::ATTRIBUTES;
use crate::source::Span;
use crate::syntax::ast::{Arguments, ComponentReference, Expression, ExpressionKind};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Attributes that must be known when the equations are sorted.
const DECIDED: [&str; 2] = ["fixed", "stateSelect"];

impl Instantiation<'_> {
    /// Adds the variables of a node and of all below it, in order of declaration.
    pub(crate) fn add_variables(
        &mut self,
        node: NodeId,
        model: &mut FlatModel,
        errors: &mut Vec<Diagnostic>,
    ) {
        let mut found = Vec::new();
        self.collect_variables(node, &mut found, errors);
        for at in found {
            // The values in the tree, which may be long expressions, are not read.
            let known = &mut self.classes.tree.variables[at].0;
            let mut binding = known.binding.take();
            if let (true, Some(Some((value, _)))) =
                (self.values.drawn.contains(&at), self.values.known.get(&at))
            {
                // The sizes that it decided are those of this draw.
                let span = binding.as_ref().map_or(Span::NONE, |binding| binding.span);
                binding = Some(literal(value, span));
            }
            let attributes = std::mem::take(&mut known.attributes);
            let structural = self.values.structural.contains(&at);
            let variable = Variable { binding, attributes, structural, ..known.clone() };
            model.variables.insert(variable.name.clone(), variable);
        }
    }

    fn collect_variables(
        &mut self,
        node: NodeId,
        found: &mut Vec<usize>,
        errors: &mut Vec<Diagnostic>,
    ) {
        match &self.classes.tree.nodes[node.0].kind {
            NodeKind::Variable(leaf) => {
                let leaf = leaf.clone();
                match self.finished(&leaf) {
                    Ok(variable) => {
                        self.classes.tree.variables[leaf.variable].0 = variable;
                        found.push(leaf.variable);
                    }
                    Err(error) => errors.push(error),
                }
            }
            NodeKind::Composite(_) => {
                let members = match self.classes.members(node) {
                    Ok(members) => members,
                    Err(error) => return errors.push(error),
                };
                for (_, state) in members {
                    let nodes = match state {
                        MemberState::Single(one) => vec![one],
                        MemberState::Array(_, nodes) => nodes,
                        _ => Vec::new(),
                    };
                    for one in nodes {
                        self.collect_variables(one, found, errors);
                    }
                }
            }
        }
    }

    /// The variable with its binding and attributes.
    fn finished(&mut self, leaf: &Leaf) -> Result<Variable, Diagnostic> {
        let mut variable = self.classes.tree.variables[leaf.variable].0.clone();
        if let Some(bound) = &leaf.modifier.binding {
            // External objects are made once, before the simulation (MLS §12.9.7).
            let impure = variable.variability <= Variability::Parameter
                || matches!(variable.base, BaseType::ExternalObject(_));
            variable.binding = self.bound(bound, impure)?;
        }
        if let Some(binding) = variable.binding.take() {
            check_literal(&binding, &variable.base, &variable)?;
            let each = leaf.modifier.binding.as_ref().is_some_and(|bound| bound.each);
            // `each` is about the array that holds the component, whose own value is an array, as a
            // rule.
            let is_short = |rank: usize| rank < variable.dims.len();
            let each = each && self.types().rank_of(&binding).is_some_and(is_short);
            let binding = self.checked_value(binding, &variable, each)?;
            variable.binding = Some(if each { filled(binding, &variable.dims) } else { binding });
        }
        variable.binding = self.with_elements(leaf, None, variable.binding.take(), &variable)?;
        for name in ATTRIBUTES {
            let modifier = leaf.modifier.elements.iter().find(|(known, _)| **known == name);
            let bound = modifier.and_then(|(_, modifier)| modifier.binding.as_ref());
            let whole = bound.map_or(Ok(None), |bound| self.bound(bound, false))?;
            if let Some(value) = self.with_elements(leaf, Some(name), whole, &variable)? {
                let value = if DECIDED.contains(&name) { self.decided(value)? } else { value };
                let is_final = modifier.is_some_and(|(_, modifier)| modifier.is_final);
                variable.attributes.insert(name, Attribute { value, is_final });
            }
        }
        Ok(variable)
    }

    /// The value of a variable, or of an attribute of it, in which single elements have values of
    /// their own.
    fn with_elements(
        &mut self,
        leaf: &Leaf,
        attribute: Option<&'static str>,
        whole: Option<Expression>,
        variable: &Variable,
    ) -> Result<Option<Expression>, Diagnostic> {
        let mut own: FxHashMap<&[usize], Expression> = FxHashMap::default();
        for (indices, modifier) in &leaf.modifier.of_elements {
            let Some(bound) = modifier.value_of(attribute) else { continue };
            let Some(value) = self.bound(bound, false)? else { continue };
            if attribute.is_none() {
                let element = Variable { dims: Vec::new(), ..variable.clone() };
                check_literal(&value, &element.base, &element)?;
                own.insert(indices, self.checked_value(value, &element, false)?);
            } else {
                own.insert(indices, value);
            }
        }
        let Some(span) = own.values().next().map(|value| value.span) else { return Ok(whole) };
        let is_array =
            whole.as_ref().is_some_and(|whole| self.types().rank_of(whole).is_none_or(|n| n > 0));
        let mut elements = Vec::new();
        for at in 0..variable.len() {
            let indices = indices_of(at, &variable.dims);
            let value = match (own.remove(indices.as_slice()), &whole, attribute) {
                (Some(own), _, _) => own,
                (None, Some(whole), _) if is_array => element_of(whole, &indices),
                (None, Some(whole), _) => whole.clone(),
                (None, None, Some("fixed")) => {
                    Expression::new(ExpressionKind::Boolean(false), span)
                }
                (None, None, Some("start")) => start_of(&variable.base, span),
                (None, None, _) => return Err(incomplete(variable, &indices, span)),
            };
            elements.push(value);
        }
        Ok(Some(nested(elements, &variable.dims, span)))
    }

    /// Refuses a value that does not fit. An Integer as the ordinal of an enumeration, which old
    /// libraries store in Integer parameters, is a warning, and so is a constant that depends on a
    /// parameter whose value is known: the parameter is evaluated.
    fn checked_value(
        &mut self,
        value: Expression,
        variable: &Variable,
        each: bool,
    ) -> Result<Expression, Diagnostic> {
        let types = self.types();
        let is_ordinal = matches!(variable.base, BaseType::Enumeration(_))
            && variable.dims.is_empty()
            && types.rank_of(&value) == Some(0)
            && types.type_of(&value) == Some(BaseType::Integer);
        let is_known = self.record_values.may_be(&value, variable.variability);
        let checked = types.check_value(&value, variable, each).and_then(|()| match is_known {
            true => Ok(()),
            false => types.check_variability(&value, variable),
        });
        let Err(error) = checked else {
            self.record_values.keep_may_be(&value, variable.variability);
            return Ok(value);
        };
        if self.classes.library.is_strict() {
            return Err(error);
        }
        if is_ordinal {
            self.warnings.push(error.warning());
            return Ok(value);
        }
        if error.code == NOT_CONSTANT
            && variable.variability == Variability::Constant
            && let Ok(known) = self.flat_value(&value)
        {
            self.warnings.add_once(error);
            return Ok(literal(&known, value.span));
        }
        Err(error)
    }

    /// The value of an attribute that decides how a variable is treated.
    fn decided(&mut self, value: Expression) -> Result<Expression, Diagnostic> {
        if !self.is_fixed(&value) {
            return Ok(value);
        }
        Ok(literal(&self.flat_value(&value)?, value.span))
    }

    fn bound(&mut self, bound: &Bound, impure: bool) -> Result<Option<Expression>, Diagnostic> {
        let Some(value) = &bound.value else { return Ok(None) };
        let value = self.part_of(value, bound)?;
        self.bound_value(&value, bound.context, impure).map(Some)
    }

    /// The value of a binding; the components of a record share that of the record.
    fn bound_value(
        &mut self,
        value: &Expression,
        context: ScopeId,
        impure: bool,
    ) -> Result<Expression, Diagnostic> {
        let (base, name) = match &value.kind {
            ExpressionKind::Field { base, name } if is_computed(base) => (base, *name),
            _ => return self.resolve(value, context, &Local { impure, ..Local::default() }),
        };
        let known = self.record_values.get(base, context, impure);
        let resolved = match known {
            Some(resolved) => resolved,
            None => {
                let resolved = Arc::new(self.bound_value(base, context, impure)?);
                self.record_values.insert(base, context, impure, &resolved);
                resolved
            }
        };
        Ok(Expression::new(ExpressionKind::Field { base: resolved, name }, value.span))
    }
}

impl Instantiation<'_> {}

/// An element of a resolved value that is an array.
fn element_of(whole: &Expression, indices: &[usize]) -> Expression {
    match (&whole.kind, indices) {
        (_, []) => whole.clone(),
        (ExpressionKind::Array(elements), [first, rest @ ..]) => match elements.get(first - 1) {
            Some(element) => element_of(element, rest),
            None => picked(whole.clone(), indices),
        },
        _ => picked(whole.clone(), indices),
    }
}

/// The start value of a variable that has none (MLS §4.9).
fn start_of(base: &BaseType, span: Span) -> Expression {
    let kind = match base {
        BaseType::Boolean => ExpressionKind::Boolean(false),
        BaseType::Integer => ExpressionKind::Integer(0),
        _ => ExpressionKind::Real(0.0),
    };
    Expression::new(kind, span)
}

fn incomplete(variable: &Variable, indices: &[usize], span: Span) -> Diagnostic {
    let numbers: Vec<String> = indices.iter().map(usize::to_string).collect();
    let name = &variable.name;
    fault!(
        SIZE_MISMATCH,
        "only some elements of `{name}` have a value: `{name}[{}]` has none", numbers.join(",");
        help: "give every element of the array a value")
    .at(span)
}

/// An array of these sizes from its elements, the last index fastest.
fn nested(elements: Vec<Expression>, dims: &[usize], span: Span) -> Expression {
    let mut level = elements;
    for size in dims.iter().rev() {
        let rows = level.chunks((*size).max(1));
        level =
            rows.map(|row| Expression::new(ExpressionKind::Array(row.to_vec()), span)).collect();
    }
    let empty = || Expression::new(ExpressionKind::Array(Vec::new()), span);
    level.into_iter().next().unwrap_or_else(empty)
}

/// A value of one element for every element: `fill(value, 2, 3)`.
fn filled(value: Expression, dims: &[usize]) -> Expression {
    if dims.is_empty() {
        return value;
    }
    let span = value.span;
    let size = |n: &usize| Expression::new(ExpressionKind::Integer(*n as i64), span);
    let positional = std::iter::once(value).chain(dims.iter().map(size)).collect();
    let function = ComponentReference::from_name(&crate::name::Name::parse("fill"), span);
    let arguments = Box::new(Arguments { positional, ..Arguments::default() });
    Expression::new(ExpressionKind::Call { function, arguments }, span)
}

/// Refuses a literal of the wrong type or an array constructor of the wrong size; what is computed
/// is checked where it is computed.
fn check_literal(e: &Expression, base: &BaseType, variable: &Variable) -> Result<(), Diagnostic> {
    let found = match &e.kind {
        ExpressionKind::Real(_) => "Real",
        ExpressionKind::Integer(_) => "Integer",
        ExpressionKind::Boolean(_) => "Boolean",
        ExpressionKind::String(_) => "String",
        ExpressionKind::Array(elements) => {
            return check_array(elements, e, base, &variable.dims, variable);
        }
        _ => return Ok(()),
    };
    let fits = match base {
        BaseType::Real => matches!(found, "Real" | "Integer"),
        BaseType::Integer | BaseType::Enumeration(_) => found == "Integer",
        BaseType::Boolean => found == "Boolean",
        BaseType::String => found == "String",
        BaseType::ExternalObject(_) | BaseType::Clock => false,
    };
    if !fits {
        let required = type_name(base);
        let name = &variable.name;
        return Err(
            fault!(TYPE_MISMATCH, "`{name}` is {required}, but its value is {found}").at(e.span)
        );
    }
    Ok(())
}

fn check_array(
    elements: &[Expression],
    e: &Expression,
    base: &BaseType,
    dims: &[usize],
    variable: &Variable,
) -> Result<(), Diagnostic> {
    let name = &variable.name;
    let Some((size, inner)) = dims.split_first() else {
        return Err(fault!(
            SIZE_MISMATCH,
            "the value of `{name}` has more dimensions than its declaration"
        )
        .at(e.span));
    };
    if elements.len() != *size {
        let count = elements.len();
        return Err(
            fault!(SIZE_MISMATCH, "`{name}` needs {size} elements here, not {count}").at(e.span)
        );
    }
    elements.iter().try_for_each(|element| match &element.kind {
        ExpressionKind::Array(deeper) => check_array(deeper, element, base, inner, variable),
        _ => check_literal(element, base, variable),
    })
}
