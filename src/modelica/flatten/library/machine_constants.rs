//! The constants of `ModelicaServices.Machine`. The library documents itself as the part of the
//! Modelica Standard Library that each program replaces by its own values; the implementation that
//! comes along since version 4.1 has the limits of the type (2.2e-308, 1.8e308), whose reciprocal
//! or square overflows where libraries calculate with them.

use crate::name::Name;
use crate::syntax::ast::{
    Binding, ClassDefinition, ClassSpecifier, ComponentDeclaration, Element, Expression,
    ExpressionKind, Modification, Section, VariabilityPrefix,
};
use std::sync::Arc;

/// As in `models/Modelica/Constants.mo`.
const VALUES: &[(&str, ExpressionKind)] = &[
    ("eps", ExpressionKind::Real(f64::EPSILON)),
    ("small", ExpressionKind::Real(1e-60)),
    ("inf", ExpressionKind::Real(1e60)),
    ("Integer_inf", ExpressionKind::Integer(i32::MAX as i64)),
];

/// The class of a name, with the values of this program if it is that of the machine's constants.
pub(super) fn provided(name: &Name, class: Arc<ClassDefinition>) -> Arc<ClassDefinition> {
    match name.parts.as_slice() {
        [library, machine] if *library == "ModelicaServices" && *machine == "Machine" => {
            let mut class = ClassDefinition::clone(&class);
            provide(&mut class);
            Arc::new(class)
        }
        _ => class,
    }
}

fn provide(class: &mut ClassDefinition) {
    let ClassSpecifier::Long(long) = &mut class.specifier else { return };
    if long.sections.error().is_some() {
        return;
    }
    for section in long.sections.iter_mut() {
        let Section::Elements { elements, .. } = section else { continue };
        for element in elements {
            let Element::Component(clause) = element else { continue };
            if clause.type_prefixes.variability != Some(VariabilityPrefix::Constant) {
                continue;
            }
            clause.components.iter_mut().for_each(bind);
        }
    }
}

/// Gives a constant the program's value; its other modifiers remain.
fn bind(constant: &mut ComponentDeclaration) {
    let name = constant.name.node;
    let Some((_, value)) = VALUES.iter().find(|(known, _)| name == *known) else { return };
    let span = constant.span;
    let modification = constant.modification.get_or_insert_with(|| Modification {
        arguments: Vec::new(),
        binding: None,
        span,
    });
    modification.binding = Some(Binding::Expression(Expression::new(value.clone(), span)));
}
