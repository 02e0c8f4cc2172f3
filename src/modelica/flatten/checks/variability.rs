//! Which expressions can change during a simulation, as far as a class tells by itself
//! (MLS §3.8).

use super::scope::Scope;
use crate::inference::{Variability, VariabilityOfNames, most_variable};
use crate::name::Ident;
use crate::syntax::ast::{ComponentReference, Expression};

/// Whether an expression in a class keeps its value during a simulation. Names that the class does
/// not tell about, and those of the loop variables around, are taken to do so.
pub(crate) fn is_fixed(class: Scope<'_>, loops: &[Ident], expression: &Expression) -> bool {
    let most = most_variable(&mut DeclaredVariability { class, loops }, expression);
    most.is_none_or(|most| most.variability <= Variability::Parameter)
}

struct DeclaredVariability<'a> {
    class: Scope<'a>,
    loops: &'a [Ident],
}

impl VariabilityOfNames for DeclaredVariability<'_> {
    fn of_reference(&mut self, reference: &ComponentReference) -> Option<Variability> {
        let name = reference.parts[0].name;
        // Parts of components may be parameters whatever the component is.
        if self.loops.contains(&name) || reference.parts.len() > 1 {
            return None;
        }
        let component = self.class.component(name)?;
        let is_outer = component.clause.prefixes.outer;
        let is_predefined = component.class().is_none_or(|c| c.predefined().is_some());
        match component.is_fixed() {
            true => Some(Variability::Parameter),
            false => (!is_outer && is_predefined).then_some(Variability::Continuous),
        }
    }
}
