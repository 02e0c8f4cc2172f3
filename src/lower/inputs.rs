//! Inputs of the model itself that nothing is connected to (MLS §4.4.2.2).

use super::dae::{Dae, Kind};
use super::equation::Equation;
use super::errors::NOT_SUPPORTED;
use crate::fault;
use crate::flatten::FlatModel;
use crate::symbolic::VarId;
use crate::syntax::ast::CausalityPrefix;

/// An input at the top level without a binding has its start value, which is zero by default.
pub(super) fn zero_inputs(dae: &mut Dae, flat: &FlatModel) {
    let is_bound = |name: &str| {
        let whole = name.strip_suffix(']').and_then(|name| name.rsplit_once('['));
        let declared = flat.variables.get(name);
        let declared = declared.or_else(|| flat.variables.get(whole?.0));
        declared.is_some_and(|variable| variable.binding.is_some())
    };
    for position in 0..dae.variables.len() {
        let variable = &dae.variables[position];
        if variable.causality == Some(CausalityPrefix::Input)
            && matches!(variable.kind, Kind::Unknown | Kind::Discrete)
            && !is_bound(&variable.name)
        {
            let zero = dae.pool.constant(0.0);
            let right = variable.start.unwrap_or(zero);
            let span = variable.span;
            let warning = fault!(
                NOT_SUPPORTED,
                "the input `{}` is not connected; it keeps its start value",
                variable.name
            );
            dae.warnings.push(warning.at(span).warning());
            let left = dae.pool.variable(VarId(position as u32));
            dae.equations.push(Equation::new(left, right, span));
        }
    }
}
