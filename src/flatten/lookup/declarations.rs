//! Collects the components of a class, inherited ones included (MLS §5.6.1, §7.1), and finds out
//! what their types are made of (MLS §4.6).

use super::elements::Elements;
use super::modification::{Modifier, Redeclaration, Replacement};
use super::names::{Predefined, Type};
use super::scope::{MAX_BASES, ScopeId, Text};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{
    CYCLIC_CLASS, DUPLICATE_ELEMENT, FINAL_OVERRIDE, NOT_SUPPORTED, TOO_LARGE, TYPE_MISMATCH,
};
use crate::flatten::instantiate::instance::{Declaration, Shape};
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    self, CausalityPrefix, ClassSpecifier, ComponentClause, ComponentDeclaration, ConnectionPrefix,
    Deselection, Element, EnumerationClass, Extends, Restriction, Subscript, TypeSpecifier,
};
use crate::value::EnumerationDefinition;
use std::sync::Arc;

/// How many short classes a type may lead through.
const MAX_DEPTH: usize = 100;

/// Enumerations of the language (MLS §4.9.7.1, §8.3.7) and their literals.
const STATE_SELECT: &[&str] = &["never", "avoid", "default", "prefer", "always"];
const ASSERTION_LEVEL: &[&str] = &["warning", "error"];

/// What the type of a component is made of.
pub struct Expanded {
    pub shape: Shape,
    pub dims: Vec<(Subscript, ScopeId)>,
    pub modifier: Modifier,
    pub causality: Option<CausalityPrefix>,
    pub connection: Option<ConnectionPrefix>,
    pub connector: bool,
    /// The class that the type names, if it is not predefined.
    pub class: Option<ScopeId>,
}

impl Instantiation<'_> {
    pub fn find_elements(&mut self, id: ScopeId) -> Result<Elements, Diagnostic> {
        let text = self.text(id).clone();
        let bases = self.bases(id)?;
        let mut bases = bases.iter();
        let mut found = Elements::default();
        let class_extends = text.extended.is_some();
        if matches!(text.definition.specifier, ClassSpecifier::Short(_)) || class_extends {
            for base in bases.by_ref().take(1) {
                self.inherit(id, *base, false, &[], &mut found)?;
            }
        }
        for (protected, element) in text.elements() {
            match element {
                Element::Extends(extends) => {
                    if let Some(base) = bases.next() {
                        self.check_deselected(&text, *base, extends)?;
                        self.check_base_kind(&text, *base, extends.span)?;
                        self.inherit(id, *base, protected, &extends.deselected, &mut found)?;
                    }
                }
                Element::Component(clause) if clause.prefixes.redeclare => {
                    self.check_redeclared(id, clause, &found)?;
                }
                Element::Component(clause) => {
                    for component in &clause.components {
                        let declaration = self.declaration(clause, component, protected, id)?;
                        self.add_component(id, Arc::new(declaration), &mut found)?;
                    }
                }
                Element::Class(_) | Element::Import(_) => {}
            }
        }
        found.add_base(id);
        Ok(found)
    }

    fn inherit(
        &mut self,
        id: ScopeId,
        base: ScopeId,
        protected: bool,
        deselected: &[Deselection],
        found: &mut Elements,
    ) -> Result<(), Diagnostic> {
        let inherited = self.elements(base)?;
        if found.is_empty() && !protected && deselected.is_empty() {
            *found = Elements::sharing(&inherited);
            return self.check_bases(id, found);
        }
        for (name, declaration) in inherited.iter() {
            let is_out =
                |one: &Deselection| matches!(one, Deselection::Component(out) if out.node == name);
            if deselected.iter().any(is_out) {
                continue;
            }
            let declaration = if protected && !declaration.protected {
                Arc::new(Declaration { protected: true, ..(**declaration).clone() })
            } else {
                declaration.clone()
            };
            self.add_component(id, declaration, found)?;
        }
        inherited.lineage().for_each(|base| found.add_base(base));
        self.check_bases(id, found)
    }

    fn check_bases(&self, id: ScopeId, found: &Elements) -> Result<(), Diagnostic> {
        if found.bases() > MAX_BASES {
            let text = self.text(id);
            return Err(
                fault!(TOO_LARGE, "`{}` has too many base classes", text.name).at(text.span())
            );
        }
        Ok(())
    }

    /// A component redeclared among the elements must be inherited.
    fn check_redeclared(
        &mut self,
        id: ScopeId,
        clause: &ComponentClause,
        found: &Elements,
    ) -> Result<(), Diagnostic> {
        for component in &clause.components {
            let name = component.name.node;
            if !found.contains(name) {
                // The extends clause may stand behind the redeclaration.
                let mut inherited = false;
                for base in self.bases(id)?.iter() {
                    inherited |= self.elements(*base)?.contains(name);
                }
                if !inherited {
                    let class = &self.text(id).name;
                    return Err(fault!(
                        crate::flatten::errors::UNKNOWN_ELEMENT,
                        "`{class}` does not inherit a component `{name}` to redeclare"
                    )
                    .at(component.name.span));
                }
            }
        }
        Ok(())
    }

    /// Which kinds of classes may extend which (MLS §7.1.3).
    fn check_base_kind(&self, own: &Text, base: ScopeId, span: Span) -> Result<(), Diagnostic> {
        use Restriction as R;
        let inherited = self.text(base);
        let fits = match (inherited.restriction(), own.restriction()) {
            // What is only a class holds what all kinds may hold.
            (R::Class, _) => true,
            (R::Function { .. }, R::Function { .. }) => true,
            (R::Package, R::Package) => true,
            (R::Record, R::Record | R::OperatorRecord | R::Connector | R::ExpandableConnector)
            | (R::Record, R::Model | R::Block | R::Class) => true,
            (R::Model, R::Model | R::Class) => true,
            (R::Block, R::Block | R::Model | R::Class) => true,
            (
                R::Connector,
                R::Connector | R::ExpandableConnector | R::Model | R::Block | R::Class,
            ) => true,
            (R::ExpandableConnector, R::ExpandableConnector) => true,
            (one, other) => one == other,
        };
        if fits {
            return Ok(());
        }
        Err(fault!(
            TYPE_MISMATCH,
            "`{}` cannot extend `{}`, which is a different kind of class",
            own.name,
            inherited.name
        )
        .at(span))
    }

    /// A component inherited twice is one if both are the same declaration (MLS §7.1).
    fn add_component(
        &self,
        id: ScopeId,
        declaration: Arc<Declaration>,
        found: &mut Elements,
    ) -> Result<(), Diagnostic> {
        let name = declaration.name;
        if let Some(known) = found.get(name) {
            if known.span == declaration.span
                || (known.scope != declaration.scope && known.is_same(&declaration))
            {
                return Ok(());
            }
            return Err(fault!(
                DUPLICATE_ELEMENT,
                "`{}` has two components named `{name}`",
                self.text(id).name
            )
            .at(declaration.span)
            .related(known.span, "the other one"));
        }
        found.add(declaration);
        Ok(())
    }

    fn declaration(
        &mut self,
        clause: &ComponentClause,
        component: &ComponentDeclaration,
        protected: bool,
        context: ScopeId,
    ) -> Result<Declaration, Diagnostic> {
        let name = component.name.node;
        let outer = self.scope(context).modifier.elements.get(&name).cloned().unwrap_or_default();
        let redeclaration = outer.redeclaration.clone();
        let defaults = constraining(clause, redeclaration.as_ref(), context)?;
        let mut own = match (&redeclaration, &clause.constraint) {
            (Some(_), Some(_)) => defaults,
            _ => {
                let own = Modifier::new(component.modification.as_ref(), false, context)?;
                defaults.overridden_by(own, name)?
            }
        };
        let declared_final = clause.prefixes.is_final;
        own.is_final = declared_final;
        let is_final = declared_final || outer.is_final;
        let outer = Modifier { redeclaration: None, ..outer };
        let outer_span = outer.span;
        let mut modifier = own.overridden_by(outer, name)?;
        modifier.is_final = false;
        let subscripts = component.subscripts.iter().chain(&clause.subscripts);
        let mut declaration = Declaration {
            name,
            type_specifier: clause.type_specifier.clone(),
            scope: context,
            dims: subscripts.map(|subscript| (subscript.clone(), context)).collect(),
            modifier,
            condition: component.condition.clone().map(|condition| (condition, context)),
            prefixes: clause.prefixes,
            type_prefixes: clause.type_prefixes,
            is_final,
            protected,
            evaluate: evaluates(component),
            description: component.comment.text.clone(),
            span: component.span,
        };
        if let Some(redeclaration) = redeclaration {
            let span = outer_span.unwrap_or(component.span);
            if declared_final {
                return Err(
                    fault!(FINAL_OVERRIDE, "`{name}` is final and cannot be redeclared").at(span)
                );
            }
            redeclared(&mut declaration, &redeclaration, span)?;
        }
        Ok(declaration)
    }

    /// Follows the short classes of a component's type down to what it is made of, collecting
    /// modifiers (outer over inner) and dimensions.
    pub fn expand(&mut self, declared: &Declaration) -> Result<Expanded, Diagnostic> {
        let found = self.lookup_type(declared.scope, &declared.type_specifier)?;
        self.expand_type(found, &declared.type_specifier, declared.modifier.clone())
    }

    /// As [`Instantiation::expand`], from what a type specifier means.
    pub fn expand_type(
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
        };
        for _ in 0..MAX_DEPTH {
            let id = match found {
                Type::Predefined(predefined) => {
                    expanded.shape = predefined_shape(predefined, specifier)?;
                    return Ok(expanded);
                }
                Type::Class(id) => id,
            };
            expanded.class.get_or_insert(id);
            let text = self.text(id).clone();
            let name = text.definition.name.node;
            let scope = self.scope(id);
            let parent = scope.parent.unwrap_or(ScopeId::TOP);
            let (around, defaults) = (scope.modifier.clone(), scope.defaults.clone());
            expanded.connector |= matches!(
                text.restriction(),
                Restriction::Connector | Restriction::ExpandableConnector
            );
            let outer = std::mem::take(&mut expanded.modifier);
            match &text.definition.specifier {
                ClassSpecifier::Enumeration(enumeration) => {
                    expanded.modifier = around.overridden_by(outer, name)?;
                    let definition = enumeration_of(&text.name, enumeration, specifier.span)?;
                    expanded.shape = Shape::Enumeration(definition);
                    return Ok(expanded);
                }
                ClassSpecifier::Short(short) => {
                    let own = Modifier::of_arguments(&short.modification, parent)?;
                    let own = defaults.overridden_by(own, name)?.overridden_by(around, name)?;
                    expanded.modifier = own.overridden_by(outer, name)?;
                    expanded.dims.extend(short.subscripts.iter().map(|s| (s.clone(), parent)));
                    expanded.causality = expanded.causality.or(short.prefixes.causality);
                    expanded.connection = expanded.connection.or(short.prefixes.connection);
                    found = self.lookup_type(parent, &short.target)?;
                }
                ClassSpecifier::Long(_) => match self.predefined_base(id, &text)? {
                    Some((Type::Predefined(Predefined::ExternalObject), _)) => {
                        expanded.modifier = around.overridden_by(outer, name)?;
                        expanded.shape = Shape::ExternalObject(text.name.clone());
                        return Ok(expanded);
                    }
                    Some((base, extends)) => {
                        let own = Modifier::of_arguments(&extends.modification, id)?;
                        let own = own.overridden_by(around, name)?;
                        expanded.modifier = own.overridden_by(outer, name)?;
                        found = base;
                    }
                    None if matches!(text.restriction(), Restriction::Function { .. }) => {
                        expanded.shape = Shape::Function;
                        return Ok(expanded);
                    }
                    None => {
                        check_component_class(&text, specifier)?;
                        let own = defaults.overridden_by(around, name)?;
                        expanded.modifier = own.overridden_by(outer, name)?;
                        expanded.shape = Shape::Class(id);
                        return Ok(expanded);
                    }
                },
                ClassSpecifier::Derivative(_) => {
                    return Err(fault!(
                        TYPE_MISMATCH,
                        "`{}` is a function, not the type of a component",
                        text.name
                    )
                    .at(specifier.span));
                }
            }
        }
        Err(fault!(CYCLIC_CLASS, "type `{}` is defined in terms of itself", specifier.name)
            .at(specifier.span))
    }

    /// The predefined type that a long class extends, directly or through others, if it does:
    /// `type T extends Real(…); end T;`, or a class of external objects.
    pub fn predefined_base(
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
    pub fn enumeration(
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

impl Declaration {
    /// Whether both declare the same, as two base classes may (MLS §7.1).
    fn is_same(&self, other: &Declaration) -> bool {
        let plain = |one: &Declaration| one.dims.is_empty() && one.condition.is_none();
        self.type_specifier.name == other.type_specifier.name
            && self.prefixes == other.prefixes
            && self.type_prefixes == other.type_prefixes
            && self.modifier.is_same(&other.modifier)
            && plain(self)
            && plain(other)
    }
}

/// The modifiers of the constraining clauses: of the declaration, and of redeclarations that stand
/// under the last one (MLS §7.3.2).
fn constraining(
    clause: &ComponentClause,
    redeclaration: Option<&Redeclaration>,
    context: ScopeId,
) -> Result<Modifier, Diagnostic> {
    let mut modifier = match &clause.constraint {
        Some(constraint) => Modifier::of_arguments(&constraint.modification, context)?,
        None => Modifier::default(),
    };
    let mut under = Vec::new();
    let mut next = redeclaration.and_then(|redeclaration| redeclaration.over.as_deref());
    while let Some(one) = next {
        under.push(one);
        next = one.over.as_deref();
    }
    for one in under.into_iter().rev() {
        let Replacement::Component(clause) = &one.replacement else { continue };
        let Some(constraint) = &clause.constraint else { continue };
        let more = Modifier::of_arguments(&constraint.modification, one.context)?;
        modifier = match clause.components.first() {
            Some(component) => modifier.overridden_by(more, component.name.node)?,
            None => modifier,
        };
    }
    Ok(modifier)
}

/// Puts the type, the prefixes and the dimensions of a redeclaration in the place of the declared
/// ones (MLS §7.3); its modifiers were merged before.
fn redeclared(
    declaration: &mut Declaration,
    redeclaration: &Redeclaration,
    span: Span,
) -> Result<(), Diagnostic> {
    let name = declaration.name;
    let Replacement::Component(clause) = &redeclaration.replacement else {
        return Err(fault!(TYPE_MISMATCH, "component `{name}` is redeclared as a class").at(span));
    };
    let Some(component) = clause.components.first() else { return Ok(()) };
    let context = redeclaration.context;
    declaration.type_specifier = clause.type_specifier.clone();
    declaration.scope = context;
    let subscripts = component.subscripts.iter().chain(&clause.subscripts);
    let dims: Vec<_> = subscripts.map(|subscript| (subscript.clone(), context)).collect();
    if !dims.is_empty() {
        declaration.dims = dims;
    }
    let (own, new) = (&mut declaration.type_prefixes, clause.type_prefixes);
    own.variability = new.variability.or(own.variability);
    own.causality = new.causality.or(own.causality);
    own.connection = new.connection.or(own.connection);
    declaration.is_final |= clause.prefixes.is_final;
    declaration.evaluate |= evaluates(component);
    if component.comment.text.is_some() {
        declaration.description = component.comment.text.clone();
    }
    declaration.span = component.span;
    Ok(())
}

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
        })),
        None => Err(fault!(
            NOT_SUPPORTED,
            "`{name}` is an enumeration without literals: it can only be redeclared"
        )
        .at(span)),
    }
}

/// Whether a declaration carries `annotation(Evaluate = true)` (MLS §18.3).
fn evaluates(component: &ComponentDeclaration) -> bool {
    let Some(annotation) = &component.comment.annotation else { return false };
    annotation.arguments.iter().any(|argument| match argument {
        ast::Argument::Element(element) => {
            let binding = element.modification.as_ref().and_then(|m| m.binding.as_ref());
            element.name.node.to_string() == "Evaluate"
                && matches!(
                    binding,
                    Some(ast::Binding::Expression(value))
                        if value.kind == ast::ExpressionKind::Boolean(true)
                )
        }
        ast::Argument::Redeclaration(_) => false,
    })
}
