//! When sub-partitions tick: a Boolean for each that is true in one round of the event iteration.

use super::Base;
use super::conversion::{Grid, Rational, number};
use super::partitions::{Partitions, SubPartition};
use crate::diag::Diagnostic;
use crate::flatten::{BaseType, Variability};
use crate::lower::build::scalar_of_nothing;
use crate::lower::builder::Builder;
use crate::lower::dae::VariableKind;
use crate::lower::equation::Equation;
use crate::lower::expressions::Operations;
use crate::source::Span;
use crate::symbolic::{Expr, RelationOperator, VarId};

/// The ticks of all sub-partitions.
pub(super) struct Ticks {
    subs: Vec<SubTicks>,
}

#[derive(Debug, Clone, Copy)]
struct SubTicks {
    active: Expr,
    interval: Option<Expr>,
    is_first: Option<Expr>,
}

impl Ticks {
    /// Whether a sub-partition ticks.
    pub(super) fn active(&self, sub: usize) -> Expr {
        self.subs[sub].active
    }
}

impl Builder<'_> {
    /// Variables and equations for the ticks of all sub-partitions.
    pub(super) fn ticks(&mut self, partitions: &Partitions) -> Result<Ticks, Diagnostic> {
        let mut base_ticks = Vec::with_capacity(partitions.bases.len());
        for base in &partitions.bases {
            base_ticks.push(match &base.clock {
                Base::Event(condition, _) => Some(self.event_tick(*condition, base.span)?),
                Base::Counted(counter, resolution) => {
                    Some(self.counted_tick(*counter, *resolution, base.span)?)
                }
                Base::Variable(interval) => Some(self.variable_tick(*interval, base.span)?),
                Base::Rational(_) | Base::Real(_) | Base::Inferred | Base::Solver(_) => None,
            });
        }
        let mut counters: Vec<Option<Expr>> = vec![None; partitions.bases.len()];
        let mut subs = Vec::with_capacity(partitions.subs.len());
        for sub in &partitions.subs {
            let grid = sub.grid.unwrap_or(Grid::of(Rational::from(1)));
            let active = match base_ticks[sub.base] {
                None => self.timed_tick(&partitions.bases[sub.base].clock, grid, sub.span)?,
                Some(tick) if grid == Grid::of(Rational::from(1)) => tick,
                Some(tick) => {
                    let counter = match counters[sub.base] {
                        Some(known) => known,
                        None => self.tick_counter(tick, sub.span)?,
                    };
                    counters[sub.base] = Some(counter);
                    self.every_nth(tick, counter, grid, sub.span)
                }
            };
            subs.push(SubTicks { active, interval: None, is_first: None });
        }
        Ok(Ticks { subs })
    }

    /// A discrete variable of the system, with its value at events.
    pub(super) fn at_events(&mut self, name: &str, base: BaseType, span: Span) -> (VarId, Expr) {
        let number = self.dae.variables.len();
        let mut variable =
            scalar_of_nothing(&format!("{name}[{number}]"), VariableKind::Discrete, span);
        variable.base = base;
        variable.variability = Variability::Discrete;
        let id = self.dae.declare_variable(variable);
        (id, self.dae.pool.variable(id))
    }

    fn set_at_events(&mut self, variable: Expr, value: Expr, span: Span) {
        self.dae.events.equations.push(Equation::new(variable, value, span));
    }

    pub(super) fn pre(&mut self, of: VarId) -> Expr {
        let previous = self.previous_variable(of);
        self.dae.pool.variable(previous)
    }

    /// Ticks at times that are known: start + shift + i·interval.
    fn timed_tick(&mut self, clock: &Base, grid: Grid, span: Span) -> Result<Expr, Diagnostic> {
        let (interval, shift) =
            (self.in_seconds(clock, grid.interval), { self.in_seconds(clock, grid.shift) });
        let due = self.sample_since_start(shift, interval, span)?;
        let value = self.edge(due, span)?;
        Ok(self.tick_variable(value, span))
    }

    fn tick_variable(&mut self, value: Expr, span: Span) -> Expr {
        let (_, tick) = self.at_events("$tick", BaseType::Boolean, span);
        self.set_at_events(tick, value, span);
        tick
    }

    fn in_seconds(&mut self, clock: &Base, value: Rational) -> Expr {
        let factor = self.dae.pool.constant(number(value));
        match clock {
            Base::Real(unit) => self.dae.pool.mul(factor, *unit),
            _ => factor,
        }
    }

    /// `edge(pre(condition))`: one round of the event iteration after the condition.
    fn event_tick(&mut self, condition: VarId, span: Span) -> Result<Expr, Diagnostic> {
        let before = self.pre(condition);
        let (fired, value) = self.at_events("$fired", BaseType::Boolean, span);
        self.set_at_events(value, before, span);
        let fired_before = self.pre(fired);
        let not = self.dae.pool.not(fired_before);
        let edge = self.dae.pool.and(value, not);
        Ok(self.tick_variable(edge, span))
    }

    /// Ticks at start + n/resolution, n growing by the counter at every tick.
    fn counted_tick(
        &mut self,
        counter: VarId,
        resolution: i64,
        span: Span,
    ) -> Result<Expr, Diagnostic> {
        let started = self.start_time(span);
        let (sum, counted) = self.at_events("$counted", BaseType::Integer, span);
        let before = self.pre(sum);
        let per_second = self.dae.pool.constant(resolution as f64);
        let since = self.dae.pool.div(before, per_second);
        let next = self.dae.pool.add(started, since);
        let tick = self.tick_when_reached(next, span);
        let counter = self.dae.pool.variable(counter);
        let more = self.dae.pool.add(before, counter);
        let value = self.dae.pool.if_then_else(tick, more, before);
        self.set_at_events(counted, value, span);
        self.dae.variables[sum.0 as usize].start = Some(self.dae.pool.constant(0.0));
        Ok(tick)
    }

    /// Ticks at the start, and one interval after every tick.
    fn variable_tick(&mut self, interval: VarId, span: Span) -> Result<Expr, Diagnostic> {
        let (next, scheduled) = self.at_events("$next", BaseType::Real, span);
        let before = self.pre(next);
        let tick = self.tick_when_reached(before, span);
        let time = self.dae.pool.variable(VarId(0));
        let interval = self.dae.pool.variable(interval);
        let later = self.dae.pool.add(time, interval);
        let value = self.dae.pool.if_then_else(tick, later, before);
        let initial = self.initial_signal();
        let value = self.dae.pool.if_then_else(initial, time, value);
        self.set_at_events(scheduled, value, span);
        Ok(tick)
    }

    fn start_time(&mut self, span: Span) -> Expr {
        let (start, started) = self.at_events("$started", BaseType::Real, span);
        let before = self.pre(start);
        let initial = self.initial_signal();
        let time = self.dae.pool.variable(VarId(0));
        let value = self.dae.pool.if_then_else(initial, time, before);
        self.set_at_events(started, value, span);
        started
    }

    /// A tick when time has come, after the initialization.
    fn tick_when_reached(&mut self, instant: Expr, span: Span) -> Expr {
        let time = self.dae.pool.variable(VarId(0));
        let due = self.relation(RelationOperator::GreaterEqual, time, instant, false, span);
        let initial = self.initial_signal();
        let not = self.dae.pool.not(initial);
        let value = self.dae.pool.and(due, not);
        self.tick_variable(value, span)
    }

    /// How many ticks there were before the one at hand.
    fn tick_counter(&mut self, tick: Expr, span: Span) -> Result<Expr, Diagnostic> {
        let (counter, value) = self.at_events("$count", BaseType::Integer, span);
        let before = self.pre(counter);
        let one = self.dae.pool.constant(1.0);
        let more = self.dae.pool.add(before, one);
        let counted = self.dae.pool.if_then_else(tick, more, before);
        self.set_at_events(value, counted, span);
        self.dae.variables[counter.0 as usize].start = Some(self.dae.pool.constant(-1.0));
        Ok(value)
    }

    /// Every n-th tick, from one on.
    fn every_nth(&mut self, tick: Expr, counter: Expr, grid: Grid, span: Span) -> Expr {
        let pool = &mut self.dae.pool;
        let (every, from) =
            (pool.constant(number(grid.interval)), pool.constant(number(grid.shift)));
        let since = pool.sub(counter, from);
        let zero = pool.constant(0.0);
        let begun = pool.relation(RelationOperator::GreaterEqual, since, zero);
        let ratio = pool.div(since, every);
        let whole = pool.function("floor", &[ratio]);
        let multiple = pool.mul(whole, every);
        let fits = pool.relation(RelationOperator::Equal, multiple, since);
        let begun = pool.and(tick, begun);
        let value = pool.and(begun, fits);
        self.tick_variable(value, span)
    }

    /// `firstTick()` of a sub-partition: there was no tick before.
    pub(super) fn is_first_tick(&mut self, ticks: &mut Ticks, sub: usize, span: Span) -> Expr {
        if let Some(known) = ticks.subs[sub].is_first {
            return known;
        }
        let (ticked, value) = self.at_events("$ticked", BaseType::Boolean, span);
        let before = self.pre(ticked);
        let now = self.dae.pool.or(ticks.subs[sub].active, before);
        self.set_at_events(value, now, span);
        let first = self.dae.pool.not(before);
        ticks.subs[sub].is_first = Some(first);
        first
    }

    /// `interval()` of a sub-partition, seconds.
    pub(super) fn interval_of(
        &mut self,
        partitions: &Partitions,
        ticks: &mut Ticks,
        sub: usize,
    ) -> Expr {
        if let Some(known) = ticks.subs[sub].interval {
            return known;
        }
        let partition = &partitions.subs[sub];
        let grid = partition.grid.unwrap_or(Grid::of(Rational::from(1)));
        let clock = &partitions.bases[partition.base].clock;
        let interval = match clock {
            Base::Event(_, start) => self.measured_interval(ticks, sub, *start, partition),
            Base::Counted(of, resolution) => {
                let before = self.pre(*of);
                let per_second = self.dae.pool.constant(*resolution as f64);
                let first = self.dae.pool.div(before, per_second);
                self.measured_interval(ticks, sub, first, partition)
            }
            Base::Variable(of) => {
                let first = self.pre(*of);
                self.measured_interval(ticks, sub, first, partition)
            }
            _ => self.in_seconds(clock, grid.interval),
        };
        ticks.subs[sub].interval = Some(interval);
        interval
    }

    /// The time since the tick before; at the first one a given value.
    fn measured_interval(
        &mut self,
        ticks: &mut Ticks,
        sub: usize,
        first: Expr,
        partition: &SubPartition,
    ) -> Expr {
        let span = partition.span;
        let is_first = self.is_first_tick(ticks, sub, span);
        let (last, value) = self.at_events("$last", BaseType::Real, span);
        let before = self.pre(last);
        let time = self.dae.pool.variable(VarId(0));
        let now = self.dae.pool.if_then_else(ticks.subs[sub].active, time, before);
        self.set_at_events(value, now, span);
        let since = self.dae.pool.sub(time, before);
        self.dae.pool.if_then_else(is_first, first, since)
    }
}
