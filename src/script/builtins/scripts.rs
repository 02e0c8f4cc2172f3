//! Scripts that run scripts.

use super::{Args, Builtin, Failure, Family};
use crate::value::Value;
use crate::{Dialect, Session};

/// Dymola's `RunScript`.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.System"],
    dialect: Some(Dialect::Dymola),
    builtins: &[Builtin { header: RUN_SCRIPT, run: run_script }],
};

/// OpenModelica's `runScript`.
pub(super) const OPENMODELICA: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[Builtin { header: RUN_SCRIPT_OPENMODELICA, run: run_script_openmodelica }],
};

const RUN_SCRIPT: &str = r#"
function RunScript "Executes a script; it shares the variables of the calling script."
  input String script "path relative to the folder of the calling script or to the working directory; the extension .mos is optional";
  input Boolean silent = false "true: results of its statements are not shown";
  output Boolean ok "false if there is no such script";
end RunScript;
"#;

fn run_script(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let script: String = args.take("script")?;
    let silent: bool = args.take("silent")?;
    if let Err(missing) = session.find_script(&script) {
        session.script_not_run();
        return Ok(session.succeeded(Err(missing)));
    }
    if silent {
        session.execution.descend();
    }
    let done = session.run_nested(&script);
    if silent {
        session.execution.ascend();
    }
    done.map(|()| true.into())
}

const RUN_SCRIPT_OPENMODELICA: &str = r#"
function runScript "Executes a script; it shares the variables of the calling script."
  input String fileName;
  output String result "what its statements answer, one after the other";
end runScript;
"#;

fn run_script_openmodelica(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let script: String = args.take("fileName")?;
    let (done, answers) = session.collecting_answers(|session| session.run_nested(&script));
    done?;
    Ok(answers.into())
}
