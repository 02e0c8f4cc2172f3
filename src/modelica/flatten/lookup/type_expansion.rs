//! What the types of components are made of (MLS §4.6), through short classes.

use super::declarations::annotated;
use super::modification::Modifier;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{CYCLIC_CLASS, NOT_SUPPORTED, TYPE_MISMATCH};
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::Expanded;
use crate::flatten::instantiate::instance::{Declaration, Shape};
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::scope::Text;
use crate::flatten::lookup::types::Predefined;
use crate::flatten::lookup::types::Type;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    ClassSpecifier, Element, EnumerationClass, Extends, Restriction, TypeSpecifier,
};
use crate::syntax::ast::{Comment, ShortClass};
use crate::value::EnumerationDefinition;
use std::sync::Arc;

/// What a type is made of.
enum Step {
    Shape(Shape),
    Type(Type),
}

impl Classes<'_> {
    /// Follows the short classes of a component's type down to what it is made of, collecting
    /// modifiers (outer over inner) and dimensions.
    pub(crate) fn expand(&mut self, declared: &Declaration) -> Result<Expanded, Diagnostic> {
        let found = self.lookup_type(declared.scope, &declared.type_specifier)?;
        self.expand_type(found, &declared.type_specifier, declared.modifier.clone())
    }

    /// As [`Classes::expand`], from what a type specifier means.
    fn expand_type(
        &mut self,
        mut found: Type,
        specifier: &TypeSpecifier,
        modifier: Modifier,
    ) -> Result<Expanded, Diagnostic> {
        let mut expanded = Expanded {
            shape: Shape::Predefined(Predefined::Real),
            dims: Vec::new(),
            modifier,
            causality: None,
            connection: None,
            connector: false,
            class: None,
            absolute: None,
        };
        for _ in 0..MAX_DEPTH {
            let step = match found {
                Type::Predefined(predefined) => {
                    Step::Shape(predefined_shape(predefined, specifier)?)
                }
                Type::Class(id) => self.expand_class(id, specifier, &mut expanded)?,
            };
            match step {
                Step::Shape(shape) => return Ok(Expanded { shape, ..expanded }),
                Step::Type(next) => found = next,
            }
        }
        Err(fault!(CYCLIC_CLASS, "type `{}` is defined in terms of itself", specifier.name)
            .at(specifier.span))
    }

    /// What a class is made of: its shape, or the type that it is made of in turn.
    fn expand_class(
        &mut self,
        id: ScopeId,
        specifier: &TypeSpecifier,
        expanded: &mut Expanded,
    ) -> Result<Step, Diagnostic> {
        expanded.class.get_or_insert(id);
        let text = self.text(id).clone();
        expanded.connector |=
            matches!(text.restriction(), Restriction::Connector | Restriction::ExpandableConnector);
        match &text.definition.specifier {
            ClassSpecifier::Enumeration(enumeration) => {
                self.modify(id, Modifier::default(), expanded)?;
                enumeration_of(&text.name, enumeration, specifier.span)
                    .map(|definition| Step::Shape(Shape::Enumeration(definition)))
            }
            ClassSpecifier::Short(short) => self.expand_short(id, short, expanded),
            ClassSpecifier::Long(_) => self.expand_long(id, &text, specifier, expanded),
            ClassSpecifier::Derivative(_) => Err(fault!(
                TYPE_MISMATCH,
                "`{}` is a function, not the type of a component",
                text.name
            )
            .at(specifier.span)),
        }
    }

    fn expand_short(
        &mut self,
        id: ScopeId,
        short: &ShortClass,
        expanded: &mut Expanded,
    ) -> Result<Step, Diagnostic> {
        let scope = self.scope(id);
        let parent = scope.parent.unwrap_or(ScopeId::TOP);
        let own = Modifier::of_arguments(&short.modification, parent)?;
        let own = scope.defaults.clone().overridden_by(own, self.simple_name(id))?;
        self.modify(id, own, expanded)?;
        let absolute = annotated(&short.comment, "absoluteValue");
        expanded.absolute = expanded.absolute.or(absolute);
        expanded.dims.extend(short.subscripts.iter().map(|s| (s.clone(), parent)));
        expanded.causality = expanded.causality.or(short.prefixes.causality);
        expanded.connection = expanded.connection.or(short.prefixes.connection);
        self.lookup_type(parent, &short.target).map(Step::Type)
    }

    fn expand_long(
        &mut self,
        id: ScopeId,
        text: &Text,
        specifier: &TypeSpecifier,
        expanded: &mut Expanded,
    ) -> Result<Step, Diagnostic> {
        match self.predefined_base(id, text)? {
            Some((Type::Predefined(Predefined::ExternalObject), _)) => {
                self.modify(id, Modifier::default(), expanded)?;
                Ok(Step::Shape(Shape::ExternalObject(text.name.clone())))
            }
            Some((base, extends)) => {
                let own = Modifier::of_arguments(&extends.modification, id)?;
                self.modify(id, own, expanded)?;
                Ok(Step::Type(base))
            }
            None if matches!(text.restriction(), Restriction::Function { .. }) => {
                // What remains of a function is the one that is meant where none is passed (MLS §12.4.2).
                let binding = expanded.modifier.binding.take();
                expanded.modifier = Modifier { binding, ..Modifier::default() };
                Ok(Step::Shape(Shape::Function))
            }
            None => {
                check_component_class(text, specifier)?;
                let own = self.scope(id).defaults.clone();
                self.modify(id, own, expanded)?;
                Ok(Step::Shape(Shape::Class(id)))
            }
        }
    }

    /// Puts the modifier of what a type is made of, and what modifies its class where it stands,
    /// under those of the component.
    fn modify(
        &self,
        id: ScopeId,
        own: Modifier,
        expanded: &mut Expanded,
    ) -> Result<(), Diagnostic> {
        let name = self.simple_name(id);
        let outer = std::mem::take(&mut expanded.modifier);
        let own = own.overridden_by(self.scope(id).modifier.clone(), name)?;
        let is_array = matches!(&self.text(id).definition.specifier,
            ClassSpecifier::Short(short) if !short.subscripts.is_empty());
        let own = if is_array { own } else { own.of_class() };
        expanded.modifier = own.overridden_by(outer, name)?;
        Ok(())
    }

    fn simple_name(&self, id: ScopeId) -> Ident {
        self.text(id).definition.name.node
    }

    /// The predefined type that a long class extends, directly or through others, if it does:
    /// `type T extends Real(…); end T;`, or a class of external objects.
    pub(crate) fn predefined_base(
        &mut self,
        id: ScopeId,
        text: &Text,
    ) -> Result<Option<(Type, Extends)>, Diagnostic> {
        let extends = text.elements().find_map(|(_, element)| match element {
            Element::Extends(extends) => Some(extends),
            _ => None,
        });
        let Some(extends) = extends else { return Ok(None) };
        let is_external = extends.base.name.is_simple()
            && extends.base.name.first().is_some_and(|name| name == "ExternalObject");
        let is_simple = matches!(text.restriction(), Restriction::Type | Restriction::Connector);
        if !is_simple && !is_external {
            return Ok(None);
        }
        let parent = self.scope(id).parent.unwrap_or(ScopeId::TOP);
        let base = self.lookup_type(parent, &extends.base);
        if text.restriction() == Restriction::Connector {
            // Most connectors extend connectors, which have components.
            let is_type = |base: &Type| match base {
                Type::Predefined(_) => true,
                Type::Class(class) => self.text(*class).restriction() == Restriction::Type,
            };
            return Ok(base.ok().filter(is_type).map(|base| (base, extends.clone())));
        }
        Ok(Some((base?, extends.clone())))
    }

    /// The enumeration that a type is, through short classes; `None` if it is anything else.
    pub(crate) fn enumeration(
        &mut self,
        found: Type,
        span: Span,
    ) -> Result<Option<Arc<EnumerationDefinition>>, Diagnostic> {
        let mut found = found;
        for _ in 0..MAX_DEPTH {
            let id = match found {
                Type::Predefined(Predefined::StateSelect) => {
                    return Ok(Some(language_enumeration("StateSelect", STATE_SELECT)));
                }
                Type::Predefined(Predefined::AssertionLevel) => {
                    return Ok(Some(language_enumeration("AssertionLevel", ASSERTION_LEVEL)));
                }
                Type::Predefined(_) => return Ok(None),
                Type::Class(id) => id,
            };
            let text = self.text(id).clone();
            match &text.definition.specifier {
                ClassSpecifier::Enumeration(enumeration) => {
                    return enumeration_of(&text.name, enumeration, span).map(Some);
                }
                ClassSpecifier::Short(short) => {
                    let parent = self.scope(id).parent.unwrap_or(ScopeId::TOP);
                    found = self.lookup_type(parent, &short.target)?;
                }
                _ => return Ok(None),
            }
        }
        Ok(None)
    }
}

/// How many short classes a type may lead through.
const MAX_DEPTH: usize = 100;

/// Enumerations of the language (MLS §4.9.7.1, §8.3.7) and their literals.
const STATE_SELECT: &[&str] = &["never", "avoid", "default", "prefer", "always"];

const ASSERTION_LEVEL: &[&str] = &["warning", "error"];

fn predefined_shape(
    predefined: Predefined,
    specifier: &TypeSpecifier,
) -> Result<Shape, Diagnostic> {
    match predefined {
        Predefined::StateSelect => {
            Ok(Shape::Enumeration(language_enumeration("StateSelect", STATE_SELECT)))
        }
        Predefined::AssertionLevel => {
            Ok(Shape::Enumeration(language_enumeration("AssertionLevel", ASSERTION_LEVEL)))
        }
        Predefined::ExternalObject => {
            Err(fault!(crate::flatten::errors::PARTIAL_CLASS, "`ExternalObject` is partial";
                help: "use a class that extends it")
            .at(specifier.span))
        }
        other => Ok(Shape::Predefined(other)),
    }
}

fn language_enumeration(name: &str, literals: &[&str]) -> Arc<EnumerationDefinition> {
    Arc::new(EnumerationDefinition {
        name: Name::parse(name),
        literals: literals.iter().map(|literal| Ident::new(literal)).collect(),
        descriptions: Vec::new(),
    })
}

fn check_component_class(text: &Text, specifier: &TypeSpecifier) -> Result<(), Diagnostic> {
    match text.restriction() {
        Restriction::Package | Restriction::Operator => {
            Err(fault!(TYPE_MISMATCH, "`{}` cannot be the type of a component", text.name)
                .at(specifier.span))
        }
        _ => Ok(()),
    }
}

fn text(comment: &Comment) -> String {
    comment.text.as_deref().unwrap_or_default().to_owned()
}

/// The enumeration that a class declares.
fn enumeration_of(
    name: &Name,
    enumeration: &EnumerationClass,
    span: Span,
) -> Result<Arc<EnumerationDefinition>, Diagnostic> {
    match &enumeration.literals {
        Some(literals) => Ok(Arc::new(EnumerationDefinition {
            name: name.clone(),
            literals: literals.iter().map(|literal| literal.name.node).collect(),
            descriptions: literals.iter().map(|literal| text(&literal.comment)).collect(),
        })),
        None => Err(fault!(
            NOT_SUPPORTED,
            "`{name}` is an enumeration without literals: it can only be redeclared"
        )
        .at(span)),
    }
}
