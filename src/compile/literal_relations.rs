//! Relations inside `noEvent`, with events after all.
//!
//! A relation inside `noEvent` is taken literally (MLS §3.7.5): the integrator steps across it. Where
//! the fields on both sides point at it, steps become as short as the tolerance allows and the
//! solution does not get on. A [`System`] can give events to these relations then, at the time that
//! it has reached: its program is replaced by one in which they are relations as all others, so that
//! the solution slides along them.
//!
//! Only relations of Reals in equations that hold between events take part, not those in functions,
//! assertions and when-clauses.

use super::lower::Registers;
use super::memory::Memory;
use super::program::{Outputs, Program, compile_outputs};
use super::system::{System, run};
use crate::causalize::{Assignment, Block, CausalizedDae};
use crate::flatten::{BaseType, Variability};
use crate::lower::{Dae, Kind, Relation, Variable};
use crate::sim::{DaeSystem, Failure};
use crate::symbolic::{Expr, Node, Pool, RelationOperator, VarId};
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::{Arc, OnceLock};

/// What a program knows of its relations inside `noEvent`, once somebody has asked.
#[derive(Debug, Default)]
pub(super) struct Literal {
    differences: OnceLock<Option<Differences>>,
    program: OnceLock<Option<Arc<Program>>>,
}

/// Computes left − right of every relation, from the registers of the unknowns and parameters.
#[derive(Debug)]
struct Differences {
    registers: Registers,
    code: Outputs,
}

/// A system whose relations inside `noEvent` are looked at, or have events.
#[derive(Debug, Clone, Default)]
pub(super) struct LiteralRelations {
    /// Where differences are computed.
    memory: Option<Box<Memory>>,
    /// The system as it was before they had events.
    plain: Option<Box<System>>,
}

/// A relation, and the number of the equation it was found in first.
type Found = (Expr, usize);

/// The relations in equations between events that are taken literally and vary there.
fn literal_relations(sorted: &CausalizedDae) -> Vec<Found> {
    let (dae, pool) = (&sorted.dae, &sorted.dae.pool);
    let mut known: FxHashSet<Expr> = FxHashSet::default();
    let mut found = Vec::new();
    for (value, equation) in sorted.blocks.iter().flat_map(continuous) {
        for e in pool.reachable(&[value]) {
            if is_candidate(dae, e) && known.insert(e) {
                found.push((e, equation));
            }
        }
    }
    found
}

/// The values and residuals of a block, with the numbers of their equations.
fn continuous(block: &Block) -> Vec<Found> {
    let residuals: &[(Expr, usize)] = match block {
        Block::Assignment(_) => &[],
        Block::Linear(linear) => &linear.residuals,
        Block::Loop(torn) => &torn.residuals,
    };
    let values = block.assignments().iter().map(|a| (a.value, a.equation));
    values.chain(residuals.iter().copied()).collect()
}

fn is_candidate(dae: &Dae, e: Expr) -> bool {
    match dae.pool.node(e) {
        Node::Relation(RelationOperator::Equal | RelationOperator::NotEqual, ..) => false,
        Node::Relation(..) => dae.pool.any_variable(e, |v| {
            let variable = dae.variable(v);
            variable.base == BaseType::Real && dae.is_unknown(v)
        }),
        _ => false,
    }
}

/// The system with relations that switch at events instead of these.
fn with_events(sorted: &CausalizedDae, literal: &[Found]) -> CausalizedDae {
    let mut sorted = sorted.clone();
    let mut replaced: FxHashMap<Expr, Expr> = FxHashMap::default();
    for (e, equation) in literal {
        let Node::Relation(operator, left, right) = *sorted.dae.pool.node(*e) else { continue };
        let dae = &mut sorted.dae;
        let equations = dae.equations.iter().chain(&dae.initial_equations);
        let span = equations.chain(&dae.events.equations).nth(*equation).map(|e| e.span);
        let span = span.unwrap_or(crate::source::Span::NONE);
        let variable = VarId(dae.variables.len() as u32);
        let frozen = Variable {
            name: format!("$relation[{}]", dae.relations.len() + 1).into(),
            kind: Kind::Frozen,
            base: BaseType::Boolean,
            variability: Variability::Discrete,
            span,
            ..dae.variables[0].clone()
        };
        dae.variables.push(frozen);
        dae.relations.push(Relation { variable, operator, left, right, span });
        replaced.insert(*e, dae.pool.variable(variable));
        sorted.aliases.push(None);
    }
    let CausalizedDae { dae, blocks, event_blocks, .. } = &mut sorted;
    let (pool, variables) = (&mut dae.pool, &dae.variables);
    let mut successors = replaced;
    for block in blocks.iter_mut().chain(event_blocks) {
        // Values of events are computed at events only, where relations are what their sides say.
        let is_between = |a: &Assignment| variables[a.variable.0 as usize].kind != Kind::Discrete;
        let (assignments, residuals) = parts(block);
        for assignment in assignments.iter_mut().filter(|a| is_between(a)) {
            assignment.value = replace(pool, &mut successors, assignment.value);
        }
        for (residual, _) in residuals {
            *residual = replace(pool, &mut successors, *residual);
        }
    }
    sorted
}

fn parts(block: &mut Block) -> (&mut [Assignment], &mut [(Expr, usize)]) {
    match block {
        Block::Assignment(assignment) => (std::slice::from_mut(assignment), &mut []),
        Block::Linear(linear) => (&mut linear.assignments, &mut linear.residuals),
        Block::Loop(torn) => (&mut torn.assignments, &mut torn.residuals),
    }
}

/// The expression with all that has a successor replaced.
fn replace(pool: &mut Pool, successors: &mut FxHashMap<Expr, Expr>, expr: Expr) -> Expr {
    for old in pool.reachable(&[expr]) {
        if successors.contains_key(&old) {
            continue;
        }
        let node = pool.node(old).clone();
        let mut changed = false;
        node.for_each_operand(|operand| changed |= successors[&operand] != operand);
        let new = match changed {
            true => pool.rebuild(&node, |operand| successors[&operand]),
            false => old,
        };
        successors.insert(old, new);
    }
    successors[&expr]
}

impl Program {
    /// The code for the sides of relations inside `noEvent`; `None` if there are none.
    fn differences(&self) -> Option<&Differences> {
        let made = self.literal.differences.get_or_init(|| {
            let literal = literal_relations(&self.sorted);
            if literal.is_empty() {
                return None;
            }
            let mut pool = self.sorted.dae.pool.clone();
            let sides = literal.iter().filter_map(|(e, _)| match *pool.node(*e) {
                Node::Relation(_, left, right) => Some((left, right)),
                _ => None,
            });
            let sides: Vec<(Expr, Expr)> = sides.collect();
            let outputs: Vec<Expr> = sides.into_iter().map(|(a, b)| pool.sub(a, b)).collect();
            let mut registers = self.registers.clone();
            let code = compile_outputs(&pool, &mut registers, &self.sequence, &outputs);
            Some(Differences { registers, code })
        });
        made.as_ref()
    }

    /// The program in which relations inside `noEvent` have events, with the same unknowns; `None`
    /// if there is none.
    fn with_events(&self) -> Option<&Arc<Program>> {
        let made = self.literal.program.get_or_init(|| {
            let literal = literal_relations(&self.sorted);
            if literal.is_empty() {
                return None;
            }
            let program = Program::compile(with_events(&self.sorted, &literal)).ok()?;
            let is_alike = program.unknowns == self.unknowns
                && program.n_auxiliary == self.n_auxiliary
                && program.observed == self.observed;
            is_alike.then_some(program)
        });
        made.as_ref()
    }
}

impl System {
    /// Writes left − right of every relation inside `noEvent`; y is loaded and solved.
    pub(super) fn literal_differences(&mut self, out: &mut Vec<f64>) -> Result<(), Failure> {
        out.clear();
        let program = self.program.clone();
        let Some(Differences { registers, code }) = program.differences() else { return Ok(()) };
        let made = || Box::new(Memory::new(registers));
        let memory = self.literal.memory.get_or_insert_with(made);
        let n = program.sorted.dae.variables.len();
        memory.registers[..n].copy_from_slice(&self.registers[..n]);
        run(&code.tape, memory)?;
        out.extend(code.outputs.iter().map(|at| memory.registers[*at as usize]));
        Ok(())
    }

    /// Goes on with a program in which relations inside `noEvent` have events; whether there is one.
    /// y is loaded and solved.
    pub(super) fn replace_program(&mut self, t: f64) -> Result<bool, Failure> {
        // The past of delays and derivatives along directions belong to the program at hand.
        if self.n_directions() > 0 || !self.histories.is_empty() {
            return Ok(false);
        }
        let Some(program) = self.program.clone().with_events().cloned() else { return Ok(false) };
        let mut next = self.in_program(program);
        next.start_relations(self.program.relations.len(), t)?;
        let plain = std::mem::replace(self, next);
        self.literal.plain = Some(Box::new(plain));
        Ok(true)
    }

    /// Takes events of relations inside `noEvent` back: every simulation begins without.
    pub(super) fn restore_program(&mut self) {
        let Some(plain) = self.literal.plain.take() else { return };
        let changed = std::mem::replace(self, *plain);
        self.take_settings(changed);
    }
}

impl System {
    /// This system in a program that has more relations, at the same point of the same simulation.
    fn in_program(&mut self, program: Arc<Program>) -> System {
        let mut next = System::new(program);
        if let Some(variables) = &self.observed_variables {
            next.observe_only(variables);
        }
        let n = self.program.sorted.dae.variables.len();
        next.registers[..n].copy_from_slice(&self.registers[..n]);
        next.registers.calls = self.registers.calls.clone();
        let m = self.program.relations.len();
        next.held[..m].copy_from_slice(&self.held);
        next.excused[..m].copy_from_slice(&self.excused);
        next.switches[..m].copy_from_slice(&self.switches[..m]);
        next.switches[m..].fill(None);
        next.choices = self.choices.clone();
        next.clocks = self.clocks.clone();
        next.before = self.before.clone();
        next.lagged = self.lagged.clone();
        next.sampled = self.sampled;
        next.solves_loops = self.solves_loops;
        next.set = self.set.clone();
        next.notices = self.notices.take();
        next.treated = std::mem::take(&mut self.treated);
        next
    }

    /// Everything that follows from parameters, and the relations that have events from now on: all
    /// but the first so many.
    fn start_relations(&mut self, known: usize, t: f64) -> Result<(), Failure> {
        let program = self.program.clone();
        run(&program.registers.hoisted.tape, &mut self.registers)?;
        run(&program.time_rests, &mut self.registers)?;
        for at in known..program.relations.len() {
            let holds = self.relation_value(at, false, t);
            let register = program.relations[at].register as usize;
            self.registers[register] = f64::from(u8::from(holds));
        }
        Ok(())
    }

    /// What was asked of a system since its simulation began.
    fn take_settings(&mut self, changed: System) {
        self.set = changed.set;
        self.notices = changed.notices;
    }
}
