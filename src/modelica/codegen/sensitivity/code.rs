//! The code that computes sensitivities: compiled once for a program, the parameters and the
//! variables asked for, and shared by all systems.

use super::super::event_code::{linear_in_time, scheduled_in_time};
use super::super::hoist::Hoisting;
use super::super::jacobian::Forward;
use super::super::program::Program;
use super::super::registers::Registers;
use super::super::sequence::{compile_continuous, compile_outputs, resolved, slice};
use super::super::tape::Tape;
use super::super::tape_builder::TapeBuilder;
use super::blocks::{needed_blocks, through_blocks};
use super::directions::directions;
use super::right_sides::{Kept, RightSides};
use crate::arithmetic::Register;
use crate::causalize::{Assignment, Block};
use crate::codegen::code::Outputs;
use crate::codegen::sequence::{expressions, observing};
use crate::flatten::BaseType;
use crate::lower::{Reinit, VariableKind};
use crate::symbolic::{Expr, Pool, VarId};
use rustc_hash::FxHashSet;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Unknowns times parameters beyond which the code would take longer to make than it saves.
const LARGEST: usize = 2_000_000;
/// Code for the derivatives of a simulation by some parameters; a column for each of those that the
/// solution depends on.
#[derive(Debug)]
pub struct SensitivityCode {
    pub(crate) registers: Registers,
    /// Positions of the parameters with columns in [`Program::parameters`].
    pub(crate) parameters: Vec<usize>,
    /// The column of each parameter that the code was made for, where it has one.
    pub(crate) directions: Vec<Option<usize>>,
    /// Unknowns of the integrator.
    pub(crate) unknowns: Vec<Kept>,
    /// For every previous value that has derivatives, where these come from and go to.
    pub(crate) previous: Vec<Option<(Vec<Register>, Vec<Register>)>>,
    /// Registers that a simulation begins with zeros in.
    pub(crate) cleared: Vec<Register>,
    /// The derivatives of time at an event.
    pub(crate) time: Vec<Register>,
    /// Derivatives of parameters, and of the times at which relations on time switch.
    pub(crate) constants: Tape,
    /// For every relation, if it is one on time, the registers of the derivatives of its switch.
    pub(crate) switches: OfTimes,
    /// The same for roundings of time.
    pub(crate) roundings: OfTimes,
    /// Derivatives of the switches whose times change at events.
    pub(crate) rescheduled: Tape,
    /// Derivatives of the initial values, after the initial system.
    pub(crate) initial: Tape,
    /// Derivatives of all that an event sets, after its equations.
    pub(crate) event: Tape,
    /// For every `reinit` the derivatives of its value.
    pub(crate) reinits: Vec<Vec<Register>>,
    /// Derivatives of the algebraic unknowns, from those of the states.
    pub(crate) algebraic: Tape,
    /// Derivatives of both sides of the crossing relations and of the functions of roundings, by
    /// function; the last column is the one along the solution.
    pub(crate) crossings: Outputs,
    pub(crate) n_crossing_relations: usize,
    /// The derivatives of the states.
    pub(crate) speeds: Outputs,
    /// Right-hand sides of the sensitivity equations, column by column.
    pub(crate) rhs: RightSides,
    /// Observed variables, then their derivatives by all parameters, one after another.
    pub(crate) observe: Outputs,
}

impl SensitivityCode {
    /// Compiles it for parameters (positions in [`Program::parameters`]) and observed variables
    /// (positions in [`Program::variables`]).
    ///
    /// # Errors
    ///
    /// Why the model has no sensitivities, in words that follow on "because".
    pub fn compile(
        program: &Arc<Program>,
        parameters: &[usize],
        observed: &[usize],
    ) -> Result<Arc<SensitivityCode>, String> {
        let mut pool = program.sorted.dae.pool.clone();
        let directions = directions(program, &mut pool, parameters);
        refuse(program, parameters, directions.iter().flatten().count())?;
        let outputs = expressions(program, &mut pool, observed);
        // Those after the registers of a system that observes these variables.
        let mut registers = observing(program, &pool, &outputs).0;
        let parts = (parameters, directions);
        Compiler::new(program, pool, &mut registers, parts).compile(&outputs).map(Arc::new)
    }

    /// Number of parameters.
    pub fn n_parameters(&self) -> usize {
        self.directions.len()
    }

    /// Number of parameters that the solution depends on.
    pub fn n_directions(&self) -> usize {
        self.parameters.len()
    }
}

/// Why a model has no sensitivities.
fn refuse(program: &Program, parameters: &[usize], n_columns: usize) -> Result<(), String> {
    let dae = &program.sorted.dae;
    if !program.sorted.selections.is_empty() {
        return Err("the model chooses its states at run time".to_owned());
    }
    if !dae.events.delays.is_empty() {
        return Err("the model uses `delay`".to_owned());
    }
    if !dae.events.transports.is_empty() {
        return Err("the model uses a variable `delay` or `spatialDistribution`".to_owned());
    }
    if let Some(previous) = program.events.previous.iter().find(|previous| previous.computed) {
        let name = &dae.variable(previous.of).name;
        return Err(format!("the model uses `pre` of `{name}`, which is not discrete"));
    }
    let n_unknowns = program.continuous.unknowns.len();
    if n_unknowns * n_columns > LARGEST {
        let product = format!("{n_unknowns} unknowns times {n_columns} parameters");
        return Err(format!("{product} are more than {LARGEST}"));
    }
    for at in parameters {
        let info = &program.parameters()[*at];
        if info.base != BaseType::Real {
            return Err(format!("`{}` is not a Real", info.name));
        }
    }
    let real = |v: &&VarId| dae.variable(**v).base == BaseType::Real;
    match program.events.iterated.iter().find(real) {
        Some(v) => Err(format!("`{}` depends on itself at events", dae.variable(*v).name)),
        None => Ok(()),
    }
}

/// What derivatives start from.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Seed {
    Parameters,
    /// Variables that keep their values.
    Kept,
    States,
    /// Algebraic unknowns of the integrator.
    Algebraic,
    /// Time, at an event.
    Time,
}

/// Derivatives of variables by column.
type Seeds = Vec<(VarId, BTreeMap<usize, Expr>)>;

/// For every relation or rounding that is one on time, registers by column.
type OfTimes = Vec<Option<Vec<Register>>>;

/// What the parts of the code are made from.
struct Compiler<'a> {
    program: &'a Program,
    pool: Pool,
    registers: &'a mut Registers,
    /// Positions of those with columns.
    parameters: Vec<usize>,
    /// The column of each parameter, where it has one.
    directions: Vec<Option<usize>>,
    /// Positions of those without, whose columns come after the others in what is observed.
    others: Vec<usize>,
    /// Derivatives of parameters by column.
    of_parameters: Vec<(VarId, BTreeMap<usize, Expr>)>,
    unknowns: Vec<Kept>,
    /// Discrete variables, parameters that the initial system determines, previous values.
    kept: Vec<Kept>,
    time: Kept,
    next: u32,
}

impl<'a> Compiler<'a> {
    fn new(
        program: &'a Program,
        pool: Pool,
        registers: &'a mut Registers,
        (all, directions): (&[usize], Vec<Option<usize>>),
    ) -> Compiler<'a> {
        let dae = &program.sorted.dae;
        let of = |is_carried: bool| {
            let own = all.iter().zip(&directions).filter(|own| own.1.is_some() == is_carried);
            own.map(|(at, _)| *at).collect::<Vec<usize>>()
        };
        let (parameters, others) = (of(true), of(false));
        let mut keep = |variable: VarId| Kept {
            variable,
            registers: parameters.iter().map(|_| registers.fresh()).collect(),
        };
        let unknowns = program.continuous.unknowns.iter().map(|v| keep(*v)).collect();
        let is_kept = |v: &VarId| {
            let variable = dae.variable(*v);
            let kind = matches!(
                variable.kind,
                VariableKind::Solved | VariableKind::Discrete | VariableKind::Previous(_)
            );
            kind && variable.base == BaseType::Real
                && program.sorted.aliases[v.0 as usize].is_none()
        };
        let all = (0..dae.variables.len() as u32).map(VarId);
        let kept = all.filter(is_kept).map(&mut keep).collect();
        let time = keep(VarId(0));
        // New variables are numbered after all existing registers.
        let next = registers.len() as u32;
        let of_parameters = Vec::new();
        Compiler {
            program,
            pool,
            registers,
            parameters,
            directions,
            others,
            of_parameters,
            unknowns,
            kept,
            time,
            next,
        }
    }

    fn compile(mut self, observed: &[Expr]) -> Result<SensitivityCode, String> {
        let (constants, mut switches, roundings) = self.constants();
        let rescheduled = self.rescheduled(&mut switches);
        self.check_samples()?;
        let sorted = &self.program.sorted;
        let initial = self.stored(&sorted.initial_blocks, &[Seed::Parameters], &[]).0;
        let blocks = match sorted.event_blocks.is_empty() {
            true => &sorted.blocks,
            false => &sorted.event_blocks,
        };
        let seeds = [Seed::Parameters, Seed::Kept, Seed::States, Seed::Time];
        let (event, reinits) = self.stored(blocks, &seeds, &sorted.dae.events.reinits);
        let seeds = [Seed::Parameters, Seed::Kept, Seed::States];
        let algebraic = self.stored(&sorted.blocks, &seeds, &[]).0;
        let speeds = self.speeds();
        let crossings = self.crossings();
        let rhs = self.rhs();
        let observe = self.observe(observed);
        Ok(SensitivityCode {
            registers: self.registers.clone(),
            previous: self.previous(),
            cleared: self.cleared(),
            time: self.time.registers,
            constants,
            switches,
            roundings,
            rescheduled,
            initial,
            event,
            reinits,
            algebraic,
            crossings,
            n_crossing_relations: self.program.switching.crossing_relations.len(),
            speeds,
            rhs,
            observe,
            unknowns: self.unknowns,
            parameters: self.parameters,
            directions: self.directions,
        })
    }

    /// Where derivatives start from.
    fn seeds(&mut self, kinds: &[Seed]) -> Seeds {
        let n = self.program.sorted.states.len();
        let mut seeds = Seeds::new();
        for kind in kinds {
            let kept = match kind {
                Seed::Parameters => {
                    seeds.extend(self.of_parameters.iter().cloned());
                    continue;
                }
                Seed::Kept => &self.kept[..],
                Seed::States => &self.unknowns[..n],
                Seed::Algebraic => &self.unknowns[n..],
                Seed::Time => std::slice::from_ref(&self.time),
            };
            for kept in kept {
                let pool = &mut self.pool;
                let registers = kept.registers.iter().enumerate();
                let row = registers.map(|(k, r)| (k, pool.variable(VarId(*r)))).collect();
                seeds.push((kept.variable, row));
            }
        }
        seeds
    }

    /// Derivatives of parameters from their bindings, and of the times at which relations on time
    /// switch and roundings of time jump.
    fn constants(&mut self) -> (Tape, OfTimes, OfTimes) {
        let sorted = &self.program.sorted;
        let mut made = Vec::new();
        let dependent = self.dependent_parameters(&mut made);
        let relations = sorted.dae.relations.iter().map(|r| (r.left, Some(r.right)));
        let roundings = sorted.dae.events.roundings.iter().map(|r| (r.argument, None));
        let compared: Vec<(Expr, Option<Expr>)> = relations.chain(roundings).collect();
        let mut times = Vec::new();
        for (left, right) in compared {
            let e = right.map_or(left, |right| self.pool.sub(left, right));
            times.push(linear_in_time(&mut self.pool, sorted, e));
        }
        let known: Seeds = self.of_parameters.iter().chain(&dependent).cloned().collect();
        let mut forward = seeded(&mut self.pool, &mut self.next, known);
        let mut rows = Vec::new();
        for time in times {
            rows.push(time.map(|(factor, rest)| {
                let mut row = forward.row(rest);
                let factor = forward.pool.constant(-factor);
                row.values_mut().for_each(|value| *value = forward.pool.div(*value, factor));
                row
            }));
        }
        let mut stores = Vec::new();
        for (variable, row) in dependent {
            let mut held = BTreeMap::new();
            for (column, value) in row {
                let register = self.registers.fresh();
                stores.push((register, value));
                held.insert(column, self.pool.variable(VarId(register)));
            }
            self.of_parameters.push((variable, held));
        }
        let (mut of_times, columns) = (OfTimes::new(), self.parameters.len());
        for row in rows {
            of_times.push(row.map(|row| self.registers_for(&row, columns, &mut stores)));
        }
        // Registers made since must not be taken for new variables.
        self.next = self.next.max(self.registers.len() as u32);
        let tape = self.tape(&made, &stores);
        let roundings = of_times.split_off(sorted.dae.relations.len());
        (tape, of_times, roundings)
    }

    /// Derivatives of the times of relations that events schedule, from those of what these set.
    fn rescheduled(&mut self, switches: &mut OfTimes) -> Tape {
        let sorted = &self.program.sorted;
        let mut times = Vec::new();
        for (at, relation) in sorted.dae.relations.iter().enumerate() {
            if switches[at].is_none() {
                let difference = self.pool.sub(relation.left, relation.right);
                let time = scheduled_in_time(&mut self.pool, sorted, difference);
                times.extend(time.map(|time| (at, time)));
            }
        }
        let seeds = self.seeds(&[Seed::Parameters, Seed::Kept]);
        let mut forward = seeded(&mut self.pool, &mut self.next, seeds);
        let mut rows = Vec::new();
        for (at, (factor, rest)) in times {
            let mut row = forward.row(rest);
            let factor = forward.pool.constant(-factor);
            row.values_mut().for_each(|value| *value = forward.pool.div(*value, factor));
            rows.push((at, row));
        }
        let (mut stores, columns) = (Vec::new(), self.parameters.len());
        for (at, row) in rows {
            switches[at] = Some(self.registers_for(&row, columns, &mut stores));
        }
        self.next = self.next.max(self.registers.len() as u32);
        self.tape(&[], &stores)
    }

    /// New registers for derivatives, zeros included.
    fn registers_for(
        &mut self,
        row: &BTreeMap<usize, Expr>,
        columns: usize,
        stores: &mut Vec<(Register, Expr)>,
    ) -> Vec<Register> {
        let zero = self.pool.constant(0.0);
        let mut registers = Vec::with_capacity(columns);
        for column in 0..columns {
            let register = self.registers.fresh();
            stores.push((register, row.get(&column).copied().unwrap_or(zero)));
            registers.push(register);
        }
        registers
    }

    /// The parameters that are varied get derivatives of one; those computed from them are returned
    /// with theirs.
    fn dependent_parameters(&mut self, made: &mut Vec<Assignment>) -> Seeds {
        let one = self.pool.constant(1.0);
        for (column, at) in self.parameters.iter().chain(&self.others).enumerate() {
            let variable = self.program.parameters()[*at].variable;
            self.of_parameters.push((variable, BTreeMap::from([(column, one)])));
        }
        let varied = self.of_parameters.clone();
        let mut forward = seeded(&mut self.pool, &mut self.next, varied.clone());
        let mut dependent = Seeds::new();
        for parameter in &self.program.sorted.parameters {
            let binding = self.program.sorted.dae.variable(*parameter).binding;
            let is_varied = varied.iter().any(|(v, _)| v == parameter);
            let Some(value) = binding.filter(|_| !is_varied) else { continue };
            forward.assign(&Assignment { variable: *parameter, value, equation: 0 }, made);
            let itself = forward.pool.variable(*parameter);
            let row = forward.row(itself);
            if !row.is_empty() {
                dependent.push((*parameter, row));
            }
        }
        dependent
    }

    /// Code that computes values and then writes them to registers.
    fn tape(&mut self, made: &[Assignment], stores: &[(Register, Expr)]) -> Tape {
        let values: Vec<Expr> = stores.iter().map(|(_, value)| *value).collect();
        let needed = slice(&self.pool, made, &values);
        let mut builder = TapeBuilder::new(&self.pool, self.registers);
        for assignment in &needed {
            builder.origin(assignment.equation as u32);
            builder.define(assignment.variable, assignment.value);
        }
        let values: Vec<Register> = values.iter().map(|value| builder.emit(*value)).collect();
        for ((register, _), value) in stores.iter().zip(values) {
            builder.copy(*register, value);
        }
        builder.finish()
    }

    fn check_samples(&mut self) -> Result<(), String> {
        let seeds = self.seeds(&[Seed::Parameters]);
        let mut forward = seeded(&mut self.pool, &mut self.next, seeds);
        for sample in &self.program.sorted.dae.events.samples {
            if !forward.row(sample.start).is_empty() || !forward.row(sample.interval).is_empty() {
                return Err("the times of a `sample` depend on the parameters".to_owned());
            }
        }
        Ok(())
    }

    /// Derivatives of what blocks solve for, written to the registers that keep them: of unknowns
    /// and of discrete variables; and for every `reinit` those of its value, if these are
    /// requested.
    fn stored(
        &mut self,
        blocks: &[Block],
        seeds: &[Seed],
        reinits: &[Reinit],
    ) -> (Tape, Vec<Vec<Register>>) {
        let mut assigned = FxHashSet::default();
        for block in blocks {
            assigned.extend(block.assignments().iter().map(|a| a.variable));
            if let Block::Loop(torn) = block {
                assigned.extend(torn.iteration.iter().copied());
            }
        }
        let seeds = self.seeds(seeds);
        let kept = self.unknowns.iter().chain(&self.kept);
        let set: Vec<&Kept> = kept.filter(|kept| assigned.contains(&kept.variable)).collect();
        let values = reinits.iter().map(|reinit| reinit.value);
        let needed: Vec<Expr> =
            set.iter().map(|kept| self.pool.variable(kept.variable)).chain(values).collect();
        let needed = needed_blocks(&self.pool, blocks, &needed);
        let mut forward = seeded(&mut self.pool, &mut self.next, seeds);
        let mut made = Vec::new();
        through_blocks(&mut forward, needed, &mut made);
        let zero = forward.pool.constant(0.0);
        let mut stores = Vec::new();
        for kept in set {
            for (column, register) in kept.registers.iter().enumerate() {
                let value = forward.of(kept.variable, column).unwrap_or(zero);
                stores.push((*register, value));
            }
        }
        let rows: Vec<_> = reinits.iter().map(|reinit| forward.row(reinit.value)).collect();
        let columns = self.parameters.len();
        let registers = rows.iter().map(|row| self.registers_for(row, columns, &mut stores));
        let registers = registers.collect();
        self.next = self.next.max(self.registers.len() as u32);
        (self.tape(&made, &stores), registers)
    }

    /// The derivatives of the states, from registers.
    fn state_derivatives(&mut self) -> Vec<Expr> {
        let sorted = &self.program.sorted;
        let of = |state: VarId| {
            let mut all = (0u32..).map(VarId).zip(&sorted.dae.variables);
            all.find(|(_, variable)| variable.kind == VariableKind::Derivative(state))
                .map(|(v, _)| v)
        };
        let derivatives: Vec<VarId> = sorted.states.iter().filter_map(|s| of(*s)).collect();
        derivatives.into_iter().map(|v| resolved(&mut self.pool, sorted, v)).collect()
    }

    fn speeds(&mut self) -> Outputs {
        let outputs = self.state_derivatives();
        compile_outputs(&self.pool, self.registers, &[], &outputs)
    }

    /// The column after those of the parameters is the derivative along the solution.
    fn crossings(&mut self) -> Outputs {
        let sorted = &self.program.sorted;
        let mut compared = Vec::new();
        for at in &self.program.switching.crossing_relations {
            let relation = &sorted.dae.relations[*at];
            compared.push(self.pool.sub(relation.left, relation.right));
        }
        for rounding in &sorted.dae.events.roundings {
            if linear_in_time(&mut self.pool, sorted, rounding.argument).is_none() {
                compared.push(rounding.argument);
            }
        }
        let (m, one) = (self.parameters.len(), self.pool.constant(1.0));
        let derivatives = self.state_derivatives();
        let mut seeds = self.seeds(&[Seed::Parameters, Seed::Kept, Seed::States]);
        for (variable, row) in &mut seeds {
            if let Some(state) = sorted.states.iter().position(|state| state == variable) {
                row.insert(m, derivatives[state]);
            }
        }
        seeds.push((VarId(0), BTreeMap::from([(m, one)])));
        let needed = needed_blocks(&self.pool, &sorted.blocks, &compared);
        let mut forward = seeded(&mut self.pool, &mut self.next, seeds);
        let mut made = Vec::new();
        through_blocks(&mut forward, needed, &mut made);
        let zero = forward.pool.constant(0.0);
        let mut outputs = Vec::new();
        for e in compared {
            let row = forward.row(e);
            outputs.extend((0..=m).map(|column| row.get(&column).copied().unwrap_or(zero)));
        }
        compile_outputs(&self.pool, self.registers, &made, &outputs)
    }

    /// The derivatives of the right-hand side for parameters and kept variables.
    fn rhs(&mut self) -> RightSides {
        let continuous = &self.program.continuous;
        let mut outputs = self.state_derivatives();
        outputs.extend(&continuous.residuals);
        let needed = slice(&self.pool, &continuous.integrated, &outputs);
        let (one, m) = (self.pool.constant(1.0), self.parameters.len());
        let mut seeds = self.seeds(&[Seed::Parameters]);
        for (at, kept) in self.kept.iter().enumerate() {
            seeds.push((kept.variable, BTreeMap::from([(m + at, one)])));
        }
        let (made, rows) = self.differentiated(&needed, &outputs, seeds);
        let (mut direct, mut kept) = (Vec::new(), Vec::new());
        let (mut entries, mut of_kept) = (Vec::new(), Vec::new());
        for (row, of_row) in (0u32..).zip(&rows) {
            for (column, entry) in of_row {
                match column.checked_sub(m) {
                    None => {
                        direct.push((row, *column as u32));
                        entries.push(*entry);
                    }
                    Some(at) => {
                        kept.push((row, self.kept[at].registers[0]));
                        of_kept.push(*entry);
                    }
                }
            }
        }
        entries.extend(of_kept);
        let code = compile_continuous(&self.pool, self.registers, &made, &entries, Hoisting::Known);
        RightSides { code, direct, kept, n_rows: rows.len(), n_columns: m }
    }

    fn observe(&mut self, observed: &[Expr]) -> Outputs {
        let needed = slice(&self.pool, &self.program.sequence, observed);
        let seeds = [Seed::Parameters, Seed::Kept, Seed::States, Seed::Algebraic];
        let seeds = self.seeds(&seeds);
        let (made, rows) = self.differentiated(&needed, observed, seeds);
        let zero = self.pool.constant(0.0);
        let mut all = observed.to_vec();
        for column in self.columns() {
            all.extend(rows.iter().map(|row| row.get(&column).copied().unwrap_or(zero)));
        }
        compile_continuous(&self.pool, self.registers, &made, &all, Hoisting::Known)
    }

    /// The columns of all parameters in the order in which these were given.
    fn columns(&self) -> Vec<usize> {
        let mut others = self.parameters.len()..;
        self.directions.iter().filter_map(|own| own.or_else(|| others.next())).collect()
    }

    /// The assignments of a sequence with those of their derivatives, and the derivatives of outputs
    /// by column.
    fn differentiated(
        &mut self,
        sequence: &[Assignment],
        outputs: &[Expr],
        seeds: Seeds,
    ) -> (Vec<Assignment>, Vec<BTreeMap<usize, Expr>>) {
        let mut forward = seeded(&mut self.pool, &mut self.next, seeds);
        let mut made = Vec::new();
        for assignment in sequence {
            made.push(*assignment);
            forward.assign(assignment, &mut made);
        }
        let rows = outputs.iter().map(|output| forward.row(*output)).collect();
        (made, rows)
    }

    fn cleared(&self) -> Vec<Register> {
        let kept = self.unknowns.iter().chain(&self.kept).chain([&self.time]);
        kept.flat_map(|kept| kept.registers.iter().copied()).collect()
    }

    /// Where the derivatives of previous values come from and go to, in the order of the program.
    fn previous(&self) -> Vec<Option<(Vec<Register>, Vec<Register>)>> {
        let registers = |v: VarId| {
            let mut all = self.unknowns.iter().chain(&self.kept);
            all.find(|kept| kept.variable == v).map(|kept| kept.registers.clone())
        };
        let list = &self.program.events.previous;
        list.iter().map(|p| registers(p.of).zip(registers(VarId(p.register)))).collect()
    }
}

/// Forward accumulation from derivatives that are known.
fn seeded<'a>(pool: &'a mut Pool, next: &'a mut u32, seeds: Seeds) -> Forward<'a> {
    let mut forward = Forward::new(pool, next);
    seeds.into_iter().for_each(|(variable, row)| forward.seed(variable, row));
    forward
}
