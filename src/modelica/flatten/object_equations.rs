//! Equations of external objects: which variables stand for the same object.
//!
//! MLS §12.9.7 gives an object where its variable is declared. Libraries also make objects in equations
//! and pass them through connectors, `out.pkg = SerialPackager(n)` and `connect(a.out, b.in)`: each
//! variable is bound to the one object that its equations lead to, and the equations are gone.

use super::balance;
use super::errors::TYPE_MISMATCH;
use super::flat_expression::flat_reference;
use super::flat_model::{BaseType, FlatModel, Variability};
use crate::diag::Diagnostic;
use crate::fault;
use crate::inference::{VariabilityOfNames, most_variable};
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{
    Comment, ComponentReference, Equation, EquationKind, Expression, ExpressionKind, Subscript,
};
use indexmap::IndexMap;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::VecDeque;
use std::sync::Arc;

/// Binds variables of external objects by the equations between them, which are removed. An object
/// whose constructor needs variables is made when the simulation starts: its variables stay unknowns.
///
/// # Errors
/// One of them would stand for two objects.
pub(super) fn resolve(model: &mut FlatModel) -> Result<(), Vec<Diagnostic>> {
    let is_object = |base: &BaseType| matches!(base, BaseType::ExternalObject(_));
    let objects: FxHashSet<Arc<str>> = model
        .variables
        .iter()
        .filter(|(_, variable)| is_object(&variable.base) && variable.dims.is_empty())
        .map(|(name, _)| name.clone())
        .collect();
    if objects.is_empty() {
        return Ok(());
    }
    make_at_start(model, &objects);
    let mut same = Same::default();
    for (position, equation) in model.equations.iter().enumerate() {
        same.take(&objects, position, equation);
    }
    let mut bound = FxHashSet::default();
    for Made { name, equation, span, constructor } in &same.made {
        let is_first = model.variables[name].binding.is_none();
        match needs_variables(model, constructor) {
            true => model.equations[*equation] = at_start(name, constructor.clone(), *span),
            false if is_first => {
                model.variables[name].binding = Some(constructor.clone());
                bound.insert(*equation);
            }
            false => return Err(vec![two_objects(name, *span)]),
        }
    }
    bound.extend(same.bind(model)?);
    let kept: Vec<bool> = (0..model.equations.len()).map(|at| !bound.contains(&at)).collect();
    remove(model, &kept);
    Ok(())
}

/// Declared objects whose constructors need variables are made when the simulation starts.
fn make_at_start(model: &mut FlatModel, objects: &FxHashSet<Arc<str>>) {
    let mut late: Vec<Arc<str>> = objects.iter().cloned().collect();
    late.retain(|name| {
        let binding = model.variables[name].binding.as_ref();
        binding.is_some_and(|e| is_constructor(e) && needs_variables(model, e))
    });
    late.sort();
    for name in late {
        if let Some(constructor) = model.variables[&name].binding.take() {
            let span = constructor.span;
            model.equations.push(at_start(&name, constructor, span));
        }
    }
}

/// `when initial() then name = constructor(…); end when`
fn at_start(name: &str, constructor: Expression, span: Span) -> Equation {
    let initial = ComponentReference::from_name(&Name::parse("initial"), span);
    let call = ExpressionKind::Call { function: initial, arguments: Box::default() };
    let left = ExpressionKind::Reference(flat_reference(name, span));
    let made = EquationKind::Equal { left: Expression::new(left, span), right: constructor };
    let body = vec![Equation { kind: made, comment: Comment::default(), span }];
    let branches = vec![(Expression::new(call, span), body)];
    Equation { kind: EquationKind::When { branches }, comment: Comment::default(), span }
}

fn is_constructor(e: &Expression) -> bool {
    let ExpressionKind::Call { function, .. } = &e.kind else { return false };
    function.parts.last().is_some_and(|part| part.name == "constructor")
}

/// Whether an expression has variables that are known only when the simulation starts.
fn needs_variables(model: &FlatModel, e: &Expression) -> bool {
    let most = most_variable(&mut VariabilityIn(model), e);
    most.is_some_and(|most| most.variability > Variability::Parameter)
}

/// When the variables of a model may change; external objects do not.
struct VariabilityIn<'m>(&'m FlatModel);

impl VariabilityOfNames for VariabilityIn<'_> {
    fn of_reference(&mut self, reference: &ComponentReference) -> Option<Variability> {
        let variable = self.0.variables.get(&*balance::path(reference))?;
        match variable.base {
            BaseType::ExternalObject(_) => None,
            _ => Some(variable.variability),
        }
    }
}

/// What equations say of external objects.
#[derive(Default)]
struct Same {
    /// Constructors in equations.
    made: Vec<Made>,
    /// For each variable those that stand for the same object, by the equations at these positions.
    pairs: FxHashMap<Arc<str>, Vec<(Arc<str>, usize)>>,
    /// Where equations are written.
    spans: FxHashMap<usize, Span>,
}

/// A constructor in an equation.
struct Made {
    name: Arc<str>,
    equation: usize,
    span: Span,
    constructor: Expression,
}

/// One side of an equation.
enum Side {
    /// Its elements.
    Elements(Vec<Object>),
    /// The same for each element of the other side.
    Each(Object),
}

/// An external object in an equation.
#[derive(Clone)]
enum Object {
    Variable(Arc<str>),
    Made(Expression),
}

impl Same {
    /// Takes what an equation says, if it is one between external objects.
    fn take(&mut self, objects: &FxHashSet<Arc<str>>, position: usize, equation: &Equation) {
        let EquationKind::Equal { left, right } = &equation.kind else { return };
        let (Some(a), Some(b)) = (side(objects, left), side(objects, right)) else { return };
        let pairs: Vec<(Object, Object)> = match (a, b) {
            (Side::Elements(a), Side::Elements(b)) if a.len() == b.len() => {
                a.into_iter().zip(b).collect()
            }
            (Side::Elements(a), Side::Each(b)) | (Side::Each(b), Side::Elements(a)) => {
                a.into_iter().map(|a| (a, b.clone())).collect()
            }
            _ => return,
        };
        // Several objects that one equation makes are left to the code that lowers the equation.
        let is_alone = pairs.len() == 1;
        let is_plain = |(a, b): &(Object, Object)| {
            matches!((a, b), (Object::Variable(_), Object::Variable(_)))
        };
        if !is_alone && !pairs.iter().all(is_plain) {
            return;
        }
        self.spans.insert(position, equation.span);
        pairs.into_iter().for_each(|(a, b)| self.add(a, b, position, equation.span));
    }

    fn add(&mut self, a: Object, b: Object, equation: usize, span: Span) {
        match (a, b) {
            (Object::Variable(a), Object::Variable(b)) => {
                self.pairs.entry(a.clone()).or_default().push((b.clone(), equation));
                self.pairs.entry(b).or_default().push((a, equation));
            }
            (Object::Variable(name), Object::Made(constructor))
            | (Object::Made(constructor), Object::Variable(name)) => {
                self.made.push(Made { name, equation, span, constructor });
            }
            (Object::Made(_), Object::Made(_)) => {}
        }
    }

    /// Binds all variables that lead to one that has a value; returns the equations that did.
    fn bind(&self, model: &mut FlatModel) -> Result<FxHashSet<usize>, Vec<Diagnostic>> {
        let has_value = |name: &Arc<str>| model.variables[name].binding.is_some();
        let is_root = |name: &&Arc<str>| self.pairs.contains_key(*name) && has_value(name);
        let roots: Vec<Arc<str>> = model.variables.keys().filter(is_root).cloned().collect();
        let mut root_of: IndexMap<Arc<str>, Arc<str>> = IndexMap::new();
        let mut used = FxHashSet::default();
        for root in roots {
            let mut waiting = VecDeque::from([(root.clone(), None)]);
            while let Some((name, equation)) = waiting.pop_front() {
                used.extend(equation);
                match root_of.get(&name) {
                    Some(known) if *known == root => continue,
                    Some(_) => {
                        let span = equation.and_then(|at| self.spans.get(&at)).copied();
                        return Err(vec![two_objects(&name, span.unwrap_or(Span::NONE))]);
                    }
                    None => _ = root_of.insert(name.clone(), root.clone()),
                }
                let others = self.pairs.get(&name).into_iter().flatten();
                waiting.extend(others.map(|(other, equation)| (other.clone(), Some(*equation))));
            }
        }
        for (name, root) in root_of {
            if name != root {
                let root = ExpressionKind::Reference(flat_reference(&root, Span::NONE));
                model.variables[&name].binding = Some(Expression::new(root, Span::NONE));
            }
        }
        Ok(used)
    }
}

fn two_objects(name: &str, span: Span) -> Diagnostic {
    fault!(TYPE_MISMATCH, "`{name}` would stand for two external objects";
        help: "construct the object at one place, and connect it with the others")
    .at(span)
}

/// One side of an equation, if all of it is external objects.
fn side(objects: &FxHashSet<Arc<str>>, e: &Expression) -> Option<Side> {
    match &e.kind {
        ExpressionKind::Array(elements) => {
            let mut all = Vec::with_capacity(elements.len());
            for element in elements {
                match side(objects, element)? {
                    Side::Elements(more) => all.extend(more),
                    Side::Each(_) => return None,
                }
            }
            (!all.is_empty()).then_some(Side::Elements(all))
        }
        ExpressionKind::Call { function, arguments } => {
            if path(function).is_some_and(|name| name == "fill") {
                let filled = side(objects, arguments.positional.first()?)?;
                return match filled {
                    Side::Elements(mut one) if one.len() == 1 => one.pop().map(Side::Each),
                    _ => None,
                };
            }
            is_constructor(e).then(|| Side::Elements(vec![Object::Made(e.clone())]))
        }
        ExpressionKind::Reference(reference) => {
            let object = objects.get(path(reference)?.as_str())?.clone();
            Some(Side::Elements(vec![Object::Variable(object)]))
        }
        _ => None,
    }
}

/// The flat name of a reference whose subscripts are literals.
fn path(reference: &ComponentReference) -> Option<String> {
    let mut path = String::new();
    for part in &reference.parts {
        if !path.is_empty() {
            path.push('.');
        }
        path.push_str(part.name.as_str());
        let mut subscripts = Vec::with_capacity(part.subscripts.len());
        for subscript in &part.subscripts {
            let Subscript::Index(index) = subscript else { return None };
            let ExpressionKind::Integer(index) = index.kind else { return None };
            subscripts.push(index.to_string());
        }
        if !subscripts.is_empty() {
            path.push_str(&format!("[{}]", subscripts.join(",")));
        }
    }
    Some(path)
}

/// Leaves the equations that are kept.
fn remove(model: &mut FlatModel, kept: &[bool]) {
    let mut before = Vec::with_capacity(kept.len() + 1);
    let mut n = 0;
    for keep in kept {
        before.push(n);
        n += usize::from(*keep);
    }
    before.push(n);
    let mut keep = kept.iter();
    model.equations.retain(|_| *keep.next().unwrap_or(&true));
    for part in &mut model.parts {
        part.equations = before[part.equations.start]..before[part.equations.end];
    }
}
