//! Algorithm sections become equations: their statements are evaluated symbolically, and every
//! variable assigned equals what it has at the end (MLS §11.1).
//!
//! At the beginning a continuous variable has its start value, a discrete one its previous value.
//! Loops of known length are unrolled, branches merged into if-expressions.

use super::assigned_variables::AssignedScalar;
use super::builder::Builder;
use super::dae::VariableKind;
use super::equation::Equation;
use super::errors::{
    ARRAY_MISMATCH, NO_CONSTANT_VALUE, NOT_DISCRETE, NOT_SUPPORTED, UNBALANCED_MODEL,
    UNRESOLVED_REFERENCE,
};
use super::execution::Loops;
use super::expressions::{Lowered, Lowering, Target};
use super::shape::UNKNOWN_TEXT;
use super::statement_function::may_be_a_function;
use super::when::is_initial;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::BaseType;
use crate::source::Span;
use crate::symbolic::{Expr, VarId, substitute};
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, ForIndex, Statement, StatementKind,
};
use rustc_hash::FxHashMap;

/// How a sequence of statements ended: whether a loop was left, as a condition.
type Broken = Expr;

type Branch<'a> = (&'a Expression, &'a [Statement]);

impl Builder<'_> {
    /// Adds the equations of an algorithm section.
    pub(super) fn algorithm(&mut self, statements: &[Statement]) -> Result<(), Diagnostic> {
        let Some(first) = statements.first() else { return Ok(()) };
        let mut targets = Vec::new();
        self.targets(statements, &mut Vec::new(), &mut targets);
        for variable in targets {
            let before = self.value_before(variable, first.span)?;
            self.execution.values.insert(variable, before);
        }
        self.statements(statements, &mut Vec::new())?;
        let execution = std::mem::take(&mut self.execution);
        for (variable, right) in execution.values {
            let left = self.dae.pool.variable(variable);
            let instance = self.place.instance;
            let equation = Equation { instance, ..Equation::new(left, right, first.span) };
            let is_discrete = self.dae.variable(variable).kind == VariableKind::Discrete;
            match (self.place.initial, is_discrete) {
                (true, _) => self.dae.initial_equations.push(equation),
                (false, false) => self.dae.equations.push(equation),
                (false, true) => {
                    let in_when = execution.in_when.contains(&variable);
                    self.discrete_assignment(variable, equation, in_when)?;
                }
            }
        }
        Ok(())
    }

    /// What a variable that the algorithm assigns has before its first statement.
    fn value_before(&mut self, variable: VarId, span: Span) -> Result<Expr, Diagnostic> {
        let zero = self.dae.pool.constant(0.0);
        let known = self.dae.variable(variable);
        match known.kind {
            VariableKind::Discrete => {
                let own = self.dae.pool.variable(variable);
                self.previous(own, span)
            }
            VariableKind::Unknown => Ok(known.start.unwrap_or(zero)),
            VariableKind::Solved if self.place.initial => Ok(known.start.unwrap_or(zero)),
            _ => Err(fault!(NOT_SUPPORTED, "`{}` cannot be assigned", known.name).at(span)),
        }
    }

    fn discrete_assignment(
        &mut self,
        variable: VarId,
        equation: Equation,
        in_when: bool,
    ) -> Result<(), Diagnostic> {
        let name = self.dae.variable(variable).name.clone();
        if !self.execution.assigned.insert(variable) {
            return Err(fault!(UNBALANCED_MODEL, "`{name}` is assigned more than once";
                help: "assign it in one algorithm or one when-clause")
            .at(equation.span));
        }
        if !in_when && self.varies(equation.right) && self.varies_between_events(equation.right) {
            return Err(fault!(NOT_DISCRETE,
                "`{name}` is discrete, but its value can change between events";
                help: "do not use relations inside `noEvent` or inside functions")
            .at(equation.span));
        }
        self.dae.events.equations.push(equation);
        Ok(())
    }

    /// Whether an expression varies even where no when-clause acts: between events `pre(v)` is `v`.
    pub(super) fn varies_between_events(&mut self, e: Expr) -> bool {
        let initial = self.initial_signal();
        let initial = self.dae.pool.as_variable(initial);
        let zero = self.dae.pool.constant(0.0);
        let mut now = FxHashMap::default();
        for (of, previous) in &self.scalars.previous {
            now.insert(*previous, self.dae.pool.variable(*of));
        }
        now.extend(initial.map(|variable| (variable, zero)));
        let between = substitute(&mut self.dae.pool, e, &|v| now.get(&v).copied());
        self.varies(between)
    }

    pub(super) fn statement_lowering(&mut self, loops: &Loops) -> Lowering<'_, Self> {
        let live = self.place.in_when;
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.clone();
        lowering.live = live;
        lowering
    }

    fn statements(&mut self, list: &[Statement], loops: &mut Loops) -> Result<Broken, Diagnostic> {
        let mut broken = self.not_broken();
        for statement in list {
            broken =
                self.unless(broken, loops, |builder, loops| builder.statement(statement, loops))?;
            if self.dae.pool.as_constant(broken) == Some(1.0) {
                break;
            }
        }
        Ok(broken)
    }

    fn not_broken(&mut self) -> Broken {
        self.dae.pool.constant(0.0)
    }

    /// Carries out what follows in a loop that has been left where `broken` holds.
    fn unless(
        &mut self,
        broken: Broken,
        loops: &mut Loops,
        body: impl FnOnce(&mut Self, &mut Loops) -> Result<Broken, Diagnostic>,
    ) -> Result<Broken, Diagnostic> {
        if self.dae.pool.as_constant(broken) == Some(0.0) {
            return body(self, loops);
        }
        let yes = self.dae.pool.constant(1.0);
        self.choose(broken, loops, |_, _| Ok(yes), body)
    }

    fn count_statement(&mut self, span: Span) -> Result<(), Diagnostic> {
        self.calls.statements = self.calls.statements.saturating_sub(1);
        match self.calls.statements {
            0 => Err(fault!(NOT_SUPPORTED, "this model has too many statements").at(span)),
            _ => Ok(()),
        }
    }

    fn statement(&mut self, s: &Statement, loops: &mut Loops) -> Result<Broken, Diagnostic> {
        self.count_statement(s.span)?;
        let asserted = self.dae.assertions.len();
        match &s.kind {
            StatementKind::Assign { target, value } => {
                match self.assignment(target, value, loops) {
                    Err(error) if may_be_a_function(&error) => {
                        self.dae.assertions.truncate(asserted);
                        self.call_of_statement(s, loops).map_err(|_| error)?;
                    }
                    done => done?,
                }
                self.guard_new_assertions(asserted);
            }
            StatementKind::MultiAssign { targets, value } => {
                self.assign_outputs(targets, value, loops)?;
                self.guard_new_assertions(asserted);
            }
            StatementKind::If { branches, otherwise } => {
                let branches: Vec<Branch> = branches.iter().map(|(c, b)| (c, &b[..])).collect();
                return self.if_statement(&branches, otherwise, loops);
            }
            StatementKind::For { .. } | StatementKind::While { .. } => {
                return self.loop_statement(s, loops);
            }
            StatementKind::When { branches } => {
                let branches: Vec<Branch> = branches.iter().map(|(c, b)| (c, &b[..])).collect();
                let none = self.dae.pool.constant(0.0);
                self.when_statement(&branches, none, s.span, loops)?;
            }
            StatementKind::Call(call) => {
                self.statement_call(call, loops)?;
                self.guard_new_assertions(asserted);
            }
            StatementKind::Break => return Ok(self.dae.pool.constant(1.0)),
            StatementKind::Return => {
                return Err(fault!(NOT_SUPPORTED, "`return` outside a function").at(s.span));
            }
        }
        Ok(self.not_broken())
    }

    /// A loop is unrolled, or else a function.
    fn loop_statement(&mut self, s: &Statement, loops: &mut Loops) -> Result<Broken, Diagnostic> {
        // In an unrolled loop, the whole statement becomes a function instead.
        let before = loops.is_empty().then(|| self.execution.values.clone());
        let (asserted, guards) = (self.dae.assertions.len(), self.execution.guards.len());
        let outer = loops.len();
        let done = match &s.kind {
            StatementKind::For { indices, body } => self.for_statement(indices, body, loops),
            StatementKind::While { condition, body } => {
                self.while_statement(condition, body, s.span, loops)
            }
            _ => return Ok(self.not_broken()),
        };
        match (done, before) {
            (Err(error), Some(before)) if may_be_a_function(&error) => {
                loops.truncate(outer);
                self.dae.assertions.truncate(asserted);
                self.execution.values = before;
                self.execution.guards.truncate(guards);
                let called = self.call_of_statement(s, loops);
                // A loop whose end is not known must be a function; else its body is not possible.
                called.map_err(|why| if error.code == NO_CONSTANT_VALUE { why } else { error })?;
                self.guard_new_assertions(asserted);
                Ok(self.not_broken())
            }
            (done, _) => done,
        }
    }

    fn while_statement(
        &mut self,
        condition: &Expression,
        body: &[Statement],
        span: Span,
        loops: &mut Loops,
    ) -> Result<Broken, Diagnostic> {
        let mut broken = self.not_broken();
        while self.statement_lowering(loops).known(condition)? != 0.0 {
            self.count_statement(span)?;
            broken =
                self.unless(broken, loops, |builder, loops| builder.statements(body, loops))?;
            if self.dae.pool.as_constant(broken) == Some(1.0) {
                break;
            }
        }
        Ok(self.not_broken())
    }

    fn assignment(
        &mut self,
        target: &ComponentReference,
        value: &Expression,
        loops: &Loops,
    ) -> Result<(), Diagnostic> {
        if (self.place.in_when || self.place.initial)
            && let Some(done) = self.confirmed(value, loops)?
        {
            return self.assign(target, Lowered::scalar(done), loops);
        }
        let mut lowering = self.statement_lowering(loops);
        let lowered = match lowering.lower(value)? {
            Lowered::Text(text) if text.contains(UNKNOWN_TEXT) => {
                lowering.run_time_string(value)?
            }
            lowered => lowered,
        };
        self.assign(target, lowered, loops)
    }

    fn assign(
        &mut self,
        target: &ComponentReference,
        value: Lowered<Expr>,
        loops: &Loops,
    ) -> Result<(), Diagnostic> {
        let places = self.places(target, loops)?;
        let is_text =
            |place: &AssignedScalar| self.dae.variable(place.variable).base == BaseType::String;
        let value = match places.first().is_some_and(is_text) {
            true => Lowered::scalar(Lowering::new(self).number_of_text(value, target.span)?),
            false => value,
        };
        let mut values = Vec::new();
        value.append_scalars(&mut values);
        let expected = places.last().map_or(0, |place| place.element + 1);
        if expected != values.len() {
            return Err(fault!(
                ARRAY_MISMATCH,
                "{} elements are assigned to {expected}",
                values.len()
            )
            .at(target.span));
        }
        for AssignedScalar { variable, element, guard } in places {
            let Some(before) = self.execution.values.get_mut(&variable) else {
                let name = self.dae.variable(variable).name.clone();
                return Err(fault!(NOT_SUPPORTED, "`{name}` cannot be assigned").at(target.span));
            };
            *before = match guard {
                None => values[element],
                Some(guard) => self.dae.pool.if_then_else(guard, values[element], *before),
            };
            if self.place.in_when {
                self.execution.in_when.insert(variable);
            }
        }
        Ok(())
    }

    /// `(a, , b) := f(x)`
    fn assign_outputs(
        &mut self,
        targets: &[Option<ComponentReference>],
        value: &Expression,
        loops: &Loops,
    ) -> Result<(), Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &value.kind else {
            return Err(fault!(
                NOT_SUPPORTED,
                "a list of variables on the left side needs a function call on the right side"
            )
            .at(value.span));
        };
        let name = function.name();
        let Some(user) = Target::function(self, &name) else {
            return Err(
                fault!(UNRESOLVED_REFERENCE, "there is no function `{name}`").at(function.span)
            );
        };
        let mut lowering = self.statement_lowering(loops);
        let outputs = lowering.outputs_for(targets, &user, arguments, value.span)?;
        if targets.len() > outputs.len() {
            return Err(
                fault!(ARRAY_MISMATCH, "`{name}` has {} outputs", outputs.len()).at(value.span)
            );
        }
        for (target, output) in targets.iter().zip(outputs) {
            if let Some(target) = target {
                self.assign(target, output, loops)?;
            }
        }
        Ok(())
    }

    fn if_statement(
        &mut self,
        branches: &[Branch],
        otherwise: &[Statement],
        loops: &mut Loops,
    ) -> Result<Broken, Diagnostic> {
        let Some(((condition, body), rest)) = branches.split_first() else {
            return self.statements(otherwise, loops);
        };
        let asserted = self.dae.assertions.len();
        let condition = self.statement_lowering(loops).scalar(condition)?;
        self.guard_new_assertions(asserted);
        if let Some(known) = self.dae.pool.as_constant(condition) {
            return match known != 0.0 {
                true => self.statements(body, loops),
                false => self.if_statement(rest, otherwise, loops),
            };
        }
        self.choose(
            condition,
            loops,
            |builder, loops| builder.statements(body, loops),
            |builder, loops| builder.if_statement(rest, otherwise, loops),
        )
    }

    /// Carries out both branches and merges what they assign.
    fn choose(
        &mut self,
        condition: Expr,
        loops: &mut Loops,
        first: impl FnOnce(&mut Self, &mut Loops) -> Result<Broken, Diagnostic>,
        second: impl FnOnce(&mut Self, &mut Loops) -> Result<Broken, Diagnostic>,
    ) -> Result<Broken, Diagnostic> {
        let before = self.execution.values.clone();
        self.execution.guards.push(condition);
        let flow = first(self, loops)?;
        self.execution.guards.pop();
        let taken = std::mem::replace(&mut self.execution.values, before);
        let not = self.dae.pool.not(condition);
        self.execution.guards.push(not);
        let other = second(self, loops)?;
        self.execution.guards.pop();
        for ((_, value), (_, taken)) in self.execution.values.iter_mut().zip(&taken) {
            *value = self.dae.pool.if_then_else(condition, *taken, *value);
        }
        let pool = &mut self.dae.pool;
        let (first, second) = (pool.and(condition, flow), pool.and(not, other));
        Ok(pool.or(first, second))
    }

    /// The branches of a when-statement, unless one `earlier` is active.
    fn when_statement(
        &mut self,
        branches: &[Branch],
        earlier: Expr,
        span: Span,
        loops: &mut Loops,
    ) -> Result<Broken, Diagnostic> {
        let Some(((condition, body), rest)) = branches.split_first() else {
            return Ok(self.not_broken());
        };
        if self.place.initial || self.place.in_when {
            return Err(
                fault!(NOT_SUPPORTED, "`when` inside `when` or initial algorithms").at(span)
            );
        }
        let active = self.activation(condition, loops)?;
        let not = self.dae.pool.not(earlier);
        let guard = self.dae.pool.and(not, active);
        let earlier = self.dae.pool.or(earlier, active);
        self.choose(
            guard,
            loops,
            |builder, loops| {
                (builder.place.in_when, builder.place.at_start) = (true, is_initial(condition));
                let flow = builder.statements(body, loops);
                (builder.place.in_when, builder.place.at_start) = (false, false);
                flow
            },
            |builder, loops| builder.when_statement(rest, earlier, span, loops),
        )
    }

    fn for_statement(
        &mut self,
        indices: &[ForIndex],
        body: &[Statement],
        loops: &mut Loops,
    ) -> Result<Broken, Diagnostic> {
        let Some((index, inner)) = indices.split_first() else {
            return self.statements(body, loops);
        };
        let mut broken = self.not_broken();
        for variable in self.statement_lowering(loops).loop_variables(index)? {
            self.count_statement(index.name.span)?;
            loops.push(variable);
            let iteration = self
                .unless(broken, loops, |builder, loops| builder.for_statement(inner, body, loops));
            loops.pop();
            broken = iteration?;
            if self.dae.pool.as_constant(broken) == Some(1.0) {
                break;
            }
        }
        Ok(self.not_broken())
    }

    /// `assert`, `terminate`
    fn statement_call(&mut self, call: &Expression, loops: &Loops) -> Result<(), Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &call.kind else { return Ok(()) };
        match (function.name().to_string().as_str(), self.place.in_when) {
            ("assert", _) => self.assertion(arguments, call.span, loops),
            ("terminate", true) => {
                let guard = self.guard();
                self.terminate(arguments, guard, call.span, loops);
                Ok(())
            }
            _ => self.call_statement(call, loops, self.place.in_when || self.place.initial),
        }
    }

    /// The conditions of all branches around.
    fn guard(&mut self) -> Expr {
        let mut guard = self.dae.pool.constant(1.0);
        for condition in &self.execution.guards {
            guard = self.dae.pool.and(guard, *condition);
        }
        guard
    }

    /// Assertions of the statement hold where it is executed.
    fn guard_new_assertions(&mut self, from: usize) {
        if self.dae.assertions.len() > from {
            let guard = self.guard();
            match self.place.in_when {
                true => self.move_assertions(from, guard),
                false => self.guard_assertions(from, guard),
            }
        }
    }

    /// The value that a variable has where the algorithm stands.
    pub(super) fn value_now(&mut self, variable: VarId) -> Expr {
        match self.execution.values.get(&variable) {
            Some(value) => *value,
            None => self.dae.pool.variable(variable),
        }
    }
}
