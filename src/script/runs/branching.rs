//! What if: statements that change a run from one of its generations on.

use super::changing;
use crate::Session;
use crate::builtins::Failure;
use crate::diag::Diagnostic;
use crate::errors::CANNOT_BRANCH;
use crate::fault;
use crate::syntax::ast::Script;
use std::sync::Arc;

/// What is to be executed when, and how far the run has come.
#[derive(Default)]
pub(super) struct Branching {
    pending: Vec<(usize, Arc<Script>)>,
    simulated: usize,
}

impl Session {
    /// Executes `text` among the variables of the script as soon as `Eval` has simulated the
    /// generation of this number, from 1: what follows in the generation uses the new values.
    /// Commands for the same generation are executed in the order of the calls. A change that names
    /// nothing in the script, or makes a value that the run cannot continue with, ends the run with
    /// an error.
    ///
    /// # Errors
    ///
    /// `text` is no script.
    pub fn branch_at(&mut self, generation: usize, text: &str) -> Result<(), Diagnostic> {
        let script = changing::parsed(self, "what if", text)?;
        self.extension::<Branching>().pending.push((generation, Arc::new(script)));
        Ok(())
    }

    /// Whether what [`Session::branch_at`] has prepared was not reached.
    pub fn branch_is_pending(&mut self) -> bool {
        !self.extension::<Branching>().pending.is_empty()
    }

    /// `Eval` has simulated a generation.
    pub(crate) fn generation_simulated(&mut self) -> Result<(), Failure> {
        let branching = self.extension::<Branching>();
        branching.simulated += 1;
        let simulated = branching.simulated;
        let due: Vec<_> = branching.pending.extract_if(.., |(at, _)| *at == simulated).collect();
        if due.is_empty() {
            return Ok(());
        }
        if self.execution.is_in_function() {
            let reason =
                "`Eval` is called in a function, whose variables cannot be changed from outside";
            return Err(fault!(CANNOT_BRANCH, "{reason}";
                help: "call `Eval` from the script itself")
            .into());
        }
        let done = due.iter().try_for_each(|(_, script)| self.change(script, false));
        done.map_err(|diagnostic| Failure::Elsewhere(vec![diagnostic]))
    }
}
