//! Whether a program that was read from a file can be run: it may have been damaged.
//!
//! What it computes is not checked, but that every register, call and relation which something refers
//! to is there, that lists which belong together are equally long, that a tape comes to its end, and
//! that nothing takes much more memory than its bytes. Variables and expressions are checked where
//! they are read (`symbolic::stored`).

use super::code::{CompiledLoop, CompiledSelection, LogAssertion, Outputs, Step};
use super::events::{CompiledTransport, Events};
use super::instruction::{Call, Instruction, LinearSolve};
use super::program::{Access, Program};
use super::registers::Registers;
use super::tape::Tape;
use crate::arithmetic::Register;
use crate::bytecode::Functions;
use crate::lower::{Dae, Recording};
use crate::sim::Pattern;
use std::cell::Cell;

/// Registers that nothing refers to: code that turned out to be unneeded had them.
const MOST_UNUSED: u32 = 1024;

/// What a tape can refer to.
struct Limits<'a> {
    registers: Register,
    functions: &'a Functions,
    /// Sizes of the linear systems.
    systems: &'a [usize],
    /// One past the last register, and the size of the largest linear system, that have been found.
    last: Cell<Register>,
    largest: Cell<usize>,
}

impl Limits<'_> {
    /// Whether there are so many registers from one on.
    fn has(&self, first: Register, n: usize) -> bool {
        let end = u32::try_from(n).ok().and_then(|n| first.checked_add(n));
        self.last.set(self.last.get().max(end.unwrap_or(0)));
        end.is_some_and(|end| end <= self.registers)
    }

    fn has_all<'r>(&self, registers: impl IntoIterator<Item = &'r Register>) -> bool {
        registers.into_iter().all(|register| self.has(*register, 1))
    }

    fn has_function(&self, function: u32) -> bool {
        (function as usize) < self.functions.codes.len()
    }

    fn can_call(&self, call: &Call) -> bool {
        self.has_function(call.function)
            && self.has(call.d, self.functions.n_outputs(call.function))
            && self.has_all(&call.arguments)
    }

    fn can_solve(&self, solve: &LinearSolve) -> bool {
        let n = solve.right.len();
        self.largest.set(self.largest.get().max(n));
        self.systems.get(solve.system as usize) == Some(&n)
            && self.has(solve.d, n)
            && self.has_all(&solve.right)
            && solve
                .entries
                .iter()
                .flatten()
                .all(|(place, register)| (*place as usize) < n * n && self.has(*register, 1))
    }
}

impl Tape {
    fn is_valid(&self, limits: &Limits<'_>) -> bool {
        self.calls.iter().all(|call| limits.can_call(call))
            && self.solves.iter().all(|solve| limits.can_solve(solve))
            && self.code.iter().all(|instruction| self.can_run(instruction, limits))
            && self.comes_to_an_end()
            && self.keeps_links(limits.functions)
    }

    fn can_run(&self, instruction: &Instruction, limits: &Limits<'_>) -> bool {
        let mut has_operands = true;
        instruction.for_each_operand(|register| has_operands &= limits.has(register, 1));
        let fits = match *instruction {
            Instruction::Call { call } => (call as usize) < self.calls.len(),
            Instruction::Solve { solve } => (solve as usize) < self.solves.len(),
            Instruction::Given { function, .. } => limits.has_function(function),
            Instruction::Operation(operation) => operation.operator.is_valid(),
            Instruction::Perform { link, .. } | Instruction::Return { link } => limits.has(link, 1),
            _ => true,
        };
        has_operands && fits && limits.has_all(&instruction.result())
    }

    /// Whether jumps lead forward within the main part and within each routine, and routines perform
    /// those before them: see `Routines::append`.
    fn comes_to_an_end(&self) -> bool {
        let end = self.code.len();
        let Some((first, _)) = self.routines.first() else {
            return self.leads_forward(0, end, 0);
        };
        let Some(jump) = (*first as usize).checked_sub(1) else { return false };
        let jumps_over = |at: &Instruction| matches!(at, Instruction::Jump { target } if *target as usize == end);
        if !self.code.get(jump).is_some_and(jumps_over)
            || !self.leads_forward(0, jump, self.routines.len())
        {
            return false;
        }
        let starts = self.routines.iter().map(|(start, _)| *start as usize);
        let ends = starts.clone().skip(1).chain([end]);
        self.routines.iter().enumerate().zip(ends).all(|((number, (start, link)), end)| {
            let Some(last) = end.checked_sub(1) else { return false };
            let returns =
                matches!(self.code.get(last), Some(Instruction::Return { link: l }) if l == link);
            returns && self.leads_forward(*start as usize, last, number)
        })
    }

    /// Whether the instructions from one to before another lead to later ones, at most to that other,
    /// and perform only the first routines.
    fn leads_forward(&self, start: usize, end: usize, n_routines: usize) -> bool {
        let Some(code) = self.code.get(start..end) else { return false };
        (start..).zip(code).all(|(at, instruction)| match *instruction {
            Instruction::Jump { target } | Instruction::JumpUnless { target, .. } => {
                (at + 1..=end).contains(&(target as usize))
            }
            Instruction::Perform { target, link } => {
                self.routines[..n_routines].contains(&(target, link))
            }
            Instruction::Return { .. } => false,
            _ => true,
        })
    }

    /// Whether nothing but routines writes the registers of the ways back.
    fn keeps_links(&self, functions: &Functions) -> bool {
        let mut links: Vec<Register> = self.routines.iter().map(|(_, link)| *link).collect();
        links.sort_unstable();
        let is_free = |first: Register, n: usize| {
            let at = links.partition_point(|link| *link < first);
            links.get(at).is_none_or(|link| (*link - first) as usize >= n)
        };
        links.is_empty() || self.written(functions).all(|(d, results)| is_free(d, results))
    }
}

impl Outputs {
    fn is_valid(&self, limits: &Limits<'_>) -> bool {
        self.tape.is_valid(limits) && limits.has_all(&self.outputs)
    }

    /// The same, with so many outputs.
    fn has(&self, n: usize, limits: &Limits<'_>) -> bool {
        self.outputs.len() == n && self.is_valid(limits)
    }
}

/// Whether there are entries for a square pattern of so many rows.
fn fits(pattern: &Pattern, n: usize, entries: usize) -> bool {
    let Pattern { n: rows, column_starts, rows: places } = pattern;
    *rows == n
        && places.len() == entries
        && places.iter().all(|row| *row < n)
        && column_starts.len() == n + 1
        && column_starts.first() == Some(&0)
        && column_starts.last() == Some(&entries)
        && column_starts.is_sorted()
        && (0..n).all(|column| places[pattern.column(column)].is_sorted_by(|a, b| a < b))
}

impl Step {
    fn is_valid(&self, limits: &Limits<'_>) -> bool {
        match self {
            Step::Run(run) => run.tape.is_valid(limits),
            Step::Solve(solve) => solve.is_valid(limits),
        }
    }
}

impl CompiledLoop {
    fn is_valid(&self, limits: &Limits<'_>) -> bool {
        let n = self.unknowns.len();
        let registers = self.unknowns.iter().chain(&self.residuals).chain(&self.jacobian);
        self.residuals.len() == n
            && fits(&self.pattern, n, self.jacobian.len())
            && limits.has_all(registers.chain([&self.has_residuals]))
            && self.tape.is_valid(limits)
    }
}

impl CompiledSelection {
    fn is_valid(&self, limits: &Limits<'_>) -> bool {
        let (candidates, states) = (self.candidates.len(), self.states.len());
        let Some(constraints) = candidates.checked_sub(states) else { return false };
        let mut chosen = self.chosen.clone();
        chosen.sort_unstable();
        chosen.dedup();
        self.jacobian.has(self.places.len(), limits)
            && self.places.iter().all(|(row, column)| *row < constraints && *column < candidates)
            && self.weights.len() == states
            && self.weights.iter().all(|row| row.len() == candidates && limits.has_all(row))
            && limits.has_all(self.candidates.iter().chain(&self.states))
            && (self.chosen.len(), chosen.len()) == (states, states)
            && chosen.iter().all(|candidate| *candidate < candidates)
    }
}

impl LogAssertion {
    fn is_valid(&self, limits: &Limits<'_>) -> bool {
        self.condition.has(1, limits) && self.values.is_valid(limits)
    }
}

impl CompiledTransport {
    fn is_valid(&self, limits: &Limits<'_>) -> bool {
        let n = self.outputs.len();
        let has_start = match n {
            1 => self.start.outputs.len() == 1,
            2 => self.start.outputs.len() >= 2 && self.start.outputs.len().is_multiple_of(2),
            _ => false,
        };
        has_start
            && limits.has_all(&self.outputs)
            && self.read.has(n, limits)
            && self.inputs.has(n, limits)
            && self.start.is_valid(limits)
    }
}

impl Recording {
    fn is_valid(&self, limits: &Limits<'_>) -> bool {
        let variables = self.tracks.iter().flat_map(|track| [Some(track.value), track.rate]);
        let mut registers = variables.chain([self.since]).flatten().map(|variable| variable.0);
        !self.knots.is_empty()
            && self.knots.is_sorted()
            && self.tracks.iter().all(|track| track.samples.len() == self.knots.len())
            && self.tracks.iter().all(|track| track.rate.is_none() || self.since.is_some())
            && registers.all(|register| limits.has(register, 1))
    }
}

impl Events {
    fn is_valid(&self, limits: &Limits<'_>, dae: &Dae) -> bool {
        let of_model = &dae.events;
        let registers = self.previous.iter().map(|previous| &previous.register);
        let registers = registers.chain(self.roundings.iter().map(|rounding| &rounding.register));
        let registers = registers.chain(self.delays.iter().map(|delay| &delay.register));
        limits.has_all(registers)
            && self.steps.iter().all(|step| step.is_valid(limits))
            && self.roundings.iter().filter_map(|r| r.time).all(|(_, rest)| limits.has(rest, 1))
            && self.roundings.len() == of_model.roundings.len()
            && self.rounded.len() == self.roundings.len()
            && self.rounded.iter().all(|code| code.has(1, limits))
            && self.samples.len() == of_model.samples.len()
            && self.since_start.len() == self.samples.len()
            && self.clocks.has(2 * self.samples.len(), limits)
            && self.reinitialized.len() == of_model.reinits.len()
            && self.reinits.has(2 * self.reinitialized.len(), limits)
            && self.assertions.has(self.asserted.len(), limits)
            && self.asserted.iter().all(|(_, values)| values.is_valid(limits))
            && self.log_assertions.iter().all(|assertion| assertion.is_valid(limits))
            && self.terminations.has(of_model.terminations.len(), limits)
            && of_model.recordings.iter().all(|recording| recording.is_valid(limits))
            && self.delays.len() == of_model.delays.len()
            && self.delays.iter().all(|d| d.value.has(1, limits) && d.time.has(1, limits))
            && self.transports.len() == of_model.transports.len()
            && self.transports.iter().all(|transport| transport.is_valid(limits))
    }
}

impl Registers {
    fn are_valid(&self, limits: &Limits<'_>) -> bool {
        self.hoisted.tape.is_valid(limits)
            && self.hoisted.fixed.len() <= self.len()
            && limits.has_all(self.values.iter().map(|(register, _)| register))
            && limits.has_all(self.constants())
            && self.workspaces().all(|system| (*system as usize) < self.systems().len())
    }
}

impl Program {
    /// Whether all that it refers to is there.
    pub(super) fn is_valid(&self) -> bool {
        let dae = &self.sorted.dae;
        let sizes = |function: u32| {
            let code = dae.functions.codes.get(function as usize)?;
            // What is called to write has a place for an output that it does not have.
            let n_outputs = if code.writes { code.n_outputs.max(1) } else { code.n_outputs };
            Some((code.n_inputs, n_outputs))
        };
        if !dae.functions.are_valid() || !dae.pool.has_valid_calls(sizes) {
            return false;
        }
        let limits = Limits {
            registers: self.registers.len() as Register,
            functions: &dae.functions,
            systems: self.registers.systems(),
            last: Cell::new(dae.variables.len() as Register),
            largest: Cell::new(0),
        };
        self.registers.n_variables() == dae.variables.len()
            && self.registers.n_variables() <= self.registers.len()
            && self.sorted.aliases.len() == dae.variables.len()
            && self.has_valid_unknowns(&limits)
            && self.has_valid_relations(&limits)
            && self.has_valid_values(&limits)
            && self.events.is_valid(&limits, dae)
            && self.registers.are_valid(&limits)
            && limits.registers <= limits.last.get().saturating_mul(2).saturating_add(MOST_UNUSED)
            && limits.systems.iter().all(|n| *n <= limits.largest.get())
    }

    fn has_valid_unknowns(&self, limits: &Limits<'_>) -> bool {
        let n = self.continuous.unknowns.len();
        n == self.sorted.states.len() + self.continuous.iteration.len()
            && self.continuous.n_auxiliary <= self.continuous.iteration.len()
            && self.continuous.residuals.len() == self.continuous.iteration.len()
            && self.continuous.rhs.has(n, limits)
            && self.continuous.jacobian.is_valid(limits)
            && fits(&self.continuous.pattern, n, self.continuous.jacobian.outputs.len())
            && self.selections.iter().all(|selection| selection.is_valid(limits))
            && self.steps.iter().chain(&self.initial_steps).all(|step| step.is_valid(limits))
            && self.initial_checks.iter().all(|check| check.has(2, limits))
    }

    fn has_valid_relations(&self, limits: &Limits<'_>) -> bool {
        let n = self.switching.relations.len();
        let roundings = self.events.roundings.iter().filter(|r| r.time.is_none()).count();
        let rests = self.switching.relations.iter().filter_map(|relation| relation.time);
        let groups = self.switching.relations_of_blocks.iter().flatten();
        let groups = groups.chain(&self.switching.relations_of_loops);
        n == self.sorted.dae.relations.len()
            && (self.switching.relation_sides.len(), self.switching.memoryless.len()) == (n, n)
            && self.switching.relation_sides.iter().all(|sides| sides.has(2, limits))
            && limits.has_all(self.switching.relations.iter().map(|relation| &relation.register))
            && rests.into_iter().all(|(_, rest)| limits.has(rest, 1))
            && self.switching.time_rests.is_valid(limits)
            && self.switching.rescheduled_rests.iter().all(|tape| tape.is_valid(limits))
            && self.switching.crossing_relations.iter().chain(groups).all(|relation| *relation < n)
            && self
                .switching
                .crossings
                .has(2 * (self.switching.crossing_relations.len() + roundings), limits)
            && self.has_valid_parts(limits)
            && self.switching.oscillations.is_valid(limits)
    }

    fn has_valid_parts(&self, limits: &Limits<'_>) -> bool {
        let parts = &self.switching.crossing_parts;
        let firsts = parts.iter().skip(1).map(|part| part.first);
        let ends = firsts.chain([self.switching.crossing_relations.len()]);
        parts.first().is_none_or(|part| part.first == 0)
            && parts.iter().zip(ends).all(|(part, end)| part.end() == end)
            && parts.iter().all(|part| part.code.is_valid(limits))
    }

    fn has_valid_values(&self, limits: &Limits<'_>) -> bool {
        let is_found = |access: Access| match access {
            Access::Observed { column, .. } => column < self.observed.len(),
            Access::Time | Access::Constant(_) | Access::Parameter => true,
        };
        let instances = self.sorted.dae.instances.len();
        let equations = self.sorted.dae.equations.iter().chain(&self.sorted.dae.initial_equations);
        let equations = equations.chain(&self.sorted.dae.events.equations);
        self.observe.has(self.observed.len(), limits)
            && self.unread.values.has(self.unread.variables.len(), limits)
            && self.values.parameter_tapes.iter().all(|(_, tape)| tape.is_valid(limits))
            && self.values.starts.iter().all(|(_, tape)| tape.is_valid(limits))
            && self
                .values
                .nominals
                .iter()
                .all(|(_, tape, register)| tape.is_valid(limits) && limits.has(*register, 1))
            && self.assertions.each.iter().all(|assertion| assertion.is_valid(limits))
            && self.assertions.conditions.has(self.assertions.each.len(), limits)
            && self.log_assertions.iter().all(|assertion| assertion.is_valid(limits))
            && self.variables.iter().all(|variable| is_found(variable.access))
            && equations.filter_map(|e| e.instance).all(|of| (of.0 as usize) < instances)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::causalize::causalize;
    use crate::flatten::{Library, flatten};
    use crate::source::SourceId;
    use crate::symbolic::VarId;
    use crate::syntax::parse_stored_definition;
    use std::sync::Arc;

    const MODEL: &str = "model M function f input Real u; output Real v; algorithm v := 2*u; end f; \
        Real x(start = 1, fixed = true); Real y; Real z(start = 1); \
        equation der(x) = -x; y = if x > 0.5 then f(x) else 1; z^3 + z = y; \
        when sample(0, 0.1) then reinit(x, 1); end when; end M;";

    fn program() -> Program {
        let file = parse_stored_definition(SourceId::NONE, MODEL).expect("Modelica");
        let mut library = Library::new();
        let names = library.load(&file).expect("a loadable file");
        let flat = flatten(&library, &names[0], &[]).expect("a model").model;
        let program = Program::compile(causalize(&flat).expect("it can be sorted"));
        Arc::into_inner(program.expect("it compiles")).expect("nothing else has it")
    }

    #[test]
    fn a_program_that_is_whole_is_read_again() {
        let bytes = program().to_bytes().expect("it can be kept");
        assert!(Program::from_bytes(&bytes).is_some());
    }

    #[test]
    fn what_refers_to_nothing_is_not_read() {
        let damages: [fn(&mut Program); 14] = [
            |p| p.continuous.rhs.outputs[0] = u32::MAX,
            |p| p.continuous.rhs.outputs.clear(),
            |p| p.continuous.rhs.tape.code.push(Instruction::Jump { target: 0 }),
            |p| p.continuous.rhs.tape.code.push(Instruction::Return { link: 0 }),
            |p| p.continuous.rhs.tape.code.push(Instruction::Call { call: 1 << 20 }),
            |p| p.continuous.pattern.n += 1,
            |p| p.continuous.pattern.rows[0] = 1 << 40,
            |p| p.switching.memoryless.clear(),
            |p| p.switching.crossing_relations.push(1 << 20),
            |p| p.switching.relation_sides.clear(),
            |p| p.continuous.unknowns.push(VarId(1)),
            |p| p.variables[1].access = Access::Observed { column: 1 << 20, negated: false },
            |p| p.events.clocks.outputs.truncate(1),
            |p| p.events.reinitialized.push((VarId(1), false)),
        ];
        for (number, damage) in damages.iter().enumerate() {
            let mut program = program();
            damage(&mut program);
            assert!(!program.is_valid(), "{number}");
        }
    }

    #[test]
    fn no_register_takes_memory_that_the_bytes_do_not_pay_for() {
        let mut program = program();
        program.registers.row(1 << 30);
        assert!(!program.is_valid());
    }
}
