//! What state machines do at every tick: the equations of MLS §17.3.4, "Semantics Summary", with
//! its names. `nextReset` is left out, as it is never true.

use super::state_machines::{State, Transition};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::BaseType;
use crate::lower::builder::Builder;
use crate::lower::equation::Equation;
use crate::lower::errors::{INVALID_STATE_MACHINE, NOT_SUPPORTED};
use crate::source::Span;
use crate::symbolic::{Expr, RelationOperator, VarId};

/// A state machine.
#[derive(Debug)]
struct Machine {
    /// Its states, the initial one first.
    states: Vec<usize>,
    /// Its transitions, those of high priority last.
    transitions: Vec<Transition>,
    /// The state that encloses it.
    parent: Option<usize>,
    next_state: VarId,
    active_state: VarId,
    /// The transition that fires, from 1.
    fired: VarId,
    span: Span,
}

impl Machine {
    /// The number of a state, from 1; 0 stands for none.
    fn number(&self, state: usize) -> usize {
        self.states.iter().position(|one| *one == state).map_or(0, |at| at + 1)
    }
}

impl Builder<'_> {
    /// Adds the equations of all state machines.
    pub(super) fn add_state_machines(&mut self) -> Result<(), Diagnostic> {
        let machines = self.machines()?;
        (0..machines.len()).for_each(|at| self.add_machine(&machines, at));
        for state in 0..self.clocks.machines.states.len() {
            self.add_time_in_state(&machines, state);
        }
        Ok(())
    }

    /// The clusters of states that transitions couple.
    fn machines(&mut self) -> Result<Vec<Machine>, Diagnostic> {
        let known = &self.clocks.machines;
        let mut cluster: Vec<usize> = (0..known.states.len()).collect();
        for Transition { from, to, .. } in &known.transitions {
            let (one, other) = (cluster[*from], cluster[*to]);
            cluster.iter_mut().filter(|at| **at == other).for_each(|at| *at = one);
        }
        let mut machines = Vec::new();
        for first in 0..cluster.len() {
            if cluster[..first].contains(&cluster[first]) {
                continue;
            }
            let number = cluster[first];
            let states: Vec<usize> =
                (0..cluster.len()).filter(|state| cluster[*state] == number).collect();
            machines.push(self.machine(states)?);
        }
        Ok(machines)
    }

    fn machine(&mut self, mut states: Vec<usize>) -> Result<Machine, Diagnostic> {
        let known = &self.clocks.machines;
        let span = known.states[states[0]].span;
        let name = |state: usize| known.states.get_index(state).map_or("", |(path, _)| &**path);
        let initial: Vec<(usize, Span)> =
            known.initial.iter().filter(|(state, _)| states.contains(state)).copied().collect();
        match initial.as_slice() {
            [_] => {}
            [] => {
                return Err(fault!(INVALID_STATE_MACHINE,
                    "the state machine of `{}` has no initial state", name(states[0]);
                    help: "add `initialState(…)`")
                .at(span));
            }
            [(one, first), (other, second), ..] => {
                return Err(fault!(
                    INVALID_STATE_MACHINE,
                    "a state machine has two initial states, `{}` and `{}`",
                    name(*one),
                    name(*other)
                )
                .at(*second)
                .related(*first, "the other one"));
            }
        }
        let mut transitions: Vec<Transition> =
            known.transitions.iter().filter(|t| states.contains(&t.from)).copied().collect();
        for (at, one) in transitions.iter().enumerate() {
            let same = |t: &&Transition| t.from == one.from && t.priority == one.priority;
            if let Some(other) = transitions[..at].iter().find(same) {
                return Err(fault!(INVALID_STATE_MACHINE,
                    "two transitions from `{}` have the priority {}", name(one.from), one.priority;
                    help: "give them different values of `priority`")
                .at(one.span)
                .related(other.span, "the other one"));
            }
        }
        transitions.sort_by_key(|t| std::cmp::Reverse(t.priority));
        let parent = known.enclosing(states[0]);
        if let Some(other) = states.iter().find(|state| known.enclosing(**state) != parent) {
            return Err(fault!(
                NOT_SUPPORTED,
                "the states `{}` and `{}` of one state machine lie in different states",
                name(states[0]),
                name(*other)
            )
            .at(span));
        }
        states.sort_by_key(|state| *state != initial[0].0);
        Ok(Machine {
            states,
            transitions,
            parent,
            next_state: self.variable_of_machine("$nextState", BaseType::Integer, span),
            active_state: self.variable_of_machine("$activeState", BaseType::Integer, span),
            fired: self.variable_of_machine("$fired", BaseType::Integer, span),
            span,
        })
    }

    fn variable_of_machine(&mut self, name: &str, base: BaseType, span: Span) -> VarId {
        let (variable, _) = self.at_events(name, base, span);
        self.dae.variables[variable.0 as usize].start = Some(self.dae.pool.constant(0.0));
        variable
    }

    fn set_clocked(&mut self, variable: VarId, value: Expr, span: Span) {
        let left = self.dae.pool.variable(variable);
        self.dae.equations.push(Equation::new(left, value, span));
    }

    fn equals(&mut self, value: Expr, number: usize) -> Expr {
        let number = self.dae.pool.constant(number as f64);
        self.dae.pool.relation(RelationOperator::Equal, value, number)
    }

    fn state(&self, at: usize) -> State {
        self.clocks.machines.states[at]
    }

    /// The equations of a state machine.
    fn add_machine(&mut self, machines: &[Machine], at: usize) {
        let machine = &machines[at];
        let span = machine.span;
        let before = self.pre(machine.next_state);
        let (active, reset) = match machine.parent.map(|parent| self.state(parent)) {
            Some(parent) => {
                (self.dae.pool.variable(parent.active), self.dae.pool.variable(parent.reset))
            }
            // The first tick: there is no next state from the tick before.
            None => (self.dae.pool.constant(1.0), self.equals(before, 0)),
        };
        let one = self.dae.pool.constant(1.0);
        let selected = self.dae.pool.if_then_else(reset, one, before);
        let next = self.dae.pool.variable(machine.next_state);
        let immediate = self.first_enabled(machines, machine, true, selected);
        let enabled = self.first_enabled(machines, machine, false, next);
        let delayed = self.variable_of_machine("$delayed", BaseType::Integer, span);
        self.set_clocked(delayed, enabled, span);
        let due = self.pre(delayed);
        let pool = &mut self.dae.pool;
        let is_due = pool.relation(RelationOperator::Greater, due, immediate);
        let highest = pool.if_then_else(is_due, due, immediate);
        self.set_clocked(machine.fired, highest, span);
        let fired = self.dae.pool.variable(machine.fired);
        let (mut target, mut active_reset) = (selected, reset);
        for (number, transition) in machine.transitions.iter().enumerate() {
            let fires = self.equals(fired, number + 1);
            let to = self.dae.pool.constant(machine.number(transition.to) as f64);
            target = self.dae.pool.if_then_else(fires, to, target);
            if transition.reset {
                active_reset = self.dae.pool.or(active_reset, fires);
            }
        }
        let now = self.dae.pool.if_then_else(reset, one, target);
        self.set_clocked(machine.active_state, now, span);
        let now = self.dae.pool.variable(machine.active_state);
        let following = self.dae.pool.if_then_else(active, now, before);
        self.set_clocked(machine.next_state, following, span);
        for (number, state) in machine.states.iter().enumerate() {
            self.add_state(*state, (now, number + 1), (active, reset, active_reset), span);
        }
    }

    /// The transition of the highest priority that leads from a state and is enabled; 0 for none.
    fn first_enabled(
        &mut self,
        machines: &[Machine],
        machine: &Machine,
        immediate: bool,
        state: Expr,
    ) -> Expr {
        let mut found = self.dae.pool.constant(0.0);
        for (number, transition) in machine.transitions.iter().enumerate() {
            if transition.immediate != immediate {
                continue;
            }
            let leads = self.equals(state, machine.number(transition.from));
            let condition = self.dae.pool.variable(transition.condition);
            let mut enabled = self.dae.pool.and(leads, condition);
            if transition.synchronize {
                let is_final = self.is_in_final_states(machines, *transition);
                enabled = self.dae.pool.and(enabled, is_final);
            }
            let number = self.dae.pool.constant((number + 1) as f64);
            found = self.dae.pool.if_then_else(enabled, number, found);
        }
        found
    }

    /// Whether all state machines within the state that a transition leaves are in final states;
    /// for an immediate transition at the tick before, as it fires before they are executed.
    fn is_in_final_states(&mut self, machines: &[Machine], transition: Transition) -> Expr {
        let mut all = self.dae.pool.constant(1.0);
        for inner in machines.iter().filter(|inner| inner.parent == Some(transition.from)) {
            let state = match transition.immediate {
                true => self.pre(inner.next_state),
                false => self.dae.pool.variable(inner.active_state),
            };
            let mut is_final = self.dae.pool.constant(0.0);
            for (at, one) in inner.states.iter().enumerate() {
                if inner.transitions.iter().all(|t| t.from != *one) {
                    let is_here = self.equals(state, at + 1);
                    is_final = self.dae.pool.or(is_final, is_here);
                }
            }
            all = self.dae.pool.and(all, is_final);
        }
        all
    }

    /// Whether a state is active, whether it is reset, and whether it still has to be.
    fn add_state(
        &mut self,
        state: usize,
        (now, number): (Expr, usize),
        (active, reset, active_reset): (Expr, Expr, Expr),
        span: Span,
    ) {
        let State { active: is_active, reset: is_reset, .. } = self.state(state);
        let pending = self.variable_of_machine("$nextResetState", BaseType::Boolean, span);
        let before = self.pre(pending);
        let here = self.equals(now, number);
        let pool = &mut self.dae.pool;
        let active_here = pool.and(active, here);
        let must_reset = pool.or(reset, before);
        let elsewhere = pool.not(here);
        let later = pool.and(elsewhere, must_reset);
        let still = pool.if_then_else(active, later, before);
        let flag = pool.variable(is_active);
        let resets = pool.or(active_reset, must_reset);
        let resets = pool.and(flag, resets);
        self.set_clocked(is_active, active_here, span);
        self.set_clocked(pending, still, span);
        self.set_clocked(is_reset, resets, span);
    }

    /// `ticksInState()` and `timeInState()` of a state, where they are asked for.
    fn add_time_in_state(&mut self, machines: &[Machine], at: usize) {
        let State { active, ticks: Some(ticks), time: Some(since), span, .. } = self.state(at)
        else {
            return;
        };
        let mut entered = self.dae.pool.constant(0.0);
        let around: Vec<usize> = self.clocks.machines.chain(at).collect();
        for machine in machines.iter().filter(|m| m.states.iter().any(|s| around.contains(s))) {
            let fired = self.dae.pool.variable(machine.fired);
            let none = self.equals(fired, 0);
            let some = self.dae.pool.not(none);
            entered = self.dae.pool.or(entered, some);
        }
        let ticks_before = self.pre(ticks);
        let first = self.equals(ticks_before, 0);
        let entered = self.dae.pool.or(entered, first);
        let entry = self.variable_of_machine("$entry", BaseType::Real, span);
        let entry_before = self.pre(entry);
        let pool = &mut self.dae.pool;
        let (active, time) = (pool.variable(active), pool.variable(VarId(0)));
        let (zero, one) = (pool.constant(0.0), pool.constant(1.0));
        let more = pool.add(ticks_before, one);
        let counted = pool.if_then_else(entered, one, more);
        let counted = pool.if_then_else(active, counted, zero);
        let enters = pool.and(active, entered);
        let entry_now = pool.if_then_else(enters, time, entry_before);
        let entry_value = pool.variable(entry);
        let passed = pool.sub(time, entry_value);
        let passed = pool.if_then_else(active, passed, zero);
        self.set_clocked(ticks, counted, span);
        self.set_clocked(entry, entry_now, span);
        self.set_clocked(since, passed, span);
    }
}
