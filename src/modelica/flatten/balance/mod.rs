//! Compares the number of equations with that of unknowns (MLS §4.8): of the whole model, and of
//! each class by itself.

mod idle_inputs;
mod local;
mod sets;

pub use local::LocalBalance;

use super::errors::{UNBALANCED_CLASS, UNBALANCED_MODEL};
use super::flat_expression::flat_reference;
use super::{FlatModel, Variability};
use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionComponent, ValueType};
use crate::fault;
use crate::inference::{self, Sizes, SizesOfNames};
use crate::source::Span;
use crate::syntax::ast::{
    CausalityPrefix, ComponentReference, Equation, EquationKind, Expression, ExpressionKind,
    Subscript, targets,
};
use crate::syntax::print;
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The most classes that one message names.
const MAX_CLASSES: usize = 3;

/// An error if the numbers differ. Where the size of an equation does not follow from its text, the
/// model is left to the matching of equations and unknowns.
pub(crate) fn check(model: &FlatModel, classes: &[LocalBalance]) -> Result<(), Diagnostic> {
    let unknowns = unknowns(model);
    let Some(equations) = equations(model) else { return Ok(()) };
    if equations == unknowns || equations + idle_inputs::idle_inputs(model) == unknowns {
        return Ok(());
    }
    let name = &model.name;
    let (few, many) = (plural(unknowns, "unknown"), plural(equations, "equation"));
    let fault = if equations < unknowns {
        fault!(UNBALANCED_MODEL, "`{name}` has {few} but {many}";
            help: "add the missing equations, or give variables a binding")
    } else {
        fault!(UNBALANCED_MODEL, "`{name}` has {few} but {many}";
            help: "remove redundant equations, or declare the unknowns that they determine")
    };
    let mut error = fault.at(model.span.unwrap_or(Span::NONE));
    for class in unbalanced(classes).filter(|class| !class.path.is_empty()).take(MAX_CLASSES) {
        error = error.related(class.span, format!("{} (`{}`)", class.finding(), class.path));
    }
    Err(error)
}

/// Whether the numbers are the same, as far as the text of all equations shows it.
pub(super) fn is_balanced(model: &FlatModel) -> Option<bool> {
    let equations = equations(model)?;
    let unknowns = unknowns(model);
    Some(equations == unknowns || equations + idle_inputs::idle_inputs(model) == unknowns)
}

/// Variables without equations of their own are not counted: inputs of the model.
fn unknowns(model: &FlatModel) -> usize {
    let are_unknown = model.variables.values().filter(|variable| is_unknown(variable));
    are_unknown.map(super::Variable::len).sum()
}

fn is_unknown(variable: &super::Variable) -> bool {
    variable.variability >= Variability::Discrete
        && variable.causality != Some(CausalityPrefix::Input)
}

/// Number of scalar equations, bindings and assigned variables; `None` where the size of one does not
/// follow from its text, and in a model with states, which determine one variable in turn.
fn equations(model: &FlatModel) -> Option<usize> {
    if model.parts.iter().any(|part| !part.outputs.is_empty()) {
        return None;
    }
    let bound = model.variables.values().filter(|own| is_unknown(own) && own.binding.is_some());
    let mut equations: usize = bound.map(super::Variable::len).sum();
    let mut sizes = SizesIn(model);
    let mut dims =
        |e: &Expression| inference::sizes_of(&mut sizes, e).and_then(inference::all_known);
    for equation in &model.equations {
        equations += size(equation, &mut dims)?;
    }
    let assigned = model.algorithms.iter().flat_map(|statements| targets(statements));
    Some(equations + scalars_of(assigned, model))
}

/// The sizes of an expression, where all of them are known.
type Dims<'d> = dyn FnMut(&Expression) -> Option<Vec<usize>> + 'd;

/// The sizes of variables of a flat model.
struct SizesIn<'m>(&'m FlatModel);

impl SizesOfNames for SizesIn<'_> {
    type Function = Function;

    fn of_reference(&mut self, reference: &ComponentReference) -> Option<Sizes> {
        let variable = self.0.variables.get(&*path(reference))?;
        Some(variable.dims.iter().copied().map(Some).collect())
    }

    /// A record is not the number of scalars that its sizes say.
    fn function(&mut self, function: &ComponentReference) -> Option<Option<Arc<Function>>> {
        let found = self.0.functions.get(&function.name())?;
        let is_record =
            |output: &FunctionComponent| matches!(output.value_type, ValueType::Record(..));
        Some((!found.outputs.first().is_some_and(is_record)).then(|| found.clone()))
    }
}

/// Warnings about classes that are not balanced by themselves though the model is: their parts
/// make up for each other. One for each library, as older ones do not know the rule, and about a
/// part rather than about what holds it.
pub(crate) fn warnings(classes: &[LocalBalance]) -> Vec<Diagnostic> {
    let mut named = BTreeSet::new();
    let mut found: Vec<&LocalBalance> = unbalanced(classes).collect();
    found.reverse();
    found
        .into_iter()
        .filter(|class| named.insert(class.class.first().map(|name| name.to_string())))
        .map(|class| {
            let finding = class.finding();
            fault!(UNBALANCED_CLASS, "{finding}").at(class.span).warning()
        })
        .collect()
}

/// The classes with other numbers of equations than of unknowns, each once.
fn unbalanced(classes: &[LocalBalance]) -> impl Iterator<Item = &LocalBalance> {
    let mut seen = BTreeSet::new();
    let wrong = classes.iter().filter(|class| !class.is_balanced());
    wrong.filter(move |class| seen.insert(class.class.to_string()))
}

fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// Number of scalar equations; `None` if it does not follow from its text.
fn size(equation: &Equation, dims: &mut Dims<'_>) -> Option<usize> {
    match &equation.kind {
        EquationKind::Equal { left, right } => match &left.kind {
            ExpressionKind::Tuple(outputs) => {
                let outputs = outputs.iter().flatten();
                outputs.map(|output| scalars(output, dims)).sum()
            }
            _ => Some(dims(left).or_else(|| dims(right))?.iter().product()),
        },
        EquationKind::If { branches, .. } | EquationKind::When { branches } => {
            let (_, body) = branches.first()?;
            body.iter().map(|equation| size(equation, dims)).sum()
        }
        EquationKind::Call(_) => Some(0),
        EquationKind::For { .. } | EquationKind::Connect { .. } => None,
    }
}

/// Number of scalars of an output: a variable, or a record, whose constructor lists its components.
fn scalars(output: &Expression, dims: &mut Dims<'_>) -> Option<usize> {
    match &output.kind {
        ExpressionKind::Call { arguments, .. } if !arguments.named.is_empty() => {
            arguments.named.iter().map(|component| scalars(&component.value, dims)).sum()
        }
        _ => Some(dims(output)?.iter().product()),
    }
}

/// The name of the variable that a flat reference names, without the last subscripts.
pub(crate) fn path(reference: &ComponentReference) -> Cow<'static, str> {
    if let [part] = &reference.parts[..] {
        return part.name.as_str().into();
    }
    let mut path = String::new();
    for (at, part) in reference.parts.iter().enumerate() {
        if at > 0 {
            path.push('.');
        }
        path.push_str(part.name.as_str());
        if at + 1 < reference.parts.len() && !part.subscripts.is_empty() {
            let numbers: Vec<String> = part
                .subscripts
                .iter()
                .map(|subscript| match subscript {
                    Subscript::Index(Expression { kind: ExpressionKind::Integer(n), .. }) => {
                        n.to_string()
                    }
                    _ => ":".to_owned(),
                })
                .collect();
            path.push_str(&format!("[{}]", numbers.join(",")));
        }
    }
    path.into()
}

/// Number of scalars of variables, and of records and arrays of records, whose components begin with
/// their names.
fn scalars_of<'a>(named: impl Iterator<Item = &'a ComponentReference>, model: &FlatModel) -> usize {
    let mut names: BTreeSet<String> = BTreeSet::new();
    let mut variables: BTreeSet<&str> = BTreeSet::new();
    for target in named {
        let is_new = names.insert(print::reference(target));
        match model.variables.get_key_value(&*path(target)) {
            Some((name, _)) => variables.extend([&**name]),
            None if is_new => {
                let all = model.variables.keys().map(|key| &**key);
                variables.extend(all.filter(|variable| is_part(variable, target)));
            }
            None => {}
        }
    }
    variables.into_iter().map(|name| model.variables[name].len()).sum()
}

/// Whether a variable is a component of what a reference names: a record, elements of an array of records,
/// or a component of all of these.
fn is_part(variable: &str, of: &ComponentReference) -> bool {
    if !of.parts.first().is_some_and(|part| variable.starts_with(part.name.as_str())) {
        return false;
    }
    let own = flat_reference(variable, of.span).parts;
    let literal = |subscript: &Subscript| match subscript {
        Subscript::Index(Expression { kind: ExpressionKind::Integer(n), .. }) => Some(*n),
        _ => None,
    };
    // A subscript that is not a number may be any.
    let fits = |(one, other): (&Subscript, &Subscript)| {
        let numbers = literal(one).zip(literal(other));
        numbers.is_none_or(|(one, other)| one == other)
    };
    own.len() >= of.parts.len()
        && own.iter().zip(&of.parts).all(|(own, part)| {
            own.name == part.name && own.subscripts.iter().zip(&part.subscripts).all(fits)
        })
}
