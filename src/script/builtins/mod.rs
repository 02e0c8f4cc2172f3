//! The commands and functions that scripts find without loading anything: each declared by a
//! header in Modelica and implemented in Rust beside it, one file per family.

mod args;
mod built_models;
mod classes;
mod clock;
mod comparison;
mod conversion;
mod data_files;
mod end_values;
mod executable;
mod extended;
pub(crate) mod extensions;
mod files;
mod final_states;
mod fmus;
mod gapilib;
mod header;
mod imported_units;
mod initial;
mod inputs;
mod installation;
mod introspection;
mod last_results;
mod linear_systems;
mod linearization;
mod loading;
mod matrices;
mod messages;
mod methods;
mod openmodelica;
mod operators;
mod output;
mod plotting;
mod problem;
mod reference;
mod refused;
mod regular;
mod result_files;
mod results;
mod scanning;
mod scripts;
mod settings;
mod signal_operators;
mod simflags;
mod simulation;
mod streams;
mod strings;
mod styles;
mod system;
mod total_model;
mod upgrade;
mod windows;

pub use args::Args;
pub(crate) use classes::component_names;
pub use reference::reference;
pub(crate) use result_files::{begin_writing, end_writing, inputs_of_files, writes_files};

use crate::diag::{Diagnostic, Fault};
use crate::eval::Function;
use crate::name::Name;
use crate::source::SourceId;
use crate::syntax;
use crate::value::Value;
use crate::{Dialect, Session};
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, OnceLock};

/// A command.
pub struct Builtin {
    /// Its declaration: a Modelica function without an algorithm. Inputs of type `TypeName` and
    /// `VariableName` are not evaluated; `annotation(optional = true)` marks those whose absence
    /// the command knows ([`Args::optional`]).
    pub header: &'static str,
    /// Its work. Returns as many values as the header has outputs: none and several as a
    /// [`Value::Tuple`].
    pub run: fn(&mut Session, Args) -> Result<Value, Failure>,
}

/// Why a command has no value.
#[derive(Debug)]
pub enum Failure {
    /// What is wrong with the call itself: its place is the call.
    Here(Fault),
    /// What went wrong in something that has places of its own, such as a script or a model.
    Elsewhere(Vec<Diagnostic>),
}

impl From<Fault> for Failure {
    fn from(fault: Fault) -> Failure {
        Failure::Here(fault)
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Failure {
        Failure::Elsewhere(vec![diagnostic])
    }
}

impl From<Vec<Diagnostic>> for Failure {
    fn from(diagnostics: Vec<Diagnostic>) -> Failure {
        Failure::Elsewhere(diagnostics)
    }
}

/// The commands of one file.
pub struct Family {
    /// Packages through which they can be named in full.
    pub packages: &'static [&'static str],
    /// The dialect in which their bare names come first; `None` where both agree.
    pub dialect: Option<Dialect>,
    /// The commands.
    pub builtins: &'static [Builtin],
}

/// All families. Where a bare name occurs more than once, the session's dialect decides, then the
/// order here.
pub static FAMILIES: &[&Family] = &[
    &classes::FAMILY,
    &clock::FAMILY,
    &clock::FILES,
    &comparison::FAMILY,
    &conversion::FAMILY,
    &data_files::FAMILY,
    &executable::FAMILY,
    &extended::FAMILY,
    &files::FAMILY,
    &files::OPENMODELICA,
    &fmus::FAMILY,
    &fmus::OPENMODELICA,
    &gapilib::FAMILY,
    &operators::FAMILY,
    &problem::FAMILY,
    &initial::FAMILY,
    &installation::FAMILY,
    &installation::DYMOLA,
    &introspection::FAMILY,
    &introspection::KINDS,
    &linearization::FAMILY,
    &linear_systems::FAMILY,
    &linear_systems::PICTURES,
    &linear_systems::RECORDS,
    &linearization::OPENMODELICA,
    &loading::FAMILY,
    &loading::OPENMODELICA,
    &matrices::FAMILY,
    &messages::FAMILY,
    &openmodelica::FAMILY,
    &output::FAMILY,
    &plotting::FAMILY,
    &plotting::OPENMODELICA,
    &refused::FAMILY,
    &regular::FAMILY,
    &results::FAMILY,
    &results::OPENMODELICA,
    &scripts::FAMILY,
    &scripts::OPENMODELICA,
    &settings::FAMILY,
    &settings::LIST_FAMILY,
    &signal_operators::FAMILY,
    &simulation::FAMILY,
    &streams::FAMILY,
    &streams::BARE_PRINT,
    &system::FAMILY,
    &total_model::FAMILY,
    &system::DYMOLA,
    &system::OPENMODELICA,
    &upgrade::FAMILY,
    &windows::FAMILY,
    // Last: its names are short words that other families use too.
    &strings::FAMILY,
    &scanning::FAMILY,
];

/// One entry of the table: the command with its family; the header is parsed when first needed.
struct Known {
    family: &'static Family,
    builtin: &'static Builtin,
    function: OnceLock<Arc<Function>>,
}

static TABLE: LazyLock<Vec<Known>> = LazyLock::new(|| {
    let of = |family: &'static &'static Family| {
        family.builtins.iter().map(|builtin| Known { family, builtin, function: OnceLock::new() })
    };
    FAMILIES.iter().flat_map(of).collect()
});

static BY_NAME: LazyLock<HashMap<&'static str, Vec<usize>>> = LazyLock::new(|| {
    let mut by_name: HashMap<&'static str, Vec<usize>> = HashMap::new();
    for (at, known) in TABLE.iter().enumerate() {
        by_name.entry(known.builtin.name()).or_default().push(at);
    }
    by_name
});

/// A command by its place in the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct BuiltinId(usize);

impl Builtin {
    /// The name that the header declares.
    pub fn name(&self) -> &'static str {
        let header = self.header.trim_start();
        let rest = header.strip_prefix("function").unwrap_or(header).trim_start();
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        &rest[..end]
    }
}

impl BuiltinId {
    /// The command whose header this is.
    pub(super) fn of(header: &Arc<Function>) -> Option<BuiltinId> {
        let candidates = BY_NAME.get(header.name.last()?.as_str())?;
        let is_it = |at: &usize| TABLE[*at].function.get().is_some_and(|f| Arc::ptr_eq(f, header));
        candidates.iter().copied().find(is_it).map(BuiltinId)
    }

    /// The header as a function, parsed once.
    pub(super) fn function(self) -> Arc<Function> {
        let known = &TABLE[self.0];
        known.function.get_or_init(|| Arc::new(parsed(known.builtin))).clone()
    }

    /// The packages through which it can be named in full.
    pub(super) fn packages(self) -> &'static [&'static str] {
        TABLE[self.0].family.packages
    }

    /// The declaration as written.
    pub(super) fn header(self) -> &'static str {
        TABLE[self.0].builtin.header
    }

    /// Runs the command.
    pub(super) fn run(
        self,
        session: &mut Session,
        arguments: Vec<Value>,
    ) -> Result<Value, Failure> {
        let args = Args::new(self.function(), arguments);
        (TABLE[self.0].builtin.run)(session, args)
    }
}

/// The command that `name` means in `dialect`: by its bare name, or in full through one of its
/// family's packages (any package of `DymolaCommands` or `OpenModelica.Scripting` for a command
/// that has no package of its own).
pub(super) fn find(name: &Name, dialect: Dialect) -> Option<BuiltinId> {
    let candidates = BY_NAME.get(name.last()?.as_str())?;
    if name.parts.len() > 1 {
        let package = Name::new(name.parent().parts).to_string();
        let belongs = |family: &Family| {
            family.packages.contains(&package.as_str())
                || package.starts_with("DymolaCommands.")
                    && family.dialect != Some(Dialect::OpenModelica)
                || package == "OpenModelica.Scripting" && family.dialect != Some(Dialect::Dymola)
        };
        return candidates.iter().copied().find(|at| belongs(TABLE[*at].family)).map(BuiltinId);
    }
    let rank = |at: &usize| match TABLE[*at].family.dialect {
        Some(own) if own == dialect => 0,
        None => 1,
        Some(_) => 2,
    };
    candidates.iter().copied().min_by_key(rank).map(BuiltinId)
}

/// Whether `package` is a package of commands, or holds one.
pub(super) fn is_package(package: &str) -> bool {
    let within = |known: &str| {
        known.strip_prefix(package).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    package == "DymolaCommands"
        || package.starts_with("DymolaCommands.")
        || package == "OpenModelica.Scripting"
        || FAMILIES.iter().flat_map(|family| family.packages).any(|known| within(known))
}

/// The bare names of all commands, sorted.
pub fn names() -> Vec<&'static str> {
    let mut names: Vec<&'static str> = TABLE.iter().map(|known| known.builtin.name()).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// The declarations of the commands of this name, one for each dialect that has its own.
pub fn declarations(name: &str) -> Vec<String> {
    let last = name.rsplit('.').next().unwrap_or(name);
    let found = BY_NAME.get(last).map_or(&[][..], Vec::as_slice);
    let text = |at: &usize| TABLE[*at].builtin.header.replace(" annotation(optional = true)", "");
    let of_language = || crate::functions::names().any(|known| known == name);
    if found.is_empty() && of_language() {
        return vec![format!("`{name}` is a function of the language: MLS §3.7, §10.3, §12.9")];
    }
    found.iter().map(|at| text(at).trim().to_owned()).collect()
}

/// The inputs of the commands of this name.
pub fn inputs(name: &str) -> Vec<&'static str> {
    let last = name.rsplit('.').next().unwrap_or(name);
    let found = BY_NAME.get(last).map_or(&[][..], Vec::as_slice).iter();
    let mut names: Vec<&'static str> = found
        .flat_map(|at| {
            BuiltinId(*at).function().inputs.iter().map(|i| i.name.as_str()).collect::<Vec<_>>()
        })
        .collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// The literal of an enumeration that scripts find without loading anything.
pub(super) fn constant(name: &Name) -> Option<Value> {
    strings::constant(name).or_else(|| styles::literal(name))
}

/// The packages of commands, sorted.
pub(super) fn packages() -> Vec<&'static str> {
    let mut packages: Vec<&'static str> =
        FAMILIES.iter().flat_map(|family| family.packages).copied().collect();
    packages.sort_unstable();
    packages.dedup();
    packages
}

fn parsed(builtin: &Builtin) -> Function {
    let stored = syntax::parse_stored_definition(SourceId::NONE, builtin.header);
    match stored.as_ref().map(|stored| stored.classes.as_slice()) {
        Ok([class]) => header::function(class),
        _ => panic!("the header of `{}` is Modelica: a test parses all", builtin.name()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_header_declares_the_name_it_is_found_by() {
        for known in TABLE.iter() {
            let function = parsed(known.builtin);
            assert_eq!(function.name.to_string(), known.builtin.name());
            assert!(function.description.is_some(), "{} has no description", function.name);
        }
    }

    /// A letter is missing in the name of a command or of an input.
    #[test]
    fn slips_in_names_of_commands_and_inputs_are_answered() {
        let mut session = Session::new(Box::new(crate::world::MemoryWorld::new()));
        let mut said = |dialect, call: &str| {
            session.options.dialect = Some(dialect);
            session.output.transcript = Some(crate::Transcript::default());
            session.run_text("s.mos", &format!("{call};\n"));
            session.output.transcript.take().unwrap_or_default().to_string()
        };
        let slip = |name: &str| format!("{}{}", &name[..1], &name[2..]);
        let mut silent = Vec::new();
        let of_dialect = |dialect| {
            names().into_iter().filter(|name| name.len() > 3).filter_map(move |name| {
                Some((dialect, name, find(&Name::parse(name), dialect)?.function()))
            })
        };
        let all = of_dialect(Dialect::Dymola).chain(of_dialect(Dialect::OpenModelica));
        for (dialect, name, function) in all {
            let known = |own: &str| {
                inputs(own).is_empty() && !crate::functions::names().any(|known| known == own)
            };
            let mut calls = Vec::new();
            calls.extend(Some(format!("{}()", slip(name))).filter(|_| known(&slip(name))));
            let given: Vec<&str> = function.inputs.iter().map(|own| own.name.as_str()).collect();
            let is_new = |own: &String| !given.contains(&own.as_str());
            let slips = given.iter().filter(|own| own.len() > 3).map(|own| slip(own));
            calls.extend(slips.filter(is_new).map(|own| format!("{name}({own} = 1)")));
            let is_silent = |call: &String| !said(dialect, call).contains("did you mean");
            silent.extend(calls.into_iter().filter(is_silent));
        }
        assert!(silent.is_empty(), "{silent:?}");
    }

    #[test]
    fn a_bare_name_follows_the_dialect_and_a_full_one_its_package() {
        let header = |name: &str, dialect| {
            find(&Name::parse(name), dialect).map(|id| id.function().inputs[0].name.as_str())
        };
        assert_eq!(header("print", Dialect::Dymola), Some("string"));
        assert_eq!(header("print", Dialect::OpenModelica), Some("str"));
        let full = "Modelica.Utilities.Streams.print";
        assert_eq!(header(full, Dialect::OpenModelica), Some("string"));
        assert_eq!(header("Modelica.Utilities.Strings.print", Dialect::Dymola), None);
    }
}
