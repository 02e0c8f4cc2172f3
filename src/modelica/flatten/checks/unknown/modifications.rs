//! Names of modified elements (MLS §7.2).

use super::NameCheck;
use super::modified::Modified;
use crate::flatten::lookup::types::ATTRIBUTES;
use crate::flatten::unknown;
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::ast::{Argument, Binding, Exclusion, Modification, RedeclaredElement};
use crate::syntax::visit::Visit as _;

impl<'a> NameCheck<'a, '_> {
    pub(super) fn modification(&mut self, of: &Modified<'a>, modification: &Modification) {
        self.arguments(of, &modification.arguments);
        if let Some(Binding::Expression(value)) = &modification.binding {
            self.expression(value);
        }
    }

    pub(super) fn arguments(&mut self, of: &Modified<'a>, arguments: &[Argument]) {
        for argument in arguments {
            match argument {
                Argument::Element(element) => {
                    let inner = self.modified(of, &element.name.node, element.name.span);
                    element.modification.iter().for_each(|one| self.modification(&inner, one));
                }
                Argument::Redeclaration(redeclaration) => match &redeclaration.element {
                    RedeclaredElement::Class(nested) => {
                        self.redeclared(of, nested.class.name);
                        self.redeclared_class(nested);
                    }
                    RedeclaredElement::Component(clause) => {
                        clause.components.iter().for_each(|one| self.redeclared(of, one.name));
                        self.clause(clause);
                    }
                },
            }
        }
    }

    /// Elements that an extends clause removes (MLS §7.4); those of connections are checked where the
    /// connections are.
    pub(super) fn excluded(&mut self, of: &Modified<'a>, excluded: &[Exclusion]) {
        let Modified::Class { class, is_certain: true } = of else { return };
        for exclusion in excluded {
            if let Exclusion::Component(name) = exclusion
                && self.library.element(class.class, name.node).is_none()
            {
                let known = self.library.component_names(class.class);
                let wrong = unknown::removed_element(class.name(), name.node, &known, name.span);
                self.errors.push(wrong);
            }
        }
    }

    fn redeclared(&mut self, of: &Modified<'a>, name: Spanned<Ident>) {
        _ = self.modified(of, &name.node.into(), name.span);
    }

    /// The element of a name of what is modified; says so if there is none.
    fn modified(&mut self, of: &Modified<'a>, name: &Name, span: Span) -> Modified<'a> {
        let mut at = *of;
        for part in &name.parts {
            at = self.modified_part(at, *part, span);
        }
        at
    }

    fn modified_part(&mut self, of: Modified<'a>, name: Ident, span: Span) -> Modified<'a> {
        match of {
            Modified::Class { class, is_certain } => {
                if let Some(found) = self.library.element(class.class, name) {
                    let inner = Modified::by_parts(self.library, &[Some(found)]);
                    return inner.replaceable_if(!is_certain);
                }
                if is_certain {
                    let known = self.library.component_names(class.class);
                    self.errors.push(unknown::element(class.name(), name, &known, span));
                }
            }
            Modified::Variable(variable) => {
                // Instantiation takes `value` as the value of a variable, with a warning.
                let is_value = name.as_str() == "value" && !self.library.is_strict();
                if !ATTRIBUTES.contains(&name.as_str()) && !is_value {
                    self.errors.push(unknown::attribute(variable, name, span));
                }
            }
            Modified::Unknown => {}
        }
        Modified::Unknown
    }
}
