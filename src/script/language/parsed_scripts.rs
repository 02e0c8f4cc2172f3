//! Scripts as they were read, each once as long as its file stays as it is.

use crate::diag::Diagnostic;
use crate::options::Dialect;
use crate::source::SourceId;
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, InteractiveKind,
    InteractiveStatement,
};
use crate::syntax::visit::{Visit, walk_expression, walk_modification};
use crate::syntax::{RUN_COMMAND, ScriptParts};
use crate::world::Stamp;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What a call says about the dialect of the script that contains it.
#[derive(Debug)]
enum Sign {
    /// Only this dialect has such a call.
    Of(Dialect),
    /// `runScript`, which is how OpenModelica writes it: the script that it names shows more.
    Runs(Option<Arc<str>>),
}

/// The most signs collected from one piece of a script: the first that is certain decides.
const MAX_SIGNS: usize = 64;

/// A script that was read.
pub(crate) struct Parsed {
    /// Its statements.
    pub parts: ScriptParts,
    signs: Vec<Sign>,
}

impl Parsed {
    /// # Errors
    /// What is wrong with the text.
    pub(crate) fn read(source: SourceId, text: &str) -> Result<Parsed, Diagnostic> {
        let (parts, signs) = ScriptParts::read(source, text, signs_of)?;
        Ok(Parsed { parts, signs })
    }

    /// The dialect that the script itself shows: that of the first call that only one of them has.
    pub(crate) fn dialect(&self) -> Option<Dialect> {
        self.signs.iter().find_map(|sign| match sign {
            Sign::Of(dialect) => Some(*dialect),
            Sign::Runs(_) => None,
        })
    }

    /// The dialect of a script that shows none but in the word for running others.
    pub(crate) fn dialect_of_running(&self) -> Option<Dialect> {
        let runs = self.signs.iter().any(|sign| matches!(sign, Sign::Runs(_)));
        runs.then_some(Dialect::OpenModelica)
    }

    /// The scripts that it runs by `runScript`, as far as they are named by literals.
    pub(crate) fn scripts_run(&self) -> impl Iterator<Item = &Arc<str>> {
        self.signs.iter().filter_map(|sign| match sign {
            Sign::Runs(name) => name.as_ref(),
            Sign::Of(_) => None,
        })
    }
}

/// The folder of the calling script, the working directory, and the name that was called.
pub(crate) type Call = (PathBuf, PathBuf, String);

/// Scripts read before, by path, each valid as long as the file's stamp stays; and the paths that
/// names led to.
#[derive(Default)]
pub(crate) struct ParsedScripts {
    by_path: HashMap<PathBuf, (Option<Stamp>, Arc<Parsed>)>,
    found: HashMap<Call, PathBuf>,
}

impl ParsedScripts {
    /// The script at a path whose file has this stamp, if it was read.
    pub(crate) fn get(&self, path: &Path, stamp: Option<Stamp>) -> Option<Arc<Parsed>> {
        let (known, script) = self.by_path.get(path)?;
        (*known == stamp && stamp.is_some()).then(|| script.clone())
    }

    /// Keeps a script for the next call.
    pub(crate) fn keep(&mut self, path: &Path, stamp: Option<Stamp>, script: &Arc<Parsed>) {
        self.by_path.insert(path.to_path_buf(), (stamp, script.clone()));
    }

    /// Where a call led to before.
    pub(crate) fn found(&self, call: &Call) -> Option<&PathBuf> {
        self.found.get(call)
    }

    /// Keeps where a call led to.
    pub(crate) fn keep_found(&mut self, call: Call, path: PathBuf) {
        self.found.insert(call, path);
    }
}

/// The signs of some statements.
fn signs_of(statements: &[InteractiveStatement]) -> Vec<Sign> {
    let mut signs = Signs::default();
    for statement in statements {
        if signs.found.len() >= MAX_SIGNS {
            break;
        }
        match &statement.kind {
            InteractiveKind::Statement(statement) => signs.statement(statement),
            InteractiveKind::Expression(expression) => signs.expression(expression),
            InteractiveKind::Declaration(clause) => {
                let modifications =
                    clause.components.iter().filter_map(|c| c.modification.as_ref());
                modifications.for_each(|modification| walk_modification(&mut signs, modification));
            }
            InteractiveKind::Command { name, .. } if &*name.node == RUN_COMMAND => {
                signs.found.push(Sign::Of(Dialect::Dymola));
            }
            _ => {}
        }
    }
    signs.found
}

#[derive(Default)]
struct Signs {
    found: Vec<Sign>,
}

impl Visit for Signs {
    fn expression(&mut self, expression: &Expression) {
        if let ExpressionKind::Call { function, arguments } = &expression.kind {
            self.found.extend(sign_of(function, arguments));
        }
        walk_expression(self, expression);
    }
}

/// What a call says about the dialect, if anything.
fn sign_of(function: &ComponentReference, arguments: &Arguments) -> Option<Sign> {
    match function.parts.first()?.name.as_str() {
        "OpenModelica" => return Some(Sign::Of(Dialect::OpenModelica)),
        "DymolaCommands" => return Some(Sign::Of(Dialect::Dymola)),
        _ => {}
    }
    let first = arguments.positional.first();
    let has_class = first.is_some_and(|first| matches!(&first.kind, ExpressionKind::Reference(_)));
    match function.as_ident()?.as_str() {
        "loadModel"
        | "getErrorString"
        | "loadString"
        | "buildModel"
        | "setCommandLineOptions"
        | "instantiateModel"
        | "loadFile" => Some(Sign::Of(Dialect::OpenModelica)),
        "simulate" | "checkModel" if has_class => Some(Sign::Of(Dialect::OpenModelica)),
        "simulateModel" | "translateModel" | "RunScript" | "openModel" => {
            Some(Sign::Of(Dialect::Dymola))
        }
        "runScript" => {
            let named = arguments.named.iter().find(|named| named.name.node == "fileName");
            let script = first.or(named.map(|named| &named.value));
            let literal = script.and_then(|script| match &script.kind {
                ExpressionKind::String(name) => Some(name.clone()),
                _ => None,
            });
            Some(Sign::Runs(literal))
        }
        _ => None,
    }
}
