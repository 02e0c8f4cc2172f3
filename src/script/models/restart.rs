//! Simulations that begin where another one ended.

use super::final_state::FinalState;
use super::translated::Translated;
use crate::Session;
use crate::diag::{Diagnostic, Fault, suggest};
use crate::errors::{BAD_ARGUMENT, START_VALUES_MISSING};
use crate::fault;
use crate::flatten::Variability;
use indexmap::IndexMap;
use std::sync::Arc;

/// The message of a diagnostic at the place of the call.
fn as_fault(diagnostic: Diagnostic) -> Fault {
    Fault::new(diagnostic.code, diagnostic.message.clone())
}

impl Session {
    /// The next simulations of the model translated last begin from a state, with the parameters that
    /// hold there. States and discrete variables that it lacks begin as the model says, with a note;
    /// `from` is what it was read from.
    ///
    /// # Errors
    /// It has no state of the model, or a parameter cannot have the value.
    pub fn continue_from(&mut self, state: &FinalState, from: &str) -> Result<(), Fault> {
        let Some(last) = self.last_model() else { return Ok(()) };
        let model = self.shaped_model(&last).map_err(as_fault)?;
        let variables = model.program.variables().iter();
        let discrete = variables.filter(|v| v.variability == Variability::Discrete);
        let names = model.state_names().chain(discrete.map(|variable| &variable.name));
        let (mut imported, mut missing) = (IndexMap::new(), Vec::new());
        for name in names {
            match state.value(name).filter(|value| !value.is_nan()) {
                Some(value) => _ = imported.insert(name.clone(), value),
                None => missing.push(name.to_string()),
            }
        }
        if imported.is_empty() && !missing.is_empty() {
            let problem = &model.problem;
            return Err(fault!(BAD_ARGUMENT, "`{from}` has no state of `{problem}`";
                help: "use the final state of a simulation of this model"));
        }
        self.adopt_parameters(&model, state)?;
        self.models.import_states(imported);
        if !missing.is_empty() {
            let text = format!(
                "`{from}` has no values of these variables: they start as the model says: {}",
                missing.join(", ")
            );
            self.note(START_VALUES_MISSING, text);
        }
        Ok(())
    }

    /// Says which states of the model itself begin at 0 because nothing says where they begin.
    pub fn note_default_starts(&mut self, model: &Translated) {
        let silent = model.states_without_start();
        if silent.is_empty() {
            return;
        }
        let (states, begin) = match silent.len() {
            1 => ("the state", "it begins"),
            _ => ("the states", "they begin"),
        };
        let text = format!(
            "{states} {} without start value: {begin} at 0; declare another value as in \
             `Real x(start = 1, fixed = true)`",
            suggest::listed(&silent)
        );
        self.note(START_VALUES_MISSING, text);
    }

    /// Gives the parameters these values. One that follows from others by its binding is not set:
    /// it continues to follow them.
    fn adopt_parameters(
        &mut self,
        model: &Arc<Translated>,
        state: &FinalState,
    ) -> Result<(), Fault> {
        let parameters = model.program.parameters();
        let names: Vec<String> = parameters.iter().map(|own| own.name.to_string()).collect();
        for _ in 0..names.len() {
            let now = self.numbers_of(model, &names).map_err(as_fault)?;
            let Some(now) = now else { return Ok(()) };
            let differs = |(name, now): (&String, f64)| {
                let value = state.value(name).filter(|value| !value.is_nan() && *value != now)?;
                Some((name.clone(), value))
            };
            match names.iter().zip(now).find_map(differs) {
                Some((name, value)) => self.set_parameter(&name, value)?,
                None => break,
            }
        }
        Ok(())
    }
}
