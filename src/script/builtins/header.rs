//! Headers of commands: Modelica function declarations as [`Function`]s.

use super::args::NOT_GIVEN;
use crate::eval::{Function, FunctionBody, FunctionComponent, ValueType};
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{
    Argument, Binding, CausalityPrefix, ClassDefinition, ClassSpecifier, ComponentClause,
    ComponentDeclaration, Element, Expression, ExpressionKind, Section,
};

/// The function that a header declares. Types other than the predefined ones stand for
/// themselves: `TypeName`, `VariableName`, `Expression`, and `Any` for whatever is given.
pub(super) fn function(class: &ClassDefinition) -> Function {
    let mut function = Function {
        name: Name::from(class.name.node),
        inputs: Vec::new(),
        outputs: Vec::new(),
        locals: Vec::new(),
        body: FunctionBody::Algorithm(Vec::new()),
        description: None,
        annotation: Vec::new(),
        impure: true,
        span: Span::NONE,
    };
    let ClassSpecifier::Long(long) = &class.specifier else { return function };
    function.description = long.description.clone();
    for section in &long.sections {
        if let Section::Annotation(annotation) = section {
            function.annotation.extend(annotation.arguments.iter().cloned());
        }
        let Section::Elements { elements, .. } = section else { continue };
        for element in elements {
            let Element::Component(clause) = element else { continue };
            let components = clause.components.iter().map(|one| component(clause, one));
            match clause.type_prefixes.causality {
                Some(CausalityPrefix::Output) => function.outputs.extend(components),
                _ => function.inputs.extend(components),
            }
        }
    }
    function
}

fn component(clause: &ComponentClause, declaration: &ComponentDeclaration) -> FunctionComponent {
    let optional = is_optional(declaration);
    let binding = match declaration.modification.as_ref().and_then(|m| m.binding.as_ref()) {
        _ if optional => {
            Some(Expression::new(ExpressionKind::String(NOT_GIVEN.into()), Span::NONE))
        }
        Some(Binding::Expression(expression)) => Some(expression.clone()),
        _ => None,
    };
    FunctionComponent {
        name: declaration.name.node,
        value_type: if optional { ValueType::Any } else { value_type(clause) },
        dims: if optional {
            Vec::new()
        } else {
            [clause.subscripts.as_slice(), &declaration.subscripts].concat()
        },
        field_dims: Vec::new(),
        binding,
        description: declaration.comment.text.clone(),
        span: Span::NONE,
    }
}

fn value_type(clause: &ComponentClause) -> ValueType {
    match clause.type_specifier.name.last().map(|name| name.as_str()) {
        Some("Real") => ValueType::Real,
        Some("Integer") => ValueType::Integer,
        Some("Boolean") => ValueType::Boolean,
        Some("String") => ValueType::String,
        Some("TypeName") => ValueType::TypeName,
        Some("VariableName") => ValueType::VariableName,
        Some("Expression") => ValueType::Expression,
        _ => ValueType::Any,
    }
}

/// Whether the input carries `annotation(optional = true)`: then the command knows whether it
/// was given.
fn is_optional(declaration: &ComponentDeclaration) -> bool {
    let Some(annotation) = &declaration.comment.annotation else { return false };
    annotation.arguments.iter().any(|argument| match argument {
        Argument::Element(element) => {
            element.name.node.is_simple()
                && element.name.node.first().is_some_and(|name| name == "optional")
        }
        Argument::Redeclaration(_) => false,
    })
}
