//! Continuous equations in clocked partitions: one step of the solver method at every tick
//! (MLS §16.8).

use super::clocked_equation::ClockedEquation;
use super::partitions::Partitions;
use super::ticks::Ticks;
use crate::diag::Diagnostic;
use crate::fault;
use crate::lower::builder::Builder;
use crate::lower::dae::VariableKind;
use crate::lower::equation::Equation;
use crate::lower::errors::{CLOCK_CONFLICT, NOT_SUPPORTED};
use crate::source::Span;
use crate::symbolic::{Expr, VarId};
use std::sync::Arc;

/// What a solver method makes of `der(x)` (MLS §16.8.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Method {
    /// x = previous(x) + h·previous(der(x))
    ExplicitEuler,
    /// x = previous(x) + h·der(x)
    ImplicitEuler,
    /// x = previous(x) + h/2·(der(x) + previous(der(x)))
    ImplicitTrapezoid,
}

const NAMES: [(&str, Method); 4] = [
    ("ExplicitEuler", Method::ExplicitEuler),
    ("ImplicitEuler", Method::ImplicitEuler),
    ("ImplicitTrapezoid", Method::ImplicitTrapezoid),
    ("External", Method::ImplicitTrapezoid),
];

impl Builder<'_> {
    /// Solver methods of partitions that have none, from those that they exchange values with.
    pub(super) fn infer_solver_methods(
        &mut self,
        partitions: &mut Partitions,
    ) -> Result<(), Diagnostic> {
        let links = self.links(partitions);
        let given: Vec<bool> = partitions.subs.iter().map(|sub| sub.solver.is_some()).collect();
        loop {
            let mut changed = false;
            for link in &links {
                for (from, to) in [(link.argument, link.value), (link.value, link.argument)] {
                    let Some(method) = partitions.subs[from].solver.clone() else { continue };
                    let known: Option<&Arc<str>> = partitions.subs[to].solver.as_ref();
                    match known {
                        None => {
                            partitions.subs[to].solver = Some(method);
                            changed = true;
                        }
                        Some(other) if *other == method || given[to] => {}
                        Some(other) => {
                            return Err(fault!(CLOCK_CONFLICT,
                                "two solver methods reach this, `{method}` and `{other}`";
                                help: "give it one with `Clock(c, solverMethod = …)`")
                            .at(link.span));
                        }
                    }
                }
            }
            if !changed {
                return Ok(());
            }
        }
    }

    /// An equation for every state of a clocked partition, `der(x)` becoming a variable like others.
    pub(super) fn discretized(
        &mut self,
        partitions: &Partitions,
        ticks: &mut Ticks,
    ) -> Result<Vec<ClockedEquation>, Diagnostic> {
        let states = self.dae.variables.iter().zip(0..).filter_map(|(variable, at)| {
            let VariableKind::Derivative(of) = variable.kind else { return None };
            Some((VarId(at), of, partitions.of(of)?))
        });
        let states: Vec<(VarId, VarId, usize)> = states.collect();
        let mut conditions = self.clocked_initial_equations(partitions)?;
        let mut equations = Vec::with_capacity(states.len());
        for (derivative, state, sub) in states {
            let span = self.dae.variable(state).span;
            let method = self.method(partitions, sub, state, span)?;
            let step = self.step(partitions, ticks, method, (derivative, state), sub);
            let first = self.is_first_tick(ticks, sub, span);
            let x = self.dae.pool.variable(state);
            let free = !self.dae.variable(state).fixed;
            let at = conditions.iter().position(|(_, of)| *of == sub).filter(|_| free);
            let equation = match at.map(|at| conditions.remove(at).0) {
                Some(condition) => {
                    let pool = &mut self.dae.pool;
                    let residual = pool.sub(condition.left, condition.right);
                    let later = pool.sub(x, step);
                    let left = pool.constant(0.0);
                    Equation::new(left, pool.if_then_else(first, residual, later), condition.span)
                }
                None => {
                    let previous = self.previous_variable(state);
                    let before = self.dae.pool.variable(previous);
                    let value = self.dae.pool.if_then_else(first, before, step);
                    Equation::new(x, value, span)
                }
            };
            let rate = self.backward_difference(partitions, ticks, state, sub);
            equations.push(ClockedEquation { equation, sub, rate: Some((derivative, rate)) });
        }
        match conditions.first() {
            Some((condition, _)) => Err(fault!(
                NOT_SUPPORTED,
                "an initial equation of clocked variables, without a state that it could determine"
            )
            .at(condition.span)),
            None => Ok(equations),
        }
    }

    /// (x - previous(x))/h: the derivative of a state that constraints determine.
    fn backward_difference(
        &mut self,
        partitions: &Partitions,
        ticks: &mut Ticks,
        state: VarId,
        sub: usize,
    ) -> Expr {
        let h = self.interval_of(partitions, ticks, sub);
        let previous = self.previous_variable(state);
        let pool = &mut self.dae.pool;
        let (x, before) = (pool.variable(state), pool.variable(previous));
        let difference = pool.sub(x, before);
        pool.div(difference, h)
    }

    /// Initial equations of clocked variables, taken out of those of the model.
    fn clocked_initial_equations(
        &mut self,
        partitions: &Partitions,
    ) -> Result<Vec<(Equation, usize)>, Diagnostic> {
        let incidence = self.incidence();
        let mut clocked = Vec::new();
        let mut others = Vec::new();
        for equation in std::mem::take(&mut self.dae.initial_equations) {
            let variables = incidence.of(&self.dae, &[equation.left, equation.right]);
            match variables.iter().find_map(|v| partitions.of(*v)) {
                Some(sub) => clocked.push((equation, sub)),
                None => others.push(equation),
            }
        }
        self.dae.initial_equations = others;
        Ok(clocked)
    }

    fn method(
        &self,
        partitions: &Partitions,
        sub: usize,
        state: VarId,
        span: Span,
    ) -> Result<Method, Diagnostic> {
        let name = &self.dae.variable(state).name;
        let Some(solver) = &partitions.subs[sub].solver else {
            return Err(fault!(CLOCK_CONFLICT,
                "`der({name})` is in a clocked partition that has no solver method";
                help: "give its clock one: `Clock(c, solverMethod = \"ImplicitEuler\")`")
            .at(span));
        };
        let known = NAMES.iter().find(|(known, _)| *known == &**solver);
        known.map(|(_, method)| *method).ok_or_else(|| {
            let names: Vec<&str> = NAMES.iter().map(|(name, _)| *name).collect();
            fault!(NOT_SUPPORTED, "the solver method `{solver}` of `{name}`";
                help: "there are: {}", names.join(", "))
            .at(span)
        })
    }

    /// The state after a step.
    fn step(
        &mut self,
        partitions: &Partitions,
        ticks: &mut Ticks,
        method: Method,
        (derivative, state): (VarId, VarId),
        sub: usize,
    ) -> Expr {
        let h = self.interval_of(partitions, ticks, sub);
        let (x, rate) = (self.previous_variable(state), self.previous_variable(derivative));
        let pool = &mut self.dae.pool;
        let (x, before, now) = (pool.variable(x), pool.variable(rate), pool.variable(derivative));
        let mean_rate = match method {
            Method::ExplicitEuler => before,
            Method::ImplicitEuler => now,
            Method::ImplicitTrapezoid => {
                let both = pool.add(now, before);
                let half = pool.constant(0.5);
                pool.mul(half, both)
            }
        };
        let difference = pool.mul(h, mean_rate);
        pool.add(x, difference)
    }
}
