//! Classes in their surroundings (MLS §5.6.1): the text of a class with the modifiers and
//! redeclarations that reach it and the scope in which it stands. The same text in two
//! surroundings, such as `Medium` in two tanks, is two scopes.

use super::elements::Elements;
use super::modification::{Modifier, Redeclaration, Replacement};
use super::names::Type;
use crate::diag::{Diagnostic, suggest};
use crate::fault;
use crate::flatten::errors::{CYCLIC_CLASS, TOO_LARGE, TYPE_MISMATCH, UNKNOWN_ELEMENT};
use crate::flatten::instantiate::instance::NodeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::library::ClassId;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    ClassDefinition, ClassSpecifier, Deselection, Element, Extends, Restriction, Section,
    TypeSpecifier, Visibility,
};
use std::rc::Rc;
use std::sync::Arc;

/// The most scopes that one model may need.
const MAX_SCOPES: usize = 1_000_000;

/// The most base classes that one class may have, those of its bases included.
pub const MAX_BASES: usize = 10_000;

/// A class in its surroundings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ScopeId(pub u32);

impl ScopeId {
    /// The scope of the whole library, in which the top-level classes stand.
    pub const TOP: ScopeId = ScopeId(0);
}

/// The text of a class.
#[derive(Debug, Clone)]
pub struct Text {
    /// Full name, for messages and as the name of functions and records.
    pub name: Name,
    pub definition: Arc<ClassDefinition>,
    /// The class of the library; `None` for one that stands in a modification.
    pub id: Option<ClassId>,
    /// For `extends M(…)` (MLS §7.3.1): the class that it extends and replaces.
    pub extended: Option<Rc<Nested>>,
}

impl Text {
    pub fn restriction(&self) -> Restriction {
        self.definition.restriction
    }

    pub fn span(&self) -> Span {
        self.definition.name.span
    }

    /// The sections of a long class; none for a short one.
    pub fn sections(&self) -> &[Section] {
        match &self.definition.specifier {
            ClassSpecifier::Long(long) => &long.sections,
            _ => &[],
        }
    }

    /// The elements with whether they are protected, in order.
    pub fn elements(&self) -> impl Iterator<Item = (bool, &Element)> {
        self.sections().iter().flat_map(|section| {
            let (protected, elements) = match section {
                Section::Elements { visibility, elements } => {
                    (*visibility == Some(Visibility::Protected), elements.as_slice())
                }
                _ => (false, [].as_slice()),
            };
            elements.iter().map(move |element| (protected, element))
        })
    }
}

/// A class declared in another, with all that replaces or modifies it there.
#[derive(Debug)]
pub struct Nested {
    pub text: Text,
    /// The scope in which its text stands.
    pub parent: ScopeId,
    /// Modifiers over its own.
    pub modifier: Modifier,
    /// Modifiers under its own: those of a constraining clause (MLS §7.3.2).
    pub defaults: Modifier,
    pub outer: bool,
    pub inner: bool,
    pub instance: std::cell::Cell<Option<Type>>,
}

/// A class in its surroundings.
#[derive(Debug)]
pub struct Scope {
    pub text: Option<Text>,
    /// The scope in which the text stands; `None` for the top.
    pub parent: Option<ScopeId>,
    /// The instance whose components the names in the text mean; that of the derived class for a
    /// base class.
    pub node: NodeId,
    pub modifier: Modifier,
    pub defaults: Modifier,
    /// The class that extends this one here.
    pub derived: Option<ScopeId>,
    /// What the extends clause of that class leaves out of this one.
    pub deselected: Vec<Deselection>,
    bases: Stage<Rc<[ScopeId]>>,
    elements: Stage<Rc<Elements>>,
}

/// What is found out at most once.
#[derive(Debug, Clone, Default)]
enum Stage<T> {
    #[default]
    Pending,
    Busy,
    Done(T),
    Failed(Box<Diagnostic>),
}

impl Instantiation<'_> {
    pub fn scope(&self, id: ScopeId) -> &Scope {
        &self.scopes[id.0 as usize]
    }

    /// The text of a scope; that of the top is not asked for.
    pub fn text(&self, id: ScopeId) -> &Text {
        self.scope(id).text.as_ref().expect("only the top scope has no text")
    }

    /// The full name of a class that stands in a scope; a modifier of a simulated model stands in
    /// that of the whole library.
    pub fn name_within(&self, scope: ScopeId, name: Ident) -> Name {
        let text = self.scope(scope).text.as_ref();
        text.map_or_else(|| Name::from(name), |text| text.name.child(name))
    }

    /// The instance whose components a scope's names mean.
    pub fn node_of(&self, id: ScopeId) -> NodeId {
        self.scope(id).node
    }

    pub fn is_encapsulated(&self, id: ScopeId) -> bool {
        self.scope(id).text.as_ref().is_none_or(|text| text.definition.encapsulated)
    }

    pub fn add_scope(
        &mut self,
        text: Text,
        parent: ScopeId,
        node: NodeId,
        modifier: Modifier,
        defaults: Modifier,
    ) -> Result<ScopeId, Diagnostic> {
        if self.scopes.len() > MAX_SCOPES {
            return Err(
                fault!(TOO_LARGE, "the model needs too many class instances").at(text.span())
            );
        }
        let id = ScopeId(self.scopes.len() as u32);
        self.scopes.push(Scope {
            text: Some(text),
            parent: Some(parent),
            node,
            modifier,
            defaults,
            derived: None,
            deselected: Vec::new(),
            bases: Stage::Pending,
            elements: Stage::Pending,
        });
        Ok(id)
    }

    /// The top scope, without a class.
    pub fn top_scope() -> Scope {
        Scope {
            text: None,
            parent: None,
            node: NodeId(0),
            modifier: Modifier::default(),
            defaults: Modifier::default(),
            derived: None,
            deselected: Vec::new(),
            bases: Stage::Done(Rc::new([])),
            elements: Stage::Done(Rc::default()),
        }
    }

    /// What a nested class is here: a scope of its own, or that of the class that it is another
    /// name of.
    pub fn instance(&mut self, nested: &Rc<Nested>) -> Result<Type, Diagnostic> {
        if let Some(known) = nested.instance.get() {
            return Ok(known);
        }
        let found = match self.renamed(nested)? {
            Some(target) => target,
            None => Type::Class(self.class_scope(nested)?),
        };
        nested.instance.set(Some(found));
        Ok(found)
    }

    fn class_scope(&mut self, nested: &Nested) -> Result<ScopeId, Diagnostic> {
        let holder = self.node_of(nested.parent);
        let node = self.add_package(&nested.text.name, holder);
        let scope = self.add_scope(
            nested.text.clone(),
            nested.parent,
            node,
            nested.modifier.clone(),
            nested.defaults.clone(),
        )?;
        self.set_scope(node, scope);
        Ok(scope)
    }

    /// The class of which a short class without modifiers is another name.
    fn renamed(&mut self, nested: &Nested) -> Result<Option<Type>, Diagnostic> {
        let ClassSpecifier::Short(short) = &nested.text.definition.specifier else {
            return Ok(None);
        };
        let plain = short.modification.is_empty()
            && short.subscripts.is_empty()
            && short.prefixes == Default::default()
            && nested.modifier.is_empty()
            && nested.defaults.is_empty()
            && matches!(
                nested.text.restriction(),
                Restriction::Package | Restriction::Function { .. }
            );
        if !plain {
            return Ok(None);
        }
        let cycle = || {
            fault!(CYCLIC_CLASS, "`{}` is defined in terms of itself", nested.text.name)
                .at(nested.text.span())
        };
        if self.renaming > MAX_RENAMINGS {
            return Err(cycle());
        }
        self.renaming += 1;
        let found = self.lookup_type(nested.parent, &short.target);
        self.renaming -= 1;
        found.map(Some)
    }

    /// The base classes of a scope in the order of its extends clauses, each as a scope of its
    /// own; none while they are being looked up, for names that a base class itself needs
    /// (MLS §5.6.1.4).
    pub fn bases(&mut self, id: ScopeId) -> Result<Rc<[ScopeId]>, Diagnostic> {
        match &self.scope(id).bases {
            Stage::Done(bases) => return Ok(bases.clone()),
            Stage::Busy => return Ok(Rc::new([])),
            Stage::Failed(error) => return Err((**error).clone()),
            Stage::Pending => {}
        }
        self.scopes[id.0 as usize].bases = Stage::Busy;
        self.searching += 1;
        let found = self.find_bases(id);
        self.searching -= 1;
        self.scopes[id.0 as usize].bases = match &found {
            Ok(bases) => Stage::Done(bases.clone()),
            Err(error) => Stage::Failed(Box::new(error.clone())),
        };
        found
    }

    fn find_bases(&mut self, id: ScopeId) -> Result<Rc<[ScopeId]>, Diagnostic> {
        let text = self.text(id).clone();
        let parent = self.scope(id).parent.unwrap_or(ScopeId::TOP);
        let mut bases = Vec::new();
        match &text.definition.specifier {
            ClassSpecifier::Short(short) => {
                let own = Modifier::of_arguments(&short.modification, parent)?;
                let defaults = self.scope(id).defaults.clone();
                let own = defaults.overridden_by(own, text.definition.name.node)?;
                let base = self.lookup_type(parent, &short.target)?;
                let modifier = self.scope(id).modifier.clone();
                // A type made of a predefined one has no elements to inherit.
                if let Type::Class(class) = base
                    && self.text(class).restriction() != Restriction::Type
                {
                    bases.push(self.base(id, base, own, modifier, &short.target)?);
                }
            }
            ClassSpecifier::Long(long) => {
                let outer = self.modifier_of_bases(id)?;
                if let (Some(arguments), Some(extended)) = (&long.class_extends, &text.extended) {
                    let own = Modifier::of_arguments(arguments, id)?;
                    let base = Type::Class(self.class_scope(extended)?);
                    let specifier =
                        TypeSpecifier { name: extended.text.name.clone(), span: text.span() };
                    bases.push(self.base(id, base, own, outer.clone(), &specifier)?);
                }
                // A type made of a predefined one and an external object have none either.
                if let Some((Type::Predefined(_), _)) = self.predefined_base(id, &text)? {
                    return Ok(bases.into());
                }
                for (_, element) in text.elements() {
                    let Element::Extends(extends) = element else { continue };
                    bases.push(self.extended(id, extends, outer.clone())?);
                }
            }
            ClassSpecifier::Enumeration(_) | ClassSpecifier::Derivative(_) => {}
        }
        Ok(bases.into())
    }

    fn extended(
        &mut self,
        id: ScopeId,
        extends: &Extends,
        outer: Modifier,
    ) -> Result<ScopeId, Diagnostic> {
        let base = self.lookup_type(id, &extends.base)?;
        let own = Modifier::of_arguments(&extends.modification, id)?;
        let scope = self.base(id, base, own, outer, &extends.base)?;
        self.scopes[scope.0 as usize].deselected = extends.deselected.clone();
        Ok(scope)
    }

    fn base(
        &mut self,
        derived: ScopeId,
        base: Type,
        own: Modifier,
        outer: Modifier,
        specifier: &TypeSpecifier,
    ) -> Result<ScopeId, Diagnostic> {
        let Type::Class(class) = base else {
            return Err(fault!(
                TYPE_MISMATCH,
                "a class with components cannot extend `{}`",
                specifier.name
            )
            .at(specifier.span));
        };
        self.check_cycle(derived, class, specifier)?;
        let names: Vec<(Ident, Option<Span>)> =
            own.elements.iter().map(|(name, modifier)| (*name, modifier.span)).collect();
        let text = self.text(class).clone();
        let name = text.definition.name.node;
        let inner = self.scope(class).modifier.clone();
        let modifier = inner.overridden_by(own.overridden_by(outer, name)?, name)?;
        let defaults = self.scope(class).defaults.clone();
        let parent = self.scope(class).parent.unwrap_or(ScopeId::TOP);
        let node = self.node_of(derived);
        let scope = self.add_scope(text, parent, node, modifier, defaults)?;
        self.scopes[scope.0 as usize].derived = Some(derived);
        for (name, span) in names {
            self.check_modified(scope, name, span.unwrap_or(specifier.span))?;
        }
        Ok(scope)
    }

    fn check_cycle(
        &self,
        derived: ScopeId,
        base: ScopeId,
        specifier: &TypeSpecifier,
    ) -> Result<(), Diagnostic> {
        let base = self.text(base);
        let mut derived = Some(derived);
        let mut length = 0;
        while let Some(id) = derived {
            let text = self.text(id);
            length += 1;
            if text.definition.span == base.definition.span || length > MAX_BASES {
                return Err(
                    fault!(CYCLIC_CLASS, "`{}` extends itself", base.name).at(specifier.span)
                );
            }
            derived = self.scope(id).derived;
        }
        Ok(())
    }

    /// What modifies the bases of a class: the outer modifiers, and the redeclarations among its
    /// own elements (MLS §7.3).
    fn modifier_of_bases(&mut self, id: ScopeId) -> Result<Modifier, Diagnostic> {
        let text = self.text(id).clone();
        let mut own = Modifier::default();
        for (_, element) in text.elements() {
            if let Element::Component(clause) = element
                && clause.prefixes.redeclare
            {
                for component in &clause.components {
                    own.redeclare_component(clause, component, id)?;
                }
            }
        }
        let library = self.library;
        let children: Vec<(Ident, ClassId)> =
            text.id.map_or(Vec::new(), |class| library.class(class).children().collect());
        for (name, child) in children {
            if library.is_redeclaration(child) {
                let redeclaration = Redeclaration::new(Replacement::Element(child), id);
                let span = library.class(child).definition().name.span;
                own.redeclare(name, redeclaration, span);
            }
        }
        let name = text.definition.name.node;
        own.overridden_by(self.scope(id).modifier.clone(), name)
    }

    /// The components of a class, inherited ones included.
    pub fn elements(&mut self, id: ScopeId) -> Result<Rc<Elements>, Diagnostic> {
        match &self.scope(id).elements {
            Stage::Done(elements) => return Ok(elements.clone()),
            Stage::Failed(error) => return Err((**error).clone()),
            Stage::Busy => {
                let text = self.text(id);
                return Err(
                    fault!(CYCLIC_CLASS, "`{}` depends on itself", text.name).at(text.span())
                );
            }
            Stage::Pending => {}
        }
        self.scopes[id.0 as usize].elements = Stage::Busy;
        let found = self.find_elements(id).map(Rc::new);
        self.scopes[id.0 as usize].elements = match &found {
            Ok(elements) => Stage::Done(elements.clone()),
            Err(error) => Stage::Failed(Box::new(error.clone())),
        };
        found
    }

    /// An error if a class has no element of a name that a modifier names.
    pub fn check_modified(
        &mut self,
        id: ScopeId,
        name: Ident,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let elements = self.elements(id)?;
        if elements.contains(name) || self.find_class(id, name)?.is_some() {
            return Ok(());
        }
        let known: Vec<Ident> = elements.names().collect();
        let known = known.iter().map(|known| known.as_str());
        Err(fault!(UNKNOWN_ELEMENT, "`{}` has no component `{name}` to modify", self.text(id).name)
            .help_if(suggest::did_you_mean(name.as_str(), known))
            .at(span))
    }
}

/// How many short classes may be other names of one another.
const MAX_RENAMINGS: usize = 100;
