//! Clocked when-clauses (MLS §16.6): their equations belong to the clock, whatever they look like.

use super::is_clock;
use crate::diag::Diagnostic;
use crate::fault;
use crate::lower::builder::Builder;
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::execution::Loops;
use crate::lower::expressions::Lowering;
use crate::source::Span;
use crate::syntax::ast::{self, EquationKind, Expression};

impl Builder<'_> {
    /// Whether a when-clause is clocked.
    pub(in crate::lower) fn is_clocked(
        &self,
        branches: &[(Expression, Vec<ast::Equation>)],
    ) -> bool {
        branches.iter().any(|(condition, _)| is_clock(self.flat, condition))
    }

    /// Whether an equation is a clocked when-clause, or holds nothing but these.
    pub(in crate::lower) fn is_clocked_equation(&self, equation: &ast::Equation) -> bool {
        let all = |body: &[ast::Equation]| body.iter().all(|e| self.is_clocked_equation(e));
        match &equation.kind {
            EquationKind::When { branches } => self.is_clocked(branches),
            EquationKind::For { body, .. } => all(body),
            _ => false,
        }
    }

    /// The equations of a clocked when-clause.
    pub(in crate::lower) fn clocked_when(
        &mut self,
        branches: &[(Expression, Vec<ast::Equation>)],
        span: Span,
        loops: &mut Loops,
    ) -> Result<(), Diagnostic> {
        let [(condition, body)] = branches else {
            return Err(fault!(NOT_SUPPORTED, "a clocked when-clause has no `elsewhen`";
                help: "write a when-clause for each clock")
            .at(span));
        };
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.clone();
        let clock = lowering.scalar(condition)?;
        let clock = self.clock_of(clock, condition.span)?;
        let asserted = self.dae.assertions.len();
        let outer = std::mem::replace(&mut self.place.in_when, true);
        let equations = self.collect(body, loops);
        self.place.in_when = outer;
        for equation in equations? {
            self.clocks.on_clock.push((clock, equation));
            self.push(equation);
        }
        let asserted = self.dae.assertions.split_off(asserted);
        self.clocks.asserted.extend(asserted.into_iter().map(|assertion| (clock, assertion)));
        Ok(())
    }
}
