//! Names in the annotations of functions that have a meaning: derivatives (MLS §12.7.1), inverses (§12.8)
//! and `smoothOrder` (§18.3). Other annotations are for tools.

use super::NameCheck;
use crate::flatten::checks::scope::Scope;
use crate::flatten::unknown;
use crate::syntax::ast::{
    Annotation, Argument, Binding, ElementModification, ExpressionKind, Modification, Restriction,
};
use crate::syntax::visit::{Visit as _, walk_modification};

impl<'a> NameCheck<'a, '_> {
    pub(super) fn annotation(&mut self, class: Scope<'a>, annotation: &Annotation) {
        if !matches!(class.restriction(), Restriction::Function { .. }) {
            return;
        }
        for argument in &annotation.arguments {
            let Some((element, modification)) = modified(argument) else { continue };
            match element.name.node.last().map_or("", |name| name.as_str()) {
                "derivative" => {
                    let of_inputs = modification.arguments.iter().filter_map(modified);
                    of_inputs.for_each(|(_, inner)| walk_modification(self, inner));
                    self.function_after(modification);
                }
                "inverse" => self.inverses(class, modification),
                "smoothOrder" => walk_modification(self, modification),
                _ => {}
            }
        }
    }

    /// The inputs that `inverse(x = f(y))` calculates, and how.
    fn inverses(&mut self, class: Scope<'a>, modification: &Modification) {
        for (element, inverse) in modification.arguments.iter().filter_map(modified) {
            let input = element.name.node.first();
            if let Some(input) = input.filter(|input| class.component(*input).is_none())
                && !self.is_open
            {
                let known = self.library.component_names(class.class);
                let wrong = unknown::component(class.name(), input, &known, element.name.span);
                self.errors.push(wrong);
            }
            self.function_after(inverse);
        }
    }

    /// The function after `=`, alone or called.
    fn function_after(&mut self, modification: &Modification) {
        let Some(Binding::Expression(value)) = &modification.binding else { return };
        match &value.kind {
            ExpressionKind::Reference(function) => _ = self.function(&function.name(), value.span),
            _ => self.expression(value),
        }
    }
}

/// An argument with what it is modified by.
fn modified(argument: &Argument) -> Option<(&ElementModification, &Modification)> {
    match argument {
        Argument::Element(element) => Some((element, element.modification.as_ref()?)),
        Argument::Redeclaration(_) => None,
    }
}
