//! Which equation may determine which variable where there are states of state machines: those of
//! a state determine its own variables and its outputs, variables of enclosing instances that other
//! states determine too (MLS §17.3.5).

use super::clocked_equation::ClockedEquation;
use super::partitions::Partitions;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::FlatModel;
use crate::lower::builder::Builder;
use crate::lower::dae::VariableKind;
use crate::lower::errors::{CLOCK_CONFLICT, INVALID_STATE_MACHINE, NOT_SUPPORTED};
use crate::symbolic::{Expr, VarId};
use rustc_hash::{FxHashMap, FxHashSet};

/// What an equation is to determine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Column {
    pub(super) variable: VarId,
    /// The state whose output it is.
    pub(super) output_of: Option<usize>,
}

/// All clocked unknowns, those that several states determine once for each.
#[derive(Debug)]
pub(super) struct Columns {
    pub(super) list: Vec<Column>,
    position: FxHashMap<Column, usize>,
}

impl Builder<'_> {
    /// For every state the variable that says whether it is active, its own variables, and its
    /// outputs: all have one clock.
    pub(super) fn variables_of_states(&self) -> Vec<Vec<VarId>> {
        let states = &self.clocks.machines.states;
        let mut found: Vec<Vec<VarId>> = states.values().map(|state| vec![state.active]).collect();
        if found.is_empty() {
            return found;
        }
        for (at, variable) in self.dae.variables.iter().enumerate() {
            let is_solved_for = matches!(
                variable.kind,
                VariableKind::Unknown | VariableKind::Discrete | VariableKind::Derivative(_)
            );
            let variable = VarId(at as u32);
            if is_solved_for && let Some(state) = self.state_of_variable(variable) {
                found[state].push(variable);
            }
        }
        for (state, outputs) in self.outputs_of_states().into_iter().enumerate() {
            found[state].extend(outputs);
        }
        found
    }

    /// The outputs of all states, those of a state within another in the inner one alone.
    fn outputs_of_states(&self) -> Vec<Vec<VarId>> {
        let machines = &self.clocks.machines;
        let mut outputs: Vec<Vec<VarId>> = vec![Vec::new(); machines.states.len()];
        let flat: &FlatModel = self.flat;
        for part in &flat.parts {
            let Some(state) = machines.around(&part.instance) else { continue };
            for name in &part.outputs {
                let Some((position, _, variable)) = flat.variables.get_full(name) else {
                    continue;
                };
                let first = self.scalars.first[position].0;
                let scalars = (first..first + variable.len() as u32).map(VarId);
                outputs[state].extend(scalars.filter(|v| {
                    let declared = self.state_of_variable(*v);
                    declared.is_none_or(|declared| !machines.chain(declared).any(|s| s == state))
                }));
            }
        }
        let inner: Vec<Vec<usize>> = (0..outputs.len())
            .map(|state| {
                let others = 0..outputs.len();
                others.filter(|o| *o != state && machines.chain(*o).any(|s| s == state)).collect()
            })
            .collect();
        let all = outputs.clone();
        for (state, outputs) in outputs.iter_mut().enumerate() {
            outputs.sort_unstable();
            outputs.dedup();
            outputs.retain(|v| !inner[state].iter().any(|inner| all[*inner].contains(v)));
        }
        outputs
    }

    /// All clocked unknowns.
    pub(super) fn columns(&self, partitions: &Partitions) -> Result<Columns, Diagnostic> {
        let is_clocked = |v: VarId| {
            partitions.of(v).is_some() && self.dae.variable(v).kind == VariableKind::Discrete
        };
        let mut list = Vec::new();
        let mut merged: FxHashSet<VarId> = FxHashSet::default();
        let mut owners: FxHashMap<VarId, Vec<usize>> = FxHashMap::default();
        for (state, outputs) in self.outputs_of_states().into_iter().enumerate() {
            for variable in outputs.into_iter().filter(|v| is_clocked(*v)) {
                let others = owners.entry(variable).or_default();
                if let Some(other) = others.iter().find(|other| !self.exclude(**other, state)) {
                    return Err(self.parallel(variable, *other, state));
                }
                others.push(state);
                merged.insert(variable);
                list.push(Column { variable, output_of: Some(state) });
            }
        }
        let others = (0..self.dae.variables.len() as u32).map(VarId);
        let others = others.filter(|v| is_clocked(*v) && !merged.contains(v));
        list.extend(others.map(|variable| Column { variable, output_of: None }));
        let position = list.iter().enumerate().map(|(at, column)| (*column, at)).collect();
        Ok(Columns { list, position })
    }

    /// Whether two states are never active together: they lie in different states of one machine.
    fn exclude(&self, one: usize, other: usize) -> bool {
        let machines = &self.clocks.machines;
        let others: Vec<usize> = machines.chain(other).collect();
        let mut chain = machines.chain(one);
        chain.any(|a| others.iter().any(|b| a != *b && self.same_machine(a, *b)))
    }

    /// Whether transitions couple two states.
    fn same_machine(&self, one: usize, other: usize) -> bool {
        let (mut seen, mut open) = (FxHashSet::default(), vec![one]);
        while let Some(at) = open.pop() {
            if !seen.insert(at) {
                continue;
            }
            for t in &self.clocks.machines.transitions {
                if t.from == at {
                    open.push(t.to);
                } else if t.to == at {
                    open.push(t.from);
                }
            }
        }
        seen.contains(&other)
    }

    fn parallel(&self, variable: VarId, one: usize, other: usize) -> Diagnostic {
        let states = &self.clocks.machines.states;
        let path = |state: usize| states.get_index(state).map_or("", |(path, _)| &**path);
        fault!(INVALID_STATE_MACHINE,
            "{} is an output of `{}` and of `{}`, states that can be active at the same tick",
            self.name_for_message(variable), path(one), path(other);
            help: "let states of one state machine determine it")
        .at(states[other].span)
        .related(states[one].span, "the other state")
    }

    /// The column of a variable in an equation of a state, or of none.
    pub(super) fn column_of(
        &self,
        columns: &Columns,
        variable: VarId,
        state: Option<usize>,
    ) -> Option<usize> {
        let output = Column { variable, output_of: state };
        if state.is_some()
            && let Some(at) = columns.position.get(&output)
        {
            return Some(*at);
        }
        let at = columns.position.get(&Column { variable, output_of: None })?;
        let machines = &self.clocks.machines;
        let is_own = |state| {
            let declared = self.state_of_variable(variable);
            declared.is_some_and(|declared| machines.chain(declared).any(|one| one == state))
        };
        state.is_none_or(is_own).then_some(*at)
    }

    /// States hold clocked equations alone, of the clock of their machine, and no derivatives.
    pub(super) fn check_states(
        &self,
        partitions: &Partitions,
        clocked: &[ClockedEquation],
    ) -> Result<(), Diagnostic> {
        if self.clocks.machines.states.is_empty() {
            return Ok(());
        }
        for (at, variable) in self.dae.variables.iter().enumerate() {
            let is_derivative = matches!(variable.kind, VariableKind::Derivative(_));
            if is_derivative && self.state_of_variable(VarId(at as u32)).is_some() {
                return Err(fault!(NOT_SUPPORTED,
                    "`{}` in a state of a state machine: continuous equations are not discretized \
                     there", variable.name;
                    help: "write the difference equation with `previous`")
                .at(variable.span));
            }
        }
        for ClockedEquation { equation, sub, .. } in clocked {
            let Some(state) = self.state_of_instance(equation.instance) else { continue };
            let (path, one) = self.state_at(state);
            if partitions.of(one) != Some(*sub) {
                return Err(fault!(
                    CLOCK_CONFLICT,
                    "this equation has another clock than the state machine of `{path}`, in which \
                     it stands"
                )
                .at(equation.span));
            }
        }
        let incidence = self.incidence();
        for equation in self.dae.equations.iter().chain(&self.dae.events.equations) {
            let Some(state) = self.state_of_instance(equation.instance) else { continue };
            if !incidence.of(&self.dae, &[equation.left, equation.right]).is_empty() {
                let (path, _) = self.state_at(state);
                return Err(fault!(
                    NOT_SUPPORTED,
                    "an equation that is not clocked in `{path}`, a state of a state machine"
                )
                .at(equation.span));
            }
        }
        Ok(())
    }

    fn state_at(&self, state: usize) -> (&str, VarId) {
        let one = self.clocks.machines.states.get_index(state);
        one.map_or(("", VarId(0)), |(path, state)| (&**path, state.active))
    }

    /// `previous(x)`: the start value where the state is reset that declares x (MLS §17.3.2).
    pub(super) fn previous_or_start(&mut self, of: VarId) -> Expr {
        let previous = self.previous_variable(of);
        let before = self.dae.pool.variable(previous);
        let Some(state) = self.state_of_variable(of) else { return before };
        let reset = self.clocks.machines.states[state].reset;
        let zero = self.dae.pool.constant(0.0);
        let start = self.dae.variable(of).start.unwrap_or(zero);
        let reset = self.dae.pool.variable(reset);
        self.dae.pool.if_then_else(reset, start, before)
    }
}
