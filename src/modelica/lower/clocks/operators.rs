//! Clocked operators in expressions: a variable for the value of each, and what it is.

use super::conversion::{Conversion, Rational};
use super::{Base, Occurrence, Operator};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::{BaseType, Variability};
use crate::functions::{Builtin, Clocked};
use crate::lower::build::scalar_of_nothing;
use crate::lower::builder::Builder;
use crate::lower::dae::VariableKind;
use crate::lower::equation::Equation;
use crate::lower::errors::{ARRAY_MISMATCH, NOT_SUPPORTED};
use crate::lower::expressions::{Array, ClockedCall, Lowered};
use crate::lower::scalar_types::{is_boolean, is_real, is_whole};
use crate::source::Span;
use crate::symbolic::{Expr, Node, VarId};

/// What an operator makes of a scalar.
type OfScalar<B> = Box<dyn Fn(&mut B, Expr) -> Result<Expr, Diagnostic>>;

impl Builder<'_> {
    /// The value of a clocked operator, or of `sample(start, interval)`.
    pub(in crate::lower) fn clocked_operator(
        &mut self,
        entry: &Builtin,
        operator: Clocked,
        call: ClockedCall<Expr>,
        span: Span,
    ) -> Result<Lowered<Expr>, Diagnostic> {
        let of_scalar: OfScalar<Self> = match operator {
            Clocked::State(operator) => {
                return self.state_operator(operator, &call, span).map(Lowered::scalar);
            }
            Clocked::Constructor => return self.clock(&call, span).map(Lowered::scalar),
            Clocked::Interval | Clocked::FirstTick => {
                return self.about_ticks(operator, &call, span).map(Lowered::scalar);
            }
            Clocked::Sample => {
                let (second, named) = (call.at(1, "interval"), call.at(1, "clock"));
                let clock = match named.or(second) {
                    Some(clock) => Some(self.only_scalar(entry, clock, span)?),
                    None => None,
                };
                if let Some(interval) = clock.filter(|e| !self.is_clock_expression(*e)) {
                    let start = call.at(0, "start").ok_or_else(|| missing(entry, span))?;
                    let start = self.only_scalar(entry, start, span)?;
                    return self.sample(start, interval, span).map(Lowered::scalar);
                }
                let clock = clock.map(|clock| self.clock_of(clock, span)).transpose()?;
                Box::new(move |builder, u| builder.sampled(u, clock, span))
            }
            Clocked::Hold => Box::new(move |builder, u| builder.held(u, span)),
            Clocked::Previous => Box::new(move |builder, u| builder.previous_of_clocked(u, span)),
            Clocked::SubSample
            | Clocked::SuperSample
            | Clocked::ShiftSample
            | Clocked::BackSample
            | Clocked::NoClock => {
                let conversion = self.conversion(entry, operator, &call, span)?;
                Box::new(move |builder, u| builder.converted(u, conversion, span))
            }
        };
        let u = call.at(0, "u").ok_or_else(|| missing(entry, span))?.clone();
        self.each_scalar(entry, u, &*of_scalar, span)
    }

    /// How an operator converts one clock into another of the same base.
    fn conversion(
        &mut self,
        entry: &Builtin,
        operator: Clocked,
        call: &ClockedCall<Expr>,
        span: Span,
    ) -> Result<Conversion, Diagnostic> {
        let mut number =
            |at, name, default| self.known_argument(entry, call, at, name, default, span);
        let is_shift = operator == Clocked::ShiftSample;
        Ok(match operator {
            Clocked::SubSample | Clocked::SuperSample => {
                let factor = number(1, "factor", 0)?;
                let factor = (factor > 0).then_some(factor);
                match operator {
                    Clocked::SubSample => Conversion::Sub(factor),
                    _ => Conversion::Super(factor),
                }
            }
            Clocked::ShiftSample | Clocked::BackSample => {
                let name = if is_shift { "shiftCounter" } else { "backCounter" };
                let counter = i128::from(number(1, name, 0)?);
                let resolution = i128::from(number(2, "resolution", 1)?.max(1));
                let by = Rational::new(counter, resolution);
                if is_shift { Conversion::Shift(by) } else { Conversion::Back(by) }
            }
            _ => Conversion::Any,
        })
    }

    fn each_scalar(
        &mut self,
        entry: &Builtin,
        value: Lowered<Expr>,
        make: &dyn Fn(&mut Self, Expr) -> Result<Expr, Diagnostic>,
        span: Span,
    ) -> Result<Lowered<Expr>, Diagnostic> {
        match value {
            Lowered::Array(Array { dims, elements }) => {
                let elements = elements.into_iter().map(|e| make(self, e));
                let elements = elements.collect::<Result<_, _>>()?;
                Ok(Lowered::Array(Array { dims, elements }))
            }
            Lowered::Record(fields) => {
                let fields = fields
                    .into_iter()
                    .map(|(name, field)| Ok((name, self.each_scalar(entry, field, make, span)?)));
                fields.collect::<Result<_, Diagnostic>>().map(Lowered::Record)
            }
            Lowered::Text(_) | Lowered::Strings(_) | Lowered::Numbered(_) => {
                Err(fault!(NOT_SUPPORTED, "`{}` of a String", entry.name).at(span))
            }
        }
    }

    fn only_scalar(
        &self,
        entry: &Builtin,
        value: &Lowered<Expr>,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        match value {
            Lowered::Array(array) if array.dims.is_empty() => Ok(array.elements[0]),
            _ => Err(fault!(ARRAY_MISMATCH, "`{}` takes scalars here", entry.name).at(span)),
        }
    }

    /// An Integer that is evaluated at translation.
    fn known_argument(
        &mut self,
        entry: &Builtin,
        call: &ClockedCall<Expr>,
        at: usize,
        name: &str,
        default: i64,
        span: Span,
    ) -> Result<i64, Diagnostic> {
        let Some(value) = call.at(at, name) else { return Ok(default) };
        let value = self.only_scalar(entry, value, span)?;
        match self.evaluate_structural(value)? {
            Some(number) if number >= 0.0 && number.fract() == 0.0 && number <= 9e18 => {
                Ok(number as i64)
            }
            Some(number) => Err(fault!(
                ARRAY_MISMATCH,
                "`{name}` of `{}` must be a whole number that is not negative, not {number}",
                entry.name
            )
            .at(span)),
            None => Err(fault!(
                NOT_SUPPORTED,
                "`{name}` of `{}` must be known at translation",
                entry.name
            )
            .at(span)),
        }
    }

    /// A variable for the value of an operator.
    fn occurrence(&mut self, like: Option<VarId>, operator: Operator, span: Span) -> Expr {
        let name = format!("$clocked[{}]", self.clocks.occurrences.len() + 1);
        let mut variable = scalar_of_nothing(&name, VariableKind::Signal, span);
        variable.variability = Variability::Discrete;
        if let Some(like) = like {
            let like = self.dae.variable(like);
            variable.base = like.base.clone();
            if like.kind == VariableKind::Clock {
                variable.kind = VariableKind::Clock;
            }
        }
        let variable = self.dae.declare_variable(variable);
        self.clocks.occurrences.push(Occurrence { variable, operator, span });
        self.dae.pool.variable(variable)
    }

    fn clock_occurrence(&mut self, operator: Operator, span: Span) -> Expr {
        let made = self.occurrence(None, operator, span);
        if let Some(variable) = self.dae.pool.as_variable(made) {
            let variable = &mut self.dae.variables[variable.0 as usize];
            (variable.kind, variable.base) = (VariableKind::Clock, BaseType::Clock);
        }
        made
    }

    fn sampled(&mut self, u: Expr, clock: Option<VarId>, span: Span) -> Result<Expr, Diagnostic> {
        let of = self.variable_for(u, "$sampled", span);
        Ok(self.occurrence(Some(of), Operator::Sample(of, clock), span))
    }

    fn held(&mut self, u: Expr, span: Span) -> Result<Expr, Diagnostic> {
        if self.dae.is_parametric(u) {
            return Ok(u);
        }
        let of = self.variable_for(u, "$held", span);
        Ok(self.occurrence(Some(of), Operator::Hold(of), span))
    }

    fn previous_of_clocked(&mut self, u: Expr, span: Span) -> Result<Expr, Diagnostic> {
        self.execution.raw -= usize::from(self.execution.raw > 0);
        if self.dae.is_parametric(u) {
            return Ok(u);
        }
        let Some(of) = self.dae.pool.as_variable(u) else {
            return Err(
                fault!(NOT_SUPPORTED, "`previous` of an expression that is not a variable";
                help: "declare a variable for the expression and use `previous` of that variable")
                .at(span),
            );
        };
        Ok(self.occurrence(Some(of), Operator::Previous(of), span))
    }

    fn converted(
        &mut self,
        u: Expr,
        conversion: Conversion,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        if self.dae.is_parametric(u) && !self.is_clock_expression(u) {
            return Ok(u);
        }
        let of = match self.is_clock_expression(u) {
            true => self.clock_of(u, span)?,
            false => self.variable_for(u, "$converted", span),
        };
        Ok(self.occurrence(Some(of), Operator::Convert(of, conversion), span))
    }

    /// `interval`, `firstTick`
    fn about_ticks(
        &mut self,
        operator: Clocked,
        call: &ClockedCall<Expr>,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        let mut of = Vec::new();
        if let Some(u) = call.at(0, "u") {
            u.append_scalars(&mut of);
        }
        Ok(match operator {
            Clocked::Interval => self.occurrence(None, Operator::Interval(of), span),
            _ => {
                let made = self.occurrence(None, Operator::FirstTick(of), span);
                if let Some(variable) = self.dae.pool.as_variable(made) {
                    self.dae.variables[variable.0 as usize].base = BaseType::Boolean;
                }
                made
            }
        })
    }

    /// `Clock(…)`
    fn clock(&mut self, call: &ClockedCall<Expr>, span: Span) -> Result<Expr, Diagnostic> {
        let scalar = |value: &Lowered<Expr>| match value {
            Lowered::Array(array) if array.dims.is_empty() => Ok(array.elements[0]),
            _ => Err(fault!(ARRAY_MISMATCH, "`Clock` takes scalars").at(span)),
        };
        if let Some(Lowered::Text(method)) = call.at(1, "solverMethod") {
            let clock = call.at(0, "c").ok_or_else(|| no_clock(span))?;
            let clock = self.clock_of(scalar(clock)?, span)?;
            let made = self.clock_occurrence(Operator::Convert(clock, Conversion::Same), span);
            if method.is_empty() {
                return Ok(made);
            }
            let solver = self.clock_occurrence(Operator::Clock(Base::Solver(method.clone())), span);
            self.same_clock(made, solver, span);
            return Ok(made);
        }
        let find = |names: [&str; 4]| {
            let at = call.positional.first();
            at.or_else(|| names.iter().find_map(|name| call.at(usize::MAX, name)))
        };
        let Some(first) = find(["intervalCounter", "interval", "condition", "c"]) else {
            return Ok(self.clock_occurrence(Operator::Clock(Base::Inferred), span));
        };
        let first = scalar(first)?;
        if self.is_clock_expression(first) {
            let clock = self.clock_of(first, span)?;
            return Ok(self.dae.pool.variable(clock));
        }
        let second = call.positional.get(1);
        let second = second.or_else(|| call.at(usize::MAX, "resolution"));
        let second = second.or_else(|| call.at(usize::MAX, "startInterval"));
        let second = second.map(scalar).transpose()?;
        let base = if is_boolean(&self.dae, first) {
            let zero = self.dae.pool.constant(0.0);
            let condition = self.condition_of_clock(first, span)?;
            Base::Event(condition, second.unwrap_or(zero))
        } else if second.is_some() || call.at(usize::MAX, "intervalCounter").is_some() || {
            is_whole(&self.dae, first)
        } {
            self.rational_clock(first, second, span)?
        } else {
            self.real_clock(first, span)?
        };
        Ok(self.clock_occurrence(Operator::Clock(base), span))
    }

    fn rational_clock(
        &mut self,
        counter: Expr,
        resolution: Option<Expr>,
        span: Span,
    ) -> Result<Base, Diagnostic> {
        let resolution = match resolution {
            Some(resolution) => self.evaluate_structural(resolution)?,
            None => Some(1.0),
        };
        let Some(resolution) = resolution.filter(|r| *r >= 1.0 && r.fract() == 0.0) else {
            return Err(fault!(
                NOT_SUPPORTED,
                "the resolution of a clock must be a whole number from 1 that is known at \
                 translation"
            )
            .at(span));
        };
        if let Some(known) = self.evaluate_structural(counter)? {
            return match known {
                0.0 => Ok(Base::Inferred),
                known if known > 0.0 && known.fract() == 0.0 => {
                    Ok(Base::Rational(Rational::new(known as i128, resolution as i128)))
                }
                _ => Err(fault!(
                    ARRAY_MISMATCH,
                    "the interval counter of a clock must be a positive whole number, not {known}"
                )
                .at(span)),
            };
        }
        match self.dae.pool.as_variable(counter) {
            Some(variable) => Ok(Base::Counted(variable, resolution as i64)),
            None => Err(not_a_variable("interval counter", span)),
        }
    }

    fn real_clock(&mut self, interval: Expr, span: Span) -> Result<Base, Diagnostic> {
        if self.dae.is_parametric(interval) {
            return Ok(Base::Real(interval));
        }
        match self.dae.pool.as_variable(interval) {
            Some(variable) => Ok(Base::Variable(variable)),
            None => Err(not_a_variable("interval", span)),
        }
    }

    fn condition_of_clock(&mut self, condition: Expr, span: Span) -> Result<VarId, Diagnostic> {
        let condition = self.condition(condition, span)?;
        self.dae.pool.as_variable(condition).ok_or_else(|| {
            fault!(NOT_SUPPORTED, "the condition of this clock never changes").at(span)
        })
    }

    /// The variable of a clock expression.
    pub(super) fn clock_of(&mut self, e: Expr, span: Span) -> Result<VarId, Diagnostic> {
        match self.dae.pool.node(e).clone() {
            Node::Variable(v) if self.dae.variable(v).kind == VariableKind::Clock => Ok(v),
            Node::If(condition, a, b) => match self.evaluate_structural(condition)? {
                Some(0.0) => self.clock_of(b, span),
                Some(_) => self.clock_of(a, span),
                None => {
                    Err(fault!(NOT_SUPPORTED, "which clock this is must be known at translation")
                        .at(span))
                }
            },
            _ => Err(no_clock(span)),
        }
    }

    pub(super) fn is_clock_expression(&self, e: Expr) -> bool {
        match self.dae.pool.node(e) {
            Node::Variable(v) => self.dae.variable(*v).kind == VariableKind::Clock,
            Node::If(_, a, _) => self.is_clock_expression(*a),
            _ => false,
        }
    }

    fn same_clock(&mut self, a: Expr, b: Expr, span: Span) {
        self.clocks.equations.push(Equation::new(a, b, span));
    }

    /// The variable that an expression is, or a new one that is equal to it.
    fn variable_for(&mut self, e: Expr, name: &str, span: Span) -> VarId {
        let is_variable = |kind| {
            matches!(
                kind,
                VariableKind::Unknown | VariableKind::Discrete | VariableKind::Derivative(_)
            )
        };
        if let Some(variable) = self.dae.pool.as_variable(e)
            && is_variable(self.dae.variable(variable).kind)
        {
            return variable;
        }
        let number = self.dae.variables.len();
        let mut variable =
            scalar_of_nothing(&format!("{name}[{number}]"), VariableKind::Unknown, span);
        if !is_real(&self.dae, e) && !self.dae.varies(e) {
            variable.kind = VariableKind::Discrete;
            variable.base =
                if is_boolean(&self.dae, e) { BaseType::Boolean } else { BaseType::Integer };
        }
        let variable = self.dae.declare_variable(variable);
        let left = self.dae.pool.variable(variable);
        self.clocks.equations.push(Equation::new(left, e, span));
        variable
    }
}

fn missing(entry: &Builtin, span: Span) -> Diagnostic {
    fault!(ARRAY_MISMATCH, "`{}` needs an argument", entry.name).at(span)
}

fn no_clock(span: Span) -> Diagnostic {
    fault!(NOT_SUPPORTED, "a clock is expected here").at(span)
}

fn not_a_variable(what: &str, span: Span) -> Diagnostic {
    fault!(NOT_SUPPORTED, "the {what} of a clock must be a variable or a parameter expression")
        .at(span)
}
