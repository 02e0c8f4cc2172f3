//! Collects the components of a class, inherited ones included (MLS §5.6.1, §7.1), and finds out
//! what their types are made of (MLS §4.6).

use super::elements::Elements;
use super::modification::{Modifier, Redeclaration, Replacement};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{DUPLICATE_ELEMENT, FINAL_OVERRIDE, TOO_LARGE, TYPE_MISMATCH};
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::Declaration;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::elements::MAX_BASES;
use crate::flatten::lookup::scope::Text;
use crate::source::Span;
use crate::syntax::ast::{
    self, ClassSpecifier, Comment, ComponentClause, ComponentDeclaration, Element, Exclusion,
    Restriction, Subscript,
};
use crate::syntax::print;
use std::sync::Arc;

impl Classes<'_> {
    pub(crate) fn find_elements(&mut self, id: ScopeId) -> Result<Elements, Diagnostic> {
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
                        self.inherit(id, *base, protected, &extends.excluded, &mut found)?;
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
        excluded: &[Exclusion],
        found: &mut Elements,
    ) -> Result<(), Diagnostic> {
        let inherited = self.elements(base)?;
        if found.is_empty() && !protected && excluded.is_empty() {
            *found = Elements::sharing(&inherited);
            return self.check_bases(id, found);
        }
        for (name, declaration) in inherited.iter() {
            let is_out =
                |one: &Exclusion| matches!(one, Exclusion::Component(out) if out.node == name);
            if excluded.iter().any(is_out) {
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
                // The extends clause may follow the redeclaration.
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
            (R::Connector, R::Connector | R::ExpandableConnector) => true,
            // Libraries do it; the table of the specification does not have it.
            (R::Connector, R::Model | R::Block | R::Class) => !self.library.is_strict(),
            (R::Package, R::Model | R::Block | R::Class) => !self.library.is_strict(),
            (R::Model, R::Block) => !self.library.is_strict(),
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
        &mut self,
        id: ScopeId,
        declaration: Arc<Declaration>,
        found: &mut Elements,
    ) -> Result<(), Diagnostic> {
        let name = declaration.name;
        if let Some(known) = found.get(name).cloned() {
            if known.span == declaration.span
                || (known.scope != declaration.scope
                    && (known.is_same(&declaration)
                        || (!self.library.is_strict()
                            && known.differs_in_attributes(&declaration)))
                    && self.have_same_type(&known, &declaration))
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

    /// Whether two declarations have one type, however its name is spelled; of names that mean
    /// nothing, those spelled alike.
    fn have_same_type(&mut self, one: &Declaration, other: &Declaration) -> bool {
        let mut meaning = |declared: &Declaration| {
            self.lookup(declared.scope, &declared.type_specifier.name).ok().flatten()
        };
        match (meaning(one), meaning(other)) {
            (None, None) => one.type_specifier.name == other.type_specifier.name,
            (one, other) => one == other,
        }
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
            // Without a constraining clause the declaration's own modifiers are that of one.
            (Some(_), None) => Modifier::new(component.modification.as_ref(), 0, context)?
                .overridden_by(defaults, name)?,
            (None, _) => {
                let own = Modifier::new(component.modification.as_ref(), 0, context)?;
                defaults.overridden_by(own, name)?
            }
        };
        let declared_final = clause.prefixes.is_final;
        own.is_final = declared_final;
        if declared_final {
            // Where a modification is refused.
            own.span.get_or_insert(component.name.span);
        }
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
            evaluate: annotated(&component.comment, "Evaluate") == Some(true),
            absolute: annotated(&component.comment, "absoluteValue"),
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
}

impl Declaration {
    /// Whether both declare the same, their types aside, as two base classes may (MLS §7.1).
    fn is_same(&self, other: &Declaration) -> bool {
        self.modifier.is_same(&other.modifier) && self.is_same_but_for_modifier(other)
    }

    /// Whether two declarations with one value have other attributes, such as `m(min = 1) = 3` and
    /// `m = 3`. The specification requires them to be identical; libraries have such
    /// (FrequencySweepVoltageSource of the standard library 4.0.0), and the one that is found first
    /// counts.
    fn differs_in_attributes(&self, other: &Declaration) -> bool {
        self.modifier.has_same_binding(&other.modifier) && self.is_same_but_for_modifier(other)
    }

    fn is_same_but_for_modifier(&self, other: &Declaration) -> bool {
        let size = |(size, _): &(Subscript, ScopeId)| match size {
            Subscript::All(_) => ":".to_owned(),
            Subscript::Index(size) => print::expression(size),
        };
        let sizes = |one: &Declaration| one.dims.iter().map(size).collect::<Vec<String>>();
        let condition = |one: &Declaration| {
            one.condition.as_ref().map(|(condition, _)| print::expression(condition))
        };
        self.prefixes == other.prefixes
            && self.type_prefixes == other.type_prefixes
            && sizes(self) == sizes(other)
            && condition(self) == condition(other)
    }
}

/// The modifiers of the constraining clauses: of the declaration, and of the redeclarations one over
/// the other, the last one included: they hold for its own class as well (MLS §7.3.2).
fn constraining(
    clause: &ComponentClause,
    redeclaration: Option<&Redeclaration>,
    context: ScopeId,
) -> Result<Modifier, Diagnostic> {
    let mut modifier = match &clause.constraint {
        Some(constraint) => Modifier::of_arguments(&constraint.modification, context)?,
        None => Modifier::default(),
    };
    for one in redeclaration.into_iter().flat_map(Redeclaration::innermost_first) {
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
    declaration.evaluate |= annotated(&component.comment, "Evaluate") == Some(true);
    declaration.absolute = annotated(&component.comment, "absoluteValue").or(declaration.absolute);
    if component.comment.text.is_some() {
        declaration.description = component.comment.text.clone();
    }
    declaration.span = component.span;
    Ok(())
}

/// The Boolean value of an annotation of a declaration or a short class, such as `Evaluate`
/// (MLS §18.3).
pub(crate) fn annotated(comment: &Comment, name: &str) -> Option<bool> {
    let value = |argument: &ast::Argument| {
        let ast::Argument::Element(element) = argument else { return None };
        let binding = element.modification.as_ref()?.binding.as_ref()?;
        match binding {
            ast::Binding::Expression(value) if element.name.node.to_string() == name => {
                match value.kind {
                    ast::ExpressionKind::Boolean(value) => Some(value),
                    _ => None,
                }
            }
            _ => None,
        }
    };
    comment.annotation.as_ref()?.arguments.iter().find_map(value)
}
