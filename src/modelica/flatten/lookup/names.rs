//! Looking up names of classes: simple (MLS §5.3.1), composite (§5.3.2), global (§5.3.3) and
//! imported ones (§5.3.4, §13.2).

use super::modification::{Modifier, Redeclaration, Replacement};
use crate::diag::{Diagnostic, suggest};
use crate::fault;
use crate::flatten::errors::{FINAL_OVERRIDE, UNKNOWN_CLASS};
use crate::flatten::ids::ScopeId;
use crate::flatten::library::ClassId;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::scope::Nested;
use crate::flatten::lookup::scope::Text;
use crate::flatten::lookup::types::Predefined;
use crate::flatten::lookup::types::Type;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{ClassSpecifier, Constraint, ImportKind, TypeSpecifier};
use std::cell::Cell;
use std::rc::Rc;

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
    pub fn lookup(&mut self, scope: ScopeId, name: &Name) -> Result<Option<Type>, Diagnostic> {
        let Some((first, rest)) = name.parts.split_first() else { return Ok(None) };
        let predefined = Predefined::named(*first).filter(|_| rest.is_empty());
        if let Some(reserved) = predefined.filter(|predefined| predefined.is_reserved()) {
            return Ok(Some(Type::Predefined(reserved)));
        }
        let found = match name.global {
            true => self.root(*first)?,
            false => self.lookup_simple(scope, *first)?,
        };
        if let (None, Some(predefined)) = (&found, predefined) {
            return Ok(Some(Type::Predefined(predefined)));
        }
        self.lookup_inside(found, rest)
    }

    /// The class of a path of names inside a class.
    pub(crate) fn lookup_inside(
        &mut self,
        mut found: Option<Type>,
        path: &[Ident],
    ) -> Result<Option<Type>, Diagnostic> {
        for part in path {
            let Some(Type::Class(scope)) = found else { return Ok(None) };
            found = match self.find_class(scope, *part)? {
                Some(nested) => Some(self.instance(&nested)?),
                None => None,
            };
        }
        Ok(found)
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
        let searched = self.search_simple(scope, name)?;
        // While base classes are looked up, inherited names are not seen.
        if self.searching == 0 {
            self.found.insert((scope, name), searched);
        }
        Ok(searched)
    }

    fn search_simple(&mut self, scope: ScopeId, name: Ident) -> Result<Option<Type>, Diagnostic> {
        let mut scope = scope;
        while scope != ScopeId::TOP {
            if let Some(nested) = self.find_class(scope, name)? {
                return if nested.outer {
                    self.inner_class(scope, name, &nested).map(Some)
                } else {
                    self.instance(&nested).map(Some)
                };
            }
            if let Some(found) = self.imported(scope, name)? {
                return Ok(Some(found));
            }
            if self.is_encapsulated(scope) {
                break;
            }
            scope = self.scope(scope).parent.unwrap_or(ScopeId::TOP);
        }
        self.root(name)
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
    pub fn find_class(
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

    fn text_of(&self, class: ClassId) -> Text {
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
        let mut text = self.text_of(child);
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
                let mut text = self.text_of(*class);
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

    fn imported(&mut self, scope: ScopeId, name: Ident) -> Result<Option<Type>, Diagnostic> {
        for target in self.imported_names(scope, name) {
            if let Some(found) = self.lookup(ScopeId::TOP, &target)? {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    /// The full names that imports of a class give to a name, the named imports first.
    pub(crate) fn imported_names(&self, scope: ScopeId, name: Ident) -> Vec<Name> {
        let Some(class) = self.scope(scope).text.as_ref().and_then(|text| text.id) else {
            return Vec::new();
        };
        let imports = self.library.class(class).imports();
        let named = imports.iter().filter_map(|import| match import {
            ImportKind::Qualified(target) if target.last() == Some(name) => Some(target.clone()),
            ImportKind::Renaming(own, target) if *own == name => Some(target.clone()),
            ImportKind::Group(package, names) if names.contains(&name) => Some(package.child(name)),
            _ => None,
        });
        let unqualified = imports.iter().filter_map(|import| match import {
            ImportKind::Unqualified(package) => Some(package.child(name)),
            _ => None,
        });
        named.chain(unqualified).map(|name| Name { global: true, ..name }).collect()
    }

    /// A class at the top level.
    pub fn root(&mut self, name: Ident) -> Result<Option<Type>, Diagnostic> {
        if let Some(known) = self.roots.get(&name) {
            return self.instance(&known.clone()).map(Some);
        }
        let Some(id) = self.library.root(name) else { return Ok(None) };
        let nested = Rc::new(Nested {
            text: self.text_of(id),
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
        let suggestion = self.suggestion(scope, name);
        fault!(UNKNOWN_CLASS, "there is no class `{name}`").help_if(suggestion).at(span)
    }

    /// The diagnostic for a function that is not there.
    pub(crate) fn unknown_function(
        &mut self,
        scope: ScopeId,
        name: &Name,
        span: Span,
    ) -> Diagnostic {
        let builtin = || suggest::did_you_mean(&name.to_string(), crate::functions::names());
        let suggestion = self.suggestion(scope, name).or_else(builtin);
        fault!(UNKNOWN_CLASS, "there is no function `{name}`").help_if(suggestion).at(span)
    }

    fn suggestion(&mut self, scope: ScopeId, name: &Name) -> Option<String> {
        let wanted = name.last().map_or("", Ident::as_str);
        let (package, candidates) = self.siblings(scope, name);
        if candidates.is_empty() && name.parts.len() > 1 {
            // The package is not there either.
            return self.suggestion(scope, &name.parent());
        }
        suggest::nearest(wanted, candidates.iter().map(|c| c.as_str()))
            .map(|near| format!("did you mean `{}`?", package.child(Ident::new(near))))
    }

    /// The names among which the last part of a name was looked up, and the package they lie in.
    fn siblings(&mut self, scope: ScopeId, name: &Name) -> (Name, Vec<Ident>) {
        let package = name.parent();
        if !package.parts.is_empty() {
            let names = match self.lookup(scope, &package) {
                Ok(Some(Type::Class(id))) => self.own_classes(id),
                _ => Vec::new(),
            };
            return (package, names);
        }
        let mut names: Vec<Ident> = ["Real", "Integer", "Boolean", "String"].map(Ident::new).into();
        let mut scope = Some(scope);
        while let Some(id) = scope {
            names.extend(self.own_classes(id));
            scope = self.scope(id).parent;
        }
        names.extend(self.library.roots());
        (Name::default(), names)
    }

    fn own_classes(&self, scope: ScopeId) -> Vec<Ident> {
        let class = self.scope(scope).text.as_ref().and_then(|text| text.id);
        class.map_or(Vec::new(), |id| {
            self.library.class(id).children().map(|(name, _)| name).collect()
        })
    }
}
