//! `Program::compile`: a causalized system becomes the tapes of a [`Program`], part by part.
//!
//! The order of the parts decides the numbers of registers and auxiliary variables, and with them
//! the bits of results where sums are formed: it is part of the contract of equal bytes.

use super::code::{Assertions, CompiledRelation, CompiledSelection, LogAssertion, Outputs, Step};
use super::crossing_parts::crossing_parts;
use super::event_code::{compile_events, linear_in_time, scheduled_in_time};
use super::events::CompiledRounding;
use super::hoist::Hoisting;
use super::iteration_variables::IterationVariables;
use super::jacobian::differentiate_sequence;
use super::linearity::linearity;
use super::memory::Memory;
use super::oscillations::oscillations;
use super::program::{
    Access, Continuous, Literal, ParameterInfo, Program, Switching, Unread, Values, VariableInfo,
    number_of_equations,
};
use super::registers::Registers;
use super::relation_groups::{memoryless, relations_of_blocks, relations_of_loops};
use super::sequence::{
    by_columns, compile_continuous, compile_outputs, compile_steps, right_sides, slice,
};
use super::tape::Tape;
use super::tape_builder::TapeBuilder;
use super::unread::unread;
use crate::arithmetic::Register;
use crate::bytecode::Functions;
use crate::causalize::{Assignment, Block, CausalizedDae};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::BaseType;
use crate::lower::errors::PARAMETER_WITHOUT_VALUE;
use crate::lower::{Dae, Level, Variable, VariableKind};
use crate::symbolic::{Expr, Node, Pool, VarId};
use rustc_hash::FxHashMap;
use std::sync::Arc;

impl Program {
    /// Compiles a causalized system.
    ///
    /// # Errors
    /// None so far; callers treat compilation as a stage that may refuse.
    pub fn compile(causalized: CausalizedDae) -> Result<Arc<Program>, Diagnostic> {
        let mut compilation = Compilation::new(causalized);
        let blocks = compilation.blocks();
        let continuous = compilation.continuous();
        let (switching, roundings) = compilation.relations();
        let selections = compilation.selections();
        let observe = compilation.observation();
        let assertions = Assertions {
            conditions: compilation.conditions_of_assertions(),
            each: compilation.assertions(true),
        };
        let log_assertions = compilation.assertions(false);
        let initial_checks = compilation.initial_checks();
        let mut events = compilation.events();
        (events.steps, events.roundings) = (blocks.at_events, roundings);
        let values = compilation.values();
        let unread = compilation.unread(blocks.unread);
        let Compilation { causalized, pool, registers, sequence, observed, .. } = compilation;
        let mut program = Program {
            variables: variables(&causalized, &observed),
            parameters: parameters(&causalized),
            reads_rates: reads_rates(&pool, &causalized),
            sorted: CausalizedDae { dae: Dae { pool, ..causalized.dae }, ..causalized },
            registers,
            sequence,
            observed,
            unread,
            initial_steps: blocks.initial,
            initial_checks,
            steps: blocks.between_events,
            selections,
            observe,
            assertions,
            log_assertions,
            events,
            continuous,
            switching,
            values,
            literal: Literal::default(),
        };
        program.fill_defaults();
        Ok(Arc::new(program))
    }

    /// Default values and bounds, computed with the default parameters.
    fn fill_defaults(&mut self) {
        let (values, warnings) = default_values(self);
        self.sorted.dae.warnings.extend(warnings);
        let dae = &self.sorted.dae;
        let number = |e: Option<Expr>, otherwise: f64| match e {
            None => otherwise,
            Some(e) => crate::symbolic::evaluate(&dae.pool, e, &values[..]),
        };
        for parameter in &mut self.parameters {
            let variable = dae.variable(parameter.variable);
            parameter.default = values[parameter.variable.0 as usize];
            parameter.min = number(variable.min, f64::NEG_INFINITY);
            parameter.max = number(variable.max, f64::INFINITY);
        }
    }
}

/// A system on its way to a program.
struct Compilation {
    causalized: CausalizedDae,
    pool: Pool,
    registers: Registers,
    /// Everything in solving order, iteration variables of loops given.
    sequence: Vec<Assignment>,
    observed: Vec<VarId>,
    /// The next free number of an auxiliary variable.
    next: u32,
}

/// The blocks as steps of solving.
struct Blocks {
    between_events: Vec<Step>,
    initial: Vec<Step>,
    at_events: Vec<Step>,
    unread: Vec<VarId>,
}

impl Compilation {
    fn new(mut causalized: CausalizedDae) -> Compilation {
        let n = causalized.dae.variables.len() as u32;
        let sequence: Vec<Assignment> =
            causalized.blocks.iter().flat_map(|block| block.assignments()).copied().collect();
        let mut registers = Registers::new(n as usize, causalized.dae.functions.clone());
        for (variable, info) in (0u32..).zip(&causalized.dae.variables) {
            if matches!(info.kind, VariableKind::Parameter { .. } | VariableKind::Constant(_)) {
                registers.hoisted.fix(variable);
            }
        }
        let is_observed = |v: &VarId| {
            causalized.dae.is_solved_for(*v) && causalized.aliases[v.0 as usize].is_none()
        };
        let observed = (0..n).map(VarId).filter(is_observed).collect();
        let pool = std::mem::take(&mut causalized.dae.pool);
        Compilation { causalized, pool, registers, sequence, observed, next: n }
    }

    fn blocks(&mut self) -> Blocks {
        let Compilation { causalized, pool, registers, next, .. } = self;
        let unread = unread(pool, causalized);
        let mut steps = |blocks: &[Block]| compile_steps(pool, registers, blocks, &unread, next);
        let between_events = steps(&causalized.blocks);
        let initial = steps(&causalized.initial_blocks);
        let mut at_events = steps(&causalized.event_blocks);
        for step in &mut at_events {
            if let Step::Solve(newton) = step {
                newton.block += causalized.blocks.len() as u32;
            }
        }
        Blocks { between_events, initial, at_events, unread }
    }

    fn continuous(&mut self) -> Continuous {
        let Compilation { causalized, pool, registers, next, .. } = self;
        let mut outputs = right_sides(causalized, pool);
        let chosen = IterationVariables::choose(pool, causalized, &outputs);
        let IterationVariables { iteration, n_auxiliary, residuals, sequence } = chosen;
        outputs.extend(&residuals);
        let rhs = compile_continuous(pool, registers, &sequence, &outputs, Hoisting::Certain);

        let unknowns: Vec<VarId> = causalized.states.iter().chain(&iteration).copied().collect();
        let needed = slice(pool, &sequence, &outputs);
        let linearity = match iteration.is_empty() {
            true => linearity(pool, causalized, &needed, &outputs),
            false => None,
        };
        let derivatives = differentiate_sequence(pool, &needed, &outputs, &unknowns, next);
        let mut rows = derivatives.rows;
        let zero = pool.constant(0.0);
        // An implicit method subtracts from the diagonal of the states: it belongs to the pattern.
        for (state, row) in rows.iter_mut().take(causalized.states.len()).enumerate() {
            row.entry(state).or_insert(zero);
        }
        let (pattern, entries) = by_columns(&rows, unknowns.len());
        let extended = derivatives.sequence;
        let jacobian = compile_continuous(pool, registers, &extended, &entries, Hoisting::Total);
        Continuous {
            integrated: sequence,
            residuals,
            unknowns,
            iteration,
            n_auxiliary,
            rhs,
            jacobian,
            pattern,
            linearity,
        }
    }

    fn relations(&mut self) -> (Switching, Vec<CompiledRounding>) {
        let Compilation { causalized, pool, registers, sequence, .. } = self;
        let mut relations = Vec::new();
        let mut relation_sides = Vec::new();
        let mut crossing_relations = Vec::new();
        let mut differences = Vec::new();
        let mut rests = Vec::new();
        let mut rescheduled = Vec::new();
        for relation in &causalized.dae.relations {
            let difference = pool.sub(relation.left, relation.right);
            let known = linear_in_time(pool, causalized, difference);
            let kept = match known {
                None => scheduled_in_time(pool, causalized, difference),
                Some(_) => None,
            };
            rescheduled.extend(kept.map(|(_, rest)| (relations.len(), rest)));
            let time = known.or(kept);
            match time {
                None => {
                    crossing_relations.push(relations.len());
                    differences.extend([relation.left, relation.right]);
                }
                Some((_, rest)) if kept.is_none() => rests.push((relations.len(), rest)),
                Some(_) => {}
            }
            relations.push(CompiledRelation {
                register: relation.variable.0,
                operator: relation.operator,
                time: time.map(|(factor, _)| (factor, 0)),
                is_rescheduled: kept.is_some(),
            });
            let both = [relation.left, relation.right];
            relation_sides.push(compile_outputs(pool, registers, &[], &both));
        }
        let mut roundings = Vec::new();
        for rounding in &causalized.dae.events.roundings {
            let time = linear_in_time(pool, causalized, rounding.argument);
            match time {
                None => {
                    let value = pool.variable(rounding.variable);
                    let above = pool.sub(rounding.argument, value);
                    let one = pool.constant(1.0);
                    differences.extend([above, pool.sub(above, one)]);
                }
                Some((_, rest)) => rests.push((relations.len() + roundings.len(), rest)),
            }
            let time = time.map(|(factor, _)| (factor, 0));
            roundings.push(CompiledRounding { register: rounding.variable.0, time });
        }
        let rest_expressions: Vec<Expr> = rests.iter().map(|(_, rest)| *rest).collect();
        let time_rests = compile_outputs(pool, registers, &[], &rest_expressions);
        for ((at, _), register) in rests.iter().zip(&time_rests.outputs) {
            let time = match at.checked_sub(relations.len()) {
                None => &mut relations[*at].time,
                Some(at) => &mut roundings[at].time,
            };
            if let Some(time) = time {
                time.1 = *register;
            }
        }
        let expressions: Vec<Expr> = rescheduled.iter().map(|(_, rest)| *rest).collect();
        let later = compile_outputs(pool, registers, &[], &expressions);
        for ((at, _), register) in rescheduled.iter().zip(&later.outputs) {
            if let Some(time) = &mut relations[*at].time {
                time.1 = *register;
            }
        }
        let rescheduled_rests = (!rescheduled.is_empty()).then_some(later.tape);
        let needed = slice(pool, sequence, &differences);
        let crossings_vary_in_time = depend_on_time(pool, &needed, &differences);
        let crossings =
            compile_continuous(pool, registers, sequence, &differences, Hoisting::Total);
        let sides = &differences[..2 * crossing_relations.len()];
        let crossing_parts = crossing_parts(pool, registers, sequence, sides);
        let rates = oscillations(pool, causalized, &differences);
        let oscillations = compile_outputs(pool, registers, &[], &rates);
        let time_rests = time_rests.tape;
        let switching = Switching {
            relations_of_blocks: relations_of_blocks(pool, causalized),
            relations_of_loops: relations_of_loops(pool, causalized),
            memoryless: memoryless(pool, causalized, &relations),
            relations,
            relation_sides,
            time_rests,
            rescheduled_rests,
            crossing_relations,
            crossings_vary_in_time,
            crossings,
            crossing_parts,
            oscillations,
        };
        (switching, roundings)
    }

    fn selections(&mut self) -> Vec<CompiledSelection> {
        let Compilation { causalized, pool, registers, sequence, .. } = self;
        let registers_of = |variables: &[VarId]| variables.iter().map(|v| v.0).collect::<Vec<_>>();
        let selections = causalized.selections.iter().map(|selection| {
            let rows = selection.jacobian.iter().enumerate();
            let entries = rows.flat_map(|(row, of_row)| {
                of_row.iter().enumerate().map(move |(column, entry)| ((row, column), *entry))
            });
            let is_zero = |entry: &Expr| pool.as_constant(*entry) == Some(0.0);
            let (places, entries): (Vec<(usize, usize)>, Vec<Expr>) =
                entries.filter(|(_, entry)| !is_zero(entry)).unzip();
            CompiledSelection {
                jacobian: compile_outputs(pool, registers, sequence, &entries),
                places,
                candidates: registers_of(&selection.candidates),
                states: registers_of(&selection.states),
                weights: selection.weights.iter().map(|row| registers_of(row)).collect(),
                chosen: selection.chosen.clone(),
            }
        });
        selections.collect()
    }

    /// Code over the whole sequence that runs when the parameters have their values.
    fn total(&mut self, outputs: &[Expr]) -> Outputs {
        let Compilation { pool, registers, sequence, .. } = self;
        compile_continuous(pool, registers, sequence, outputs, Hoisting::Total)
    }

    fn observation(&mut self) -> Outputs {
        let observed = self.observed.clone();
        self.values_of(&observed)
    }

    fn unread(&mut self, variables: Vec<VarId>) -> Unread {
        let values = self.values_of(&variables);
        Unread { variables, values }
    }

    fn values_of(&mut self, variables: &[VarId]) -> Outputs {
        let expressions: Vec<Expr> = variables.iter().map(|v| self.pool.variable(*v)).collect();
        self.total(&expressions)
    }

    /// The assertions that end the simulation, or the others, with their numbers among all.
    fn assertions(&mut self, are_errors: bool) -> Vec<LogAssertion> {
        let all = self.causalized.dae.assertions.iter().enumerate();
        let of_level = all.filter(|(_, a)| (a.level == Level::Error) == are_errors);
        let found = of_level.map(|(at, a)| (at as u32, a.condition, a.values()));
        let found: Vec<(u32, Expr, Vec<Expr>)> = found.collect();
        let assertion = |(assertion, condition, values): (u32, Expr, Vec<Expr>)| LogAssertion {
            assertion,
            condition: self.total(&[condition]),
            values: self.total(&values),
        };
        found.into_iter().map(assertion).collect()
    }

    /// The conditions of the assertions that end the simulation.
    fn conditions_of_assertions(&mut self) -> Outputs {
        let all = self.causalized.dae.assertions.iter();
        let conditions = all.filter(|a| a.level == Level::Error).map(|a| a.condition);
        let conditions: Vec<Expr> = conditions.collect();
        self.total(&conditions)
    }

    fn initial_checks(&mut self) -> Vec<Outputs> {
        let Compilation { causalized, pool, registers, .. } = self;
        let checks = causalized.initial_checks.iter();
        checks
            .map(|check| compile_outputs(pool, registers, &[], &[check.left, check.right]))
            .collect()
    }

    fn events(&mut self) -> super::events::Events {
        let Compilation { causalized, pool, registers, sequence, .. } = self;
        compile_events(pool, registers, causalized, sequence)
    }

    fn values(&mut self) -> Values {
        let Compilation { causalized, pool, registers, .. } = self;
        let base = number_of_equations(causalized);
        let origin = |v: VarId| (base + v.0 as usize) as u32;
        let stored = |registers: &mut Registers, variable: VarId, value: Expr| {
            let mut builder = TapeBuilder::new(pool, registers);
            builder.origin(origin(variable));
            builder.store(variable, value);
            (variable, builder.finish())
        };
        let dae = &causalized.dae;
        let bindings =
            causalized.parameters.iter().filter_map(|p| Some((*p, dae.variable(*p).binding?)));
        let mut results = ResultsOfCalls::default();
        let mut parameters = Vec::new();
        for (parameter, binding) in bindings {
            let is_always_evaluated = dae.variable(parameter).kind == NEVER_SET;
            let tape = match results.of(pool, binding) {
                Some(register) if is_always_evaluated => {
                    let mut builder = TapeBuilder::new(pool, registers);
                    builder.origin(origin(parameter));
                    builder.copy(parameter.0, register);
                    builder.finish()
                }
                _ => stored(registers, parameter, binding).1,
            };
            if is_always_evaluated {
                results.keep(pool, binding, &tape, registers.functions());
            }
            parameters.push((parameter, tape));
        }
        let all = (0u32..).map(VarId).zip(&dae.variables);
        let solved =
            all.clone().filter(|(_, v)| v.kind == VariableKind::Solved).map(|(id, _)| id).collect();
        let (mut starts, mut nominals) = (Vec::new(), Vec::new());
        for (id, variable) in all {
            if !dae.is_solved_for(id) && variable.kind != VariableKind::Solved {
                continue;
            }
            if let Some(start) = variable.start {
                starts.push(stored(registers, id, start));
            }
            if let Some(nominal) = variable.nominal {
                let mut builder = TapeBuilder::new(pool, registers);
                let register = builder.emit(nominal);
                nominals.push((id, builder.finish(), register));
            }
        }
        Values { parameter_tapes: parameters, starts, nominals, solved }
    }
}

/// A parameter whose tape is run in every simulation.
const NEVER_SET: VariableKind = VariableKind::Parameter { tunable: false };
/// Calls with fewer outputs are repeated for each parameter that is bound to one of these.
const MANY_OUTPUTS: u32 = 64;

/// Where parameters that are never set have the results of calls: those after them copy these. Without
/// it the outputs of a call would be written for each of them, n² numbers in all.
#[derive(Default)]
struct ResultsOfCalls(FxHashMap<(u32, Expr), Register>);

impl ResultsOfCalls {
    /// The register of the output that a parameter is bound to.
    fn of(&self, pool: &Pool, binding: Expr) -> Option<Register> {
        let Node::Call { function, output, arguments } = *pool.node(binding) else { return None };
        self.0.get(&(function, arguments)).map(|first| first + output)
    }

    fn keep(&mut self, pool: &Pool, binding: Expr, tape: &Tape, functions: &Functions) {
        let Node::Call { function, arguments, .. } = *pool.node(binding) else { return };
        let code = &functions.codes[function as usize];
        if let Some(call) = tape.calls.last()
            && call.function == function
            && code.n_outputs >= MANY_OUTPUTS
            && !code.may_lack
        {
            self.0.entry((function, arguments)).or_insert(call.d);
        }
    }
}

/// Whether the rate of a recorded input is read by more than the equation of the input itself.
fn reads_rates(pool: &Pool, causalized: &CausalizedDae) -> bool {
    let tracks = causalized.dae.events.recordings.iter().flat_map(|recording| &recording.tracks);
    let mut rates = tracks.filter_map(|track| track.rate);
    let values = || {
        causalized.blocks.iter().flat_map(|block| {
            let residuals = match block {
                Block::Loop(torn) => torn.residuals.as_slice(),
                _ => &[],
            };
            let assigned = block.assignments().iter().map(|assignment| assignment.value);
            assigned.chain(residuals.iter().map(|(residual, _)| *residual))
        })
    };
    rates.any(|rate| values().filter(|value| pool.depends_on(*value, rate)).nth(1).is_some())
}

fn depend_on_time(pool: &Pool, needed: &[Assignment], outputs: &[Expr]) -> bool {
    let mut values = needed.iter().map(|a| a.value).chain(outputs.iter().copied());
    values.any(|value| pool.depends_on(value, VarId(0)))
}

/// Values of all variables that parameters have by default; NaN where none can be computed. A
/// warning where a function gives none.
fn default_values(program: &Program) -> (Vec<f64>, Vec<Diagnostic>) {
    let mut registers = Memory::new(&program.registers);
    registers.calls.keeps_unassigned = true;
    let mut warnings = Vec::new();
    for (parameter, tape) in &program.values.parameter_tapes {
        if let Err(failed) = tape.run(&mut registers) {
            registers[parameter.0 as usize] = f64::NAN;
            if let Some(function) = tape.lacking(failed) {
                let warning = lacking(program, *parameter, function);
                // Once for all components of one type.
                if warnings.iter().all(|other: &Diagnostic| other.span() != warning.span()) {
                    warnings.push(warning);
                }
            }
        }
    }
    (registers.registers, warnings)
}

fn lacking(program: &Program, parameter: VarId, function: u32) -> Diagnostic {
    let variable = program.sorted.dae.variable(parameter);
    let function = &program.registers.functions().codes[function as usize].name;
    fault!(PARAMETER_WITHOUT_VALUE,
        "the parameter `{}` has no value: the function `{function}` gives it none", variable.name;
        help: "assign it in the function, at least for the case that it is not used")
    .at(variable.span)
    .warning()
}

fn parameters(sorted: &CausalizedDae) -> Vec<ParameterInfo> {
    let tunable = |(_, v): &(usize, &Variable)| v.kind == VariableKind::Parameter { tunable: true };
    let info = |(at, v): (usize, &Variable)| ParameterInfo {
        name: v.name.clone(),
        unit: v.unit.clone(),
        description: v.description.clone(),
        base: v.base.clone(),
        min: f64::NEG_INFINITY,
        max: f64::INFINITY,
        default: f64::NAN,
        top_level: v.top_level,
        variable: VarId(at as u32),
    };
    sorted.dae.variables.iter().enumerate().filter(tunable).map(info).collect()
}

fn variables(sorted: &CausalizedDae, observed: &[VarId]) -> Vec<VariableInfo> {
    let mut infos = Vec::new();
    for (at, v) in sorted.dae.variables.iter().enumerate() {
        let id = VarId(at as u32);
        let alias = sorted.aliases[at];
        // Made by the compiler, of no use to anybody else.
        if v.name.contains('$') {
            continue;
        }
        let access = match v.kind {
            VariableKind::Time => Access::Time,
            VariableKind::Constant(value) => Access::Constant(value),
            VariableKind::Parameter { .. } | VariableKind::Discrete
                if matches!(v.base, BaseType::ExternalObject(_)) =>
            {
                continue;
            }
            VariableKind::Parameter { .. } | VariableKind::Solved => Access::Parameter,
            VariableKind::Frozen
            | VariableKind::Text
            | VariableKind::Clock
            | VariableKind::Previous(_)
            | VariableKind::Signal
            | VariableKind::Delayed => continue,
            // A trajectory has no columns for Strings.
            VariableKind::Discrete if v.base == BaseType::String => continue,
            VariableKind::Discrete if v.name.starts_with('$') => continue,
            VariableKind::Unknown | VariableKind::Derivative(_) | VariableKind::Discrete => {
                let of = alias.map_or(id, |alias| alias.of);
                let column = observed.binary_search(&of);
                Access::Observed {
                    column: column.expect("every representative is observed"),
                    negated: alias.is_some_and(|alias| alias.negated),
                }
            }
        };
        infos.push(VariableInfo {
            name: v.name.clone(),
            unit: v.unit.clone(),
            is_relative: v.is_relative,
            display_unit: v.display_unit.clone(),
            description: v.description.clone(),
            base: v.base.clone(),
            variability: v.variability,
            causality: v.causality,
            top_level: v.top_level,
            protected: v.protected,
            access,
            variable: id,
        });
    }
    infos
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::causalize::causalize;
    use crate::flatten::{Library, flatten};
    use crate::source::SourceId;
    use crate::syntax::parse_stored_definition;

    const MODEL: &str = "model M function f input Real x; output Real y[200]; \
        protected Integer i = 0; algorithm while i < 200 and x < 9 loop i := i + 1; y[i] := x*i; \
        end while; \
        end f; parameter Real x = 2; final parameter Real k[200] = f(x); \
        Real s = sum(k)*time; end M;";

    #[test]
    fn outputs_of_a_call_have_registers_once() {
        let file = parse_stored_definition(SourceId::NONE, MODEL).expect("Modelica");
        let mut library = Library::new();
        let names = library.load(&file).expect("a loadable file");
        let flat = flatten(&library, &names[0], &[]).expect("a model").model;
        let program = Program::compile(causalize(&flat).expect("it can be sorted"));
        let program = program.expect("it compiles");
        assert!(program.registers.len() < 2_000, "{}", program.registers.len());
        let (values, _) = default_values(&program);
        for (name, expected) in [("k[1]", 2.0), ("k[200]", 400.0)] {
            let dae = &program.sorted.dae;
            let at = dae.variables.iter().position(|v| &*v.name == name).expect(name);
            assert_eq!(values[at], expected, "{name}");
        }
    }
}
