//! The operators of state machines (MLS §17.1) in equations and expressions: what they say about
//! states, and the variables that hold it.

use super::state_machines::{ConditionOf, State, Transition};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::{BaseType, Variability};
use crate::functions::StateOperator;
use crate::lower::build::scalar_of_nothing;
use crate::lower::builder::Builder;
use crate::lower::dae::VariableKind;
use crate::lower::equation::{Equation, Instance};
use crate::lower::errors::{INVALID_STATE_MACHINE, NOT_SUPPORTED};
use crate::lower::expressions::{ClockedCall, Lowered, Lowering};
use crate::lower::loops::LoopVariable;
use crate::source::Span;
use crate::symbolic::{Expr, VarId};
use crate::syntax::ast::{Arguments, EquationKind, Expression, ExpressionKind};
use std::sync::Arc;

impl Builder<'_> {
    /// The instances that equations make states.
    pub(in crate::lower) fn find_states(&mut self) {
        let flat = self.flat;
        for equation in &flat.equations {
            let EquationKind::Call(Expression {
                kind: ExpressionKind::Call { function, arguments },
                ..
            }) = &equation.kind
            else {
                continue;
            };
            let count = match function.as_ident() {
                Some(name) if name == "transition" => 2,
                Some(name) if name == "initialState" => 1,
                _ => continue,
            };
            for argument in arguments.positional.iter().take(count) {
                if let ExpressionKind::String(path) = &argument.kind {
                    self.declare_state(path, argument.span);
                }
            }
        }
    }

    fn declare_state(&mut self, path: &Arc<str>, span: Span) {
        if self.clocks.machines.states.contains_key(path) {
            return;
        }
        let active = self.discrete(&format!("activeState({path})"), BaseType::Boolean, span);
        let reset = self.discrete(&format!("$resetState({path})"), BaseType::Boolean, span);
        let state = State { active, reset, ticks: None, time: None, span };
        self.clocks.machines.states.insert(path.clone(), state);
    }

    /// A discrete variable of the system.
    fn discrete(&mut self, name: &str, base: BaseType, span: Span) -> VarId {
        let mut variable = scalar_of_nothing(name, VariableKind::Discrete, span);
        (variable.base, variable.variability) = (base, Variability::Discrete);
        variable.start = Some(self.dae.pool.constant(0.0));
        self.dae.declare_variable(variable)
    }

    /// The state in which the instance of an equation lies.
    pub(super) fn state_of_instance(&self, instance: Option<Instance>) -> Option<usize> {
        let path = self.dae.instances.get(instance?.0 as usize)?;
        self.clocks.machines.around(path)
    }

    /// The state in which a variable is declared.
    pub(super) fn state_of_variable(&self, variable: VarId) -> Option<usize> {
        let variable = self.dae.variable(variable);
        let of = match variable.kind {
            VariableKind::Derivative(of) => self.dae.variable(of),
            _ => variable,
        };
        self.clocks.machines.around(of.name.rsplit_once('.')?.0)
    }

    /// Whether the state is active in which the equation at hand stands; `None` in none.
    pub(in crate::lower) fn activity_here(&mut self) -> Option<Expr> {
        let state = self.state_of_instance(self.place.instance)?;
        let active = self.clocks.machines.states[state].active;
        Some(self.dae.pool.variable(active))
    }

    /// `transition(…)`, `initialState(…)`
    pub(in crate::lower) fn state_equation(
        &mut self,
        name: &str,
        arguments: &Arguments,
        span: Span,
        loops: &[LoopVariable<Expr>],
    ) -> Result<(), Diagnostic> {
        let mut states = Vec::new();
        for argument in arguments.positional.iter().take(2) {
            if let ExpressionKind::String(path) = &argument.kind {
                states.extend(self.clocks.machines.states.get_index_of(path));
            }
        }
        match (name, states.as_slice(), self.place.branches) {
            ("initialState", [state], 0) => {
                self.clocks.machines.initial.push((*state, span));
                Ok(())
            }
            ("transition", [from, to], 0) => self.transition((*from, *to), arguments, span, loops),
            _ => Err(fault!(NOT_SUPPORTED,
                "`{name}` of a state machine under a condition that is not evaluated at \
                 translation";
                help: "declare the parameters in the condition `final`")
            .at(span)),
        }
    }

    fn transition(
        &mut self,
        (from, to): (usize, usize),
        arguments: &Arguments,
        span: Span,
        loops: &[LoopVariable<Expr>],
    ) -> Result<(), Diagnostic> {
        let find = |at: usize, name: &str| {
            let named = arguments.named.iter().find(|given| given.name.node == name);
            arguments.positional.get(at).or(named.map(|given| &given.value))
        };
        let mut option = |at, name, default| match find(at, name) {
            Some(e) => self.option_of_transition(name, e, loops),
            None => Ok(default),
        };
        let immediate = option(3, "immediate", 1.0)? != 0.0;
        let reset = option(4, "reset", 1.0)? != 0.0;
        let synchronize = option(5, "synchronize", 0.0)? != 0.0;
        let priority = option(6, "priority", 1.0)?;
        if priority < 1.0 {
            return Err(fault!(
                INVALID_STATE_MACHINE,
                "the priority of this transition is {priority}, which is less than 1"
            )
            .at(span));
        }
        let Some(condition) = find(2, "condition") else {
            return Err(fault!(INVALID_STATE_MACHINE, "`transition` needs a condition").at(span));
        };
        self.clocks.machines.condition = Some(ConditionOf { from, immediate });
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.to_vec();
        let value = lowering.scalar(condition);
        self.clocks.machines.condition = None;
        let (value, number) = (value?, self.dae.variables.len());
        let held = self.discrete(&format!("$condition[{number}]"), BaseType::Boolean, span);
        let left = self.dae.pool.variable(held);
        self.dae.equations.push(Equation::new(left, value, condition.span));
        self.clocks.machines.transitions.push(Transition {
            from,
            to,
            condition: held,
            immediate,
            reset,
            synchronize,
            priority: priority as i64,
            span,
        });
        Ok(())
    }

    /// An argument of `transition` with parameter variability.
    fn option_of_transition(
        &mut self,
        name: &str,
        e: &Expression,
        loops: &[LoopVariable<Expr>],
    ) -> Result<f64, Diagnostic> {
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.to_vec();
        let value = lowering.scalar(e)?;
        self.evaluate_structural(value)?.ok_or_else(|| {
            fault!(
                NOT_SUPPORTED,
                "`{name}` of a transition of a state machine must be known at \
                                   translation"
            )
            .at(e.span)
        })
    }

    /// `activeState(state)`, `ticksInState()`, `timeInState()`
    pub(super) fn state_operator(
        &mut self,
        operator: StateOperator,
        call: &ClockedCall<Expr>,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        let Some(Lowered::Text(path)) = call.at(0, "state") else {
            return Err(
                fault!(NOT_SUPPORTED, "state machines have a meaning in models only").at(span)
            );
        };
        let variable = match operator {
            StateOperator::Active => {
                let state = self.clocks.machines.states.get(path);
                let state = state.ok_or_else(|| {
                    fault!(INVALID_STATE_MACHINE, "`{path}` is not a state of a state machine";
                        help: "name an instance that a `transition` or `initialState` names")
                    .at(span)
                })?;
                state.active
            }
            StateOperator::Ticks => self.since_activation(path, span)?.0,
            StateOperator::Time => self.since_activation(path, span)?.1,
            StateOperator::Transition | StateOperator::Initial => {
                return Err(
                    fault!(INVALID_STATE_MACHINE, "this is an equation, not a value").at(span)
                );
            }
        };
        Ok(self.dae.pool.variable(variable))
    }

    /// The variables of `ticksInState()` and `timeInState()`.
    fn since_activation(&mut self, path: &str, span: Span) -> Result<(VarId, VarId), Diagnostic> {
        let state = match self.clocks.machines.condition {
            Some(ConditionOf { immediate: true, .. }) => {
                return Err(fault!(NOT_SUPPORTED,
                    "`ticksInState` and `timeInState` in the condition of an immediate transition \
                     of a state machine: they depend on whether it fires";
                    help: "write `immediate = false`")
                .at(span));
            }
            Some(ConditionOf { from, .. }) => Some(from),
            None => self.clocks.machines.around(path),
        };
        let Some(at) = state else {
            return Err(fault!(
                INVALID_STATE_MACHINE,
                "`ticksInState` and `timeInState` have a meaning in states of state machines \
                 and in conditions of their transitions only"
            )
            .at(span));
        };
        let state = self.clocks.machines.states[at];
        if let (Some(ticks), Some(time)) = (state.ticks, state.time) {
            return Ok((ticks, time));
        }
        let ticks = self.discrete(&format!("$ticksInState[{at}]"), BaseType::Integer, span);
        let time = self.discrete(&format!("$timeInState[{at}]"), BaseType::Real, span);
        let known = State { ticks: Some(ticks), time: Some(time), ..state };
        self.clocks.machines.states[at] = known;
        Ok((ticks, time))
    }
}
