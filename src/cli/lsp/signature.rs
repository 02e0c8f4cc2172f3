//! The inputs of a call while it is written.

use super::completion::{Context, context_at};
use super::description;
use super::document::Document;
use super::workspace::{Documents, Workspace};
use crate::flatten::{ClassId, Declared, Library, Member};
use crate::functions;
use crate::name::Name;
use crate::script::builtins;
use crate::syntax::ast::{CausalityPrefix, Restriction};
use lsp_types::{
    Documentation, ParameterInformation, ParameterLabel, Position, SignatureHelp,
    SignatureInformation,
};
use std::sync::Arc;

/// The function or record around a position, and which of its inputs is being written.
pub(crate) fn help(
    workspace: &mut Workspace,
    document: &Arc<Document>,
    all: &Documents,
    position: Position,
) -> Option<SignatureHelp> {
    let offset = document.offset(position);
    let context: Context = context_at(&document.text, offset);
    let open = context.open.last().filter(|open| !open.name.is_empty())?.clone();
    if context.in_comment {
        return None;
    }
    let parsed = workspace.open_without_line(document, all, position.line as usize);
    let class = parsed.class_at(offset).map(|(name, _)| name);
    let is_script = document.is_script() && class.is_none();
    let inputs = workspace.session.ask(|library| {
        let scope = class.as_ref().and_then(|name| library.find(name));
        of_class(library, scope, &open.name)
    });
    let inputs = match inputs {
        Some(inputs) => inputs,
        None => of_function(&open.name, is_script)?,
    };
    // A named argument counts by its name, the others by their place.
    let named = open.in_value.then(|| open.given.last()).flatten();
    let by_name = named.and_then(|name| inputs.iter().position(|input| input.name == *name));
    let active = by_name.unwrap_or(open.commas).min(inputs.len());
    let label = format!("{}({})", open.name, labels(&inputs).join(", "));
    let parameter = |input: &Input| ParameterInformation {
        label: ParameterLabel::Simple(input.label.clone()),
        documentation: input.comment.clone().map(Documentation::String),
    };
    let signature = SignatureInformation {
        label,
        documentation: None,
        parameters: Some(inputs.iter().map(parameter).collect()),
        active_parameter: Some(active as u32),
    };
    Some(SignatureHelp {
        signatures: vec![signature],
        active_signature: Some(0),
        active_parameter: Some(active as u32),
    })
}

/// An input of a function.
struct Input {
    name: String,
    /// Its declaration.
    label: String,
    comment: Option<String>,
}

fn labels(inputs: &[Input]) -> Vec<&str> {
    inputs.iter().map(|input| input.label.as_str()).collect()
}

/// The inputs of a function of Modelica, or the components of a record.
fn of_class(library: &Library, scope: Option<ClassId>, name: &str) -> Option<Vec<Input>> {
    let parts = library.parts_of_reference(scope, &Name::parse(name));
    let Some(Some(Declared::Class(class))) = parts.last() else { return None };
    let restriction = library.definition_of(*class).restriction;
    let is_function = matches!(restriction, Restriction::Function { .. });
    if !is_function && !matches!(restriction, Restriction::Record | Restriction::OperatorRecord) {
        return None;
    }
    let input = |member: &Member| {
        let Declared::Component(owner, name) = member.declared else { return None };
        let (clause, declaration) = library.component(owner, name)?;
        let is_input = clause.type_prefixes.causality == Some(CausalityPrefix::Input);
        (is_input || !is_function).then(|| Input {
            name: member.name.to_string(),
            label: description::declared(clause, declaration),
            comment: declaration.comment.text.as_deref().map(str::to_owned),
        })
    };
    Some(library.members(*class).iter().filter_map(input).collect())
}

/// The inputs of a function of the language, or in a script of a command.
fn of_function(name: &str, is_script: bool) -> Option<Vec<Input>> {
    let plain = |name: &str| Input { name: name.to_owned(), label: name.to_owned(), comment: None };
    let inputs = match functions::find(name) {
        Some(function) => function.inputs.to_vec(),
        None if is_script => builtins::inputs(name),
        None => Vec::new(),
    };
    // Elementary functions have inputs without names.
    (!inputs.is_empty()).then(|| inputs.into_iter().map(plain).collect())
}
