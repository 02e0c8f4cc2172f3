//! Base classes (MLS §7.1): each is a scope of its own, which shares the instance of the class that
//! extends it.

use super::elements::Elements;
use super::modification::{Modifier, Redeclaration, Replacement};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{CYCLIC_CLASS, TYPE_MISMATCH};
use crate::flatten::ids::ScopeId;
use crate::flatten::library::ClassId;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::elements::MAX_BASES;
use crate::flatten::lookup::scope::Nested;
use crate::flatten::lookup::scope::Stage;
use crate::flatten::lookup::types::Type;
use crate::flatten::unknown;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{ClassSpecifier, Element, Extends, Restriction, TypeSpecifier};
use std::rc::Rc;

impl Classes<'_> {
    /// What a nested class is here: a scope of its own, or that of the class that it is another
    /// name of.
    pub(crate) fn instance(&mut self, nested: &Rc<Nested>) -> Result<Type, Diagnostic> {
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
        let node = self.tree.add_package(&nested.text.name, holder);
        let scope = self.add_scope(
            nested.text.clone(),
            nested.parent,
            node,
            nested.modifier.clone(),
            nested.defaults.clone(),
        )?;
        self.tree.set_scope(node, scope);
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
    pub(crate) fn bases(&mut self, id: ScopeId) -> Result<Rc<[ScopeId]>, Diagnostic> {
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
        self.scopes[scope.0 as usize].excluded = extends.excluded.clone();
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
    pub(crate) fn elements(&mut self, id: ScopeId) -> Result<Rc<Elements>, Diagnostic> {
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
    pub(crate) fn check_modified(
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
        Err(unknown::element(&self.text(id).name, name, &known, span))
    }
}

/// How many short classes may be other names of one another.
const MAX_RENAMINGS: usize = 100;
