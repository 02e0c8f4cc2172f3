//! Simulations that begin where another one ended.

use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::diag::Fault;
use crate::errors::{BAD_ARGUMENT, NO_TRANSLATED_MODEL};
use crate::models::final_state::FinalState;
use crate::models::simulation::Translated;
use crate::value::Value;
use crate::{Dialect, Session};
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
function importInitial "The next simulations begin at a final state: its states, discrete variables and parameters, its time, and an interval of the same length."
  input String dsName = "dsfinal.txt" "the end of the last simulation, or a copy of it";
  output Boolean ok;
end importInitial;
"#;

fn import_initial(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("dsName")?;
    model(session, "importInitial")?;
    let state = super::final_states::final_state(session, &file)?;
    session.continue_from(&state, &file)?;
    let (start, stop) = state.span;
    super::simulation::begin_at(session, start, Some(stop));
    Ok(true.into())
}

const IMPORT_INITIAL_RESULT: &str = r#"
function importInitialResult "The next simulations start from the states, discrete variables and parameters of a result file at a given time."
  input String dsResName "result file";
  input Real atTime "s";
  output Boolean ok;
end importInitialResult;
"#;

fn import_initial_result(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (file, time): (String, f64) = (args.take("dsResName")?, args.take("atTime")?);
    let model = model(session, "importInitialResult")?;
    let table = super::results::table(session, &file)?;
    let state = FinalState::in_result(&model, &table, time)?;
    session.continue_from(&state, &file)?;
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
        session.models.import_states(IndexMap::new());
    }
    Ok(Value::nothing())
}
