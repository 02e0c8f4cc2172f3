//! What the algebraic loops of a system have cost.

use super::newton::LoopSolver;
use super::system::System;
use crate::codegen::code::{CompiledLoop, Step};
use std::sync::Arc;

/// The cost of a torn loop that is solved for itself, outside of the integrator.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LoopEffort {
    /// The names of its iteration variables.
    pub unknowns: Vec<Arc<str>>,
    /// How often it was solved.
    pub solutions: u64,
    /// How often its residuals were evaluated for these.
    pub evaluations: u64,
}

impl System {
    /// The cost of every loop since the system was made: those of the initial system, of the
    /// simulation and of events, in this order.
    pub fn loop_efforts(&self) -> Vec<LoopEffort> {
        let program = self.program();
        let parts = [
            (&program.initial_steps, &self.loops.initial_solvers),
            (&program.steps, &self.loops.solvers),
            (&program.events.steps, &self.loops.event_solvers),
        ];
        let mut found = Vec::new();
        for (steps, solvers) in parts {
            let loops = steps.iter().filter_map(|step| match step {
                Step::Solve(torn) => Some(torn),
                Step::Run(_) => None,
            });
            found.extend(loops.zip(solvers).map(|(torn, solver)| self.loop_effort(torn, solver)));
        }
        found
    }

    fn loop_effort(&self, torn: &CompiledLoop, solver: &LoopSolver) -> LoopEffort {
        let dae = &self.program().sorted.dae;
        let name = |register: &u32| dae.variables[*register as usize].name.clone();
        LoopEffort {
            unknowns: torn.unknowns.iter().map(name).collect(),
            solutions: solver.solutions,
            evaluations: solver.evaluations,
        }
    }
}
