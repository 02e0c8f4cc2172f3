//! What a model leaves to its users: values of parameters, replaceable classes that are partial,
//! what its connectors are connected to, `inner` components around it. A class of a library is not
//! wrong because it leaves something open.

use crate::diag::Diagnostic;
use crate::flatten::{ClassId, Declared, Library};
use crate::syntax::ast::{
    CausalityPrefix, ClassSpecifier, ComponentClause, ComponentDeclaration, ConnectionPrefix,
    Restriction, VariabilityPrefix,
};

/// Errors that vanish once users of the model give a value or a class.
const OPEN: &[&str] = &["parameter-without-value", "value-needed", "partial-class"];

/// What follows from these where a declaration could not be made sense of.
const CONSEQUENCES: &[&str] =
    &["not-constant", "unknown-name", "size-mismatch", "conditional-component"];

/// Parts of the language that this program cannot treat: the model is not wrong.
const LIMITS: &[&str] = &["not-supported", "external-refused"];

/// What a model leaves open, by its declarations.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LeftOpen {
    /// Parameters without values, or replaceable partial classes.
    generic: bool,
    /// Connectors with more than outputs, or inputs.
    connectors: bool,
}

impl LeftOpen {
    /// What a model leaves open; nothing if there is none of this class.
    pub(crate) fn of(library: &Library, model: Option<ClassId>) -> LeftOpen {
        let Some(model) = model else { return LeftOpen { generic: false, connectors: false } };
        let around = std::iter::successors(Some(model), |class| library.enclosing(*class));
        let is_generic = |class| {
            library.members(class).iter().any(|member| leaves_open(library, member.declared))
        };
        let public = library.members(model).into_iter().filter(|member| !member.protected);
        LeftOpen {
            generic: around.into_iter().any(is_generic),
            connectors: public.into_iter().any(|member| is_open(library, member.declared)),
        }
    }

    /// Whether something outside is connected to it.
    pub(crate) fn is_component(self) -> bool {
        self.connectors
    }

    /// Errors and warnings without those that are not the model's fault.
    pub(crate) fn faults(self, mut found: Vec<Diagnostic>) -> Vec<Diagnostic> {
        let slug = |one: &Diagnostic| one.code.slug;
        let is_left = |one: &Diagnostic| self.generic && OPEN.contains(&slug(one));
        let is_incomplete = found.iter().any(is_left);
        found.retain(|one| {
            let follows = is_incomplete && CONSEQUENCES.contains(&slug(one));
            let is_around = self.connectors && slug(one) == "missing-inner";
            slug(one) != "parameter-without-value" && !is_left(one) && !follows && !is_around
        });
        let milder = |one: Diagnostic| match LIMITS.contains(&slug(&one)) {
            true => one.warning(),
            false => one,
        };
        found.into_iter().map(milder).collect()
    }
}

/// Whether users of a class have to specify an element of it.
fn leaves_open(library: &Library, element: Declared) -> bool {
    match element {
        Declared::Class(class) => library.is_replaceable(class) && is_partial(library, class),
        Declared::Component(owner, name) => {
            let Some((clause, declaration)) = library.component(owner, name) else { return false };
            let class = || library.class_of_declared(element);
            is_without_value(clause, declaration)
                || clause.prefixes.replaceable
                    && class().is_some_and(|one| is_partial(library, one))
        }
        Declared::Literal(..) | Declared::Predefined(_) => false,
    }
}

fn is_without_value(clause: &ComponentClause, declaration: &ComponentDeclaration) -> bool {
    let is_fixed = matches!(
        clause.type_prefixes.variability,
        Some(VariabilityPrefix::Parameter | VariabilityPrefix::Constant)
    );
    is_fixed && declaration.modification.as_ref().is_none_or(|one| one.binding.is_none())
}

/// Whether a class is partial, or short for one that is.
fn is_partial(library: &Library, class: ClassId) -> bool {
    let is_short =
        |one: &ClassId| matches!(library.definition_of(*one).specifier, ClassSpecifier::Short(_));
    let mut lineage = library.lineage(class).into_iter();
    let mut named = Vec::new();
    for one in lineage.by_ref() {
        named.push(one);
        if !is_short(&one) {
            break;
        }
    }
    named.into_iter().any(|one| library.definition_of(one).partial)
}

/// Whether a public element is an input, or a connector that is not just an output.
fn is_open(library: &Library, element: Declared) -> bool {
    let Declared::Component(owner, name) = element else { return false };
    let Some((clause, _)) = library.component(owner, name) else { return false };
    match clause.type_prefixes.causality {
        Some(causality) => return causality == CausalityPrefix::Input,
        None if clause.type_prefixes.connection == Some(ConnectionPrefix::Flow) => return true,
        None => {}
    }
    let Some(class) = library.class_of_declared(element) else { return false };
    let definition = library.definition_of(class);
    let is_output = match &definition.specifier {
        ClassSpecifier::Short(short) => short.prefixes.causality == Some(CausalityPrefix::Output),
        _ => false,
    };
    let is_connector =
        matches!(definition.restriction, Restriction::Connector | Restriction::ExpandableConnector);
    is_connector && !is_output
}
