//! The functions that a flat model calls, as text in front of it.

use super::{comment, indented};
use crate::eval::{Function, FunctionBody, FunctionComponent};
use crate::syntax::ast::{External, Subscript};
use crate::syntax::print;

/// Whether a function is another name of one that every reader of the text knows.
pub(super) fn is_of_language(function: &Function) -> bool {
    match &function.body {
        FunctionBody::External(external) => external.language.as_deref() == Some("builtin"),
        _ => false,
    }
}

/// A function as Modelica.
pub(super) fn function_text(function: &Function) -> String {
    let name = &function.name;
    let description = match (&function.description, &function.body) {
        (None, FunctionBody::RecordConstructor) => {
            format!(" \"Automatically generated record constructor for {name}\"")
        }
        (description, _) => comment(description.as_deref()),
    };
    let mut text = format!("function {name}{description}\n");
    let groups = [
        ("input", &function.inputs),
        ("output", &function.outputs),
        ("protected", &function.locals),
    ];
    for (prefix, components) in groups {
        components.iter().for_each(|component| text += &declaration(prefix, component));
    }
    match &function.body {
        FunctionBody::Algorithm(statements) => {
            text += "algorithm\n";
            statements.iter().for_each(|statement| text += &indented(&print::statement(statement)));
        }
        FunctionBody::External(external) => text += &format!("\n  {};\n", external_text(external)),
        FunctionBody::PartialDerivative { of, by } => {
            let by: Vec<&str> = by.iter().map(|input| input.as_str()).collect();
            return format!("function {name} = der({of}, {});\n\n", by.join(", "));
        }
        FunctionBody::RecordConstructor => {}
    }
    format!("{text}end {name};\n\n")
}

fn declaration(prefix: &str, component: &FunctionComponent) -> String {
    let sizes: Vec<String> = component
        .dims
        .iter()
        .map(|dim| match dim {
            Subscript::All(_) => ":".to_owned(),
            Subscript::Index(size) => print::expression(size),
        })
        .collect();
    let sizes = if sizes.is_empty() { String::new() } else { format!("[{}]", sizes.join(", ")) };
    let value = component.binding.as_ref().map(print::expression);
    let value = value.map_or(String::new(), |value| format!(" = {value}"));
    format!(
        "  {prefix} {}{sizes} {}{value}{};\n",
        component.value_type.name(),
        component.name,
        comment(component.description.as_deref())
    )
}

fn external_text(external: &External) -> String {
    let language = external.language.as_deref().unwrap_or("C");
    let result = external.output.as_ref().map(|to| format!("{} = ", print::reference(to)));
    let call = external.function.as_ref().map(|function| {
        let arguments: Vec<String> = external.arguments.iter().map(print::expression).collect();
        format!(" {}{}({})", result.unwrap_or_default(), function.node, arguments.join(", "))
    });
    format!("external \"{language}\"{}", call.unwrap_or_default())
}
