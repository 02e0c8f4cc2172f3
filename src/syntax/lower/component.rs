//! Component clauses (MLS §A.2.4).

use super::{Lowered, class, comment, expression, ident, modification, name};
use crate::fault;
use crate::syntax::ast::{
    CausalityPrefix, ComponentClause, ComponentDeclaration, ConnectionPrefix, ElementPrefixes,
    Subscript, TypePrefixes, TypeSpecifier, VariabilityPrefix,
};
use crate::syntax::errors::SYNTAX_ERROR;
use crate::syntax::parser::{Nodes, Rule};

/// The component clause that the grammar promises next, and its constraining clause.
pub(super) fn clause(nodes: &mut Nodes<'_>, prefixes: ElementPrefixes) -> Lowered<ComponentClause> {
    let mut parts = nodes.enter(Rule::component_clause);
    let (type_prefixes, type_specifier, subscripts) = clause_head(&mut parts)?;
    let mut components = Vec::new();
    while let Some(inside) = parts.try_enter(Rule::component_declaration) {
        components.push(declaration(inside)?);
    }
    let constraint = class::constraint(nodes)?;
    Ok(ComponentClause {
        prefixes,
        type_prefixes,
        type_specifier,
        subscripts,
        components,
        constraint,
        span: parts.whole,
    })
}

/// Prefixes, type and dimensions.
pub(super) fn clause_head(
    parts: &mut Nodes<'_>,
) -> Lowered<(TypePrefixes, TypeSpecifier, Vec<Subscript>)> {
    let prefixes = type_prefixes(parts)?;
    let specifier = type_specifier(parts);
    Ok((prefixes, specifier, expression::optional_subscripts(parts)?))
}

/// The inside of a component declaration.
pub(super) fn declaration(mut parts: Nodes<'_>) -> Lowered<ComponentDeclaration> {
    let name = ident(&mut parts);
    let subscripts = expression::optional_subscripts(&mut parts)?;
    let modification = modification::modification(&mut parts)?;
    let condition = match parts.try_enter(Rule::condition_attribute) {
        Some(mut attribute) => Some(expression::expression(&mut attribute)?),
        None => None,
    };
    let comment = comment(&mut parts)?;
    let span = parts.whole;
    Ok(ComponentDeclaration { name, subscripts, modification, condition, comment, span })
}

/// The type specifier that the grammar promises next.
pub(super) fn type_specifier(nodes: &mut Nodes<'_>) -> TypeSpecifier {
    let mut inside = nodes.enter(Rule::type_specifier);
    let name = name(&mut inside);
    TypeSpecifier { name: name.node, span: name.span }
}

/// The type prefixes that come next, in any order, each kind once.
pub(super) fn type_prefixes(nodes: &mut Nodes<'_>) -> Lowered<TypePrefixes> {
    let mut prefixes = TypePrefixes::default();
    while let Some(word) = nodes.take(Rule::type_prefix) {
        let earlier = match word.as_str() {
            "flow" => prefixes.connection.replace(ConnectionPrefix::Flow).is_some(),
            "stream" => prefixes.connection.replace(ConnectionPrefix::Stream).is_some(),
            "constant" => prefixes.variability.replace(VariabilityPrefix::Constant).is_some(),
            "parameter" => prefixes.variability.replace(VariabilityPrefix::Parameter).is_some(),
            "discrete" => prefixes.variability.replace(VariabilityPrefix::Discrete).is_some(),
            "input" => prefixes.causality.replace(CausalityPrefix::Input).is_some(),
            _ => prefixes.causality.replace(CausalityPrefix::Output).is_some(),
        };
        if earlier {
            return Err(fault!(
                SYNTAX_ERROR,
                "`{}` cannot follow another prefix of the same kind",
                word.as_str()
            )
            .help("keep one of `flow`, `stream`; one of `constant`, `parameter`, `discrete`; one of `input`, `output`")
            .at(nodes.span(&word)));
        }
    }
    Ok(prefixes)
}

/// Adds the element prefix that comes next; whether one does.
pub(super) fn element_prefix(nodes: &mut Nodes<'_>, prefixes: &mut ElementPrefixes) -> bool {
    let flag = match nodes.peek() {
        Some(Rule::kw_redeclare) => &mut prefixes.redeclare,
        Some(Rule::kw_final) => &mut prefixes.is_final,
        Some(Rule::kw_inner) => &mut prefixes.inner,
        Some(Rule::kw_outer) => &mut prefixes.outer,
        Some(Rule::kw_replaceable) => &mut prefixes.replaceable,
        _ => return false,
    };
    *flag = true;
    nodes.next();
    true
}
