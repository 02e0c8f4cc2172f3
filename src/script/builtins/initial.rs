//! Simulations that begin where another one ended.

use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::diag::Fault;
use crate::script::errors::{BAD_ARGUMENT, NO_TRANSLATED_MODEL};
use crate::script::models::simulation::{Translated, begin_with};
use crate::script::{Dialect, Session};
use crate::value::Value;
use indexmap::IndexMap;
use std::sync::Arc;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.SimulatorAPI"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: IMPORT_INITIAL, run: import_initial },
        Builtin { header: IMPORT_INITIAL_RESULT, run: import_initial_result },
        Builtin { header: INITIALIZED, run: initialized },
    ],
};

fn model(session: &Session, command: &str) -> Result<Arc<Translated>, Fault> {
    session.last_model().ok_or_else(|| {
        Fault::new(NO_TRANSLATED_MODEL, format!("`{command}`: no model has been translated yet"))
            .help("translate or simulate the model first")
    })
}

const IMPORT_INITIAL: &str = r#"
function importInitial "The next simulations continue from the end of the last one: its states, its time and the length of its interval."
  input String dsName = "dsfinal.txt" "only this name: the end of the last simulation of this session";
  output Boolean ok;
end importInitial;
"#;

fn import_initial(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("dsName")?;
    if file != "dsfinal.txt" {
        bail!(
            BAD_ARGUMENT,
            "`importInitial` continues from the last simulation of this session; it does not \
             read `{file}`";
            help: "read the values of a result file with `importInitialResult(\"result.mat\", \
                   time)`"
        );
    }
    model(session, "importInitial")?;
    let Some(end) = session.last_end().cloned() else {
        bail!(BAD_ARGUMENT, "there is no final state to continue from: no model has been simulated")
    };
    session.import_states(end.states);
    let (start, stop) = end.span;
    super::simulation::begin_at(session, stop, Some(stop + (stop - start)));
    Ok(true.into())
}

const IMPORT_INITIAL_RESULT: &str = r#"
function importInitialResult "The next simulations start from the states and parameters of a result file at a given time."
  input String dsResName "result file";
  input Real atTime "s";
  output Boolean ok;
end importInitialResult;
"#;

fn import_initial_result(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (file, time): (String, f64) = (args.take("dsResName")?, args.take("atTime")?);
    let model = model(session, "importInitialResult")?;
    let table = super::results::table(session, &file)?;
    begin_with(session, &model, &table, time)?;
    super::simulation::begin_at(session, time, None);
    Ok(true.into())
}

const INITIALIZED: &str = r#"
function initialized "Whether the next simulations start from the imported states or solve the initial equations."
  input Boolean allVars = false "true is not supported: the equations determine all variables that are not states";
  input Boolean isInitialized = true "false: the initial equations are used again";
end initialized;
"#;

fn initialized(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (all, is_initialized): (bool, bool) = (args.take("allVars")?, args.take("isInitialized")?);
    model(session, "initialized")?;
    if all {
        bail!(
            BAD_ARGUMENT,
            "`allVars = true` is not supported: given the states, the equations determine all \
             other variables";
            help: "omit it"
        );
    }
    if !is_initialized {
        session.import_states(IndexMap::new());
    }
    Ok(Value::nothing())
}
