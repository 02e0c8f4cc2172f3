//! Variables that nothing reads and whose divisions have no value, as v = q/area in an empty pipe:
//! the simulation continues, results have no number for them and for what follows from them, and a
//! warning says so.

use super::execution::{FailedOperation, read};
use super::partial_observation::Others;
use super::simulation_log::LogMessage;
use super::system::System;
use crate::codegen::errors::DOMAIN_ERROR;
use crate::codegen::sequence::{expressions, observing};
use crate::sim::Failure;
use crate::symbolic::{Expr, VarId};
use rustc_hash::FxHashSet;
use std::sync::Arc;

impl System {
    /// Observes what can be observed where variables that nothing reads have no value.
    ///
    /// # Errors
    /// The failure, if it is another one, or if neither a log takes the warning nor values may be missing.
    pub(super) fn observe_others(
        &mut self,
        t: f64,
        mut failure: Failure,
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let mut without_value = Vec::new();
        loop {
            let variable = self.without_value(t, failure)?;
            if without_value.contains(&variable) {
                return Err(failure);
            }
            without_value.push(variable);
            let Others { code, places, .. } = self.others(&without_value);
            let mut values = vec![0.0; places.len()];
            // The code has registers of its own, as that of other variables does.
            let mut memory = self.registers.clone();
            memory.extend(&code.0);
            match read(&code.1, &mut memory, &mut values) {
                Ok(()) => {
                    out.fill(f64::NAN);
                    places.iter().zip(values).for_each(|(place, value)| out[*place] = value);
                    return Ok(());
                }
                Err(next) => failure = self.refine(next),
            }
        }
    }

    /// From now on values of variables that nothing reads may be missing where their divisions have none:
    /// the caller finds NaN there and refuses what it needs.
    pub fn allow_missing_values(&mut self) {
        self.outputs.others.may_lack = true;
    }

    /// A simulation begins: the code stays.
    pub(super) fn forget_warnings_of_others(&mut self) {
        self.outputs.others.warned.clear();
    }

    /// The variable whose value has failed; warns of it once.
    fn without_value(&mut self, t: f64, failure: Failure) -> Result<VarId, Failure> {
        let program = self.program.clone();
        let Failure::Domain { origin, operation: FailedOperation::DIVISION } = failure else {
            return Err(failure);
        };
        if self.messages.log.is_none() && !self.outputs.others.may_lack {
            return Err(failure);
        }
        let variable = program.variable_of(origin);
        let Some(variable) = variable.filter(|v| program.unread.variables.binary_search(v).is_ok())
        else {
            return Err(failure);
        };
        if let Some(log) = &mut self.messages.log
            && !self.outputs.others.warned.contains(&variable)
        {
            self.outputs.others.warned.push(variable);
            let value = program.failed_value(origin, FailedOperation::DIVISION, "here");
            let text = format!("{value}; the simulation continues, as nothing depends on it");
            let (warning, span) = (Some(DOMAIN_ERROR), program.place(origin));
            log.record(LogMessage { time: t, text, warning, span });
        }
        Ok(variable)
    }

    /// What does not depend on variables without value.
    fn others(&mut self, without_value: &[VarId]) -> Others {
        let known =
            self.outputs.others.known.iter().find(|known| known.without_value == without_value);
        if let Some(known) = known {
            return known.clone();
        }
        let program = self.program.clone();
        let mut pool = program.sorted().dae.pool.clone();
        let all: Vec<Expr> = match &self.outputs.observed_variables {
            Some(variables) => expressions(&program, &mut pool, variables),
            None => program.observed.iter().map(|v| pool.variable(*v)).collect(),
        };
        let mut lacking: FxHashSet<VarId> = without_value.iter().copied().collect();
        for assignment in &program.sequence {
            if pool.any_variable(assignment.value, |v| lacking.contains(&v)) {
                lacking.insert(assignment.variable);
            }
        }
        let has_value = |e: &Expr| !pool.any_variable(*e, |v| lacking.contains(&v));
        let places: Vec<usize> = (0..all.len()).filter(|at| has_value(&all[*at])).collect();
        let outputs: Vec<Expr> = places.iter().map(|at| all[*at]).collect();
        let code = Arc::new(observing(&program, &pool, &outputs));
        let without_value = without_value.to_vec();
        let others = Others { without_value, code, places };
        self.outputs.others.known.push(others.clone());
        others
    }
}
