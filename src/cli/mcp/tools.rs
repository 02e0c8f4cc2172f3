//! The tools: what they are called with, the commands that they are, and what they answer.

use super::arguments::{Arguments, Folders};
use super::process::{self, Stop};
use super::search;
use crate::options::Global;
use crate::packages;
use crate::results::{self, ResultTable};
use serde_json::{Map, Value, json};
use std::ffi::OsString;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

/// The folder for results of simulations.
const RESULTS: &str = "results/mcp";
/// Files of one model in it, at most.
const MOST_FILES: usize = 100_000;
/// Rows of trajectories in an answer, at most.
const MOST_ROWS: usize = 40;
/// Variables in an answer, at most.
const MOST_VARIABLES: usize = 40;
/// Characters of an answer, at most.
const MOST_TEXT: usize = 40_000;

/// What a tool answers.
#[derive(Debug)]
pub(super) struct Answer {
    text: String,
    is_error: bool,
}

impl Answer {
    pub(super) fn error(text: impl Into<String>) -> Answer {
        Answer { text: text.into(), is_error: true }
    }

    fn of(text: String) -> Answer {
        Answer { text, is_error: false }
    }

    /// As the protocol has it; of a long text the middle is left out.
    pub(super) fn to_json(&self) -> Value {
        let text = shortened(&self.text);
        json!({ "content": [{ "type": "text", "text": text }], "isError": self.is_error })
    }
}

fn shortened(text: &str) -> String {
    let count = text.chars().count();
    if count <= MOST_TEXT {
        return text.to_owned();
    }
    let half = MOST_TEXT / 2;
    let head: String = text.chars().take(half).collect();
    let tail: String = text.chars().skip(count - half).collect();
    format!("{head}\n({} characters are left out)\n{tail}", count - MOST_TEXT)
}

/// A tool.
struct Tool {
    name: &'static str,
    description: &'static str,
    /// Arguments: name, type in JSON Schema, meaning.
    arguments: &'static [(&'static str, &'static str, &'static str)],
    required: &'static [&'static str],
    /// Whether it writes no files.
    is_reading: bool,
    call: fn(&Tools, &Arguments<'_>, &Stop) -> Result<Answer, String>,
}

const TOOLS: [Tool; 5] = [
    Tool {
        name: "check",
        description: "Checks every class of Modelica files, and each model including its structural \
                      analysis: names, types, numbers of equations and unknowns. Errors have a code, a \
                      place and a remedy.",
        arguments: &[
            (
                "files",
                "strings",
                "Modelica files (.mo), scripts (.mos), folders of packages, or FMUs",
            ),
            (
                "model",
                "string",
                "check this class alone, such as Modelica.Blocks.Examples.PID_Controller",
            ),
        ],
        required: &[],
        is_reading: true,
        call: check,
    },
    Tool {
        name: "simulate",
        description: "Simulates a model and answers rows of trajectories; all rows are in a file.",
        arguments: &[
            ("model", "string", "the class, also with a modification: M(p = 2)"),
            ("files", "strings", "files that define it; libraries are found by name"),
            ("parameters", "object", "values of parameters by their names"),
            ("variables", "strings", "variables of the answer; without them the first ones"),
            ("start_time", "number", "start of the simulation in s"),
            ("stop_time", "number", "end of the simulation in s"),
            ("intervals", "integer", "number of output intervals"),
            ("tolerance", "number", "relative tolerance"),
            ("input", "string", "a file whose columns the inputs of the model follow"),
        ],
        required: &["model"],
        is_reading: false,
        call: simulate,
    },
    Tool {
        name: "identify",
        description: "Identifies the parameters of the model of a problem file (.toml) from measured data: \
                      estimates, standard errors, intervals, whether the data determine them, and remarks \
                      on data and fit. May take minutes; results are in a folder below `results`.",
        arguments: &[
            ("problem", "string", "the problem file"),
            ("profile", "boolean", "profile likelihoods of the parameters"),
            ("design", "boolean", "which further measurements would narrow the intervals most"),
            ("bootstrap", "boolean", "intervals by fits to resampled data"),
            ("posterior", "boolean", "the posterior distribution"),
            ("evaluations", "integer", "stop after this number of evaluations"),
            ("searches", "integer", "searches with different seeds"),
            ("resume", "boolean", "continue a run that was stopped"),
            ("fresh", "boolean", "discard a run that was stopped"),
        ],
        required: &["problem"],
        is_reading: false,
        call: identify,
    },
    Tool {
        name: "explain",
        description: "Explains the code of a diagnostic, such as unknown-name, with an example and what to \
                      do; without a code all codes are listed.",
        arguments: &[("code", "string", "the code in brackets after `error`")],
        required: &[],
        is_reading: true,
        call: explain,
    },
    Tool {
        name: "search",
        description: "Searches classes of Modelica libraries and of the working folder by words of their \
                      names, descriptions and documentation; the full name of a class gives its \
                      documentation.",
        arguments: &[("query", "string", "words, all of which must occur, or the name of a class")],
        required: &["query"],
        is_reading: true,
        call: find,
    },
];

/// Whether there is a tool of this name.
pub(super) fn is_known(name: &str) -> bool {
    TOOLS.iter().any(|tool| tool.name == name)
}

/// The tools as `tools/list` answers them.
pub(super) fn descriptions() -> Vec<Value> {
    TOOLS.iter().map(Tool::description).collect()
}

impl Tool {
    fn description(&self) -> Value {
        let properties: Map<String, Value> =
            self.arguments.iter().map(|own| property(*own)).collect();
        json!({
            "name": self.name,
            "description": self.description,
            "inputSchema": {
                "type": "object",
                "properties": properties,
                "required": self.required,
                "additionalProperties": false,
            },
            "annotations": {
                "readOnlyHint": self.is_reading,
                "destructiveHint": false,
                "openWorldHint": false,
            },
        })
    }
}

/// Options that only a user gives, as commands speak of them and as an assistant has to.
const OF_USERS: [(&str, &str); 2] = [
    ("allow it with `--allow", "ask the user to start this server with `--allow"),
    ("with `--out`", "on the command line (`gapi identify --out`), as the user can"),
];

impl Tool {
    /// What a command says of its options, said of the arguments of the tool.
    fn in_its_words(&self, text: &str) -> String {
        let is_usage = |line: &str| {
            line.starts_with("Usage: gapi ") || line == "For more information, try '--help'."
        };
        let lines = text.split_inclusive('\n').filter(|line| !is_usage(line.trim_end()));
        let mut text: String = lines.collect();
        for (name, ..) in self.arguments {
            let option = match *name {
                "parameters" => "--set".to_owned(),
                name => format!("--{}", name.replace('_', "-")),
            };
            text = text.replace(&format!("`{option}`"), &format!("the argument `{name}`"));
            text = text.replace(&format!("'{option}"), &format!("'{name}"));
            text = text.replace(&format!(" {option}\n"), &format!(" the argument `{name}`\n"));
        }
        OF_USERS.iter().fold(text, |text, (written, said)| text.replace(written, said))
    }
}

fn property((name, kind, meaning): (&str, &str, &str)) -> (String, Value) {
    let schema = match kind {
        "strings" => json!({
            "type": "array", "items": { "type": "string" }, "description": meaning,
        }),
        "object" => json!({
            "type": "object",
            "additionalProperties": { "type": ["number", "boolean", "string"] },
            "description": meaning,
        }),
        kind => json!({ "type": kind, "description": meaning }),
    };
    (name.to_owned(), schema)
}

/// What all calls share.
pub(super) struct Tools {
    time_limit: f64,
    folders: Folders,
    global: Global,
}

impl Tools {
    /// Tools for the working folder.
    ///
    /// # Errors
    ///
    /// It cannot be read.
    pub(super) fn new(time_limit: f64, global: Global) -> io::Result<Tools> {
        let working = std::env::current_dir()?.canonicalize()?;
        let path = std::env::var_os("MODELICAPATH").unwrap_or_default();
        let named = global.library.iter().cloned().chain(std::env::split_paths(&path));
        let named = named.filter(|folder| !folder.as_os_str().is_empty());
        // One that is not there has no files.
        let libraries = named.filter_map(|folder| folder.canonicalize().ok()).collect();
        Ok(Tools { time_limit, folders: Folders { working, libraries }, global })
    }

    /// Does the work of a tool.
    pub(super) fn call(&self, name: &str, given: &Value, stop: &Stop) -> Answer {
        let Some(tool) = TOOLS.iter().find(|tool| tool.name == name) else {
            return Answer::error(format!("unknown tool `{name}`"));
        };
        let known: Vec<&str> = tool.arguments.iter().map(|own| own.0).collect();
        let none = Map::new();
        let arguments = Arguments::of(given, &known, &none);
        let answer = arguments.and_then(|arguments| (tool.call)(self, &arguments, stop));
        let answer = answer.unwrap_or_else(Answer::error);
        Answer { text: tool.in_its_words(&answer.text), ..answer }
    }

    /// A command with the permissions of this one.
    fn command(&self, name: &str) -> Vec<OsString> {
        let mut all: Vec<OsString> = vec![name.into(), "--color".into(), "never".into()];
        let global = &self.global;
        let pairs = global.library.iter().map(|own| ("--library", own.as_os_str().to_owned()));
        let pairs = pairs.chain(global.deny_read.iter().map(|own| ("--deny-read", own.into())));
        let pairs = pairs.chain(global.allow_env.iter().map(|own| ("--allow-env", own.into())));
        all.extend(pairs.flat_map(|(option, value)| [option.into(), value]));
        let joined = |option: &str, value: &std::ffi::OsStr| {
            let mut text = OsString::from(option);
            text.push(value);
            text
        };
        all.extend(global.allow_read.iter().map(|own| joined("--allow-read=", own.as_os_str())));
        all.extend(
            global.allow_external.iter().map(|own| joined("--allow-external=", own.as_ref())),
        );
        all.extend(global.allow_write.then(|| "--allow-write".into()));
        all.extend(global.no_cache.then(|| "--no-cache".into()));
        all
    }

    /// A command that computes, and is stopped after some time.
    fn limited(&self, name: &str) -> Vec<OsString> {
        let mut all = self.command(name);
        all.extend(["--time-limit".into(), self.time_limit.to_string().into()]);
        all
    }

    fn inputs(&self, arguments: &Arguments<'_>, name: &str) -> Result<Vec<OsString>, String> {
        let files = arguments.strings(name)?.into_iter();
        files.map(|file| Ok(self.folders.input(file)?.into_os_string())).collect()
    }
}

/// Runs a command, whose text is the answer.
fn ran(command: &[OsString], stop: &Stop) -> Result<Answer, String> {
    let ended = process::run(command, stop);
    let ended = ended.map_err(|error| format!("the command cannot be started: {error}"))?;
    Ok(Answer { text: ended.text, is_error: !ended.success })
}

fn check(tools: &Tools, arguments: &Arguments<'_>, stop: &Stop) -> Result<Answer, String> {
    let mut command = tools.limited("check");
    let model = arguments.text("model")?;
    if model.is_none() && arguments.strings("files")?.is_empty() {
        return Err("there is nothing to check: give `files`, `model` or both".to_owned());
    }
    if let Some(model) = model {
        command.push(format!("--model={model}").into());
    }
    command.extend(tools.inputs(arguments, "files")?);
    ran(&command, stop)
}

fn simulate(tools: &Tools, arguments: &Arguments<'_>, stop: &Stop) -> Result<Answer, String> {
    let model = arguments.required("model")?;
    let mut command = tools.limited("simulate");
    command.push(format!("--model={model}").into());
    for (option, name) in
        [("start-time", "start_time"), ("stop-time", "stop_time"), ("tolerance", "tolerance")]
    {
        let value = arguments.number(name)?;
        command.extend(value.map(|value| format!("--{option}={value}").into()));
    }
    let intervals = arguments.count("intervals")?;
    command.extend(intervals.map(|count| format!("--intervals={count}").into()));
    for (name, value) in arguments.values("parameters")? {
        command.push(format!("--set={name}={value}").into());
    }
    if let Some(input) = arguments.text("input")? {
        command.extend(["--input".into(), tools.folders.input(input)?.into_os_string()]);
    }
    let variables = arguments.strings("variables")?;
    let file = output_file(tools, model)?;
    command.extend(["--output".into(), file.clone().into_os_string()]);
    command.extend(tools.inputs(arguments, "files")?);
    let answer = ran(&command, stop);
    let shown = tools.folders.shown(&file);
    if !answer.as_ref().is_ok_and(|answer| !answer.is_error) {
        // What a simulation has computed until it failed is kept; its message says so.
        if file.metadata().is_ok_and(|file| file.len() == 0) {
            _ = std::fs::remove_file(&file);
        }
        return answer;
    }
    let answer = answer?;
    let rows = rows(&file, &variables).map_err(|why| format!("`{shown}`: {why}"))?;
    Ok(Answer::of(format!("{}\n{rows}\nAll rows are in {shown}.\n", answer.text.trim_end())))
}

/// A new file for the trajectories of a model: calls at the same time, and later ones, have others.
fn output_file(tools: &Tools, model: &str) -> Result<PathBuf, String> {
    let class = model.split('(').next().unwrap_or_default();
    let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '_');
    let name: String = class.chars().filter(|c| is_plain(*c)).collect();
    let folder = tools.folders.output(RESULTS)?;
    for number in 1..=MOST_FILES {
        let file = folder.join(format!("{}-{number}.csv", name.trim_matches('.')));
        // Making it is what takes it from other calls; a link is there already.
        match File::create_new(&file) {
            Ok(_) => return Ok(file),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(format!("`{}`: {error}", tools.folders.shown(&file))),
        }
    }
    Err(format!("{RESULTS} has {MOST_FILES} results of this model: remove some"))
}

/// Rows of trajectories as CSV: some between the first and the last one.
fn rows(file: &Path, variables: &[&str]) -> Result<String, String> {
    let fault = |fault: crate::diag::Fault| match fault.helps.is_empty() {
        true => fault.message,
        false => format!("{}; {}", fault.message, fault.helps.join("; ")),
    };
    let bytes = std::fs::read(file).map_err(|error| error.to_string())?;
    let format = results::format_of_file(&file.to_string_lossy()).map_err(fault)?;
    let table: ResultTable = format.read(&bytes).map_err(fault)?;
    let all = table.series.iter().map(|series| series.name.as_str());
    let chosen: Vec<&str> = match variables {
        [] => all.take(MOST_VARIABLES).collect(),
        some => some.iter().copied().filter(|name| *name != "time").collect(),
    };
    let columns: Result<Vec<Vec<f64>>, _> = chosen.iter().map(|name| table.column(name)).collect();
    let columns = columns.map_err(fault)?;
    let count = table.time.len();
    let shown: Vec<usize> = match count <= MOST_ROWS {
        true => (0..count).collect(),
        false => (0..MOST_ROWS).map(|k| k * (count - 1) / (MOST_ROWS - 1)).collect(),
    };
    let mut text = format!("time,{}\n", chosen.join(","));
    for at in shown {
        let cells = columns.iter().map(|column| format!(",{}", column[at]));
        text += &format!("{}{}\n", table.time[at], cells.collect::<String>());
    }
    if chosen.len() < table.series.len() {
        text += &format!("{} of {} variables are shown.\n", chosen.len(), table.series.len());
    }
    Ok(text)
}

fn identify(tools: &Tools, arguments: &Arguments<'_>, stop: &Stop) -> Result<Answer, String> {
    let problem = tools.folders.input(arguments.required("problem")?)?;
    let mut command = tools.limited("identify");
    command.push("--plain".into());
    for name in ["profile", "design", "bootstrap", "posterior", "resume", "fresh"] {
        command.extend(arguments.flag(name)?.then(|| format!("--{name}").into()));
    }
    for name in ["evaluations", "searches"] {
        let count = arguments.count(name)?;
        command.extend(count.map(|count| format!("--{name}={count}").into()));
    }
    command.push(problem.into_os_string());
    ran(&command, stop)
}

fn explain(tools: &Tools, arguments: &Arguments<'_>, stop: &Stop) -> Result<Answer, String> {
    let mut command = tools.command("explain");
    if let Some(code) = arguments.text("code")? {
        command.extend(["--".into(), code.into()]);
    }
    ran(&command, stop)
}

fn find(tools: &Tools, arguments: &Arguments<'_>, stop: &Stop) -> Result<Answer, String> {
    let query = arguments.required("query")?;
    let folders = tools.folders.libraries.iter().chain([&tools.folders.working]).cloned();
    let folders: Vec<PathBuf> = folders.chain([PathBuf::from(packages::FOLDER)]).collect();
    let found = search::classes(&folders, query, stop);
    match found.is_empty() {
        true => Ok(Answer::of(format!(
            "No class has all of these words: {query}. Fewer or other words may find it; libraries are \
             searched in the folders of --library and MODELICAPATH and in the working folder.\n"
        ))),
        false => Ok(Answer::of(search::text(&found))),
    }
}
