//! Algorithm sections become equations: their statements are evaluated symbolically, and every
//! variable assigned equals what it has at the end (MLS §11.1).
//!
//! At the beginning a continuous variable has its start value, a discrete one its previous value.
//! Loops of known length are unrolled, branches merged into if-expressions.

use super::assigned_variables::AssignedScalar;
use super::builder::Builder;
use super::calls_of_statements::assigned_outputs;
use super::dae::VariableKind;
use super::discrete::WITHOUT_EVENTS;
use super::equation::Equation;
use super::errors::{ARRAY_MISMATCH, NO_CONSTANT_VALUE, NOT_SUPPORTED, UNBALANCED_MODEL};
use super::execution::{Loops, Written};
use super::expressions::{Lowered, Lowering};
use super::function::Before;
use super::shape::UNKNOWN_TEXT;
use super::statement_function::may_be_a_function;
use super::when::is_initial;
use crate::diag::Diagnostic;
use crate::execute::{self, Branches, Decision, Domain, Done, Executed, Flow, Iteration, Targets};
use crate::fault;
use crate::flatten::BaseType;
use crate::source::Span;
use crate::symbolic::{Expr, Pool, VarId};
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, ForIndex, Statement, StatementKind,
};

/// What to do where a loop of an algorithm, which causes no events, decides on a discrete value.
const LOOP_WITHOUT_EVENTS: &str = "how often this loop runs causes no events: assign the variable in a \
    when-clause, or declare it `Real`";

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
        execute::statements(&mut Algorithm { builder: self, loops: Vec::new() }, statements)?;
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
                    let written = execution.written.get(&variable).copied();
                    self.discrete_assignment(variable, equation, in_when, written)?;
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
        written: Option<Written>,
    ) -> Result<(), Diagnostic> {
        let name = self.dae.variable(variable).name.clone();
        if !self.execution.assigned.insert(variable) {
            return Err(fault!(UNBALANCED_MODEL, "`{name}` is assigned more than once";
                help: "assign it in one algorithm or one when-clause")
            .at(equation.span));
        }
        let subject = format!("`{name}` is discrete, but its value");
        if !in_when && let Some(fault) = self.changes_between_events(&subject, equation.right) {
            let (help, place) = match written {
                Some(Written::Loop(condition)) => (LOOP_WITHOUT_EVENTS, condition),
                Some(Written::Assignment(place)) => (WITHOUT_EVENTS, place),
                None => (WITHOUT_EVENTS, equation.span),
            };
            return Err(fault.help(help).at(place));
        }
        self.dae.events.equations.push(equation);
        Ok(())
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
                true => self.dae.move_assertions(from, guard),
                false => self.dae.guard_assertions(from, guard),
            }
        }
    }
}

/// An algorithm section being evaluated.
struct Algorithm<'a, 'b> {
    builder: &'a mut Builder<'b>,
    loops: Loops,
}

/// Conditions that are not known merge what their branches assign.
impl Domain for Algorithm<'_, '_> {
    type Condition = Expr;

    fn statement(&mut self, statement: &Statement) -> Done<Self> {
        self.count(statement.span)?;
        match &statement.kind {
            StatementKind::Assign { .. }
            | StatementKind::For { .. }
            | StatementKind::While { .. } => self.or_function(statement),
            _ => execute::execute(self, statement),
        }
    }

    fn assign_value(&mut self, to: &ComponentReference, value: &Expression, _: Span) -> Executed {
        let asserted = self.builder.dae.assertions.len();
        let value = self.value(value)?;
        self.assign(to, value)?;
        self.builder.guard_new_assertions(asserted);
        Ok(())
    }

    fn assign_outputs(&mut self, targets: &Targets, call: &Expression) -> Executed {
        let asserted = self.builder.dae.assertions.len();
        let outputs = assigned_outputs(&mut self.lowering(), targets, call, |own, user, given| {
            own.outputs_for(targets, user, given, call.span)
        })?;
        outputs.into_iter().try_for_each(|(target, output)| self.assign(target, output))?;
        self.builder.guard_new_assertions(asserted);
        Ok(())
    }

    /// `assert`, `terminate`
    fn call_statement(&mut self, call: &Expression) -> Executed {
        let ExpressionKind::Call { function, arguments } = &call.kind else { return Ok(()) };
        let Algorithm { builder, loops } = self;
        let (in_when, asserted) = (builder.place.in_when, builder.dae.assertions.len());
        match (function.name().to_string().as_str(), in_when) {
            ("assert", _) => builder.assertion(arguments, call.span, loops)?,
            ("terminate", true) => {
                let guard = builder.guard();
                builder.terminate(arguments, guard, call.span, loops);
            }
            _ => builder.call_statement(call, loops, in_when || builder.place.initial)?,
        }
        builder.guard_new_assertions(asserted);
        Ok(())
    }

    fn decide(&mut self, condition: &Expression) -> Result<Decision<Expr>, Diagnostic> {
        let asserted = self.builder.dae.assertions.len();
        let condition = self.lowering().scalar(condition)?;
        self.builder.guard_new_assertions(asserted);
        Ok(match self.builder.dae.pool.as_constant(condition) {
            Some(known) => Decision::Known(known != 0.0),
            None => Decision::Open(condition),
        })
    }

    fn either(
        &mut self,
        condition: Expr,
        first: impl FnOnce(&mut Self) -> Done<Self>,
        second: impl FnOnce(&mut Self) -> Done<Self>,
    ) -> Done<Self> {
        let before = self.builder.execution.values.clone();
        self.builder.execution.guards.push(condition);
        let flow = first(self)?;
        self.builder.execution.guards.pop();
        let taken = std::mem::replace(&mut self.builder.execution.values, before);
        let not = self.builder.dae.pool.not(condition);
        self.builder.execution.guards.push(not);
        let other = second(self)?;
        let Builder { execution, dae, .. } = &mut *self.builder;
        execution.guards.pop();
        for ((_, value), (_, taken)) in execution.values.iter_mut().zip(&taken) {
            *value = dae.pool.if_then_else(condition, *taken, *value);
        }
        let (first, second) = (leaves_loop(&mut dae.pool, flow), leaves_loop(&mut dae.pool, other));
        let (first, second) = (dae.pool.and(condition, first), dae.pool.and(not, second));
        let left = dae.pool.or(first, second);
        Ok(match dae.pool.as_constant(left) {
            Some(0.0) => Flow::Next,
            Some(_) => Flow::Break,
            None => Flow::BreakIf(left),
        })
    }

    fn for_loop(&mut self, index: &ForIndex, body: Iteration<'_>) -> Done<Self> {
        let mut variables = self.lowering().loop_variables(index)?.into_iter();
        let outside = self.loops.len();
        let done = body.repeat(self, |own| {
            own.loops.truncate(outside);
            let Some(variable) = variables.next() else { return Ok(false) };
            own.loops.push(variable);
            own.count(index.name.span).map(|()| true)
        });
        self.loops.truncate(outside);
        done
    }

    fn while_loop(&mut self, condition: &Expression, body: Iteration<'_>) -> Done<Self> {
        body.repeat(self, |own| match own.lowering().known(condition)? != 0.0 {
            true => own.count(body.span).map(|()| true),
            false => Ok(false),
        })
    }

    fn when_statement(&mut self, branches: &Branches, span: Span) -> Done<Self> {
        let none = self.builder.dae.pool.constant(0.0);
        self.when_unless(branches, none, span)
    }

    fn leave_function(&mut self, span: Span) -> Done<Self> {
        Err(fault!(NOT_SUPPORTED, "`return` outside a function").at(span))
    }
}

impl<'b> Algorithm<'_, 'b> {
    fn lowering(&mut self) -> Lowering<'_, Builder<'b>> {
        self.builder.statement_lowering(&self.loops)
    }

    /// One more statement or iteration.
    fn count(&mut self, span: Span) -> Result<(), Diagnostic> {
        let left = &mut self.builder.calls.statements;
        *left = left.saturating_sub(1);
        match left {
            0 => Err(fault!(NOT_SUPPORTED, "this model has too many statements").at(span)),
            _ => Ok(()),
        }
    }

    /// A loop is unrolled, an assignment evaluated; or else they are functions.
    fn or_function(&mut self, statement: &Statement) -> Done<Self> {
        let is_loop = !matches!(statement.kind, StatementKind::Assign { .. });
        if is_loop && !self.loops.is_empty() {
            // In an unrolled loop, the whole statement becomes a function instead.
            return execute::execute(self, statement);
        }
        let before = is_loop.then(|| self.builder.execution.values.clone());
        let said = Before::new(self.builder);
        let asserted = self.builder.dae.assertions.len();
        let guards = self.builder.execution.guards.len();
        let error = match execute::execute(self, statement) {
            Err(error) if may_be_a_function(&error) => error,
            done => return done,
        };
        said.restore(self.builder);
        let execution = &mut self.builder.execution;
        execution.values = before.unwrap_or_else(|| std::mem::take(&mut execution.values));
        execution.guards.truncate(guards);
        // A loop whose end is not known must be a function; else its body is not possible.
        let is_open = is_loop && error.code == NO_CONSTANT_VALUE;
        let called = self.builder.call_of_statement(statement, &self.loops);
        called.map_err(|why| if is_open { why } else { error })?;
        self.builder.guard_new_assertions(asserted);
        Ok(Flow::Next)
    }

    fn value(&mut self, value: &Expression) -> Result<Lowered<Expr>, Diagnostic> {
        let place = self.builder.place;
        if (place.in_when || place.initial)
            && let Some(done) = self.builder.confirmed(value, &self.loops)?
        {
            return Ok(Lowered::scalar(done));
        }
        let mut lowering = self.lowering();
        match lowering.lower(value)? {
            Lowered::Text(text) if text.contains(UNKNOWN_TEXT) => lowering.run_time_string(value),
            lowered => Ok(lowered),
        }
    }

    fn assign(
        &mut self,
        target: &ComponentReference,
        value: Lowered<Expr>,
    ) -> Result<(), Diagnostic> {
        let Algorithm { builder, loops } = self;
        let places = builder.places(target, loops)?;
        let is_text =
            |place: &AssignedScalar| builder.dae.variable(place.variable).base == BaseType::String;
        let value = match places.first().is_some_and(is_text) {
            true => Lowered::scalar(Lowering::new(*builder).number_of_text(value, target.span)?),
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
            let Some(before) = builder.execution.values.get_mut(&variable) else {
                let name = builder.dae.variable(variable).name.clone();
                return Err(fault!(NOT_SUPPORTED, "`{name}` cannot be assigned").at(target.span));
            };
            *before = match guard {
                None => values[element],
                Some(guard) => builder.dae.pool.if_then_else(guard, values[element], *before),
            };
            builder.execution.assigned_by(variable, Written::Assignment(target.span));
            if builder.place.in_when {
                builder.execution.in_when.insert(variable);
            }
        }
        Ok(())
    }

    /// The branches of a when-statement, unless one `earlier` is active.
    fn when_unless(&mut self, branches: &Branches, earlier: Expr, span: Span) -> Done<Self> {
        let Some(((condition, body), rest)) = branches.split_first() else {
            return Ok(Flow::Next);
        };
        let Algorithm { builder, loops } = self;
        if builder.place.initial || builder.place.in_when {
            return Err(
                fault!(NOT_SUPPORTED, "`when` inside `when` or initial algorithms").at(span)
            );
        }
        let active = builder.activation(condition, loops)?;
        let not = builder.dae.pool.not(earlier);
        let guard = builder.dae.pool.and(not, active);
        let earlier = builder.dae.pool.or(earlier, active);
        self.either(
            guard,
            |own| {
                let at_start = is_initial(condition);
                (own.builder.place.in_when, own.builder.place.at_start) = (true, at_start);
                let done = execute::statements(own, body);
                (own.builder.place.in_when, own.builder.place.at_start) = (false, false);
                done
            },
            |own| own.when_unless(rest, earlier, span),
        )
    }
}

/// The condition under which a loop is left.
fn leaves_loop(pool: &mut Pool, flow: Flow<Expr>) -> Expr {
    match flow {
        Flow::Next => pool.constant(0.0),
        Flow::Break | Flow::Return => pool.constant(1.0),
        Flow::BreakIf(condition) => condition,
    }
}
