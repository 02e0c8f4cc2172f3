//! Files and options given to a command that does not take them: what the file is, and which command
//! takes it. The ending decides, before the file is read as something else; endings of both tables and
//! traces, such as `.txt`, decide nothing.

use super::args::Command;
use super::session::is_class;
use super::terminal;
use crate::diag::Fault;
use crate::registry::BAD_OPTION;
use crate::script::errors::FILE_ERROR;
use crate::source::{SourceMap, Span};
use clap::Error;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use std::path::Path;

/// What a file contains.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FileKind {
    Problem,
    Model,
    Script,
    Table,
}

impl FileKind {
    fn of(path: &Path) -> Option<FileKind> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        Some(match ending.as_str() {
            "toml" => FileKind::Problem,
            "mo" => FileKind::Model,
            "mos" => FileKind::Script,
            "csv" | "tsv" | "mat" | "xlsx" => FileKind::Table,
            _ => return None,
        })
    }

    fn name(self) -> &'static str {
        match self {
            FileKind::Problem => "a problem file",
            FileKind::Model => "a file of Modelica classes",
            FileKind::Script => "a script",
            FileKind::Table => "a table of data",
        }
    }

    /// Commands for a file of this kind, given to a command that takes another.
    fn commands(self, path: &Path, expected: FileKind) -> String {
        let file = path.display();
        match self {
            FileKind::Problem => format!("estimate its parameters: `gapi identify {file}`"),
            FileKind::Model if matches!(expected, FileKind::Problem | FileKind::Table) => {
                format!("draft a problem file for it: `gapi new DATA.csv --model {file}`")
            }
            FileKind::Model => {
                format!("simulate it, `gapi simulate {file}`, or check it, `gapi check {file}`")
            }
            FileKind::Script => format!("run it: `gapi run {file}`"),
            FileKind::Table => {
                format!("draft a problem file for it: `gapi new {file} --model MODEL.mo`")
            }
        }
    }
}

/// Why a command cannot take one of its files.
pub(super) fn refusal(command: &Command) -> Option<String> {
    let fault = match command {
        Command::Run(arguments) => other_kind(arguments.script.as_deref()?, FileKind::Script),
        Command::Identify(arguments) => {
            let mut all = std::iter::once(&arguments.problem).chain(&arguments.others);
            all.find_map(|path| {
                unfinished_name(path).or_else(|| other_kind(path, FileKind::Problem))
            })
        }
        Command::Estimate(arguments) => other_kind(&arguments.problem, FileKind::Problem),
        Command::Teach(arguments) => other_kind(&arguments.run.input, FileKind::Script),
        Command::New(arguments) => {
            other_kind(&arguments.data, FileKind::Table).or_else(|| missing_model(&arguments.model))
        }
        Command::Report(arguments) => no_results(arguments.folder.as_deref()?),
        Command::Simulate(arguments) => {
            arguments.files.iter().find_map(|path| other_kind(path, FileKind::Model))
        }
        Command::Linearize(arguments) => {
            arguments.files.iter().find_map(|path| other_kind(path, FileKind::Model))
        }
        Command::Flatten(arguments) => {
            arguments.files.iter().find_map(|path| other_kind(path, FileKind::Model))
        }
        _ => None,
    }?;
    Some(terminal::rendered(&fault.at(Span::NONE), &SourceMap::default()))
}

fn other_kind(path: &Path, expected: FileKind) -> Option<Fault> {
    let kind = FileKind::of(path).filter(|kind| *kind != expected && path.is_file())?;
    let (file, name, expected_name) = (path.display(), kind.name(), expected.name());
    Some(
        Fault::new(BAD_OPTION, format!("`{file}` is {name}, not {expected_name}"))
            .help(kind.commands(path, expected)),
    )
}

/// A problem named without its ending, or by its folder.
fn unfinished_name(path: &Path) -> Option<Fault> {
    let full = path.with_added_extension("toml");
    if path.is_dir() {
        let names = super::disk::list_named(path).unwrap_or_default();
        let problems: Vec<String> = names
            .into_iter()
            .map(|name| path.join(name))
            .filter(|path| FileKind::of(path) == Some(FileKind::Problem))
            .map(|path| format!("`{}`", path.display()))
            .collect();
        let help = match problems.as_slice() {
            [] => "give a problem file; this folder has none".to_owned(),
            all => format!("give a problem file; this folder has {}", all.join(", ")),
        };
        let message = format!("`{}` is a folder, not a problem file", path.display());
        return Some(Fault::new(BAD_OPTION, message).help(help));
    }
    (!path.exists() && full.is_file()).then(|| {
        Fault::new(FILE_ERROR, format!("there is no file `{}`", path.display()))
            .help(format!("did you mean `{}`?", full.display()))
    })
}

/// A model that is neither a file nor the name of a class.
fn missing_model(model: &Path) -> Option<Fault> {
    let is_named = model.exists() || is_class(&model.to_string_lossy());
    (!is_named).then(|| {
        Fault::new(FILE_ERROR, format!("there is no file `{}`", model.display()))
            .help("give a Modelica file or folder, or the name of a library class")
    })
}

fn no_results(path: &Path) -> Option<Fault> {
    let kind = FileKind::of(path).filter(|_| path.is_file())?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let message = format!("`{}` is {}, not a folder of results", path.display(), kind.name());
    Some(
        Fault::new(BAD_OPTION, message).help(format!(
            "give the folder that the run has written: `gapi report results/{name}`"
        )),
    )
}

/// Options that users look for at the command line, and where a problem file has them.
const IN_PROBLEM_FILES: [(&str, &str); 6] = [
    (
        "--seed",
        "`seed = [1, 2, 3, 4, 5, 6]` in the problem file, or `--searches N` for N searches with different seeds",
    ),
    ("--method", "`[method]` in the problem file, and below it `name = \"levenberg_marquardt\"`"),
    ("--fitness", "`fitness = \"huber\"` in the problem file"),
    ("--generations", "`[stop]` in the problem file, and below it `generations = 100`"),
    ("--stop-time", "`stop_time = 600` in the `[[experiment]]` of the problem file"),
    ("--model", "`model = \"Class\"` and `files = [\"Class.mo\"]` in the problem file"),
];

/// A wrong command line with what to write instead, where that is known.
pub(super) fn explained(mut error: Error) -> Error {
    let text = |error: &Error, kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.clone()),
        _ => None,
    };
    let remedy = match error.kind() {
        ErrorKind::InvalidSubcommand => {
            text(&error, ContextKind::InvalidSubcommand).and_then(|given| {
                let path = Path::new(&given);
                let kind = FileKind::of(path).filter(|_| path.is_file())?;
                Some(kind.commands(path, kind))
            })
        }
        ErrorKind::UnknownArgument => text(&error, ContextKind::InvalidArg)
            .and_then(|given| argument_remedy(&given, std::env::args().nth(1)?.as_str())),
        _ => None,
    };
    if let Some(remedy) = remedy {
        error.remove(ContextKind::SuggestedSubcommand);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![remedy.into()]));
    }
    error
}

fn argument_remedy(given: &str, command: &str) -> Option<String> {
    match command {
        "identify" => {
            let (_, place) = IN_PROBLEM_FILES.iter().find(|(option, _)| *option == given)?;
            Some(format!("write {place}"))
        }
        "new" if FileKind::of(Path::new(given)) == Some(FileKind::Model) => {
            Some(format!("write `--model {given}`"))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_problem_files_are_named_for_identify_only() {
        assert!(argument_remedy("--seed", "identify").is_some_and(|help| help.contains("seed =")));
        assert_eq!(argument_remedy("--seed", "run"), None);
        assert_eq!(argument_remedy("M.mo", "new"), Some("write `--model M.mo`".to_owned()));
        assert_eq!(argument_remedy("more.csv", "new"), None);
    }
}
