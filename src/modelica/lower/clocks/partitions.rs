//! Base-partitions and sub-partitions (MLS §16.7): equations and variables that belong to one clock.

use super::conversion::{Conversion, Grid, Rational};
use super::{Base, Occurrence, Operator};
use crate::diag::Diagnostic;
use crate::fault;
use crate::lower::builder::Builder;
use crate::lower::dae::{Dae, VariableKind};
use crate::lower::equation::Equation;
use crate::lower::errors::CLOCK_CONFLICT;
use crate::source::Span;
use crate::symbolic::{Expr, VarId};
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;

/// All partitions that are clocked.
#[derive(Debug)]
pub(super) struct Partitions {
    pub(super) bases: Vec<BasePartition>,
    pub(super) subs: Vec<SubPartition>,
    /// The sub-partition of a clocked variable, by its number.
    of: Vec<Option<u32>>,
}

/// What ticks by one clock.
#[derive(Debug)]
pub(super) struct BasePartition {
    /// The clock that was given, and where; that of a rational one is a second.
    pub(super) clock: Base,
    pub(super) span: Span,
}

/// What ticks together.
#[derive(Debug)]
pub(super) struct SubPartition {
    pub(super) base: usize,
    /// When it ticks, once that is inferred.
    pub(super) grid: Option<Grid>,
    /// Where one of its operators stands.
    pub(super) span: Span,
    /// A variable, for messages.
    pub(super) variable: VarId,
    pub(super) solver: Option<Arc<str>>,
}

/// A conversion between sub-partitions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Link {
    pub(super) argument: usize,
    pub(super) value: usize,
    pub(super) conversion: Conversion,
    pub(super) span: Span,
}

impl Partitions {
    /// The sub-partition of a variable; `None` where it is not clocked.
    pub(super) fn of(&self, variable: VarId) -> Option<usize> {
        self.of.get(variable.0 as usize).copied().flatten().map(|number| number as usize)
    }
}

/// Which variables decide the clock of an expression; relations and roundings that are frozen
/// between events stand for what they compare.
#[derive(Debug)]
pub(super) struct Incidence {
    frozen: FxHashMap<VarId, [Option<Expr>; 2]>,
    /// The values of clocked operators.
    operators: FxHashSet<VarId>,
}

impl Builder<'_> {
    pub(super) fn incidence(&self) -> Incidence {
        let dae = &self.dae;
        let relations = dae.relations.iter().map(|r| (r.variable, [Some(r.left), Some(r.right)]));
        let roundings = dae.events.roundings.iter().map(|r| (r.variable, [Some(r.argument), None]));
        Incidence {
            frozen: relations.chain(roundings).collect(),
            operators: self.clocks.occurrences.iter().map(|o| o.variable).collect(),
        }
    }
}

impl Incidence {
    /// The variables that decide the clock of an expression, those of frozen values included.
    pub(super) fn of(&self, dae: &Dae, roots: &[Expr]) -> Vec<VarId> {
        let (mut open, mut seen) = (roots.to_vec(), FxHashSet::default());
        let mut found = Vec::new();
        while let Some(e) = open.pop() {
            dae.pool.visit_variables(&[e], |v| {
                if !seen.insert(v) {
                    return;
                }
                match dae.variable(v).kind {
                    VariableKind::Frozen => {
                        open.extend(self.frozen.get(&v).into_iter().flatten().flatten())
                    }
                    VariableKind::Previous(of) => found.push(of),
                    VariableKind::Unknown | VariableKind::Discrete | VariableKind::Clock => {
                        found.push(v)
                    }
                    VariableKind::Signal if self.operators.contains(&v) => found.push(v),
                    VariableKind::Derivative(of) => found.extend([v, of]),
                    _ => {}
                }
            });
        }
        found
    }
}

/// Sets of variables, joined one after the other.
struct Sets(Vec<u32>);

impl Sets {
    fn new(count: usize) -> Sets {
        Sets((0..count as u32).collect())
    }

    fn root(&mut self, of: VarId) -> u32 {
        let mut at = of.0;
        while self.0[at as usize] != at {
            let up = self.0[self.0[at as usize] as usize];
            self.0[at as usize] = up;
            at = up;
        }
        at
    }

    fn join(&mut self, a: VarId, b: VarId) {
        let (a, b) = (self.root(a), self.root(b));
        // The lower number stays, so that the order of variables decides.
        self.0[a.max(b) as usize] = a.min(b);
    }

    fn join_all(&mut self, variables: &[VarId]) {
        variables.windows(2).for_each(|pair| self.join(pair[0], pair[1]));
    }
}

impl Builder<'_> {
    /// The clocked partitions, with the clocks that are given and without intervals.
    pub(super) fn clock_partitions(&mut self) -> Result<Partitions, Diagnostic> {
        let (mut bases, mut subs) = self.joined();
        let clocked = self.clocked_bases(&mut bases)?;
        let mut partitions =
            Partitions { bases: Vec::new(), subs: Vec::new(), of: vec![None; bases.0.len()] };
        let (mut base_numbers, mut sub_numbers) = (FxHashMap::default(), FxHashMap::default());
        for at in 0..bases.0.len() as u32 {
            let variable = VarId(at);
            let base = bases.root(variable);
            let Some(span) = clocked.get(&base) else { continue };
            let base = *base_numbers.entry(base).or_insert_with(|| {
                partitions.bases.push(BasePartition { clock: Base::Inferred, span: *span });
                partitions.bases.len() - 1
            });
            let sub = *sub_numbers.entry(subs.root(variable)).or_insert_with(|| {
                let span = self.dae.variable(variable).span;
                partitions.subs.push(SubPartition {
                    base,
                    grid: None,
                    span,
                    variable,
                    solver: None,
                });
                partitions.subs.len() - 1
            });
            partitions.of[at as usize] = Some(sub as u32);
        }
        self.given_clocks(&mut partitions)?;
        Ok(partitions)
    }

    /// Variables joined by base-clocks and by sub-clocks.
    fn joined(&self) -> (Sets, Sets) {
        let count = self.dae.variables.len();
        let (mut bases, mut subs) = (Sets::new(count), Sets::new(count));
        let incidence = self.incidence();
        let mut both = |variables: &[VarId]| {
            bases.join_all(variables);
            subs.join_all(variables);
        };
        for equation in self.dae.equations.iter().chain(&self.dae.events.equations) {
            both(&incidence.of(&self.dae, &[equation.left, equation.right]));
        }
        for (clock, Equation { left, right, .. }) in &self.clocks.on_clock {
            let mut variables = incidence.of(&self.dae, &[*left, *right]);
            variables.push(*clock);
            both(&variables);
        }
        self.variables_of_states().iter().for_each(|variables| both(variables));
        for occurrence in &self.clocks.occurrences {
            let variable = occurrence.variable;
            match &occurrence.operator {
                Operator::Previous(of) => both(&[variable, *of]),
                Operator::Sample(_, Some(clock)) => both(&[variable, *clock]),
                Operator::Interval(of) | Operator::FirstTick(of) => {
                    let mut all = incidence.of(&self.dae, of);
                    all.push(variable);
                    both(&all);
                }
                Operator::Clock(Base::Counted(of, _) | Base::Variable(of)) => {
                    both(&[variable, *of]);
                }
                Operator::Sample(_, None)
                | Operator::Hold(_)
                | Operator::Convert(..)
                | Operator::Clock(_) => {}
            }
        }
        for occurrence in &self.clocks.occurrences {
            if let Operator::Convert(of, _) = occurrence.operator {
                bases.join(occurrence.variable, of);
            }
        }
        (bases, subs)
    }

    /// The base-partitions that are clocked, with a place that says so.
    fn clocked_bases(&self, bases: &mut Sets) -> Result<FxHashMap<u32, Span>, Diagnostic> {
        let mut clocked: FxHashMap<u32, Span> = FxHashMap::default();
        for (clock, equation) in &self.clocks.on_clock {
            clocked.entry(bases.root(*clock)).or_insert(equation.span);
        }
        for state in self.clocks.machines.states.values() {
            clocked.entry(bases.root(state.active)).or_insert(state.span);
        }
        let mut unclocked: Vec<(VarId, Span)> = Vec::new();
        for occurrence in &self.clocks.occurrences {
            let Occurrence { variable, span, .. } = occurrence;
            match &occurrence.operator {
                Operator::Hold(of) => {
                    unclocked.push((*variable, *span));
                    clocked.entry(bases.root(*of)).or_insert(*span);
                }
                Operator::Sample(of, _) => {
                    unclocked.push((*of, *span));
                    clocked.entry(bases.root(*variable)).or_insert(*span);
                }
                Operator::Clock(Base::Event(of, _)) => {
                    unclocked.push((*of, *span));
                    clocked.entry(bases.root(*variable)).or_insert(*span);
                }
                _ => {
                    clocked.entry(bases.root(*variable)).or_insert(*span);
                }
            }
        }
        for (variable, span) in unclocked {
            if let Some(other) = clocked.get(&bases.root(variable)) {
                let name = self.name_for_message(variable);
                return Err(fault!(CLOCK_CONFLICT, "{name} is clocked and not clocked";
                    help: "use `sample` for what comes from continuous time, and `hold` for what \
                           goes there")
                .at(span)
                .related(*other, "clocked by this"));
            }
        }
        Ok(clocked)
    }

    /// The clock of every base-partition, and the intervals of rational clocks.
    fn given_clocks(&mut self, partitions: &mut Partitions) -> Result<(), Diagnostic> {
        for occurrence in &self.clocks.occurrences {
            let Operator::Clock(clock) = &occurrence.operator else { continue };
            let Some(number) = partitions.of(occurrence.variable) else { continue };
            let sub = &mut partitions.subs[number];
            let base = &mut partitions.bases[sub.base];
            let span = occurrence.span;
            match (clock, &base.clock) {
                (Base::Inferred, _) => continue,
                (Base::Solver(method), _) => {
                    if sub.solver.as_ref().is_some_and(|other| other != method) {
                        return Err(fault!(
                            CLOCK_CONFLICT,
                            "two solver methods for one clock, `{method}` and `{}`",
                            sub.solver.as_deref().unwrap_or_default()
                        )
                        .at(span));
                    }
                    sub.solver = Some(method.clone());
                    continue;
                }
                (_, Base::Inferred) | (Base::Rational(_), Base::Rational(_)) => {}
                (one, other) if one == other => {}
                _ => {
                    return Err(fault!(CLOCK_CONFLICT,
                        "a second clock for what ticks by another one already";
                        help: "use one clock variable for both, or convert between the clocks \
                               with `hold` and `sample`")
                    .at(span)
                    .related(base.span, "the other clock"));
                }
            }
            let interval = match clock {
                Base::Rational(interval) => *interval,
                _ => Rational::from(1),
            };
            let grid = Grid::of(interval);
            if let Some(known) = sub.grid.filter(|known| *known != grid) {
                return Err(fault!(CLOCK_CONFLICT,
                    "two intervals for one clock, {} and {} seconds: equations join what ticks \
                     by them", known.interval, grid.interval;
                    help: "convert between clocks of one base with `subSample` or `superSample`, \
                           between others with `hold` and `sample`")
                .at(span)
                .related(sub.span, "the other interval"));
            }
            (sub.grid, sub.span) = (Some(grid), span);
            (base.clock, base.span) = (clock.clone(), span);
        }
        Ok(())
    }

    /// All conversions between sub-partitions.
    pub(super) fn links(&self, partitions: &Partitions) -> Vec<Link> {
        let link = |occurrence: &Occurrence| {
            let Operator::Convert(of, conversion) = occurrence.operator else { return None };
            Some(Link {
                argument: partitions.of(of)?,
                value: partitions.of(occurrence.variable)?,
                conversion,
                span: occurrence.span,
            })
        };
        self.clocks.occurrences.iter().filter_map(link).collect()
    }

    /// A variable of the model, or words for one that is not.
    pub(super) fn name_for_message(&self, variable: VarId) -> String {
        let name = &self.dae.variable(variable).name;
        match name.contains('$') {
            true => "this expression".into(),
            false => format!("`{name}`"),
        }
    }
}
