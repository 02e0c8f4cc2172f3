//! Names that mean nothing as the classes are declared (MLS §5.3): of classes and functions, in
//! expressions, of modified elements (§7.2) and of arguments (§12.4.1). Every class is checked by itself,
//! with what depends on conditions and on redeclarations: also what no model instantiates.

mod annotations;
mod calls;
mod certainty;
mod expressions;
mod modifications;
mod modified;

use super::imports;
use super::scope::Scope;
use crate::diag::Diagnostic;
use crate::flatten::declared::Declared;
use crate::flatten::library::{ClassId, Library};
use crate::flatten::unknown;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    ClassElement, ClassSpecifier, ComponentClause, ComponentDeclaration, Constraint, Element,
    Import, Section, ShortClass, Subscript, TypeSpecifier,
};
use crate::syntax::visit::Visit as _;
pub(super) use certainty::is_certain;
use modified::Modified;
use rustc_hash::FxHashSet;

/// Checks the names that a class itself writes.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    let is_long = matches!(class.definition().specifier, ClassSpecifier::Long(_));
    let scope = if is_long { Some(class) } else { class.parent() };
    let mut walk = NameCheck {
        library: class.library,
        scope,
        is_open: scope.is_some_and(Scope::has_open_names),
        loops: Vec::new(),
        unknown_packages: FxHashSet::default(),
        errors,
    };
    match &class.definition().specifier {
        ClassSpecifier::Long(long) => {
            if let Some(arguments) = &long.class_extends {
                let base = class.library.replaced_class(class.class);
                let base = base.map(|base| Modified::class(class.of(base)));
                walk.arguments(&base.unwrap_or(Modified::Unknown), arguments);
            }
            walk.body(class);
        }
        ClassSpecifier::Short(short) => walk.short(short),
        ClassSpecifier::Derivative(derivative) => {
            let function = walk.specifier(&derivative.target);
            walk.derivative_by(&function, &derivative.variables);
        }
        ClassSpecifier::Enumeration(_) => {}
    }
}

/// A walk over the text of a class.
struct NameCheck<'a, 'e> {
    library: &'a Library,
    /// The class in which names are looked up; `None` at the top.
    scope: Option<Scope<'a>>,
    /// Whether names may mean elements that no declaration shows.
    is_open: bool,
    /// The loop variables in force.
    loops: Vec<Ident>,
    /// First names of paths that were reported: one missing library is one error.
    unknown_packages: FxHashSet<Ident>,
    errors: &'e mut Vec<Diagnostic>,
}

impl<'a> NameCheck<'a, '_> {
    fn body(&mut self, class: Scope<'a>) {
        class.elements().for_each(|(_, element)| self.element(class, element));
        for section in class.sections() {
            match section {
                Section::Equations { equations, .. } => {
                    equations.iter().for_each(|equation| self.equation(equation));
                }
                Section::Algorithm { statements, .. } => {
                    statements.iter().for_each(|statement| self.statement(statement));
                }
                Section::External(external) => {
                    external.output.iter().for_each(|output| self.reference(output));
                    external.arguments.iter().for_each(|argument| self.expression(argument));
                    external.annotation.iter().for_each(|one| self.annotation(class, one));
                }
                Section::Annotation(annotation) => self.annotation(class, annotation),
                Section::Elements { .. } => {}
            }
        }
    }

    fn element(&mut self, class: Scope<'a>, element: &Element) {
        match element {
            Element::Import(import) => self.import(class, import),
            Element::Extends(extends) => {
                let parts = self.library.parts_of_base(class.class, &extends.base.name);
                // What the class itself inherits gives no base class a meaning (MLS §5.6.1.4).
                let is_open = class.around().is_some_and(Scope::has_open_names);
                let base = self.class_of(&extends.base, &parts, is_open);
                self.arguments(&base, &extends.modification);
                self.excluded(&base, &extends.excluded);
                extends.annotation.iter().for_each(|annotation| self.graphics(annotation));
            }
            Element::Component(clause) => self.clause(clause),
            // The class is checked by itself.
            Element::Class(nested) => self.constraint(nested.constraint.as_ref()),
        }
    }

    fn import(&mut self, class: Scope<'a>, import: &Import) {
        for (target, at) in imports::missing(self.library, &import.kind) {
            if self.is_first_of_package(&target, at) {
                self.errors.push(imports::unknown(class, &target, import.span));
            }
        }
    }

    fn clause(&mut self, clause: &ComponentClause) {
        let target = self.specifier(&clause.type_specifier);
        self.subscripts(&clause.subscripts);
        let target = target.replaceable_if(clause.prefixes.replaceable);
        clause.components.iter().for_each(|component| self.component(&target, component));
        self.constraint(clause.constraint.as_ref());
    }

    fn component(&mut self, target: &Modified<'a>, component: &ComponentDeclaration) {
        self.subscripts(&component.subscripts);
        let target = target.of(component.name.node);
        component.modification.iter().for_each(|one| self.modification(&target, one));
        component.condition.iter().for_each(|condition| self.expression(condition));
        self.comment(&component.comment);
    }

    fn constraint(&mut self, constraint: Option<&Constraint>) {
        if let Some(constraint) = constraint {
            let target = self.specifier(&constraint.target);
            self.arguments(&target, &constraint.modification);
            self.comment(&constraint.comment);
        }
    }

    fn redeclared_class(&mut self, nested: &ClassElement) {
        if let ClassSpecifier::Short(short) = &nested.class.specifier {
            self.short(short);
        }
        self.constraint(nested.constraint.as_ref());
    }

    fn short(&mut self, short: &ShortClass) {
        let target = self.specifier(&short.target);
        self.subscripts(&short.subscripts);
        self.arguments(&target, &short.modification);
        self.comment(&short.comment);
    }

    fn subscripts(&mut self, subscripts: &[Subscript]) {
        for subscript in subscripts {
            if let Subscript::Index(index) = subscript {
                self.expression(index);
            }
        }
    }

    /// What a type specifier means; says so if nothing.
    fn specifier(&mut self, specifier: &TypeSpecifier) -> Modified<'a> {
        let scope = self.scope.map(|scope| scope.class);
        let parts = self.library.parts_of_type(scope, &specifier.name);
        self.class_of(specifier, &parts, self.is_open)
    }

    /// What the parts of a type specifier mean; says so if nothing. The first may mean an element that no
    /// declaration shows if `is_open`.
    fn class_of(
        &mut self,
        specifier: &TypeSpecifier,
        parts: &[Option<Declared>],
        is_open: bool,
    ) -> Modified<'a> {
        let Some(at) = parts.iter().position(Option::is_none) else {
            return Modified::by_parts(self.library, parts);
        };
        if !may_be_undeclared(self.library, parts, at, is_open) {
            let scope = self.scope.map(|scope| scope.class);
            self.unknown_class(scope, &specifier.name, at, specifier.span);
        }
        Modified::Unknown
    }

    /// Whether the part of a name at `at`, which is not found, may exist where the class is used.
    fn may_be_undeclared(&self, parts: &[Option<Declared>], at: usize) -> bool {
        may_be_undeclared(self.library, parts, at, self.is_open)
    }

    fn unknown_class(&mut self, scope: Option<ClassId>, name: &Name, at: usize, span: Span) {
        if self.is_first_of_package(name, at) {
            let suggestion = self.library.suggestion(scope, name);
            self.errors.push(unknown::class(name, suggestion, span));
        }
    }

    /// Whether it is the first name in a package that is not found.
    fn is_first_of_package(&mut self, name: &Name, at: usize) -> bool {
        let package = name.first().filter(|_| at == 0 && !name.is_simple());
        package.is_none_or(|package| self.unknown_packages.insert(package))
    }
}

/// Whether the part of a name at `at`, which is not found, may exist where its class is used; the first
/// one if `is_open`.
fn may_be_undeclared(
    library: &Library,
    parts: &[Option<Declared>],
    at: usize,
    is_open: bool,
) -> bool {
    if at == 0 { is_open } else { !is_certain(library, &parts[..at]) }
}
