//! Variables of flat models by names with subscripts.

use crate::flatten::{FlatModel, Variable};
use crate::models::variable_unit::VariableUnit;
use crate::syntax::ast::{Expression, ExpressionKind};

/// The variable of a model that has this name, or of which this is an element.
pub(super) fn variable_of<'f>(flat: &'f FlatModel, name: &str) -> Option<&'f Variable> {
    let array = || name.strip_suffix(']').and_then(|inner| inner.rsplit_once('['));
    flat.variables.get(name).or_else(|| flat.variables.get(array()?.0))
}

/// An attribute of a variable or of an element of it.
pub(super) fn attribute<'f>(
    flat: &'f FlatModel,
    name: &str,
    which: &str,
) -> Option<&'f Expression> {
    let attribute = variable_of(flat, name)?.attributes.get(which)?;
    Some(element(&attribute.value, name))
}

/// The unit of a variable; empty where it has none.
pub(super) fn unit_in(flat: &FlatModel, name: &str) -> String {
    match attribute(flat, name, "unit").map(|unit| &unit.kind) {
        Some(ExpressionKind::String(unit)) => unit.to_string(),
        _ => String::new(),
    }
}

/// The unit of a variable, and whether it is a difference.
pub(super) fn variable_unit(flat: &FlatModel, name: &str) -> VariableUnit {
    let is_relative = variable_of(flat, name).is_some_and(|variable| variable.is_relative);
    VariableUnit { symbol: unit_in(flat, name), is_relative, ..VariableUnit::default() }
}

/// The value of an attribute for an element of an array, whose name ends with its subscript.
fn element<'e>(value: &'e Expression, name: &str) -> &'e Expression {
    let subscript = || name.strip_suffix(']')?.rsplit_once('[')?.1.parse::<usize>().ok();
    match (&value.kind, subscript()) {
        (ExpressionKind::Array(elements), Some(at)) => {
            elements.get(at.wrapping_sub(1)).unwrap_or(value)
        }
        _ => value,
    }
}
