//! Inputs that nothing is connected to (MLS §4.4.2.2).

use super::dae::{Dae, VariableKind};
use super::equation::Equation;
use super::errors::INPUT_WITHOUT_DATA;
use super::recordings::follow;
use super::used_variables::used_variables;
use crate::fault;
use crate::flatten::{FlatModel, Variability, Variable};
use crate::symbolic::VarId;
use crate::syntax::ast::CausalityPrefix;

/// An input at the top level without a binding follows its samples, if it has any; otherwise it has
/// its start value, which is zero by default. So has
/// an input of a component that is neither connected nor used by an equation, such as that of a
/// reference system whose frequency is a parameter: the model is not balanced, but whatever the
/// input is, nothing depends on it.
pub(super) fn unbound_inputs(dae: &mut Dae, flat: &FlatModel) {
    let (mut used, mut recorded) = (None, Vec::new());
    for position in 0..dae.variables.len() {
        let variable = &dae.variables[position];
        if !matches!(variable.kind, VariableKind::Unknown | VariableKind::Discrete) {
            continue;
        }
        let is_top_level = variable.causality == Some(CausalityPrefix::Input);
        let declared = declared(flat, &variable.name);
        let is_inside = |declared: &Variable| declared.is_input && !declared.top_level;
        if declared.is_some_and(|declared| declared.binding.is_some())
            || !(is_top_level || declared.is_some_and(is_inside))
        {
            continue;
        }
        if !is_top_level && used.get_or_insert_with(|| used_or_differentiated(dae))[position] {
            continue;
        }
        match flat.recorded.iter().find(|input| *input.name == *dae.variables[position].name) {
            Some(input) => {
                let variable = &mut dae.variables[position];
                if input.is_held && variable.variability == Variability::Discrete {
                    // `pre` of it is what it was before its sample.
                    variable.kind = VariableKind::Discrete;
                }
                recorded.push((VarId(position as u32), input));
            }
            None => keep_start(dae, position, is_top_level),
        }
    }
    follow(dae, &recorded);
}

/// For every variable, whether equations contain it or its derivative.
fn used_or_differentiated(dae: &mut Dae) -> Vec<bool> {
    let mut used = used_variables(dae);
    for variable in &dae.variables {
        if let VariableKind::Derivative(of) = variable.kind {
            used[of.0 as usize] = true;
        }
    }
    used
}

/// The flat variable of a scalar of this name.
fn declared<'f>(flat: &'f FlatModel, name: &str) -> Option<&'f Variable> {
    let whole = name.strip_suffix(']').and_then(|name| name.rsplit_once('['));
    flat.variables.get(name).or_else(|| flat.variables.get(whole?.0))
}

/// An equation for an input that has none, and a warning.
fn keep_start(dae: &mut Dae, position: usize, is_top_level: bool) {
    let variable = &dae.variables[position];
    let zero = dae.pool.constant(0.0);
    let right = variable.start.unwrap_or(zero);
    let span = variable.span;
    let how = if is_top_level { "has no data" } else { "is neither connected nor used" };
    let name = &variable.name;
    let warning = fault!(INPUT_WITHOUT_DATA, "the input `{name}` {how}; it keeps its start value");
    let data =
        "give it data with `inputs` of a problem file or `gapi simulate --input`, or connect it";
    let warning = warning.help_if(is_top_level.then(|| data.to_owned()));
    dae.warnings.push(warning.at(span).warning());
    let left = dae.pool.variable(VarId(position as u32));
    dae.equations.push(Equation::new(left, right, span));
}
