//! Code for outputs, and only for what they need: slices of the sequence of assignments as tapes.

use super::code::{CompiledLoop, CompiledRun, Outputs, Step};
use super::hoist::Hoisting;
use super::jacobian::differentiate_sequence;
use super::machine_code::MachineCode;
use super::program::{Access, Program};
use super::registers::Registers;
use super::tape_builder::TapeBuilder;
use crate::arithmetic::Register;
use crate::causalize::{Assignment, Block, CausalizedDae};
use crate::lower::VariableKind;
use crate::sim::Pattern;
use crate::symbolic::{Expr, Pool, VarId, VariableCollection};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;

/// A set of variables with all that they are computed from.
pub(super) fn close(
    pool: &Pool,
    sequence: &[Assignment],
    mut needed: FxHashSet<VarId>,
) -> FxHashSet<VarId> {
    let mut collection = VariableCollection::new(pool);
    for assignment in sequence.iter().rev() {
        if needed.contains(&assignment.variable) {
            collection.add(assignment.value, |variable| {
                needed.insert(variable);
            });
        }
    }
    needed
}

/// The assignments that outputs need, in order.
pub(crate) fn slice(pool: &Pool, sequence: &[Assignment], outputs: &[Expr]) -> Vec<Assignment> {
    let mut needed = FxHashSet::default();
    let mut collection = VariableCollection::new(pool);
    for output in outputs {
        collection.add(*output, |variable| {
            needed.insert(variable);
        });
    }
    let needed = close(pool, sequence, needed);
    sequence.iter().filter(|a| needed.contains(&a.variable)).copied().collect()
}

/// Code that computes outputs, and only what they need.
pub(crate) fn compile_outputs(
    pool: &Pool,
    registers: &mut Registers,
    sequence: &[Assignment],
    outputs: &[Expr],
) -> Outputs {
    compile_continuous(pool, registers, sequence, outputs, Hoisting::Never)
}

/// The same for code that runs when the parameters have their values.
pub(crate) fn compile_continuous(
    pool: &Pool,
    registers: &mut Registers,
    sequence: &[Assignment],
    outputs: &[Expr],
    hoisting: Hoisting,
) -> Outputs {
    let needed = slice(pool, sequence, outputs);
    let mut builder = TapeBuilder::new(pool, registers).hoisting(hoisting);
    for assignment in &needed {
        builder.origin(assignment.equation as u32);
        builder.define(assignment.variable, assignment.value);
    }
    let registers = outputs.iter().map(|output| builder.emit(*output)).collect();
    Outputs { tape: builder.finish(), outputs: registers, ..Outputs::default() }
}

/// The steps of solving blocks one after another, without what nothing reads.
pub(super) fn compile_steps(
    pool: &mut Pool,
    registers: &mut Registers,
    blocks: &[Block],
    unread: &[VarId],
    next: &mut u32,
) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut run: Vec<Assignment> = Vec::new();
    for (number, block) in blocks.iter().enumerate() {
        let torn = match block {
            Block::Assignment(a) if unread.binary_search(&a.variable).is_ok() => continue,
            Block::Assignment(_) | Block::Linear(_) => {
                run.extend(block.assignments());
                continue;
            }
            Block::Loop(torn) => torn,
        };
        steps.extend(compile_run(pool, registers, &mut run));
        let residuals: Vec<Expr> = torn.residuals.iter().map(|(residual, _)| *residual).collect();
        let derivatives =
            differentiate_sequence(pool, &torn.assignments, &residuals, &torn.iteration, next);
        let zero = pool.constant(0.0);
        let one = pool.constant(1.0);
        let has_residuals = registers.fresh();
        let mut builder = TapeBuilder::new(pool, registers);
        builder.mark(has_residuals, zero);
        for Assignment { variable, value, equation } in &torn.assignments {
            builder.origin(*equation as u32);
            builder.store(*variable, *value);
        }
        let mut results = Vec::new();
        for (residual, equation) in &torn.residuals {
            builder.origin(*equation as u32);
            results.push(builder.emit(*residual));
        }
        builder.mark(has_residuals, one);
        let inner: FxHashSet<VarId> = torn.assignments.iter().map(|a| a.variable).collect();
        for Assignment { variable, value, equation } in &derivatives.sequence {
            if !inner.contains(variable) {
                builder.origin(*equation as u32);
                builder.define(*variable, *value);
            }
        }
        // Only what is not always zero: large loops have few entries in every row.
        let mut entries: Vec<BTreeMap<usize, Register>> = Vec::new();
        for (row, (_, equation)) in derivatives.rows.iter().zip(&torn.residuals) {
            builder.origin(*equation as u32);
            let emitted = row.iter().map(|(column, entry)| (*column, builder.emit(*entry)));
            entries.push(emitted.collect());
        }
        let (pattern, jacobian) = by_columns(&entries, torn.iteration.len());
        steps.push(Step::Solve(CompiledLoop {
            tape: builder.finish(),
            unknowns: torn.iteration.iter().map(|v| v.0).collect(),
            residuals: results,
            pattern,
            jacobian,
            has_residuals,
            block: number as u32,
            machine_code: MachineCode::default(),
        }));
    }
    steps.extend(compile_run(pool, registers, &mut run));
    steps
}

/// Entries of a Jacobian by columns.
pub(super) fn by_columns<Entry: Copy>(
    rows: &[BTreeMap<usize, Entry>],
    n: usize,
) -> (Pattern, Vec<Entry>) {
    let mut columns: Vec<Vec<(usize, Entry)>> = vec![Vec::new(); n];
    for (row, entries) in rows.iter().enumerate() {
        for (column, entry) in entries {
            columns[*column].push((row, *entry));
        }
    }
    let mut pattern = Pattern { n, column_starts: vec![0], rows: Vec::new() };
    let mut values = Vec::new();
    for column in columns {
        for (row, entry) in column {
            pattern.rows.push(row);
            values.push(entry);
        }
        pattern.column_starts.push(pattern.rows.len());
    }
    (pattern, values)
}

fn compile_run(pool: &Pool, registers: &mut Registers, run: &mut Vec<Assignment>) -> Option<Step> {
    if run.is_empty() {
        return None;
    }
    let mut builder = TapeBuilder::new(pool, registers);
    for assignment in run.drain(..) {
        builder.origin(assignment.equation as u32);
        builder.store(assignment.variable, assignment.value);
    }
    Some(Step::Run(CompiledRun { tape: builder.finish(), machine_code: MachineCode::default() }))
}

/// A variable's representative, with its sign.
pub(crate) fn resolved(pool: &mut Pool, sorted: &CausalizedDae, variable: VarId) -> Expr {
    match sorted.aliases[variable.0 as usize] {
        None => pool.variable(variable),
        Some(alias) => {
            let of = pool.variable(alias.of);
            if alias.negated { pool.neg(of) } else { of }
        }
    }
}

/// What variables (positions in [`Program::variables`]) are.
pub(crate) fn expressions(program: &Program, pool: &mut Pool, variables: &[usize]) -> Vec<Expr> {
    let of = |at: &usize| match program.variables()[*at].access {
        Access::Constant(value) => pool.constant(value),
        _ => resolved(pool, &program.sorted, program.variables()[*at].variable),
    };
    variables.iter().map(of).collect()
}

/// The derivatives of the states, in order.
pub(crate) fn right_sides(sorted: &CausalizedDae, pool: &mut Pool) -> Vec<Expr> {
    let mut derivatives: FxHashMap<VarId, VarId> = FxHashMap::default();
    for (v, variable) in (0..).map(VarId).zip(&sorted.dae.variables) {
        if let VariableKind::Derivative(of) = variable.kind {
            derivatives.entry(of).or_insert(v);
        }
    }
    let own = sorted.states.iter().filter_map(|state| derivatives.get(state));
    own.map(|derivative| resolved(pool, sorted, *derivative)).collect()
}

/// Code for what a system observes, with the registers that the system has then.
pub(crate) fn observing(program: &Program, pool: &Pool, outputs: &[Expr]) -> (Registers, Outputs) {
    let mut registers = program.registers.clone();
    let sequence = &program.sequence;
    let code = compile_continuous(pool, &mut registers, sequence, outputs, Hoisting::Known);
    (registers, code)
}
