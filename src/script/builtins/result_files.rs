//! The files that commands are going to write. Their names are known before a command begins, so that
//! whatever fails, the older file is not read as if the command had written it.

use super::{executable, last_results, simulation};
use crate::Session;
use crate::diag::Diagnostic;
use crate::eval::Function;
use crate::name::Ident;
use crate::value::{FromValue, RealMatrix, Value};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is going to be written.
struct Expected {
    /// The files, the one with the results first.
    files: Vec<PathBuf>,
    /// The class that is simulated, if one is.
    problem: Option<String>,
}

/// The commands being executed that write files, innermost last.
#[derive(Default)]
struct Begun(Vec<Writing>);

struct Writing {
    command: &'static str,
    expected: Expected,
    /// The paths of its files.
    paths: Vec<PathBuf>,
    /// The number of the first message after it began.
    first_message: usize,
}

/// What a command is given.
struct Given<'a> {
    header: &'a Function,
    values: &'a [Option<Value>],
}

impl Given<'_> {
    fn has(&self, name: &str) -> bool {
        self.header.inputs.iter().any(|input| input.name == name)
    }

    fn value(&self, name: &str) -> Option<&Value> {
        let at = self.header.inputs.iter().position(|input| input.name == name)?;
        self.values.get(at)?.as_ref()
    }

    /// The text or name of this input, `default` where none is given; `None` if it has another type.
    fn text(&self, name: &str, default: &str) -> Option<String> {
        match self.value(name) {
            None => Some(default.to_owned()),
            Some(Value::String(text)) if &**text == super::args::NOT_GIVEN => {
                Some(default.to_owned())
            }
            Some(Value::String(text) | Value::VariableName(text)) => Some(text.to_string()),
            Some(Value::TypeName(name)) => Some(name.to_string()),
            Some(_) => None,
        }
    }
}

/// Inputs that hold what a command simulates and writes.
const INPUTS: &[&str] = &[
    "problem",
    "resultFile",
    "initialNames",
    "initialValues",
    "className",
    "fileNamePrefix",
    "outputFormat",
    "simflags",
    "callStr",
    "command",
    "string",
    "file",
    "fileName",
    "filename",
];

/// Commands that write the file of one input.
const WRITERS: &[(&str, &str)] = &[
    ("writeMatrix", "fileName"),
    ("writeRealMatrix", "fileName"),
    ("writeTrajectory", "fileName"),
    ("writeFile", "fileName"),
    ("writeMATmatrix", "fileName"),
    ("writeCSVmatrix", "fileName"),
];

/// Commands that simulate models, or may do so.
const SIMULATING: &[&str] = &[
    "simulateModel",
    "simulateExtendedModel",
    "simulateMultiExtendedModel",
    "simulateMultiResultsModel",
    "simulate",
    "linearizeModel",
    "linearize",
    "system",
    "command",
    "Execute",
];

/// Whether a command of this name writes files.
pub(crate) fn writes_files(name: Ident) -> bool {
    command_named(name).is_some()
}

fn command_of(header: &Function) -> Option<&'static str> {
    command_named(header.name.last()?)
}

fn command_named(name: Ident) -> Option<&'static str> {
    let writers = WRITERS.iter().map(|(command, _)| command);
    SIMULATING.iter().chain(writers).copied().find(|known| name == *known)
}

/// The inputs of a command that say what it is going to write; none of other commands.
pub(crate) fn inputs_of_files(header: &Function) -> &'static [&'static str] {
    command_of(header).map_or(&[], |_| INPUTS)
}

/// A command is given these arguments: notes what it is going to write. Whether there is anything.
pub(crate) fn begin_writing(
    session: &mut Session,
    header: &Arc<Function>,
    values: &[Option<Value>],
) -> bool {
    let Some(command) = command_of(header) else { return false };
    let given = Given { header, values };
    let Some(expected) = expected(session, command, &given) else { return false };
    let paths = expected.files.iter().map(|file| session.world.expect_file(file)).collect();
    let first_message = session.output.messages.next_number();
    session.extension::<Begun>().0.push(Writing { command, expected, paths, first_message });
    true
}

/// The command that began last has ended: what it has not written is out of date.
pub(crate) fn end_writing(session: &mut Session, error: Option<&Diagnostic>) {
    let Some(writing) = session.extension::<Begun>().0.pop() else { return };
    let reported = session.output.messages.first_unhandled(writing.first_message);
    let cause = reported.or(error).map_or("nothing was written", |cause| &*cause.message);
    let reason = match writing.expected.problem {
        Some(_) => format!("the simulation that writes it failed: {cause}"),
        None => format!("`{}`, which writes it, failed: {cause}", writing.command),
    };
    let cause = cause.to_owned();
    let ends = writing.paths.iter().map(|path| session.world.end_expected(path, &reason));
    let missing = ends.collect::<Vec<bool>>();
    let is_missing = missing.first().copied().unwrap_or(error.is_some());
    if let (Some(problem), true) = (&writing.expected.problem, is_missing) {
        let file = writing.expected.files.first().map(|file| file.to_string_lossy().into_owned());
        last_results::note_none(session, problem, &file.unwrap_or_default(), cause);
        session.models.end = None;
    }
}

fn expected(session: &mut Session, command: &str, given: &Given<'_>) -> Option<Expected> {
    if let Some((_, input)) = WRITERS.iter().find(|(writer, _)| *writer == command) {
        let file = given.text(input, "").filter(|file| !file.is_empty())?;
        let file = match command {
            "writeTrajectory" => super::results::trajectory_file(file),
            _ => file,
        };
        return Some(Expected { files: vec![PathBuf::from(file)], problem: None });
    }
    match command {
        "system" | "command" | "Execute" => {
            let mut inputs = ["callStr", "command", "string", "file"].into_iter();
            let input = inputs.find(|input| given.has(input))?;
            let (problem, file) = executable::expected(session, &given.text(input, "")?)?;
            Some(Expected { files: vec![file.into()], problem: Some(problem) })
        }
        _ if given.has("className") => of_openmodelica(session, command, given),
        _ => {
            let problem = given.text("problem", "").unwrap_or_default();
            let named = Some(problem.trim().to_owned()).filter(|problem| !problem.is_empty());
            let last = || session.last_model().map(|last| last.problem.clone());
            let problem = named.or_else(last).unwrap_or_default();
            Some(Expected { files: of_dymola(command, given), problem: Some(problem) })
        }
    }
}

fn of_dymola(command: &str, given: &Given<'_>) -> Vec<PathBuf> {
    match command {
        "linearizeModel" => {
            let file = given.text("resultFile", "dslin");
            file.map(|file| super::linearization::linear_file(&file).into()).into_iter().collect()
        }
        _ => {
            let linear = linear_files(given);
            let file = given.text("resultFile", "dsres").filter(|_| linear.is_empty());
            let results = file.map(|file| simulation::result_path(&file));
            let end = results.as_ref().map(|_| PathBuf::from(super::final_states::FINAL));
            linear.into_iter().chain(results).chain(end).collect()
        }
    }
}

/// The files of linear models whose numbers are among the initial values.
fn linear_files(given: &Given<'_>) -> Vec<PathBuf> {
    let names = given.value("initialNames").cloned().map(Vec::<String>::from_value);
    let values = given.value("initialValues").cloned().map(RealMatrix::from_value);
    let (Some(Ok(names)), Some(Ok(values))) = (names, values) else { return Vec::new() };
    let column = names.iter().position(|name| name == super::extended::LINEARIZE);
    let Some(at) = column.filter(|at| *at < values.columns) else { return Vec::new() };
    let numbers = (0..values.rows).map(|row| values.row(row)[at]);
    numbers.map(|number| super::extended::linear_file(number).into()).collect()
}

fn of_openmodelica(session: &Session, command: &str, given: &Given<'_>) -> Option<Expected> {
    let class = given.text("className", "")?;
    let prefix = given.text("fileNamePrefix", "");
    let prefix = prefix.map(|own| if own.is_empty() { class.clone() } else { own });
    let usual = prefix.zip(given.text("outputFormat", "mat"));
    let usual = usual.map(|(prefix, format)| format!("{prefix}_res.{format}"));
    let flags = given.text("simflags", "").unwrap_or_default();
    let mut files: Vec<PathBuf> = Vec::new();
    if let Some(usual) = usual {
        files.push(match command {
            "simulate" => super::simflags::result_file(session, &flags, &usual).into(),
            _ => usual.into(),
        });
    }
    if command == "linearize" {
        files.push(Path::new(super::linearization::FILE).to_path_buf());
    }
    Some(Expected { files, problem: Some(class) })
}
