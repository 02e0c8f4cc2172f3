//! The working directory, the environment, and what is refused because it leaves the script.

use super::strings::text;
use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::script::errors::REFUSED;
use crate::script::session::Stop;
use crate::script::{Dialect, Session};
use crate::value::Value;

/// Commands with the same meaning in both tools.
pub(super) const FAMILY: Family = Family {
    packages: &["Modelica.Utilities.System"],
    dialect: None,
    builtins: &[
        Builtin { header: EXIT, run: exit },
        Builtin { header: SYSTEM, run: refused },
        Builtin { header: EXECUTE, run: refused },
        Builtin { header: COMMAND, run: refused },
        Builtin { header: SET_ENVIRONMENT_VARIABLE, run: refused },
        Builtin { header: GET_WORK_DIRECTORY, run: get_work_directory },
        Builtin { header: SET_WORK_DIRECTORY, run: set_work_directory },
        Builtin { header: GET_ENVIRONMENT_VARIABLE, run: get_environment_variable },
    ],
};

/// `cd` as Dymola has it.
pub(super) const DYMOLA: Family = Family {
    packages: &["DymolaCommands.System"],
    dialect: Some(Dialect::Dymola),
    builtins: &[Builtin { header: CD, run: cd }],
};

/// `cd` as OpenModelica has it, and its environment.
pub(super) const OPENMODELICA: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: CD_OPENMODELICA, run: cd_openmodelica },
        Builtin { header: GET_ENVIRONMENT_VAR, run: get_environment_var },
    ],
};

const EXIT: &str = r#"
function exit "Ends the run."
  input Integer status = 0 "exit code of the process";
end exit;
"#;

fn exit(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let status: i64 = args.take("status")?;
    session.stop = Some(Stop::Exit(i32::try_from(status).unwrap_or(i32::MAX)));
    Ok(Value::nothing())
}

const SYSTEM: &str = r#"
function system "Runs a command of the operating system: refused."
  input String callStr;
  input String outputFile = "";
  output Boolean ok;
end system;
"#;

const EXECUTE: &str = r#"
function Execute "Opens a file with its program: refused."
  input String file;
  output Boolean ok;
end Execute;
"#;

const COMMAND: &str = r#"
function command "Runs a command of the operating system: refused."
  input String string;
  output Integer result;
end command;
"#;

const SET_ENVIRONMENT_VARIABLE: &str = r#"
function setEnvironmentVariable "Changes the environment: refused."
  input String name;
  input String content;
  input Boolean convertFromSlash = false;
end setEnvironmentVariable;
"#;

fn refused(_: &mut Session, args: Args) -> Result<Value, Failure> {
    bail!(
        REFUSED,
        "`{}` is refused: a script may not run programs or change the environment",
        args.command();
        help: "do this before or after the script"
    )
}

const GET_WORK_DIRECTORY: &str = r#"
function getWorkDirectory "The working directory."
  output String directory;
end getWorkDirectory;
"#;

fn get_work_directory(session: &mut Session, _: Args) -> Result<Value, Failure> {
    Ok(text(session.world.current_dir().display().to_string()))
}

const SET_WORK_DIRECTORY: &str = r#"
function setWorkDirectory "Changes the working directory."
  input String directory;
end setWorkDirectory;
"#;

fn set_work_directory(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    session.go_to(&args.take::<String>("directory")?)?;
    Ok(Value::nothing())
}

const GET_ENVIRONMENT_VARIABLE: &str = r#"
function getEnvironmentVariable "The content of an environment variable."
  input String name;
  input Boolean convertToSlash = false "whether backslashes become slashes";
  output String content "empty if it is not set";
  output Boolean exist;
end getEnvironmentVariable;
"#;

fn get_environment_variable(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let content = session.world.env(&args.take::<String>("name")?);
    let exist = content.is_some();
    let mut content = content.unwrap_or_default();
    if args.take("convertToSlash")? {
        content = content.replace('\\', "/");
    }
    Ok(Value::Tuple(vec![text(content), exist.into()]))
}

const CD: &str = r#"
function cd "Changes the working directory and shows it."
  input String Dir = "" "empty: only show it";
  output Boolean ok;
end cd;
"#;

fn cd(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let directory: String = args.take("Dir")?;
    let changed = session.change_directory(&directory);
    Ok(session.succeeded(changed))
}

const CD_OPENMODELICA: &str = r#"
function cd "Changes the working directory and returns it."
  input String newWorkingDirectory = "" "empty: only return it";
  output String workingDirectory;
end cd;
"#;

fn cd_openmodelica(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let directory: String = args.take("newWorkingDirectory")?;
    if !directory.is_empty() {
        let changed = session.go_to(&directory);
        session.or_report(changed);
    }
    get_work_directory(session, args)
}

const GET_ENVIRONMENT_VAR: &str = r#"
function getEnvironmentVar "The content of an environment variable."
  input String var;
  output String value "empty if it is not set";
end getEnvironmentVar;
"#;

fn get_environment_var(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    Ok(text(session.world.env(&args.take::<String>("var")?).unwrap_or_default()))
}
