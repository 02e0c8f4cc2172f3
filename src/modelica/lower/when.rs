//! When-equations (MLS §8.3.5): what they assign becomes one equation for each variable,
//! `v = if active₁ then e₁ elseif active₂ then e₂ … else pre(v)`.
//!
//! A branch is active in the event iteration in which one of its conditions becomes true and no
//! branch before it is active; a branch with `initial()` also during initialization (MLS §8.6).

use super::builder::Builder;
use super::dae::VariableKind;
use super::equation::Equation;
use super::errors::{ARRAY_MISMATCH, NOT_SUPPORTED, UNBALANCED_MODEL};
use super::events::Reinit;
use super::execution::Loops;
use super::expressions::{Array, Lowering};
use super::loops::LoopVariable;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::BaseType;
use crate::source::Span;
use crate::symbolic::{Expr, VarId};
use crate::syntax::ast::{self, EquationKind, Expression, ExpressionKind};
use indexmap::IndexMap;

/// A value with the condition under which a when-clause gives it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Guarded {
    pub(super) guard: Expr,
    pub(super) value: Expr,
    pub(super) span: Span,
}

type Assigned = IndexMap<VarId, Vec<Guarded>>;

impl Builder<'_> {
    pub(super) fn when_equation(
        &mut self,
        branches: &[(Expression, Vec<ast::Equation>)],
        span: Span,
        loops: &mut Loops,
    ) -> Result<(), Diagnostic> {
        if self.place.initial {
            return Err(fault!(NOT_SUPPORTED, "`when` among the initial equations").at(span));
        }
        if self.place.branches > 0 {
            return Err(fault!(NOT_SUPPORTED, "`when` under a condition that can change";
                help: "move the condition into the condition of the when-clause")
            .at(span));
        }
        let mut assigned = Assigned::new();
        let mut earlier = self.dae.pool.constant(0.0);
        for (condition, body) in branches {
            let active = self.activation(condition, loops)?;
            let not = self.dae.pool.not(earlier);
            let guard = self.dae.pool.and(not, active);
            self.place.in_when = true;
            let done = self.when_body(body, guard, &mut assigned, loops);
            self.place.in_when = false;
            done?;
            earlier = self.dae.pool.or(earlier, active);
        }
        for (variable, values) in assigned {
            self.assign_at_events(variable, &values, span)?;
        }
        Ok(())
    }

    /// Whether a when-clause with this condition acts: a condition becomes true, or it is
    /// `initial()` and the model is being initialized.
    pub(super) fn activation(
        &mut self,
        condition: &Expression,
        loops: &[LoopVariable<Expr>],
    ) -> Result<Expr, Diagnostic> {
        let elements = match &condition.kind {
            ExpressionKind::Array(elements) => elements.as_slice(),
            _ => std::slice::from_ref(condition),
        };
        let mut lowered = Vec::new();
        let mut at_start = false;
        for element in elements {
            if is_initial(element) {
                at_start = true;
                continue;
            }
            let mut lowering = Lowering::new(self);
            lowering.loops = loops.to_vec();
            lowered.push((lowering.array(element)?, element.span));
        }
        self.activation_of(&lowered, at_start)
    }

    /// The same for conditions that are expressions already.
    fn activation_of(
        &mut self,
        conditions: &[(Array<Expr>, Span)],
        at_start: bool,
    ) -> Result<Expr, Diagnostic> {
        let mut edges = self.dae.pool.constant(0.0);
        for (array, span) in conditions {
            for element in &array.elements {
                let edge = self.edge(*element, *span)?;
                edges = self.dae.pool.or(edges, edge);
            }
        }
        let initial = self.initial_signal();
        let not = self.dae.pool.not(initial);
        let later = self.dae.pool.and(not, edges);
        Ok(match at_start {
            true => self.dae.pool.or(initial, later),
            false => later,
        })
    }

    /// `v = if guard₁ then value₁ … else pre(v)`
    fn assign_at_events(
        &mut self,
        variable: VarId,
        values: &[Guarded],
        span: Span,
    ) -> Result<(), Diagnostic> {
        let (name, kind) =
            (self.dae.variable(variable).name.clone(), self.dae.variable(variable).kind);
        if kind != VariableKind::Discrete {
            return Err(
                fault!(NOT_SUPPORTED, "`{name}` cannot be assigned in a when-clause").at(span)
            );
        }
        if !self.execution.assigned.insert(variable) {
            return Err(fault!(UNBALANCED_MODEL, "`{name}` is assigned by two when-clauses";
                help: "use one `when` with `elsewhen` branches")
            .at(span));
        }
        let left = self.dae.pool.variable(variable);
        let mut right = self.previous(left, span)?;
        for value in values.iter().rev() {
            right = self.dae.pool.if_then_else(value.guard, value.value, right);
        }
        let span = values.first().map_or(span, |value| value.span);
        let equation =
            Equation { instance: self.place.instance, ..Equation::new(left, right, span) };
        self.dae.events.equations.push(equation);
        Ok(())
    }

    fn when_body(
        &mut self,
        body: &[ast::Equation],
        guard: Expr,
        assigned: &mut Assigned,
        loops: &mut Loops,
    ) -> Result<(), Diagnostic> {
        for equation in body {
            let before = self.dae.assertions.len();
            match &equation.kind {
                EquationKind::Equal { left, right } => {
                    for pair in self.when_equal(left, right, equation.span, loops)? {
                        let Some(variable) = self.dae.pool.as_variable(pair.left) else {
                            return Err(fault!(NOT_SUPPORTED,
                                "an equation in a when-clause must determine a variable";
                                help: "write `variable = expression`")
                            .at(equation.span));
                        };
                        let value = Guarded { guard, value: pair.right, span: pair.span };
                        assigned.entry(variable).or_default().push(value);
                    }
                }
                EquationKind::If { branches, otherwise } => {
                    self.when_if(branches, otherwise, guard, assigned, loops)?;
                }
                EquationKind::For { indices, body } => {
                    self.when_for(indices, body, guard, assigned, loops)?;
                }
                EquationKind::Call(call) => self.when_call(call, guard, loops)?,
                EquationKind::When { .. } => {
                    return Err(fault!(NOT_SUPPORTED, "`when` inside `when`").at(equation.span));
                }
                EquationKind::Connect { .. } => {
                    return Err(fault!(NOT_SUPPORTED, "`connect` inside `when`").at(equation.span));
                }
            }
            self.dae.move_assertions(before, guard);
        }
        Ok(())
    }

    /// The scalar equations of `left = right`, of which the right side may be a call that writes.
    fn when_equal(
        &mut self,
        left: &Expression,
        right: &Expression,
        span: Span,
        loops: &mut Loops,
    ) -> Result<Vec<Equation>, Diagnostic> {
        match self.confirmed(right, loops)? {
            Some(done) => {
                let left = self.when_lowering(loops).scalar(left)?;
                Ok(vec![Equation::new(left, done, span)])
            }
            None => self.equal(left, right, span, loops),
        }
    }

    fn when_if(
        &mut self,
        branches: &[(Expression, Vec<ast::Equation>)],
        otherwise: &[ast::Equation],
        guard: Expr,
        assigned: &mut Assigned,
        loops: &mut Loops,
    ) -> Result<(), Diagnostic> {
        let mut rest = guard;
        for (condition, body) in branches {
            let condition = self.when_lowering(loops).scalar(condition)?;
            let taken = self.dae.pool.and(rest, condition);
            self.when_body(body, taken, assigned, loops)?;
            let not = self.dae.pool.not(condition);
            rest = self.dae.pool.and(rest, not);
        }
        self.when_body(otherwise, rest, assigned, loops)
    }

    fn when_for(
        &mut self,
        indices: &[ast::ForIndex],
        body: &[ast::Equation],
        guard: Expr,
        assigned: &mut Assigned,
        loops: &mut Loops,
    ) -> Result<(), Diagnostic> {
        let Some((index, inner)) = indices.split_first() else {
            return self.when_body(body, guard, assigned, loops);
        };
        for variable in self.when_lowering(loops).loop_variables(index)? {
            loops.push(variable);
            let done = self.when_for(inner, body, guard, assigned, loops);
            loops.pop();
            done?;
        }
        Ok(())
    }

    /// Relations in the body of a when-clause cause no events of their own.
    fn when_lowering(&mut self, loops: &Loops) -> Lowering<'_, Self> {
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.clone();
        lowering.live = true;
        lowering
    }

    /// `assert`, `terminate`, `reinit`
    fn when_call(
        &mut self,
        call: &Expression,
        guard: Expr,
        loops: &Loops,
    ) -> Result<(), Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &call.kind else {
            return Err(fault!(NOT_SUPPORTED, "this is not an equation").at(call.span));
        };
        match (function.name().to_string().as_str(), arguments.positional.as_slice()) {
            ("assert", _) => self.assertion(arguments, call.span, loops),
            ("terminate", _) => {
                self.terminate(arguments, guard, call.span, loops);
                Ok(())
            }
            ("reinit", [state, value]) => {
                let mut lowering = self.when_lowering(loops);
                let (states, values) = (lowering.array(state)?, lowering.array(value)?);
                self.reinit(&states, &values, guard, call.span)
            }
            _ => self.call_statement(call, loops, true),
        }
    }

    /// Assertions read since `from`, those of initial sections, hold at the start.
    pub(super) fn move_to_start(&mut self, from: usize) {
        if self.dae.assertions.len() > from {
            let guard = self.initial_signal();
            self.dae.move_assertions(from, guard);
        }
    }

    fn reinit(
        &mut self,
        states: &Array<Expr>,
        values: &Array<Expr>,
        guard: Expr,
        span: Span,
    ) -> Result<(), Diagnostic> {
        if states.dims != values.dims {
            return Err(fault!(ARRAY_MISMATCH, "the sides of `reinit` differ in size").at(span));
        }
        for (state, value) in states.elements.iter().zip(&values.elements) {
            let variable = self.dae.pool.as_variable(*state);
            let is_settable = |v: &VarId| match self.dae.variable(*v).kind {
                VariableKind::Unknown => true,
                // As other tools have it: see `causalize::reinit`.
                VariableKind::Discrete => {
                    !self.flat.strict && self.dae.variable(*v).base == BaseType::Real
                }
                _ => false,
            };
            let Some(state) = variable.filter(is_settable) else {
                return Err(
                    fault!(NOT_SUPPORTED, "`reinit` of a variable that is not a state").at(span)
                );
            };
            self.dae.events.reinits.push(Reinit { state, condition: guard, value: *value, span });
        }
        Ok(())
    }
}

/// `initial()`
pub(super) fn is_initial(e: &Expression) -> bool {
    match &e.kind {
        ExpressionKind::Call { function, .. } => {
            function.as_ident().is_some_and(|name| name == "initial")
        }
        _ => false,
    }
}
