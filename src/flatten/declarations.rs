//! Collects the components of a class, inherited ones included (MLS §5.6.1, §7.1), and finds out
//! what their types are made of (MLS §4.6).

use super::Variability;
use super::errors::{
    CYCLIC_CLASS, DUPLICATE_ELEMENT, NOT_SUPPORTED, TOO_LARGE, TYPE_MISMATCH, UNKNOWN_ELEMENT,
};
use super::instance::{Context, Declaration, Member, MemberState, NodeId, Shape};
use super::library::{ClassId, Library};
use super::lookup::Type;
use super::modification::Modifier;
use crate::diag::{Diagnostic, suggest};
use crate::fault;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{
    self, CausalityPrefix, ClassSpecifier, ComponentClause, ComponentDeclaration, Element, Extends,
    Restriction, Subscript, TypeSpecifier, VariabilityPrefix, Visibility,
};
use crate::value::EnumerationDefinition;
use indexmap::IndexMap;
use std::sync::Arc;

/// How many classes may extend one another before it is taken for a cycle.
const MAX_DEPTH: usize = 100;

/// How many base classes one class may have in all.
const MAX_BASES: usize = 2000;

/// The components of a class and the classes that its equations come from.
#[derive(Debug, Default)]
pub(super) struct Collected {
    pub(super) members: IndexMap<Ident, Member>,
    pub(super) lineage: Vec<ClassId>,
}

/// What the type of a component is made of.
pub(super) struct Expanded {
    pub(super) shape: Shape,
    pub(super) dims: Vec<(Subscript, Context)>,
    pub(super) modifier: Modifier,
    pub(super) causality: Option<CausalityPrefix>,
}

impl Library {
    /// The components of an instance of `class` at `node`, under an outer modifier. An error if
    /// the modifier names what the class does not have.
    pub(super) fn collect(
        &self,
        class: ClassId,
        node: NodeId,
        modifier: Modifier,
    ) -> Result<Collected, Diagnostic> {
        let mut collected = Collected::default();
        let left = self.collect_into(class, node, modifier, false, &mut collected, 0)?;
        if let Some((name, modifier)) = left.elements.first() {
            let names = collected.members.keys().map(|name| name.as_str());
            return Err(fault!(
                UNKNOWN_ELEMENT,
                "`{}` has no component `{name}` to modify",
                self.class(class).name
            )
            .help_if(suggest::did_you_mean(name.as_str(), names))
            .at(modifier.span.unwrap_or(Span::NONE)));
        }
        Ok(collected)
    }

    /// Adds the components of a class and returns what is left of the modifier.
    fn collect_into(
        &self,
        class: ClassId,
        node: NodeId,
        mut modifier: Modifier,
        protected: bool,
        out: &mut Collected,
        depth: usize,
    ) -> Result<Modifier, Diagnostic> {
        let found = self.class(class);
        if depth > MAX_DEPTH {
            return Err(fault!(CYCLIC_CLASS, "`{}` extends itself", found.name)
                .at(found.definition.name.span));
        }
        if out.lineage.len() > MAX_BASES {
            return Err(fault!(TOO_LARGE, "`{}` is one of too many base classes", found.name)
                .at(found.definition.name.span));
        }
        if let ClassSpecifier::Short(short) = &found.definition.specifier {
            let context = Context { node, class: found.parent };
            let own = Modifier::of_arguments(&short.modification, context)?;
            let merged = own.overridden_by(modifier, found.definition.name.node)?;
            let base =
                self.base_class(self.lookup_in(found.parent, &short.target)?, &short.target)?;
            return self.collect_into(base, node, merged, protected, out, depth + 1);
        }
        for (visibility, element) in found.elements() {
            let protected = protected || visibility == Visibility::Protected;
            match element {
                Element::Extends(extends) => {
                    modifier =
                        self.collect_base(class, extends, node, modifier, protected, out, depth)?;
                }
                Element::Component(clause) => {
                    for component in &clause.components {
                        let outer = modifier.take(component.name.node);
                        let context = Context { node, class: Some(class) };
                        let declaration =
                            self.declaration(clause, component, outer, protected, context)?;
                        self.add_member(class, declaration, out)?;
                    }
                }
                Element::Class(nested) if nested.prefixes.redeclare => {
                    return Err(fault!(NOT_SUPPORTED, "redeclarations are not translated yet")
                        .at(nested.class.name.span));
                }
                Element::Class(_) | Element::Import(_) => {}
            }
        }
        out.lineage.push(class);
        Ok(modifier)
    }

    #[allow(clippy::too_many_arguments, reason = "the state of one recursion")]
    fn collect_base(
        &self,
        class: ClassId,
        extends: &Extends,
        node: NodeId,
        modifier: Modifier,
        protected: bool,
        out: &mut Collected,
        depth: usize,
    ) -> Result<Modifier, Diagnostic> {
        if !extends.deselected.is_empty() {
            return Err(fault!(
                NOT_SUPPORTED,
                "`break` in an extends clause is not translated yet"
            )
            .at(extends.span));
        }
        let base = self.base_class(self.lookup_base(class, &extends.base)?, &extends.base)?;
        self.check_base_kind(class, base, extends.span)?;
        let context = Context { node, class: Some(class) };
        let own = Modifier::of_arguments(&extends.modification, context)?;
        let names: Vec<Ident> = own.elements.keys().copied().collect();
        let merged = own.overridden_by(modifier, self.class(base).definition.name.node)?;
        let left = self.collect_into(base, node, merged, protected, out, depth + 1)?;
        match names.iter().find(|name| left.elements.contains_key(*name)) {
            Some(name) => Err(fault!(
                UNKNOWN_ELEMENT,
                "`{}` has no component `{name}` to modify",
                self.class(base).name
            )
            .help_if(suggest::did_you_mean(
                name.as_str(),
                out.members.keys().map(|name| name.as_str()),
            ))
            .at(extends.span)),
            None => Ok(left),
        }
    }

    /// Which kinds of classes may extend which (MLS §7.1.3).
    fn check_base_kind(&self, class: ClassId, base: ClassId, span: Span) -> Result<(), Diagnostic> {
        use Restriction as R;
        let (own, inherited) = (self.class(class), self.class(base));
        let fits = match (inherited.definition.restriction, own.definition.restriction) {
            // What is only a class holds what all kinds may hold.
            (R::Class, _) => true,
            (R::Function { .. }, R::Function { .. }) => true,
            (R::Package, R::Package) => true,
            (R::Record, R::Record | R::OperatorRecord | R::Connector | R::ExpandableConnector)
            | (R::Record, R::Model | R::Block | R::Class) => true,
            (R::Model, R::Model | R::Class) => true,
            (R::Block, R::Block | R::Model | R::Class) => true,
            (R::Connector, R::Connector | R::Model | R::Block | R::Class) => true,
            (one, other) => one == other,
        };
        if fits {
            return Ok(());
        }
        Err(fault!(
            TYPE_MISMATCH,
            "`{}` cannot extend `{}`, which is another kind of class",
            own.name,
            inherited.name
        )
        .at(span))
    }

    /// A component inherited twice is one if both are the same declaration (MLS §7.1).
    fn add_member(
        &self,
        class: ClassId,
        declaration: Declaration,
        out: &mut Collected,
    ) -> Result<(), Diagnostic> {
        let name = declaration.name;
        if let Some(known) = out.members.get(&name) {
            if known.declaration.span == declaration.span {
                return Ok(());
            }
            return Err(fault!(
                DUPLICATE_ELEMENT,
                "`{}` has two components named `{name}`",
                self.class(class).name
            )
            .at(declaration.span)
            .related(known.declaration.span, "the other one"));
        }
        let member = Member { declaration: Arc::new(declaration), state: MemberState::Pending };
        out.members.insert(name, member);
        Ok(())
    }

    fn declaration(
        &self,
        clause: &ComponentClause,
        component: &ComponentDeclaration,
        outer: Modifier,
        protected: bool,
        context: Context,
    ) -> Result<Declaration, Diagnostic> {
        refuse_prefixes(clause)?;
        let own = Modifier::new(component.modification.as_ref(), false, context)?;
        let mut modifier = own;
        let declared_final = clause.prefixes.is_final;
        modifier.is_final = declared_final;
        let is_final = declared_final || outer.is_final;
        let mut modifier = modifier.overridden_by(outer, component.name.node)?;
        modifier.is_final = false;
        let expanded = self.expand(context, &clause.type_specifier, modifier)?;
        let mut dims: Vec<(Subscript, Context)> = component
            .subscripts
            .iter()
            .chain(&clause.subscripts)
            .map(|subscript| (subscript.clone(), context))
            .collect();
        dims.extend(expanded.dims);
        Ok(Declaration {
            name: component.name.node,
            shape: expanded.shape,
            dims,
            modifier: expanded.modifier,
            condition: component.condition.clone().map(|condition| (condition, context)),
            variability: clause.type_prefixes.variability.map(|variability| match variability {
                VariabilityPrefix::Constant => Variability::Constant,
                VariabilityPrefix::Parameter => Variability::Parameter,
                VariabilityPrefix::Discrete => Variability::Discrete,
            }),
            causality: clause.type_prefixes.causality.or(expanded.causality),
            is_final,
            protected,
            evaluate: evaluates(component),
            description: component.comment.text.clone(),
            span: component.span,
        })
    }

    /// Follows the short classes of a type down to what it is made of, collecting modifiers
    /// (outer over inner) and dimensions.
    pub(super) fn expand(
        &self,
        context: Context,
        specifier: &TypeSpecifier,
        mut modifier: Modifier,
    ) -> Result<Expanded, Diagnostic> {
        let mut found = self.lookup_in(context.class, specifier)?;
        let mut dims = Vec::new();
        let mut causality = None;
        for _ in 0..MAX_DEPTH {
            let id = match found {
                Type::Predefined(predefined) => {
                    let shape = Shape::Predefined(predefined);
                    return Ok(Expanded { shape, dims, modifier, causality });
                }
                Type::Class(id) => id,
            };
            let class = self.class(id);
            let scope = Context { node: NodeId(0), class: class.parent };
            match &class.definition.specifier {
                ClassSpecifier::Enumeration(_) => {
                    let shape = Shape::Enumeration(self.enumeration(id, specifier.span)?);
                    return Ok(Expanded { shape, dims, modifier, causality });
                }
                ClassSpecifier::Short(short) => {
                    let own = Modifier::of_arguments(&short.modification, scope)?;
                    modifier = own.overridden_by(modifier, class.definition.name.node)?;
                    dims.extend(short.subscripts.iter().map(|s| (s.clone(), scope)));
                    causality = causality.or(short.prefixes.causality);
                    found = self.lookup_in(class.parent, &short.target)?;
                }
                ClassSpecifier::Long(_) => match self.predefined_base(id)? {
                    Some((base, extends)) => {
                        let scope = Context { node: NodeId(0), class: Some(id) };
                        let own = Modifier::of_arguments(&extends.modification, scope)?;
                        modifier = own.overridden_by(modifier, class.definition.name.node)?;
                        found = base;
                    }
                    None => {
                        self.check_component_class(id, specifier)?;
                        return Ok(Expanded { shape: Shape::Class(id), dims, modifier, causality });
                    }
                },
                ClassSpecifier::Derivative(_) => {
                    return Err(fault!(
                        TYPE_MISMATCH,
                        "`{}` is a function, not the type of a component",
                        class.name
                    )
                    .at(specifier.span));
                }
            }
        }
        Err(fault!(CYCLIC_CLASS, "type `{}` is defined by itself", specifier.name)
            .at(specifier.span))
    }

    /// The predefined type that a long class extends, directly or through others, if it does:
    /// `type T extends Real(…); end T;`
    fn predefined_base(&self, class: ClassId) -> Result<Option<(Type, &Extends)>, Diagnostic> {
        let found = self.class(class);
        if found.definition.restriction != Restriction::Type {
            return Ok(None);
        }
        let Some(extends) = found.extends.first() else { return Ok(None) };
        Ok(Some((self.lookup_base(class, &extends.base)?, extends)))
    }

    fn check_component_class(
        &self,
        id: ClassId,
        specifier: &TypeSpecifier,
    ) -> Result<(), Diagnostic> {
        let class = self.class(id);
        match class.definition.restriction {
            Restriction::Package | Restriction::Function { .. } | Restriction::Operator => {
                Err(fault!(TYPE_MISMATCH, "`{}` cannot be the type of a component", class.name)
                    .at(specifier.span))
            }
            Restriction::ExpandableConnector | Restriction::OperatorRecord => Err(fault!(
                NOT_SUPPORTED,
                "components of an expandable connector or an operator record, such as `{}`, are \
                 not translated yet",
                class.name
            )
            .at(specifier.span)),
            _ => Ok(()),
        }
    }

    /// The enumeration that a class declares.
    pub(super) fn enumeration(
        &self,
        id: ClassId,
        span: Span,
    ) -> Result<Arc<EnumerationDefinition>, Diagnostic> {
        let class = self.class(id);
        match &class.definition.specifier {
            ClassSpecifier::Enumeration(enumeration) => match &enumeration.literals {
                Some(literals) => Ok(Arc::new(EnumerationDefinition {
                    name: class.name.clone(),
                    literals: literals.iter().map(|literal| literal.name.node).collect(),
                })),
                None => Err(fault!(
                    NOT_SUPPORTED,
                    "`{}` is an enumeration without literals: it can only be replaced",
                    class.name
                )
                .at(span)),
            },
            _ => Err(fault!(TYPE_MISMATCH, "`{}` is no enumeration", class.name).at(span)),
        }
    }

    fn lookup_in(
        &self,
        scope: Option<ClassId>,
        specifier: &TypeSpecifier,
    ) -> Result<Type, Diagnostic> {
        self.lookup_type(scope, specifier)
    }

    fn base_class(&self, base: Type, specifier: &TypeSpecifier) -> Result<ClassId, Diagnostic> {
        match base {
            Type::Class(id) => Ok(id),
            Type::Predefined(_) => Err(fault!(
                TYPE_MISMATCH,
                "a class with components cannot extend `{}`",
                specifier.name
            )
            .at(specifier.span)),
        }
    }
}

/// What a declaration may not say yet.
fn refuse_prefixes(clause: &ComponentClause) -> Result<(), Diagnostic> {
    let prefixes = clause.prefixes;
    let what = if clause.type_prefixes.connection.is_some() {
        "flow and stream variables"
    } else if prefixes.inner || prefixes.outer {
        "inner and outer components"
    } else if prefixes.redeclare {
        "redeclarations"
    } else {
        return Ok(());
    };
    Err(fault!(NOT_SUPPORTED, "{what} are not translated yet").at(clause.span))
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
