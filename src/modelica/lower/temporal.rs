//! Operators with a meaning in time (MLS §3.7.4, §3.7.5) as variables that change at events only.

use super::build::scalar_of_nothing;
use super::builder::Builder;
use super::dae::{Variable, VariableKind};
use super::discrete::{WITHOUT_EVENTS, not_discrete};
use super::equation::{Assertion, Equation, Level};
use super::errors::{ARRAY_MISMATCH, NOT_DISCRETE, NOT_SUPPORTED};
use super::events::{Delay, Rounding, Sample};
use super::expressions::{Array, Operations, StringPart, size_fault};
use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::flatten::{BaseType, Variability};
use crate::functions::{Builtin, Temporal};
use crate::source::Span;
use crate::symbolic::function::FunctionId;
use crate::symbolic::{Expr, RelationOperator, VarId, substitute};
use rustc_hash::FxHashMap;

impl Builder<'_> {
    /// The value of an operator whose arguments are lowered.
    pub(super) fn temporal_operator(
        &mut self,
        entry: &Builtin,
        operator: Temporal,
        mut arguments: Vec<Array<Expr>>,
        span: Span,
    ) -> Result<Array<Expr>, Diagnostic> {
        if matches!(operator, Temporal::Pre | Temporal::Edge | Temporal::Change) {
            self.execution.raw -= 1;
        }
        match operator {
            Temporal::Initial if self.place.initial => {
                return Ok(Array::scalar(self.dae.pool.constant(1.0)));
            }
            Temporal::Initial => return Ok(Array::scalar(self.initial_signal())),
            Temporal::Terminal => return Ok(Array::scalar(self.terminal_signal())),
            Temporal::SpatialDistribution => {
                let [out0, _] = self.spatial_distribution(&arguments, span)?;
                return Ok(Array::scalar(out0));
            }
            _ => {}
        }
        let mut array = arguments.remove(0);
        if let Temporal::Pre | Temporal::Edge | Temporal::Change = operator {
            self.check_discrete(entry.name, &array.elements, span)?;
        }
        for at in 0..array.elements.len() {
            let element = array.elements[at];
            array.elements[at] = match operator {
                Temporal::Pre => self.previous(element, span)?,
                Temporal::Edge => self.edge_of_variable(element, span)?,
                Temporal::Change => self.change(element, span)?,
                Temporal::Derivative => self.derivative(element, span)?,
                Temporal::Delay => {
                    let time = delay_time(&arguments, at, &array.dims, span)?;
                    let longest =
                        delay_time(arguments.get(1..).unwrap_or_default(), at, &array.dims, span);
                    self.delay(element, time, longest.ok(), span)?
                }
                _ => return Err(fault!(NOT_SUPPORTED, "`{}`", entry.name).at(span)),
            };
        }
        Ok(array)
    }

    /// Refuses continuous-time variables as arguments of `pre`, `edge` and `change` where no
    /// when-clause acts (MLS §3.7.5.1): between events they have no value before.
    pub(super) fn check_discrete(
        &self,
        operator: &str,
        arguments: &[Expr],
        span: Span,
    ) -> Result<(), Diagnostic> {
        if self.place.in_when || self.place.initial {
            return Ok(());
        }
        let variables = arguments.iter().filter_map(|a| self.dae.pool.as_variable(*a));
        let mut variables = variables.map(|variable| self.dae.variable(variable));
        // What is declared `discrete` may be an input that holds its samples.
        let is_continuous = |variable: &&Variable| {
            variable.variability == Variability::Continuous
                && matches!(variable.kind, VariableKind::Unknown | VariableKind::Derivative(_))
        };
        match variables.find(is_continuous) {
            None => Ok(()),
            Some(variable) => Err(fault!(
                NOT_DISCRETE,
                "`{}` changes between events, so `{operator}` of it has a value in when-clauses only",
                variable.name;
                help: "write the equation in a when-clause")
            .at(span)),
        }
    }

    /// `pre(a)`: the value of a variable before the event iteration in progress.
    pub(super) fn previous(&mut self, a: Expr, span: Span) -> Result<Expr, Diagnostic> {
        if self.dae.is_parametric(a) {
            return Ok(a);
        }
        let variable = self.dae.pool.as_variable(a);
        match variable.map(|v| (v, self.dae.variable(v).kind)) {
            Some((
                v,
                VariableKind::Discrete | VariableKind::Unknown | VariableKind::Derivative(_),
            )) => {
                let previous = self.previous_variable(v);
                Ok(self.dae.pool.variable(previous))
            }
            _ => Err(fault!(NOT_SUPPORTED, "`pre` of an expression that is not a variable";
                help: "declare a variable for the expression and use `pre` of that variable")
            .at(span)),
        }
    }

    pub(super) fn previous_variable(&mut self, of: VarId) -> VarId {
        if let Some(known) = self.scalars.previous.get(&of) {
            return *known;
        }
        let source = self.dae.variable(of);
        let mut variable = scalar_of_nothing(
            &format!("pre({})", source.name),
            VariableKind::Previous(of),
            source.span,
        );
        variable.base = source.base.clone();
        variable.variability = Variability::Discrete;
        let id = self.dae.declare_variable(variable);
        self.scalars.previous.insert(of, id);
        id
    }

    /// `b and not pre(b)`
    pub(super) fn edge(&mut self, b: Expr, span: Span) -> Result<Expr, Diagnostic> {
        let b = self.condition(b, span)?;
        let before = self.previous(b, span)?;
        let not = self.dae.pool.not(before);
        Ok(self.dae.pool.and(b, not))
    }

    /// `edge(b)` of a variable, with the value it has where an algorithm stands.
    fn edge_of_variable(&mut self, b: Expr, span: Span) -> Result<Expr, Diagnostic> {
        let before = self.previous(b, span)?;
        let now = self.now(b);
        let not = self.dae.pool.not(before);
        Ok(self.dae.pool.and(now, not))
    }

    /// `v <> pre(v)`
    fn change(&mut self, v: Expr, span: Span) -> Result<Expr, Diagnostic> {
        let before = self.previous(v, span)?;
        let now = self.now(v);
        Ok(self.dae.pool.relation(RelationOperator::NotEqual, now, before))
    }

    fn now(&mut self, v: Expr) -> Expr {
        match self.dae.pool.as_variable(v) {
            Some(variable) => self.execution.value_now(&mut self.dae.pool, variable),
            None => v,
        }
    }

    /// A Boolean as a discrete variable, so that it has a previous value.
    pub(super) fn condition(&mut self, b: Expr, span: Span) -> Result<Expr, Diagnostic> {
        let known = self.dae.pool.as_variable(b).map(|v| self.dae.variable(v).kind);
        if known == Some(VariableKind::Discrete) || self.dae.is_parametric(b) {
            return Ok(b);
        }
        if let Some(variable) = self.scalars.conditions.get(&b) {
            return Ok(self.dae.pool.variable(*variable));
        }
        // Relations in when-clauses before it are evaluated at their events alone.
        if let Some(fault) = self.changes_between_events("this condition", b) {
            return Err(fault.help(WITHOUT_EVENTS).at(span));
        }
        let name = format!("$condition[{}]", self.scalars.conditions.len() + 1);
        let mut variable = scalar_of_nothing(&name, VariableKind::Discrete, span);
        variable.base = BaseType::Boolean;
        variable.variability = Variability::Discrete;
        let id = self.dae.declare_variable(variable);
        self.scalars.conditions.insert(b, id);
        let left = self.dae.pool.variable(id);
        self.dae.events.equations.push(Equation::new(left, b, span));
        Ok(left)
    }

    /// What is wrong with a discrete value that varies even where no when-clause acts: between events
    /// `pre(v)` is `v`.
    pub(super) fn changes_between_events(&mut self, subject: &str, e: Expr) -> Option<Fault> {
        if !self.dae.varies(e) {
            return None;
        }
        let initial = self.initial_signal();
        let initial = self.dae.pool.as_variable(initial);
        let zero = self.dae.pool.constant(0.0);
        let mut now = FxHashMap::default();
        for (of, previous) in &self.scalars.previous {
            now.insert(*previous, self.dae.pool.variable(*of));
        }
        now.extend(initial.map(|variable| (variable, zero)));
        let between = substitute(&mut self.dae.pool, e, &|v| now.get(&v).copied());
        let dae = &self.dae;
        dae.varies(between).then(|| not_discrete(dae, subject, between, |v| dae.is_varying(v)))
    }

    /// 1 during initialization.
    pub(super) fn initial_signal(&mut self) -> Expr {
        let id = match self.dae.events.initial {
            Some(known) => known,
            None => self.signal("$initial"),
        };
        self.dae.events.initial = Some(id);
        self.dae.pool.variable(id)
    }

    fn terminal_signal(&mut self) -> Expr {
        let id = match self.dae.events.terminal {
            Some(known) => known,
            None => self.signal("$terminal"),
        };
        self.dae.events.terminal = Some(id);
        self.dae.pool.variable(id)
    }

    fn signal(&mut self, name: &str) -> VarId {
        let mut variable = scalar_of_nothing(name, VariableKind::Signal, Span::NONE);
        variable.base = BaseType::Boolean;
        variable.variability = Variability::Discrete;
        self.dae.declare_variable(variable)
    }

    /// `sample(start, interval)`
    pub(super) fn sample(
        &mut self,
        start: Expr,
        interval: Expr,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        self.sample_from(start, interval, false, span)
    }

    /// The same, its first time counted from the start of the simulation.
    pub(super) fn sample_since_start(
        &mut self,
        start: Expr,
        interval: Expr,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        self.sample_from(start, interval, true, span)
    }

    fn sample_from(
        &mut self,
        start: Expr,
        interval: Expr,
        since_start: bool,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        if !self.dae.is_parametric(start) || !self.dae.is_parametric(interval) {
            return Err(fault!(
                NOT_SUPPORTED,
                "start and interval of `sample` must depend only on parameters"
            )
            .at(span));
        }
        let same =
            |s: &&Sample| (s.start, s.interval, s.since_start) == (start, interval, since_start);
        if let Some(known) = self.dae.events.samples.iter().find(same) {
            return Ok(self.dae.pool.variable(known.variable));
        }
        let zero = self.dae.pool.constant(0.0);
        let condition = self.dae.pool.relation(RelationOperator::Greater, interval, zero);
        let parts = vec![StringPart::Text("the interval of `sample` must be positive".into())];
        self.dae.assertions.push(Assertion::new(condition, parts, Level::Error, span));
        let variable = self.signal(&format!("$sample[{}]", self.dae.events.samples.len() + 1));
        self.dae.events.samples.push(Sample { variable, start, since_start, interval, span });
        Ok(self.dae.pool.variable(variable))
    }

    /// `delay(argument, time, longest)` (MLS §3.7.4.1). A delay time that is 0 in the model is a
    /// connection: the parameters in it cannot be set any more.
    fn delay(
        &mut self,
        argument: Expr,
        time: Expr,
        longest: Option<Expr>,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        if !self.dae.is_parametric(time) {
            return self.variable_delay(argument, time, longest, span);
        }
        if self.dae.is_parametric(argument) {
            return Ok(argument);
        }
        let same = |d: &&Delay| d.argument == argument && d.time == time;
        if let Some(known) = self.dae.events.delays.iter().find(same) {
            return Ok(self.dae.pool.variable(known.variable));
        }
        if self.value_in_model(time)? == Some(0.0) {
            self.evaluate_structural(time)?;
            return Ok(argument);
        }
        let zero = self.dae.pool.constant(0.0);
        let condition = self.dae.pool.relation(RelationOperator::Greater, time, zero);
        let message = "the delay time of `delay` must be positive, or 0 in the model itself".into();
        let parts = vec![StringPart::Text(message)];
        self.dae.assertions.push(Assertion::new(condition, parts, Level::Error, span));
        let name = format!("$delay[{}]", self.dae.events.delays.len() + 1);
        let variable =
            self.dae.declare_variable(scalar_of_nothing(&name, VariableKind::Delayed, span));
        self.dae.events.delays.push(Delay { variable, argument, time, span });
        Ok(self.dae.pool.variable(variable))
    }

    /// A function that jumps, outside `noEvent`, in terms of `floor` (MLS §3.7.2).
    pub(super) fn rounding_function(
        &mut self,
        function: FunctionId,
        arguments: &[Expr],
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        Ok(match (function.get().name, arguments) {
            ("floor" | "integer", [x]) => self.floor(*x, span),
            ("ceil", [x]) => self.ceil(*x, span),
            ("div", [x, y]) => self.quotient(*x, *y, span),
            ("mod", [x, y]) => {
                let ratio = self.dae.pool.div(*x, *y);
                let quotient = self.floor(ratio, span);
                self.remainder(*x, quotient, *y)
            }
            ("rem", [x, y]) => {
                let quotient = self.quotient(*x, *y, span);
                self.remainder(*x, quotient, *y)
            }
            (name, _) => {
                return Err(fault!(NOT_SUPPORTED, "events of `{name}`";
                    help: "write `noEvent({name}(…))`")
                .at(span));
            }
        })
    }

    fn floor(&mut self, argument: Expr, span: Span) -> Expr {
        let roundings = &self.dae.events.roundings;
        if let Some(known) = roundings.iter().find(|r| r.argument == argument) {
            return self.dae.pool.variable(known.variable);
        }
        let name = format!("$floor[{}]", roundings.len() + 1);
        let mut variable = scalar_of_nothing(&name, VariableKind::Frozen, span);
        variable.variability = Variability::Discrete;
        let variable = self.dae.declare_variable(variable);
        self.dae.events.roundings.push(Rounding { variable, argument, span });
        self.dae.pool.variable(variable)
    }

    fn ceil(&mut self, x: Expr, span: Span) -> Expr {
        let minus = self.dae.pool.neg(x);
        let floor = self.floor(minus, span);
        self.dae.pool.neg(floor)
    }

    /// x/y rounded towards zero.
    fn quotient(&mut self, x: Expr, y: Expr, span: Span) -> Expr {
        let ratio = self.dae.pool.div(x, y);
        let zero = self.dae.pool.constant(0.0);
        let positive = self.relation(RelationOperator::GreaterEqual, ratio, zero, false, span);
        let (floor, ceil) = (self.floor(ratio, span), self.ceil(ratio, span));
        self.dae.pool.if_then_else(positive, floor, ceil)
    }

    fn remainder(&mut self, x: Expr, quotient: Expr, y: Expr) -> Expr {
        let multiple = self.dae.pool.mul(quotient, y);
        self.dae.pool.sub(x, multiple)
    }
}

/// The delay time of an element: one for all, or an array of the same sizes.
fn delay_time(
    others: &[Array<Expr>],
    at: usize,
    dims: &[usize],
    span: Span,
) -> Result<Expr, Diagnostic> {
    let Some(time) = others.first() else {
        return Err(fault!(ARRAY_MISMATCH, "`delay` needs a delay time").at(span));
    };
    match time.dims.is_empty() {
        true => Ok(time.elements[0]),
        false if time.dims == dims => Ok(time.elements[at]),
        false => Err(size_fault(dims, &time.dims).at(span)),
    }
}
