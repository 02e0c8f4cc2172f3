//! Commands above models: an editor that has them runs a simulation.

use super::document::Document;
use super::parsed::Parsed;
use crate::source::Span;
use crate::syntax::ast::Restriction;
use lsp_types::{CodeLens, Command};
use serde_json::json;

/// The command that simulates a model: its arguments are the file and the class.
pub(crate) const SIMULATE: &str = "gapilib.simulate";

/// The command that runs a problem file: its argument is the file.
pub(crate) const IDENTIFY: &str = "gapilib.identify";

/// The lens above a problem file.
pub(crate) fn problem(document: &Document) -> Vec<CodeLens> {
    let Some(path) = document.path.as_ref().filter(|_| document.is_problem()) else {
        return Vec::new();
    };
    let command = Command {
        title: "identify".to_owned(),
        command: IDENTIFY.to_owned(),
        arguments: Some(vec![json!(path.display().to_string())]),
    };
    vec![CodeLens { range: document.range(0..0), command: Some(command), data: None }]
}

/// A lens above each model and block that is not partial, in a file that was saved once.
pub(crate) fn models(parsed: &Parsed) -> Vec<CodeLens> {
    let document = &parsed.document;
    let Some(path) = document.path.as_ref().filter(|_| !document.is_script()) else {
        return Vec::new();
    };
    let all = parsed.all_classes().into_iter().filter(|(_, class)| {
        matches!(class.restriction, Restriction::Model | Restriction::Block) && !class.partial
    });
    let lens = |name: String, span: Span| CodeLens {
        range: document.range(span.start as usize..span.end as usize),
        command: Some(Command {
            title: "simulate".to_owned(),
            command: SIMULATE.to_owned(),
            arguments: Some(vec![json!(path.display().to_string()), json!(name)]),
        }),
        data: None,
    };
    all.map(|(name, class)| lens(name.to_string(), class.name.span)).collect()
}
