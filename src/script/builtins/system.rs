//! The working directory, the environment, and programs outside of the script.

use super::strings::text;
use super::{Args, Builtin, Failure, Family, executable};
use crate::diag::Fault;
use crate::value::Value;
use crate::{Dialect, Session};

/// Commands with the same meaning in both tools.
pub(super) const FAMILY: Family = Family {
    packages: &["Modelica.Utilities.System"],
    dialect: None,
    builtins: &[
        Builtin { header: EXIT, run: exit },
        Builtin { header: COMMAND, run: command },
        Builtin { header: SET_ENVIRONMENT_VARIABLE, run: set_environment_variable },
        Builtin { header: GET_WORK_DIRECTORY, run: get_work_directory },
        Builtin { header: SET_WORK_DIRECTORY, run: set_work_directory },
        Builtin { header: GET_ENVIRONMENT_VARIABLE, run: get_environment_variable },
    ],
};

/// `cd` as Dymola has it.
pub(super) const DYMOLA: Family = Family {
    packages: &["DymolaCommands.System"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: CD, run: cd },
        Builtin { header: SYSTEM, run: system },
        Builtin { header: EXECUTE, run: execute },
    ],
};

/// `cd` as OpenModelica has it, and its environment.
pub(super) const OPENMODELICA: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: CD_OPENMODELICA, run: cd_openmodelica },
        Builtin { header: SYSTEM_OPENMODELICA, run: system_openmodelica },
        Builtin { header: GET_ENVIRONMENT_VAR, run: get_environment_var },
        Builtin { header: SET_ENVIRONMENT_VAR, run: set_environment_var },
    ],
};

const EXIT: &str = r#"
function exit "Ends the run."
  input Integer status = 0 "exit code of the process";
end exit;
"#;

fn exit(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let status: i64 = args.take("status")?;
    session.execution.exit(i32::try_from(status).unwrap_or(i32::MAX));
    Ok(Value::nothing())
}

const SYSTEM: &str = r#"
function system "Runs an operating-system command; requires --allow-system."
  input String command;
  output Boolean ok "whether its exit status is 0";
end system;
"#;

const EXECUTE: &str = r#"
function Execute "Runs an operating-system command; requires --allow-system."
  input String file;
  output Boolean ok "whether its exit status is 0";
end Execute;
"#;

const SYSTEM_OPENMODELICA: &str = r#"
function system "Runs an operating-system command; requires --allow-system."
  input String callStr;
  input String outputFile = "" "file for its output; empty: the output is printed";
  output Integer retval "its exit status";
end system;
"#;

const COMMAND: &str = r#"
function command "Runs an operating-system command; requires --allow-system."
  input String string;
  output Integer result "its exit status";
end command;
"#;

/// Runs the command that an input holds and prints what it printed.
fn status(session: &mut Session, args: &mut Args, input: &str) -> Result<i32, Fault> {
    let command: String = args.take(input)?;
    if let Some(status) = executable::answered(session, &command) {
        return Ok(status);
    }
    let (status, printed) = session.world.run_program(&command)?;
    session.print_of_script(&String::from_utf8_lossy(&printed));
    Ok(status)
}

fn system(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    Ok((status(session, &mut args, "command")? == 0).into())
}

fn execute(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    Ok((status(session, &mut args, "file")? == 0).into())
}

fn command(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    Ok(i64::from(status(session, &mut args, "string")?).into())
}

fn system_openmodelica(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("outputFile")?;
    if file.is_empty() {
        return Ok(i64::from(status(session, &mut args, "callStr")?).into());
    }
    let command: String = args.take("callStr")?;
    if let Some(status) = executable::answered(session, &command) {
        session.world.write_file(file.as_ref(), b"")?;
        return Ok(i64::from(status).into());
    }
    let (status, printed) = session.world.run_program(&command)?;
    session.world.write_file(file.as_ref(), &printed)?;
    Ok(i64::from(status).into())
}

const SET_ENVIRONMENT_VARIABLE: &str = r#"
function setEnvironmentVariable "Sets an environment variable for this session and the commands that it runs."
  input String name;
  input String content;
  input Boolean convertFromSlash = false "has no effect";
end setEnvironmentVariable;
"#;

fn set_environment_variable(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    session.world.set_environment_variable(args.take("name")?, args.take("content")?);
    Ok(Value::nothing())
}

const SET_ENVIRONMENT_VAR: &str = r#"
function setEnvironmentVar "Sets an environment variable for this session and the commands that it runs."
  input String var;
  input String value;
  output Boolean success;
end setEnvironmentVar;
"#;

fn set_environment_var(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    session.world.set_environment_variable(args.take("var")?, args.take("value")?);
    Ok(true.into())
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
    session.world.change_dir(&args.take::<String>("directory")?)?;
    Ok(Value::nothing())
}

const GET_ENVIRONMENT_VARIABLE: &str = r#"
function getEnvironmentVariable "The value of an environment variable."
  input String name;
  input Boolean convertToSlash = false "whether backslashes become slashes";
  output String content "empty if it is not set";
  output Boolean exist;
end getEnvironmentVariable;
"#;

fn get_environment_variable(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let content = session.world.environment_variable(&args.take::<String>("name")?)?;
    let exist = content.is_some();
    let mut content = content.unwrap_or_default();
    if args.take("convertToSlash")? {
        content = content.replace('\\', "/");
    }
    Ok(Value::Tuple(vec![text(content), exist.into()]))
}

const CD: &str = r#"
function cd "Changes the working directory and prints it."
  input String Dir = "" "empty: only print it";
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
        let changed = session.world.change_dir(&directory);
        session.or_report(changed);
    }
    get_work_directory(session, args)
}

const GET_ENVIRONMENT_VAR: &str = r#"
function getEnvironmentVar "The value of an environment variable."
  input String var;
  output String value "empty if it is not set";
end getEnvironmentVar;
"#;

fn get_environment_var(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let content = session.world.environment_variable(&args.take::<String>("var")?)?;
    Ok(text(content.unwrap_or_default()))
}
