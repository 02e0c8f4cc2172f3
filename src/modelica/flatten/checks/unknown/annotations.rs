//! Names in the annotations of functions that have a meaning: derivatives (MLS §12.7.1), inverses (§12.8)
//! and `smoothOrder` (§18.3). Other annotations are for tools.

use super::NameCheck;
use crate::flatten::checks::scope::Scope;
use crate::flatten::unknown;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    Annotation, Argument, Binding, Comment, ComponentReference, ElementModification,
    ExpressionKind, Modification, Restriction,
};
use crate::syntax::graphics;
use crate::syntax::visit::{Visit, walk_arguments, walk_modification};

impl<'a> NameCheck<'a, '_> {
    pub(super) fn annotation(&mut self, class: Scope<'a>, annotation: &Annotation) {
        self.graphics(annotation);
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

    /// Literals of the enumerations of graphics, which no tool can draw if there are none of this name.
    pub(super) fn graphics(&mut self, annotation: &Annotation) {
        let mut written = Literals(Vec::new());
        walk_arguments(&mut written, &annotation.arguments);
        for (enumeration, literal, span) in written.0 {
            let known = graphics::literals(enumeration.as_str());
            let scope = self.scope.map(|scope| scope.class);
            let name = Name::new([enumeration, literal]);
            let is_other = || self.library.parts_of_reference(scope, &name)[0].is_some();
            if !known.is_empty() && !known.contains(&literal.as_str()) && !is_other() {
                self.errors.push(unknown::graphical_literal(enumeration, literal, known, span));
            }
        }
    }

    /// The same for what stands after an element.
    pub(super) fn comment(&mut self, comment: &Comment) {
        comment.annotation.iter().for_each(|annotation| self.graphics(annotation));
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

/// Names of two parts, as literals of enumerations are written.
struct Literals(Vec<(Ident, Ident, Span)>);

impl Visit for Literals {
    fn reference(&mut self, reference: &ComponentReference) {
        if let [enumeration, literal] = reference.parts.as_slice() {
            self.0.push((enumeration.name, literal.name, reference.span));
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
