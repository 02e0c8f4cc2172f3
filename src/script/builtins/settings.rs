//! Settings of the session, and its variables.

use super::{Args, Builtin, Failure, Family};
use crate::language::transcript::PROMPT;
use crate::name::Name;
use crate::value::Value;
use crate::{Dialect, Session};

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &[],
    dialect: None,
    builtins: &[
        Builtin { header: CLEAR, run: clear },
        Builtin { header: CLEAR_VARIABLES, run: clear_variables },
        Builtin { header: ECHO, run: echo },
        Builtin { header: LIST_VARIABLES, run: list_variables },
        Builtin { header: VARIABLES, run: variables },
        Builtin { header: SET_COMMAND_LINE_OPTIONS, run: accepted },
        Builtin { header: SET_DEBUG_FLAGS, run: accepted },
        Builtin { header: SET_COMPILER_FLAGS, run: accepted },
        Builtin { header: SET_MATCHING_ALGORITHM, run: accepted },
        Builtin { header: SET_INDEX_REDUCTION_METHOD, run: accepted },
        Builtin { header: SET_TEARING_METHOD, run: accepted },
        Builtin { header: GET_VERSION, run: get_version },
        Builtin { header: HELP, run: help },
    ],
};

/// Dymola's `list`, which is about variables.
pub(super) const LIST_FAMILY: Family = Family {
    packages: &["DymolaCommands.SimulatorAPI"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: LIST, run: variables },
        Builtin { header: SAVELOG, run: savelog },
    ],
};

const CLEAR: &str = r#"
function clear "Clears variables, flags, imports and classes."
  output Boolean ok;
end clear;
"#;

fn clear(session: &mut Session, _: Args) -> Result<Value, Failure> {
    session.clear();
    Ok(true.into())
}

const CLEAR_VARIABLES: &str = r#"
function clearVariables "Clears the variables."
  output Boolean ok;
end clearVariables;
"#;

fn clear_variables(session: &mut Session, _: Args) -> Result<Value, Failure> {
    session.workspace.variables.clear();
    session.models.forget_variables();
    Ok(true.into())
}

const ECHO: &str = r#"
function echo "Turns the display of results on or off."
  input Boolean setEcho;
  output Boolean newEcho;
end echo;
"#;

fn echo(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let enabled: bool = args.take("setEcho")?;
    session.output.set_muted(!enabled);
    Ok(enabled.into())
}

const LIST_VARIABLES: &str = r#"
function listVariables "The names of the variables."
  output TypeName variables[:];
end listVariables;
"#;

fn list_variables(session: &mut Session, _: Args) -> Result<Value, Failure> {
    let names: Vec<String> =
        session.workspace.variables.iter().map(|(name, _)| name.to_string()).collect();
    Ok(names.into())
}

const LIST: &str = r#"
function list "Prints the variables with their types and values, in alphabetic order."
  input String filename = "" "output file; .mos: a script that sets the variables; empty: the terminal";
  input String variables[:] = {"*"} "patterns; * stands for any characters, ? for one";
  output Boolean ok;
end list;
"#;

const VARIABLES: &str = r#"
function variables "Prints the variables with their types and values, in alphabetic order."
  input String filename = "" "output file; .mos: a script that sets the variables; empty: the terminal";
  input String variables[:] = {"*"} "patterns; * stands for any characters, ? for one";
  output Boolean ok;
end variables;
"#;

fn variables(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("filename")?;
    let patterns: Vec<String> = args.take("variables")?;
    let is_script = file.ends_with(".mos");
    let listing: String =
        patterns.iter().map(|pattern| session.workspace.listing(pattern, !is_script)).collect();
    if file.is_empty() {
        session.print_of_script(&listing);
        return Ok(true.into());
    }
    let written = session.world.write_file(file.as_ref(), listing.as_bytes());
    Ok(session.succeeded(written))
}

const SAVELOG: &str = r#"
function savelog "Writes the session so far to a file."
  input String logfile = "dymolalg.txt" "extension .mos: only the statements";
  output Boolean ok;
end savelog;
"#;

fn savelog(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("logfile")?;
    let contents = match file.ends_with(".mos") {
        true => session.output.log().statements(&session.sources),
        false => session.output.log().text(&session.sources),
    };
    let written = session.world.write_log(file.as_ref(), contents.as_bytes(), PROMPT);
    Ok(session.succeeded(written))
}

const SET_COMMAND_LINE_OPTIONS: &str = r#"
function setCommandLineOptions "Accepts options of the OpenModelica compiler; they have no effect."
  input String options;
  output Boolean ok;
end setCommandLineOptions;
"#;

const SET_DEBUG_FLAGS: &str = r#"
function setDebugFlags "Accepts flags of the OpenModelica compiler; they have no effect."
  input String debugFlags;
  output Boolean success;
end setDebugFlags;
"#;

const SET_COMPILER_FLAGS: &str = r#"
function setCompilerFlags "Accepts flags of a C compiler; they have no effect: models are compiled to machine code without a C compiler."
  input String compilerFlags;
  output Boolean success;
end setCompilerFlags;
"#;

const SET_MATCHING_ALGORITHM: &str = r#"
function setMatchingAlgorithm "Accepts a choice that has no effect: there is one algorithm."
  input String matchingAlgorithm;
  output Boolean success;
end setMatchingAlgorithm;
"#;

const SET_INDEX_REDUCTION_METHOD: &str = r#"
function setIndexReductionMethod "Accepts a choice that has no effect: there is one method."
  input String method;
  output Boolean success;
end setIndexReductionMethod;
"#;

const SET_TEARING_METHOD: &str = r#"
function setTearingMethod "Accepts a choice that has no effect: there is one method."
  input String tearingMethod;
  output Boolean success;
end setTearingMethod;
"#;

fn accepted(session: &mut Session, args: Args) -> Result<Value, Failure> {
    session.no_effect(args.command());
    Ok(true.into())
}

const GET_VERSION: &str = r#"
function getVersion "The version of this program, or of a loaded library."
  input TypeName cl = OpenModelica;
  output String version;
end getVersion;
"#;

fn get_version(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: Name = args.take("cl")?;
    if class.to_string() != "OpenModelica" {
        let version = session.classes.version_of(&class);
        return Ok(session.or_report(version).unwrap_or_default().into());
    }
    Ok(concat!("gapilib ", env!("CARGO_PKG_VERSION")).into())
}

const HELP: &str = r#"
function help "Prints the declaration of a command, or the names of all."
  input VariableName name = "" "the command, with or without quotes";
  output Boolean ok;
end help;
"#;

fn help(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: String = args.take("name")?;
    if name.is_empty() {
        let names: String = super::names().iter().map(|name| format!("{name}\n")).collect();
        session.print_of_script(&names);
        return Ok(true.into());
    }
    match super::find(&crate::name::Name::parse(&name), session.dialect()) {
        Some(id) => {
            let shown = id.header().replace(" annotation(optional = true)", "");
            session.print_of_script(shown.trim_start());
            Ok(true.into())
        }
        None => {
            let known = super::names();
            let fault = crate::fault!(crate::errors::BAD_ARGUMENT, "there is no command `{name}`");
            let hint = crate::diag::suggest::did_you_mean(&name, known.iter().copied());
            session.report_fault(fault.help_if(hint));
            Ok(false.into())
        }
    }
}
