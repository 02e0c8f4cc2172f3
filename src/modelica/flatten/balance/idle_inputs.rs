//! Inputs of components that are neither connected nor used.

use crate::flatten::{FlatModel, Variability, Variable};
use crate::syntax::ast::ComponentReference;
use crate::syntax::visit::{Visit, walk_reference};
use std::collections::BTreeSet;

/// How many scalars are inputs of components that no equation, statement or binding names: they
/// need no equation, as nothing depends on them.
pub(super) fn idle_inputs(model: &FlatModel) -> usize {
    let is_open = |variable: &&Variable| {
        variable.is_input
            && !variable.top_level
            && variable.variability >= Variability::Discrete
            && variable.binding.is_none()
    };
    let open: Vec<&Variable> = model.variables.values().filter(is_open).collect();
    if open.is_empty() {
        return 0;
    }
    let used = names(model);
    let is_idle = |variable: &&&Variable| !used.contains(&without_subscripts(&variable.name));
    open.iter().filter(is_idle).map(|variable| variable.len()).sum()
}

/// The names of all variables in a model, without their subscripts.
fn names(model: &FlatModel) -> BTreeSet<String> {
    let mut names = Names::default();
    model.equations.iter().chain(&model.initial_equations).for_each(|e| names.equation(e));
    let algorithms = model.algorithms.iter().chain(&model.initial_algorithms);
    algorithms.flatten().for_each(|statement| names.statement(statement));
    for variable in model.variables.values() {
        variable.binding.iter().for_each(|binding| names.expression(binding));
        variable.attributes.values().for_each(|attribute| names.expression(&attribute.value));
    }
    names.found
}

#[derive(Default)]
struct Names {
    found: BTreeSet<String>,
}

impl Visit for Names {
    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
        let parts: Vec<&str> = reference.parts.iter().map(|part| part.name.as_str()).collect();
        self.found.insert(parts.join("."));
    }
}

/// `c[2].x` as `c.x`.
fn without_subscripts(name: &str) -> String {
    let mut depth = 0usize;
    let outside = |c: &char| {
        depth += usize::from(*c == '[');
        let is_outside = depth == 0;
        depth -= usize::from(*c == ']' && depth > 0);
        is_outside
    };
    name.chars().filter(outside).collect()
}
