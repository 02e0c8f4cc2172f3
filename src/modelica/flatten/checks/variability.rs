//! Which expressions can change during a simulation, as far as a class tells by itself
//! (MLS §3.8).

use super::scope::Scope;
use crate::functions::{self, VariabilityRule};
use crate::name::Ident;
use crate::syntax::ast::{ComponentReference, Expression, ExpressionKind};
use crate::syntax::visit::{Visit, walk_expression};

/// Whether an expression in a class keeps its value during a simulation. Names that the class does
/// not tell about, and those of the loop variables around, are taken to do so.
pub fn is_fixed(class: Scope<'_>, loops: &[Ident], expression: &Expression) -> bool {
    let mut walk = VariabilityCheck { class, loops, varies: false };
    walk.expression(expression);
    !walk.varies
}

struct VariabilityCheck<'a> {
    class: Scope<'a>,
    loops: &'a [Ident],
    varies: bool,
}

impl Visit for VariabilityCheck<'_> {
    fn expression(&mut self, expression: &Expression) {
        if let ExpressionKind::Call { function, .. } = &expression.kind {
            let name = match function.parts.as_slice() {
                [name] => name.name.as_str(),
                [package, _] if package.name.as_str() == "Connections" => return,
                _ => "",
            };
            match functions::find(name).map(|entry| entry.variability) {
                Some(VariabilityRule::Never) => return,
                Some(VariabilityRule::Always) => self.varies = true,
                Some(VariabilityRule::OfArguments) | None => {}
            }
        }
        walk_expression(self, expression);
    }

    fn reference(&mut self, reference: &ComponentReference) {
        let name = reference.parts[0].name;
        let is_simple = reference.parts.len() == 1;
        if self.loops.contains(&name) {
            return;
        }
        match self.class.component(name) {
            None => self.varies |= is_simple && !reference.global && name.as_str() == "time",
            // Parts of components may be parameters whatever the component is.
            Some(component) if is_simple => {
                let is_outer = component.clause.prefixes.outer;
                let is_predefined = component.class().is_none_or(|c| c.predefined().is_some());
                self.varies |= !component.is_fixed() && !is_outer && is_predefined;
            }
            Some(_) => {}
        }
    }
}
