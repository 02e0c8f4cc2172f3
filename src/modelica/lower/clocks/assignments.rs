//! Clocked equations become equations at events: `v = if tick then … else pre(v)`.
//!
//! Which equation determines which variable is found for every sub-partition by itself; what cannot
//! be solved for its variable stays an implicit equation, `v = if tick then v - residual …`.

use super::Operator;
use super::clocked_equation::ClockedEquation;
use super::partitions::Partitions;
use super::state_outputs::{Column, Columns};
use super::ticks::Ticks;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::{BaseType, Variability};
use crate::graph::{Bipartite, Matching, match_equations};
use crate::lower::builder::Builder;
use crate::lower::dae::{Dae, VariableKind};
use crate::lower::equation::{Assertion, Equation};
use crate::lower::errors::{NOT_SUPPORTED, UNBALANCED_MODEL};
use crate::source::Span;
use crate::symbolic::{Expr, Substitution, VarId, solve};
use indexmap::IndexMap;
use rustc_hash::FxHashMap;

/// How many variables and equations a message names.
const MAX_SHOWN: usize = 5;

type Values = FxHashMap<VarId, Expr>;

impl Builder<'_> {
    /// Replaces all that is clocked by equations at events.
    pub(super) fn write_clocked(&mut self, partitions: Partitions) -> Result<(), Diagnostic> {
        let (mut clocked, asserted) = self.take_clocked(&partitions);
        self.check_states(&partitions, &clocked)?;
        let mut ticks = self.ticks(&partitions)?;
        clocked.extend(self.discretized(&partitions, &mut ticks)?);
        let values = self.values_of_operators(&partitions, &mut ticks);
        let live = self.live_values(&values);
        self.become_discrete(&partitions);
        let replacement = |v: VarId| live.get(&v).or_else(|| values.get(&v)).copied();
        let mut substitution = Substitution::new(&replacement);
        for ClockedEquation { equation, .. } in &mut clocked {
            equation.left = substitution.apply(&mut self.dae.pool, equation.left);
            equation.right = substitution.apply(&mut self.dae.pool, equation.right);
        }
        for (mut assertion, sub) in asserted {
            assertion.for_each_expression(&mut |e: &mut Expr| {
                *e = substitution.apply(&mut self.dae.pool, *e);
            });
            let first = self.dae.assertions.len();
            self.dae.assertions.push(assertion);
            self.dae.move_assertions(first, ticks.active(sub));
        }
        self.drop_clocked_relations(&partitions);
        self.replace_operators(&values);
        self.assign_clocked(&partitions, &ticks, &clocked)
    }

    /// What the clocked operators stand for.
    fn values_of_operators(&mut self, partitions: &Partitions, ticks: &mut Ticks) -> Values {
        let mut values = Values::default();
        for occurrence in self.clocks.occurrences.clone() {
            let variable = occurrence.variable;
            let value = match occurrence.operator {
                Operator::Previous(of) => self.previous_or_start(of),
                Operator::Sample(of, _) => {
                    let previous = self.previous_variable(of);
                    self.dae.pool.variable(previous)
                }
                Operator::Hold(of) | Operator::Convert(of, _) => self.dae.pool.variable(of),
                Operator::Interval(_) | Operator::FirstTick(_) => {
                    let Some(sub) = partitions.of(variable) else { continue };
                    match occurrence.operator {
                        Operator::Interval(_) => self.interval_of(partitions, ticks, sub),
                        _ => self.is_first_tick(ticks, sub, occurrence.span),
                    }
                }
                Operator::Clock(_) => continue,
            };
            values.insert(variable, value);
        }
        values
    }

    /// Relations and roundings as they are at every evaluation: clocked equations cause no events
    /// (MLS §16.8.1).
    fn live_values(&mut self, operators: &Values) -> Values {
        enum Frozen {
            Relation(usize),
            Rounding(usize),
        }
        let mut all: Vec<(VarId, Frozen)> = Vec::new();
        let relations = self.dae.relations.iter().enumerate();
        all.extend(relations.map(|(at, relation)| (relation.variable, Frozen::Relation(at))));
        let roundings = self.dae.events.roundings.iter().enumerate();
        all.extend(roundings.map(|(at, rounding)| (rounding.variable, Frozen::Rounding(at))));
        // What is inside another was made before it.
        all.sort_unstable_by_key(|(variable, _)| *variable);
        let mut live = Values::default();
        for (variable, frozen) in all {
            let replacement = |v: VarId| live.get(&v).or_else(|| operators.get(&v)).copied();
            let mut substitution = Substitution::new(&replacement);
            let pool = &mut self.dae.pool;
            let value = match frozen {
                Frozen::Relation(at) => {
                    let relation = self.dae.relations[at];
                    let left = substitution.apply(pool, relation.left);
                    let right = substitution.apply(pool, relation.right);
                    pool.relation(relation.operator, left, right)
                }
                Frozen::Rounding(at) => {
                    let argument = self.dae.events.roundings[at].argument;
                    let argument = substitution.apply(pool, argument);
                    pool.function("floor", &[argument])
                }
            };
            live.insert(variable, value);
        }
        live
    }

    /// Takes the clocked equations and assertions out of those of the model. Equations of clocks
    /// are done with: they have said what ticks together.
    fn take_clocked(
        &mut self,
        partitions: &Partitions,
    ) -> (Vec<ClockedEquation>, Vec<(Assertion, usize)>) {
        let incidence = self.incidence();
        let mut clocked = Vec::new();
        let equations = std::mem::take(&mut self.dae.equations);
        let at_events = std::mem::take(&mut self.dae.events.equations);
        let sub_of = |builder: &Self, roots: &[Expr]| {
            let variables = incidence.of(&builder.dae, roots);
            variables.iter().find_map(|v| partitions.of(*v))
        };
        for (list, is_at_events) in [(equations, false), (at_events, true)] {
            for equation in list {
                if self.is_clock_expression(equation.left) {
                    continue;
                }
                match (sub_of(self, &[equation.left, equation.right]), is_at_events) {
                    (Some(sub), _) => clocked.push(ClockedEquation { equation, sub, rate: None }),
                    (None, false) => self.dae.equations.push(equation),
                    (None, true) => self.dae.events.equations.push(equation),
                }
            }
        }
        let mut asserted: Vec<(Assertion, usize)> = Vec::new();
        for (clock, assertion) in std::mem::take(&mut self.clocks.asserted) {
            asserted.extend(partitions.of(clock).map(|sub| (assertion, sub)));
        }
        for assertion in std::mem::take(&mut self.dae.assertions) {
            let mut roots = vec![assertion.condition];
            roots.extend(assertion.values());
            match sub_of(self, &roots) {
                Some(sub) => asserted.push((assertion, sub)),
                None => self.dae.assertions.push(assertion),
            }
        }
        (clocked, asserted)
    }

    /// All clocked variables keep their values between ticks.
    fn become_discrete(&mut self, partitions: &Partitions) {
        for (at, variable) in self.dae.variables.iter_mut().enumerate() {
            let is_clocked = partitions.of(VarId(at as u32)).is_some();
            if is_clocked
                && matches!(variable.kind, VariableKind::Unknown | VariableKind::Derivative(_))
            {
                variable.kind = VariableKind::Discrete;
                variable.variability = Variability::Discrete;
            }
        }
    }

    /// Relations and roundings of clocked variables: they are no longer read.
    fn drop_clocked_relations(&mut self, partitions: &Partitions) {
        let incidence = self.incidence();
        let clocked = |dae: &Dae, roots: &[Expr]| {
            incidence.of(dae, roots).iter().any(|v| partitions.of(*v).is_some())
        };
        let relations = std::mem::take(&mut self.dae.relations);
        let roundings = std::mem::take(&mut self.dae.events.roundings);
        let (dropped, kept): (Vec<_>, Vec<_>) =
            relations.into_iter().partition(|r| clocked(&self.dae, &[r.left, r.right]));
        self.dae.relations = kept;
        let mut unused: Vec<VarId> = dropped.iter().map(|relation| relation.variable).collect();
        let (dropped, kept): (Vec<_>, Vec<_>) =
            roundings.into_iter().partition(|r| clocked(&self.dae, &[r.argument]));
        self.dae.events.roundings = kept;
        unused.extend(dropped.iter().map(|rounding| rounding.variable));
        for variable in unused {
            self.dae.variables[variable.0 as usize].kind = VariableKind::Signal;
        }
    }

    /// Writes the values of clocked operators, those of `hold`, into what is not clocked.
    fn replace_operators(&mut self, values: &Values) {
        let replacement = |v: VarId| values.get(&v).copied();
        let mut substitution = Substitution::new(&replacement);
        let dae = &mut self.dae;
        let pool = &mut dae.pool;
        let mut replace = |e: &mut Expr| *e = substitution.apply(pool, *e);
        for equation in dae.equations.iter_mut().chain(&mut dae.initial_equations) {
            replace(&mut equation.left);
            replace(&mut equation.right);
        }
        for relation in &mut dae.relations {
            replace(&mut relation.left);
            replace(&mut relation.right);
        }
        dae.assertions.iter_mut().for_each(|a| a.for_each_expression(&mut replace));
        dae.events.for_each_expression(replace);
    }

    /// Every clocked variable by one equation of its sub-partition.
    fn assign_clocked(
        &mut self,
        partitions: &Partitions,
        ticks: &Ticks,
        clocked: &[ClockedEquation],
    ) -> Result<(), Diagnostic> {
        let columns = self.columns(partitions)?;
        let mut rows = Vec::with_capacity(clocked.len());
        for clocked in clocked {
            rows.push(self.row(partitions, *clocked, &columns));
        }
        let matching = match_equations(&Bipartite::new(columns.list.len(), rows));
        if !matching.is_perfect() {
            return Err(self.unbalanced(clocked, &columns, &matching));
        }
        let mut merged: IndexMap<VarId, Vec<(Expr, Expr, ClockedEquation)>> = IndexMap::new();
        for (clocked, unknown) in clocked.iter().zip(&matching.equation_to_unknown) {
            let ClockedEquation { equation, sub, .. } = clocked;
            let Some(Column { variable, output_of }) = unknown.map(|at| columns.list[at]) else {
                continue;
            };
            let Some((way, value)) = self.value_by(*clocked, variable) else { continue };
            if way == Way::Difference {
                self.check_difference(*clocked, variable)?;
            }
            let state = self.state_of_instance(equation.instance);
            let state = state.or_else(|| self.state_of_variable(variable));
            let guard = state.map(|state| {
                let active = self.clocks.machines.states[state].active;
                self.dae.pool.variable(active)
            });
            if let (Some(guard), Some(_)) = (guard, output_of) {
                merged.entry(variable).or_default().push((guard, value, *clocked));
                continue;
            }
            let active = match guard {
                Some(guard) => self.dae.pool.and(ticks.active(*sub), guard),
                None => ticks.active(*sub),
            };
            self.assign_when(variable, active, value, *equation);
        }
        for (variable, values) in merged {
            self.assign_merged(variable, ticks, &values);
        }
        Ok(())
    }

    /// `v = if active then value else pre(v)`
    fn assign_when(&mut self, variable: VarId, active: Expr, value: Expr, equation: Equation) {
        let previous = self.previous_variable(variable);
        let pool = &mut self.dae.pool;
        let (left, before) = (pool.variable(variable), pool.variable(previous));
        let right = pool.if_then_else(active, value, before);
        self.dae.events.equations.push(Equation { left, right, ..equation });
    }

    /// A variable that states of state machines determine in turn (MLS §17.3.5).
    fn assign_merged(
        &mut self,
        variable: VarId,
        ticks: &Ticks,
        values: &[(Expr, Expr, ClockedEquation)],
    ) {
        let Some((_, _, first)) = values.first() else { return };
        // `last(v)`: a reset of the state that declares it comes first.
        let mut merged = self.previous_or_start(variable);
        for (guard, value, _) in values.iter().rev() {
            merged = self.dae.pool.if_then_else(*guard, *value, merged);
        }
        let equation = Equation { instance: None, ..first.equation };
        self.assign_when(variable, ticks.active(first.sub), merged, equation);
    }

    /// The variables that an equation may determine, by their columns, the best first.
    fn row(
        &mut self,
        partitions: &Partitions,
        clocked: ClockedEquation,
        columns: &Columns,
    ) -> Vec<usize> {
        let state = self.state_of_instance(clocked.equation.instance);
        let mut variables = Vec::new();
        let sides = [clocked.equation.left, clocked.equation.right];
        self.dae.pool.visit_variables(&sides, |v| variables.push(v));
        variables.extend(clocked.rate.map(|(derivative, _)| derivative));
        variables.sort_unstable();
        variables.dedup();
        let mut row: Vec<(Way, usize)> = Vec::new();
        for v in variables {
            if partitions.of(v) == Some(clocked.sub)
                && let Some(at) = self.column_of(columns, v, state)
                && let Some((way, _)) = self.value_by(clocked, v)
            {
                row.push((way, at));
            }
        }
        row.sort_unstable();
        row.into_iter().map(|(_, at)| at).collect()
    }

    /// A derivative by a backward difference: a warning, and no more than that where the start of
    /// the state matters.
    fn check_difference(
        &mut self,
        clocked: ClockedEquation,
        derivative: VarId,
    ) -> Result<(), Diagnostic> {
        let Equation { left, span, .. } = clocked.equation;
        let state = self.dae.pool.as_variable(left);
        let name = self.dae.variable(derivative).name.clone();
        if state.is_none_or(|state| self.dae.variable(state).fixed) {
            return Err(fault!(NOT_SUPPORTED,
                "index reduction in a clocked partition: constraints determine the state of \
                 `{name}`, but it has a start value of its own";
                help: "remove `fixed = true` from the state, or write the controller without \
                       derivatives of constrained variables")
            .at(span));
        }
        let warning = fault!(
            NOT_SUPPORTED,
            "`{name}` of a clocked partition is a backward difference, as constraints determine \
             the state"
        )
        .at(span);
        self.dae.warnings.push(warning.warning());
        Ok(())
    }

    /// The value that an equation gives a variable, and how; `None` if it cannot.
    fn value_by(&mut self, clocked: ClockedEquation, variable: VarId) -> Option<(Way, Expr)> {
        let equation = clocked.equation;
        if let Some((derivative, value)) = clocked.rate
            && derivative == variable
        {
            return Some((Way::Difference, value));
        }
        let base = self.dae.variable(variable).base.clone();
        let pool = &mut self.dae.pool;
        for (side, other) in [(equation.left, equation.right), (equation.right, equation.left)] {
            if pool.as_variable(side) == Some(variable) && !pool.depends_on(other, variable) {
                return Some((Way::Assigned, other));
            }
        }
        if base != BaseType::Real {
            return None;
        }
        if let Some(solution) = solve(pool, equation.left, equation.right, variable)
            && solution.is_exact
            && pool.as_constant(solution.divisor).is_some_and(|divisor| divisor != 0.0)
        {
            return Some((Way::Solved, solution.value));
        }
        let residual = pool.sub(equation.left, equation.right);
        let own = pool.variable(variable);
        Some((Way::Implicit, pool.sub(own, residual)))
    }

    fn unbalanced(
        &self,
        clocked: &[ClockedEquation],
        columns: &Columns,
        matching: &Matching,
    ) -> Diagnostic {
        let mut fault = fault!(UNBALANCED_MODEL,
            "the clocked equations do not determine the clocked variables: {} equations, {} variables", clocked.len(), columns.list.len())
        .at(clocked.first().map_or(Span::NONE, |first| first.equation.span));
        let open = matching.unknown_to_equation.iter().zip(&columns.list);
        for (_, v) in open.filter(|(equation, _)| equation.is_none()).take(MAX_SHOWN) {
            let variable = self.dae.variable(v.variable);
            let mut words = format!("no equation determines {}", self.name_for_message(v.variable));
            if let Some((path, _)) =
                v.output_of.and_then(|at| self.clocks.machines.states.get_index(at))
            {
                words.push_str(&format!(", an output of the state `{path}`, there"));
            }
            fault = fault.related(variable.span, words);
        }
        let left = matching.equation_to_unknown.iter().zip(clocked);
        for (_, open) in left.filter(|(unknown, _)| unknown.is_none()).take(MAX_SHOWN) {
            fault = fault.related(open.equation.span, "this equation determines nothing");
        }
        fault
    }
}

/// How an equation gives a variable its value, the best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Way {
    Assigned,
    Solved,
    Implicit,
    Difference,
}
