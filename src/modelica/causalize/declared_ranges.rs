//! Values outside the interval of `min` and `max` (MLS §4.9), as far as they are known at translation:
//! of constants and parameters, and start values that are fixed. Those of variables show in a
//! simulation.

use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::BaseType;
use crate::lower::errors::OUTSIDE_RANGE;
use crate::lower::{Dae, Variable, VariableKind};
use crate::source::Span;
use crate::symbolic::VarId;
use rustc_hash::FxHashSet;

/// Warns of each declaration that has such a value, once for all elements of an array.
pub(super) fn warn_of_values_outside(dae: &mut Dae) {
    let mut seen: FxHashSet<Span> = FxHashSet::default();
    let mut warnings = Vec::new();
    for (id, variable) in (0..).map(VarId).zip(&dae.variables) {
        if let Some(warning) = outside(dae, id, variable)
            && seen.insert(variable.span)
        {
            warnings.push(warning);
        }
    }
    dae.warnings.extend(warnings);
}

fn outside(dae: &Dae, id: VarId, variable: &Variable) -> Option<Diagnostic> {
    if !matches!(variable.base, BaseType::Real | BaseType::Integer) {
        return None;
    }
    let (value, subject) = match variable.kind {
        VariableKind::Constant(value) => (value, ""),
        VariableKind::Parameter { .. } => (dae.defaults.get(id), ""),
        VariableKind::Unknown | VariableKind::Discrete if variable.fixed => {
            (dae.defaults.of(dae, variable.start?), "the start value of ")
        }
        _ => return None,
    };
    let limit = |limit: Option<_>| limit.map_or(f64::NAN, |limit| dae.defaults.of(dae, limit));
    let (min, max) = (limit(variable.min), limit(variable.max));
    let (words, attribute, limit) = match () {
        () if value < min => ("below", "min", min),
        () if value > max => ("above", "max", max),
        () => return None,
    };
    let name = &variable.name;
    Some(
        fault!(OUTSIDE_RANGE, "{subject}`{name}` is {value}, {words} its `{attribute}` of {limit}";
            help: "correct the value, or the attribute `{attribute}`")
        .at(variable.span)
        .warning(),
    )
}
