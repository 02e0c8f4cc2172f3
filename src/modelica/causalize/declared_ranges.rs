//! Values outside the interval of `min` and `max` (MLS §4.9), as far as they are known at translation:
//! of constants and parameters, and start values that are fixed. Those of variables show in a
//! simulation.

use crate::flatten::BaseType;
use crate::lower::{Beyond, Dae, OutsideRanges, Variable, VariableKind};
use crate::source::Span;
use crate::symbolic::VarId;
use rustc_hash::FxHashSet;

/// Warns of each variable that has such a value, once for all elements of an array.
pub(super) fn warn_of_values_outside(dae: &mut Dae) {
    let mut seen: FxHashSet<(Span, String)> = FxHashSet::default();
    let mut found = OutsideRanges::default();
    for (id, variable) in (0..).map(VarId).zip(&dae.variables) {
        let Some((value, subject)) = known_value(dae, id, variable) else { continue };
        let name = &variable.name;
        for beyond in limits_exceeded(dae, variable, value) {
            if seen.insert((variable.span, beyond.subject(name))) {
                let sentence = format!("{subject}`{name}` is {value}, {}", beyond.words());
                let help = format!("correct the value, or the attribute `{}`", beyond.attribute);
                found.add(name, variable.span, sentence, help);
            }
        }
    }
    dae.warnings.extend(found.warnings(None));
}

/// The value of a variable that has one at translation, and what to call it.
fn known_value(dae: &Dae, id: VarId, variable: &Variable) -> Option<(f64, &'static str)> {
    if !matches!(variable.base, BaseType::Real | BaseType::Integer) {
        return None;
    }
    match variable.kind {
        VariableKind::Constant(value) => Some((value, "")),
        VariableKind::Parameter { .. } => Some((dae.defaults.get(id), "")),
        VariableKind::Unknown | VariableKind::Discrete if variable.fixed => {
            Some((dae.defaults.of(dae, variable.start?), "the start value of "))
        }
        _ => None,
    }
}

fn limits_exceeded(dae: &Dae, variable: &Variable, value: f64) -> impl Iterator<Item = Beyond> {
    let attributes = dae.defaults.attributes(dae, variable);
    let min = attributes.min.filter(|min| value < *min);
    let max = attributes.max.filter(|max| value > *max);
    let min = min.map(|limit| Beyond { attribute: "min", limit });
    min.into_iter().chain(max.map(|limit| Beyond { attribute: "max", limit }))
}
