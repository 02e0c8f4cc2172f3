//! What a compiled model tells of itself: its parameters and variables, and what depends on what.

use super::errors::*;
use super::program::{ParameterInfo, Program, VariableInfo};
use super::sequence::close;
use crate::causalize::CausalizedDae;
use crate::diag::{Diagnostic, Fault, suggest};
use crate::fault;
use crate::flatten::{Experiment, Variability};
use crate::lower::VariableKind;
use crate::source::Span;
use crate::symbolic::VarId;
use rustc_hash::FxHashSet;
use std::sync::Arc;

/// Names that a message lists at most.
const MOST_NAMES: usize = 8;

impl Program {
    /// Name of the class.
    pub fn name(&self) -> &str {
        &self.sorted.dae.name
    }

    /// The sorted system it was made of.
    pub fn sorted(&self) -> &CausalizedDae {
        &self.sorted
    }

    /// Parameters that can be set, in order of declaration.
    pub fn parameters(&self) -> &[ParameterInfo] {
        &self.parameters
    }

    /// All scalar variables, time first, then in order of declaration, then derivatives.
    pub fn variables(&self) -> &[VariableInfo] {
        &self.variables
    }

    /// The `experiment` annotation.
    pub fn experiment(&self) -> Experiment {
        self.sorted.dae.experiment
    }

    /// What deserves a warning.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.sorted.dae.warnings
    }

    /// The variables that are solved for between events, and the iteration variables of loops.
    pub(crate) fn solved_variables(&self) -> impl Iterator<Item = VarId> + '_ {
        let assigned = self.sequence.iter().map(|assignment| assignment.variable);
        assigned.chain(self.continuous.iteration.iter().copied())
    }

    /// The name of an unknown of the integrator.
    pub fn unknown_name(&self, unknown: usize) -> Option<&Arc<str>> {
        self.continuous.unknowns.get(unknown).map(|v| &self.sorted.dae.variable(*v).name)
    }

    /// Where the relation or rounding of a crossing function is written.
    pub fn crossing_place(&self, crossing: usize) -> Option<Span> {
        let dae = &self.sorted.dae;
        match self.switching.crossing_relations.get(crossing) {
            Some(relation) => dae.relations.get(*relation).map(|relation| relation.span),
            None => {
                let rounding = crossing.checked_sub(self.switching.crossing_relations.len())?;
                dae.events.roundings.get(rounding).map(|rounding| rounding.span)
            }
        }
    }

    /// Position of a variable in [`Program::variables`].
    pub fn find_variable(&self, name: &str) -> Result<usize, Fault> {
        self.variables.iter().position(|v| &*v.name == name).ok_or_else(|| {
            let known = self.variables.iter().map(|v| &*v.name);
            let help = suggest::did_you_mean(name, known).or_else(|| self.unknown_names());
            fault!(UNKNOWN_VARIABLE, "`{}` has no variable `{name}`", self.name()).help_if(help)
        })
    }

    /// Whether a parameter follows from the initial equations, whatever value it is given.
    pub fn is_solved_at_start(&self, name: &str) -> bool {
        let dae = &self.sorted.dae;
        self.values.solved.iter().any(|own| &*dae.variable(*own).name == name)
    }

    /// The names of what the model computes, for a message; the first of many.
    fn unknown_names(&self) -> Option<String> {
        let is_unknown = |v: &&VariableInfo| !v.is_known() && !v.protected && &*v.name != "time";
        let is_derivative = |v: &&VariableInfo| v.name.starts_with("der(");
        let unknowns = self.variables.iter().filter(is_unknown).filter(|v| !is_derivative(v));
        let names: Vec<String> = unknowns.map(|v| format!("`{}`", v.name)).collect();
        let more = if names.len() > MOST_NAMES { ", …" } else { "" };
        let shown = names.iter().take(MOST_NAMES).cloned().collect::<Vec<_>>().join(", ");
        (!names.is_empty()).then(|| format!("its variables are {shown}{more}"))
    }

    /// Position of a parameter in [`Program::parameters`].
    pub fn find_parameter(&self, name: &str) -> Result<usize, Fault> {
        if let Some(found) = self.parameters.iter().position(|p| &*p.name == name) {
            return Ok(found);
        }
        let exists = self.variables.iter().find(|v| &*v.name == name);
        if exists.is_some_and(|v| v.variability <= Variability::Parameter) {
            return Err(fault!(STRUCTURAL_PARAMETER,
                "`{name}` cannot be set: it is constant, final, or a structural parameter";
                help: "change it with a modification when translating the model"));
        }
        let known: Vec<&str> = self.parameters.iter().map(|p| &*p.name).collect();
        Err(fault!(UNKNOWN_PARAMETER, "`{}` has no parameter `{name}`", self.name())
            .help_if(suggest::did_you_mean(name, known.iter().copied()))
            .help_if(
                (!known.is_empty())
                    .then(|| format!("its parameters are {}", suggest::listed(&known))),
            ))
    }

    /// The expression of a variable of [`Program::variables`], aliases resolved, with its sign.
    pub(super) fn resolve(&self, variable: VarId) -> (VarId, bool) {
        match self.sorted.aliases[variable.0 as usize] {
            Some(alias) => (alias.of, alias.negated),
            None => (variable, false),
        }
    }

    /// Everything that variables of [`Program::variables`] are computed from, what relations
    /// compare included.
    fn dependencies(&self, variables: &[usize]) -> FxHashSet<VarId> {
        let dae = &self.sorted.dae;
        let sources: FxHashSet<VarId> = variables
            .iter()
            .filter_map(|at| self.variables.get(*at))
            .map(|info| self.resolve(info.variable).0)
            .collect();
        let mut needed = close(&dae.pool, &self.sequence, sources);
        loop {
            let mut sources = needed.clone();
            for relation in dae.relations.iter().filter(|r| needed.contains(&r.variable)) {
                sources.extend(dae.pool.variables(relation.left));
                sources.extend(dae.pool.variables(relation.right));
            }
            for rounding in dae.events.roundings.iter().filter(|r| needed.contains(&r.variable)) {
                sources.extend(dae.pool.variables(rounding.argument));
            }
            let before = needed.len();
            needed = close(&dae.pool, &self.sequence, sources);
            if needed.len() == before {
                return needed;
            }
        }
    }

    /// Whether states, iteration variables or values of events are needed to compute these
    /// variables: if not, they are functions of time and parameters alone.
    pub fn needs_states(&self, variables: &[usize]) -> bool {
        let needed = self.dependencies(variables);
        let remembered = |v: &VarId| {
            matches!(
                self.sorted.dae.variable(*v).kind,
                VariableKind::Discrete
                    | VariableKind::Previous(_)
                    | VariableKind::Signal
                    | VariableKind::Solved
                    | VariableKind::Delayed
            )
        };
        let found = |v: &VarId| needed.contains(v);
        needed.iter().any(remembered) || self.continuous.unknowns.iter().any(found)
    }

    /// Whether all relations and roundings that these variables need change at times that parameters
    /// alone determine, so that no variable has to be solved for to evaluate them.
    pub fn switches_at_known_times(&self, variables: &[usize]) -> bool {
        let needed = self.dependencies(variables);
        let is_needed = |register: &u32| needed.contains(&VarId(*register));
        let relations = self.switching.relations.iter().map(|own| (own.register, own.time));
        let roundings = self.events.roundings.iter().map(|own| (own.register, own.time));
        let mut all = relations.chain(roundings);
        all.all(|(register, time)| time.is_some() || !is_needed(&register))
    }

    /// Whether a variable is computed from one of these parameters, other parameters between them
    /// included. States, iteration variables and values of events count as depending on every parameter.
    pub fn depends_on_parameters(&self, variable: usize, parameters: &[usize]) -> bool {
        if parameters.is_empty() {
            return false;
        }
        if self.needs_states(&[variable]) {
            return true;
        }
        let mut needed = self.dependencies(&[variable]);
        for parameter in self.sorted.parameters.iter().rev() {
            if needed.contains(parameter)
                && let Some(binding) = self.sorted.dae.variable(*parameter).binding
            {
                needed.extend(self.sorted.dae.pool.variables(binding));
            }
        }
        let of = |at: &usize| self.parameters.get(*at).map(|p| p.variable);
        parameters.iter().filter_map(of).any(|p| needed.contains(&p))
    }
}
