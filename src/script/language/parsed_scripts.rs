//! Scripts as they were read, each once as long as its file stays as it is.

use crate::diag::Diagnostic;
use crate::script::options::Dialect;
use crate::script::world::Stamp;
use crate::source::SourceId;
use crate::syntax::ScriptParts;
use crate::syntax::ast::{Expression, ExpressionKind, InteractiveKind, StatementKind};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A script that was read.
pub struct Parsed {
    /// Its statements.
    pub parts: ScriptParts,
    /// The dialect that it shows: that of the first call or `=` that only one of them has.
    pub dialect: Option<Dialect>,
}

impl Parsed {
    /// # Errors
    /// What is wrong with the text.
    pub fn read(source: SourceId, text: &str) -> Result<Parsed, Diagnostic> {
        let (parts, dialect) = ScriptParts::read(source, text, |one| dialect_of(&one.kind))?;
        Ok(Parsed { parts, dialect })
    }
}

/// The folder of the calling script, the working directory, and the name that was called.
pub type Call = (PathBuf, PathBuf, String);

/// Scripts read before, by path, each valid as long as the file's stamp stays; and the paths that
/// names led to.
#[derive(Default)]
pub struct ParsedScripts {
    by_path: HashMap<PathBuf, (Option<Stamp>, Arc<Parsed>)>,
    found: HashMap<Call, PathBuf>,
}

impl ParsedScripts {
    /// The script at a path whose file has this stamp, if it was read.
    pub fn get(&self, path: &Path, stamp: Option<Stamp>) -> Option<Arc<Parsed>> {
        let (known, script) = self.by_path.get(path)?;
        (*known == stamp && stamp.is_some()).then(|| script.clone())
    }

    /// Keeps a script for the next call.
    pub fn keep(&mut self, path: &Path, stamp: Option<Stamp>, script: &Arc<Parsed>) {
        self.by_path.insert(path.to_path_buf(), (stamp, script.clone()));
    }

    /// Where a call led to before.
    pub fn found(&self, call: &Call) -> Option<&PathBuf> {
        self.found.get(call)
    }

    /// Keeps where a call led to.
    pub fn keep_found(&mut self, call: Call, path: PathBuf) {
        self.found.insert(call, path);
    }
}

/// The dialect that a statement shows, if only one of them has it.
fn dialect_of(kind: &InteractiveKind) -> Option<Dialect> {
    let call = match kind {
        InteractiveKind::Expression(expression) => expression,
        InteractiveKind::Statement(statement) => match &statement.kind {
            StatementKind::Assign { value, .. } | StatementKind::Call(value) => value,
            _ => return None,
        },
        _ => return None,
    };
    let Expression { kind: ExpressionKind::Call { function, arguments }, .. } = call else {
        return None;
    };
    let has_class = arguments
        .positional
        .first()
        .is_some_and(|first| matches!(&first.kind, ExpressionKind::Reference(_)));
    match function.parts.first()?.name.as_str() {
        "OpenModelica" => return Some(Dialect::OpenModelica),
        "DymolaCommands" => return Some(Dialect::Dymola),
        _ => {}
    }
    match function.as_ident()?.as_str() {
        "loadModel"
        | "getErrorString"
        | "loadString"
        | "buildModel"
        | "setCommandLineOptions"
        | "instantiateModel"
        | "loadFile" => Some(Dialect::OpenModelica),
        "simulate" | "checkModel" if has_class => Some(Dialect::OpenModelica),
        "simulateModel" | "translateModel" | "RunScript" | "openModel" => Some(Dialect::Dymola),
        _ => None,
    }
}
