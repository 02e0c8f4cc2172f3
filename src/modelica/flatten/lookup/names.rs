//! Names of classes in instances (MLS §5.3): with the modifiers and redeclarations that reach what they
//! mean.

use super::modification::{Modifier, Redeclaration, Replacement};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::FINAL_OVERRIDE;
use crate::flatten::ids::ScopeId;
use crate::flatten::library::ClassId;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::scope::Nested;
use crate::flatten::lookup::scope::Text;
use crate::flatten::lookup::types::Predefined;
use crate::flatten::lookup::types::Type;
use crate::flatten::unknown;
use crate::name::{Ident, Name};
use crate::names::{self, Names};
use crate::source::Span;
use crate::syntax::ast::{ClassSpecifier, Constraint, ImportKind, TypeSpecifier};
use std::cell::Cell;
use std::rc::Rc;

impl Names for Classes<'_> {
    type Class = ScopeId;
    type Meaning = Type;
    type Fault = Diagnostic;

    fn element(&mut self, scope: ScopeId, name: Ident) -> Result<Option<Type>, Diagnostic> {
        let Some(nested) = self.find_class(scope, name)? else { return Ok(None) };
        match nested.outer {
            true => self.inner_class(scope, name, &nested).map(Some),
            false => self.instance(&nested).map(Some),
        }
    }

    fn imports(&self, scope: ScopeId) -> &[ImportKind] {
        let class = self.scope(scope).text.as_ref().and_then(|text| text.id);
        class.map_or(&[], |class| self.library.class(class).imports())
    }

    fn around(&self, scope: ScopeId) -> Option<ScopeId> {
        let around = self.scope(scope).parent.filter(|around| *around != ScopeId::TOP);
        around.filter(|_| !self.is_encapsulated(scope))
    }

    fn top(&mut self, name: Ident) -> Result<Option<Type>, Diagnostic> {
        let predefined = || Predefined::named(name).map(Type::Predefined);
        Ok(self.root(name)?.or_else(predefined))
    }

    fn inside(&mut self, of: Type, name: Ident) -> Result<Option<Type>, Diagnostic> {
        let Type::Class(scope) = of else { return Ok(None) };
        let Some(nested) = self.find_class(scope, name)? else { return Ok(None) };
        self.instance(&nested).map(Some)
    }
}

impl Classes<'_> {
    /// What a type specifier means in a scope; an error with suggestions if nothing.
    pub(crate) fn lookup_type(
        &mut self,
        scope: ScopeId,
        specifier: &TypeSpecifier,
    ) -> Result<Type, Diagnostic> {
        match self.lookup(scope, &specifier.name)? {
            Some(found) => Ok(found),
            None => Err(self.unknown_class(scope, &specifier.name, specifier.span)),
        }
    }

    /// What a name means as a class in a scope.
    pub(crate) fn lookup(
        &mut self,
        scope: ScopeId,
        name: &Name,
    ) -> Result<Option<Type>, Diagnostic> {
        let Some((first, rest)) = name.parts.split_first() else { return Ok(None) };
        let predefined = Predefined::named(*first).filter(|_| rest.is_empty());
        if let Some(reserved) = predefined.filter(|predefined| predefined.is_reserved()) {
            return Ok(Some(Type::Predefined(reserved)));
        }
        let found = match name.global {
            true => self.top(*first)?,
            false => self.lookup_simple(scope, *first)?,
        };
        self.followed(found, rest)
    }

    /// A simple name: declared, inherited or imported by the class or by one that encloses it.
    pub(crate) fn lookup_simple(
        &mut self,
        scope: ScopeId,
        name: Ident,
    ) -> Result<Option<Type>, Diagnostic> {
        if let Some(known) = self.found.get(&(scope, name)) {
            return Ok(*known);
        }
        let searched = self.simple(Some(scope).filter(|scope| *scope != ScopeId::TOP), name)?;
        // While base classes are looked up, inherited names are not seen.
        if self.searching == 0 {
            self.found.insert((scope, name), searched);
        }
        Ok(searched)
    }

    /// The class that an `outer` class means (MLS §5.4): that of the nearest enclosing instance.
    fn inner_class(
        &mut self,
        scope: ScopeId,
        name: Ident,
        outer: &Rc<Nested>,
    ) -> Result<Type, Diagnostic> {
        let mut node = self.tree.nodes[self.node_of(scope).0].parent;
        while let Some(id) = node {
            if let Some(holder) = self.tree.scope_of(id)
                && let Some(nested) = self.find_class(holder, name)?
                && nested.inner
            {
                return self.instance(&nested);
            }
            node = self.tree.nodes[id.0].parent;
        }
        self.instance(outer)
    }

    /// A class that another declares or inherits, with what replaces it.
    pub(crate) fn find_class(
        &mut self,
        scope: ScopeId,
        name: Ident,
    ) -> Result<Option<Rc<Nested>>, Diagnostic> {
        if let Some(known) = self.nested.get(&(scope, name)) {
            return Ok(known.clone());
        }
        let found = self.search_class(scope, name)?;
        if found.is_some() || self.searching == 0 {
            self.nested.insert((scope, name), found.clone());
        }
        Ok(found)
    }

    fn search_class(
        &mut self,
        scope: ScopeId,
        name: Ident,
    ) -> Result<Option<Rc<Nested>>, Diagnostic> {
        let Some(text) = &self.scope(scope).text else { return Ok(None) };
        let own = text.id.and_then(|id| self.library.class(id).child(name));
        if let Some(child) = own
            && !self.library.is_redeclaration(child)
        {
            return self.declared_class(scope, child, name).map(Some);
        }
        self.inherited_class(scope, name)
    }

    fn inherited_class(
        &mut self,
        scope: ScopeId,
        name: Ident,
    ) -> Result<Option<Rc<Nested>>, Diagnostic> {
        for base in self.bases(scope)?.iter() {
            if let Some(found) = self.find_class(*base, name)? {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    fn name_text(&self, class: ClassId) -> Text {
        let found = self.library.class(class);
        Text {
            name: found.name().clone(),
            definition: found.definition().clone(),
            id: Some(class),
            extended: None,
        }
    }

    fn declared_class(
        &mut self,
        scope: ScopeId,
        child: ClassId,
        name: Ident,
    ) -> Result<Rc<Nested>, Diagnostic> {
        let prefixes = self.library.class(child).prefixes();
        let outer = self.scope(scope).modifier.elements.get(&name).cloned().unwrap_or_default();
        let mut text = self.name_text(child);
        if self.library.class(child).is_class_extends() {
            text.extended = self.inherited_class(scope, name)?;
        }
        let mut original = Nested {
            text,
            parent: scope,
            // A final redeclaration cannot be replaced; components of the class can be modified.
            modifier: Modifier { redeclaration: None, is_final: false, ..outer.clone() },
            defaults: Modifier::default(),
            outer: prefixes.outer,
            inner: prefixes.inner,
            instance: Cell::new(None),
        };
        let constraint = self.library.class(child).constraint().cloned();
        let Some(redeclaration) = outer.redeclaration else {
            // The modifiers of the constraining clause hold for the original class as well.
            if constraint.is_some() {
                original.defaults = self.constraining(&original, constraint.as_ref())?;
            }
            return Ok(Rc::new(original));
        };
        if prefixes.is_final {
            return Err(fault!(FINAL_OVERRIDE, "`{name}` is final and cannot be redeclared")
                .at(outer.span.unwrap_or(Span::NONE)));
        }
        let mut defaults = self.constraining(&original, constraint.as_ref())?;
        for one in redeclaration.innermost_first() {
            if let Some(constraint) = self.constraint_of(one) {
                let more = Modifier::of_arguments(&constraint.modification, one.context)?;
                defaults = defaults.overridden_by(more, name)?;
            }
        }
        self.replaced(original, &redeclaration, &defaults)
    }

    /// The constraining clause of a redeclaration: its modifiers hold for its own class and for those
    /// that replace it (MLS §7.3.2).
    fn constraint_of<'r>(&'r self, redeclaration: &'r Redeclaration) -> Option<&'r Constraint> {
        match &redeclaration.replacement {
            Replacement::Class(element) => element.constraint.as_ref(),
            Replacement::Element(class) => self.library.class(*class).constraint(),
            Replacement::Component(_) => None,
        }
    }

    /// The modifiers that hold for whatever replaces a class (MLS §7.3.2).
    fn constraining(
        &self,
        original: &Nested,
        constraint: Option<&Constraint>,
    ) -> Result<Modifier, Diagnostic> {
        match (constraint, &original.text.definition.specifier) {
            (Some(constraint), _) => {
                Modifier::of_arguments(&constraint.modification, original.parent)
            }
            (None, ClassSpecifier::Short(short)) => {
                Modifier::of_arguments(&short.modification, original.parent)
            }
            _ => Ok(Modifier::default()),
        }
    }

    /// The class that a redeclaration puts in the place of another.
    fn replaced(
        &mut self,
        original: Nested,
        redeclaration: &Redeclaration,
        defaults: &Modifier,
    ) -> Result<Rc<Nested>, Diagnostic> {
        let modifier = original.modifier.clone();
        let (inner, outer) = (original.inner, original.outer);
        let text = match &redeclaration.replacement {
            Replacement::Class(element) => Text {
                name: self.name_within(redeclaration.context, element.class.name.node),
                definition: element.class.clone(),
                id: None,
                extended: None,
            },
            Replacement::Element(class) => {
                let mut text = self.name_text(*class);
                if self.library.class(*class).is_class_extends() {
                    let below = Nested { modifier: Modifier::default(), ..original };
                    text.extended = Some(match &redeclaration.over {
                        Some(over) => self.replaced(below, over, defaults)?,
                        None => Rc::new(below),
                    });
                }
                text
            }
            Replacement::Component(clause) => {
                return Err(fault!(
                    crate::flatten::errors::TYPE_MISMATCH,
                    "class `{}` is redeclared as a component",
                    original.text.name
                )
                .at(clause.span));
            }
        };
        Ok(Rc::new(Nested {
            text,
            parent: redeclaration.context,
            modifier,
            defaults: defaults.clone(),
            outer,
            inner,
            instance: Cell::new(None),
        }))
    }

    /// A class at the top level.
    pub(crate) fn root(&mut self, name: Ident) -> Result<Option<Type>, Diagnostic> {
        if let Some(known) = self.roots.get(&name) {
            return self.instance(&known.clone()).map(Some);
        }
        let Some(id) = self.library.root(name) else { return Ok(None) };
        let nested = Rc::new(Nested {
            text: self.name_text(id),
            parent: ScopeId::TOP,
            modifier: Modifier::default(),
            defaults: Modifier::default(),
            outer: false,
            inner: false,
            instance: Cell::new(None),
        });
        self.roots.insert(name, nested.clone());
        self.instance(&nested).map(Some)
    }

    /// The class of a full name, without what modifies it anywhere.
    pub(crate) fn class_named(&mut self, name: &Name) -> Result<Option<Type>, Diagnostic> {
        self.lookup(ScopeId::TOP, &Name { global: true, ..name.clone() })
    }

    /// The diagnostic for a class that is not there.
    fn unknown_class(&mut self, scope: ScopeId, name: &Name, span: Span) -> Diagnostic {
        unknown::class(name, self.suggestion(scope, name), span)
    }

    /// The diagnostic for a function that is not there.
    pub(crate) fn unknown_function(
        &mut self,
        scope: ScopeId,
        name: &Name,
        span: Span,
    ) -> Diagnostic {
        let known = self.tree.component_names(self.node_of(scope));
        unknown::function(name, &known, self.suggestion(scope, name), span)
    }

    fn suggestion(&mut self, scope: ScopeId, name: &Name) -> Option<String> {
        names::suggestion(name, |package| self.candidates(scope, package))
    }

    /// The names of the classes in a package; for no package, of those in scope.
    fn candidates(&mut self, scope: ScopeId, package: &Name) -> Vec<Ident> {
        if !package.parts.is_empty() {
            return match self.lookup(scope, package) {
                Ok(Some(Type::Class(id))) => self.own_classes(id),
                _ => Vec::new(),
            };
        }
        let mut names: Vec<Ident> = ["Real", "Integer", "Boolean", "String"].map(Ident::new).into();
        let mut scope = Some(scope);
        while let Some(id) = scope {
            names.extend(self.own_classes(id));
            scope = self.scope(id).parent;
        }
        names.extend(self.library.roots());
        names
    }

    fn own_classes(&self, scope: ScopeId) -> Vec<Ident> {
        let class = self.scope(scope).text.as_ref().and_then(|text| text.id);
        class.map_or(Vec::new(), |id| {
            self.library.class(id).children().map(|(name, _)| name).collect()
        })
    }
}
