//! `delay` by a time that varies, and `spatialDistribution` (MLS §3.7.4.1, §3.7.4.2), as variables
//! whose values the running system takes from what it has recorded.

use super::build::scalar_of_nothing;
use super::builder::Builder;
use super::dae::VariableKind;
use super::equation::{Assertion, Level};
use super::errors::{ARRAY_MISMATCH, NOT_SUPPORTED};
use super::events::Transport;
use super::expressions::Array;
use super::string_part::StringPart;
use crate::diag::Diagnostic;
use crate::fault;
use crate::source::Span;
use crate::symbolic::{Expr, RelationOperator, VarId};

impl Builder<'_> {
    /// `delay(argument, time, longest)` with a time that varies.
    pub(super) fn variable_delay(
        &mut self,
        argument: Expr,
        time: Expr,
        longest: Option<Expr>,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        let Some(longest) = longest else {
            return Err(fault!(NOT_SUPPORTED,
                "`delay` by a time that varies needs the longest delay";
                help: "write it as the third argument: `delay(expression, time, longest)`")
            .at(span));
        };
        if !self.dae.is_parametric(longest) {
            return Err(fault!(
                NOT_SUPPORTED,
                "the longest delay of `delay` must depend on parameters only"
            )
            .at(span));
        }
        if self.dae.is_parametric(argument) {
            return Ok(argument);
        }
        let known = self.dae.events.transports.iter().find_map(|transport| match transport {
            Transport::Delay { variable, argument: a, time: t, longest: l, .. }
                if (*a, *t, *l) == (argument, time, longest) =>
            {
                Some(*variable)
            }
            _ => None,
        });
        if let Some(variable) = known {
            return Ok(self.dae.pool.variable(variable));
        }
        let zero = self.dae.pool.constant(0.0);
        self.require(RelationOperator::Greater, longest, zero, LONGEST, span);
        self.require(RelationOperator::GreaterEqual, time, zero, DELAY_TIME, span);
        self.require(RelationOperator::LessEqual, time, longest, DELAY_TIME, span);
        let variable = self.transported(span);
        let transport = Transport::Delay { variable, argument, time, longest, span };
        self.dae.events.transports.push(transport);
        Ok(self.dae.pool.variable(variable))
    }

    /// `(out0, out1) = spatialDistribution(in0, in1, x, positiveVelocity, initialPoints,
    /// initialValues)`
    pub(super) fn spatial_distribution(
        &mut self,
        arguments: &[Array<Expr>],
        span: Span,
    ) -> Result<[Expr; 2], Diagnostic> {
        let scalars: Vec<Expr> = arguments.iter().take(4).filter_map(one).collect();
        let [in0, in1, position, positive] = scalars[..] else {
            return Err(fault!(
                ARRAY_MISMATCH,
                "the first four arguments of `spatialDistribution` are scalars"
            )
            .at(span));
        };
        let (points, values) = self.initial_profile(arguments, span)?;
        let outputs = [self.transported(span), self.transported(span)];
        let inputs = [in0, in1];
        let transport =
            Transport::Pipe { outputs, inputs, position, positive, points, values, span };
        self.dae.events.transports.push(transport);
        Ok(outputs.map(|variable| self.dae.pool.variable(variable)))
    }

    /// Places and values of the first content of a pipe; 0 everywhere unless given.
    fn initial_profile(
        &mut self,
        arguments: &[Array<Expr>],
        span: Span,
    ) -> Result<(Vec<Expr>, Vec<Expr>), Diagnostic> {
        let (zero, one) = (self.dae.pool.constant(0.0), self.dae.pool.constant(1.0));
        let points = arguments.get(4).map_or(vec![zero, one], |array| array.elements.clone());
        let values = arguments.get(5).map_or(vec![zero, zero], |array| array.elements.clone());
        if points.len() != values.len() || points.len() < 2 {
            return Err(fault!(ARRAY_MISMATCH,
                "`spatialDistribution` has {} initial points and {} initial values",
                points.len(), values.len();
                help: "give as many values as points, and at least those at 0 and 1")
            .at(span));
        }
        if !points.iter().chain(&values).all(|e| self.dae.is_parametric(*e)) {
            return Err(fault!(
                NOT_SUPPORTED,
                "initial points and values of `spatialDistribution` must depend on parameters only"
            )
            .at(span));
        }
        self.require(RelationOperator::Equal, points[0], zero, POINTS, span);
        self.require(RelationOperator::Equal, points[points.len() - 1], one, POINTS, span);
        for pair in points.windows(2) {
            self.require(RelationOperator::LessEqual, pair[0], pair[1], POINTS, span);
        }
        Ok((points, values))
    }

    fn transported(&mut self, span: Span) -> VarId {
        let name = format!("$transported[{}]", self.dae.variables.len());
        self.dae.declare_variable(scalar_of_nothing(&name, VariableKind::Delayed, span))
    }

    fn require(&mut self, operator: RelationOperator, a: Expr, b: Expr, message: &str, span: Span) {
        let condition = self.dae.pool.relation(operator, a, b);
        let parts = vec![StringPart::Text(message.into())];
        self.dae.assertions.push(Assertion::new(condition, parts, Level::Error, span));
    }
}

const LONGEST: &str = "the longest delay of `delay` must be positive";
const DELAY_TIME: &str = "the delay time of `delay` must lie between 0 and the longest delay";
const POINTS: &str = "the initial points of `spatialDistribution` must ascend from 0 to 1";

fn one(array: &Array<Expr>) -> Option<Expr> {
    if array.dims.is_empty() { array.elements.first().copied() } else { None }
}
