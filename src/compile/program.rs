//! A compiled model: immutable, shared by any number of [`System`](super::System)s.

use super::combinations::relations_of_blocks;
use super::events::{CompiledRounding, Events, compile_events, linear_in_time};
use super::held::Held;
use super::hoist::Hoisting;
use super::jacobian::differentiate_sequence;
use super::literal_relations::Literal;
use super::lower::{Registers, TapeBuilder};
use super::machine_code::MachineCode;
use super::notices::Notice;
use super::sliding::memoryless;
use super::system::System;
use super::tape::{Register, Tape};
use crate::causalize::{Assignment, Block, CausalizedDae};
use crate::diag::Diagnostic;
use crate::flatten::{BaseType, Variability};
use crate::lower::{Assertion, Kind, Level, Variable};
use crate::sim::Pattern;
use crate::symbolic::{Expr, Pool, VarId, VariableCollection};
use crate::syntax::ast::CausalityPrefix;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A parameter that can be set between simulations.
#[derive(Debug, Clone)]
pub struct ParameterInfo {
    /// Its full name.
    pub name: Arc<str>,
    /// Unit, empty if none.
    pub unit: Arc<str>,
    /// The string behind its declaration.
    pub description: Arc<str>,
    /// Predefined type; values are numbers (Boolean 0 or 1, enumerations by ordinal).
    pub base: BaseType,
    /// Attribute `min`; `-∞` without.
    pub min: f64,
    /// Attribute `max`; `∞` without.
    pub max: f64,
    /// Its value if nobody sets it; NaN if it cannot be computed.
    pub default: f64,
    /// Whether it stands directly in the class.
    pub top_level: bool,
    pub(super) variable: VarId,
}

/// A scalar variable of the model, aliases, parameters and constants included.
#[derive(Debug, Clone)]
pub struct VariableInfo {
    /// Its full name.
    pub name: Arc<str>,
    /// Unit, empty if none.
    pub unit: Arc<str>,
    /// Unit for people, empty if none.
    pub display_unit: Arc<str>,
    /// The string behind its declaration.
    pub description: Arc<str>,
    /// Predefined type.
    pub base: BaseType,
    /// When it may change.
    pub variability: Variability,
    /// `input` or `output`.
    pub causality: Option<CausalityPrefix>,
    /// Whether it stands directly in the class.
    pub top_level: bool,
    /// Whether it is protected.
    pub protected: bool,
    /// Where its value is found.
    pub access: Access,
    pub(super) variable: VarId,
}

impl VariableInfo {
    /// Whether its value does not change during a simulation.
    pub fn is_known(&self) -> bool {
        self.variability <= Variability::Parameter
    }

    /// Whether it is an output of the model itself.
    pub fn is_output(&self) -> bool {
        self.top_level && self.causality == Some(CausalityPrefix::Output)
    }
}

/// Where the value of a variable is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Access {
    /// It is the simulated time.
    Time,
    /// A number.
    Constant(f64),
    /// A parameter: ask [`System::value`].
    Parameter,
    /// A column of the observed variables (when all are observed), with its sign.
    Observed {
        /// Which column.
        column: usize,
        /// Whether the variable has the opposite sign.
        negated: bool,
    },
}

/// A step of solving for all variables, the states (or nothing, at the start) given.
#[derive(Debug, Clone)]
pub(super) enum Step {
    Run(Tape),
    Solve(CompiledLoop),
}

/// A torn loop with its Jacobian.
#[derive(Debug, Clone)]
pub(super) struct CompiledLoop {
    pub(super) tape: Tape,
    pub(super) unknowns: Vec<Register>,
    pub(super) residuals: Vec<Register>,
    /// Row-major.
    pub(super) jacobian: Vec<Register>,
    /// 1 once the tape has computed the residuals: what fails behind them is a derivative.
    pub(super) has_residuals: Register,
    pub(super) block: u32,
}

/// A frozen relation, compiled.
#[derive(Debug, Clone)]
pub(super) struct CompiledRelation {
    pub(super) register: Register,
    pub(super) operator: crate::symbolic::RelationOperator,
    /// For a relation on time alone: registers of the factor of time and of the rest.
    pub(super) time: Option<(f64, Register)>,
}

/// States chosen at run time, as registers.
#[derive(Debug, Clone)]
pub(super) struct CompiledSelection {
    /// By rows.
    pub(super) jacobian: Outputs,
    pub(super) candidates: Vec<Register>,
    pub(super) states: Vec<Register>,
    pub(super) weights: Vec<Vec<Register>>,
    /// Places of the candidates that are states at first.
    pub(super) chosen: Vec<usize>,
}

/// Code with the registers of its results.
#[derive(Debug, Clone, Default)]
pub(super) struct Outputs {
    pub(super) tape: Tape,
    pub(super) outputs: Vec<Register>,
    pub(super) machine_code: MachineCode,
}

/// A compiled model.
#[derive(Debug)]
pub struct Program {
    pub(super) sorted: CausalizedDae,
    pub(super) registers: Registers,
    /// Everything in solving order, iteration variables of loops given.
    pub(super) sequence: Vec<Assignment>,
    /// The same where all algebraic unknowns of the integrator are given.
    pub(super) integrated: Vec<Assignment>,
    /// What must be zero there.
    pub(super) residuals: Vec<Expr>,
    /// The unknowns of the integrator: states, then [`Program::iteration`].
    pub(super) unknowns: Vec<VarId>,
    /// The algebraic ones.
    pub(super) iteration: Vec<VarId>,
    /// Of these, how many at the end are in the sequence as well.
    pub(super) n_auxiliary: usize,
    pub(super) parameters: Vec<ParameterInfo>,
    pub(super) variables: Vec<VariableInfo>,
    pub(super) observed: Vec<VarId>,
    /// Every parameter's own tape, in order.
    pub(super) parameter_tapes: Vec<(VarId, Tape)>,
    /// Start value of every unknown that has one.
    pub(super) starts: Vec<(VarId, Tape)>,
    /// Parameters that the initial system determines.
    pub(super) solved: Vec<VarId>,
    pub(super) nominals: Vec<(VarId, Tape, Register)>,
    pub(super) initial_steps: Vec<Step>,
    /// Both sides of what initial values must fulfil besides.
    pub(super) initial_checks: Vec<Outputs>,
    pub(super) steps: Vec<Step>,
    pub(super) relations: Vec<CompiledRelation>,
    /// Both sides of every relation, from the registers of the variables.
    pub(super) relation_sides: Vec<Outputs>,
    /// The part of [`CompiledRelation::time`] that parameters make.
    pub(super) time_rests: Tape,
    pub(super) rhs: Outputs,
    pub(super) jacobian: Outputs,
    pub(super) pattern: Pattern,
    pub(super) crossings: Outputs,
    /// Whether these depend on time otherwise than through states and unknowns of loops.
    pub(super) crossings_vary_in_time: bool,
    /// The relations that have crossing functions.
    pub(super) crossing_relations: Vec<usize>,
    /// For every block that is solved at once, the relations in it.
    pub(super) relations_of_blocks: Vec<Vec<usize>>,
    /// For every relation, whether only functions of the relations follow from it at events.
    pub(super) memoryless: Vec<bool>,
    pub(super) selections: Vec<CompiledSelection>,
    pub(super) observe: Outputs,
    pub(super) assertions: Vec<(usize, Outputs)>,
    /// Warnings: they do not end a simulation.
    pub(super) notices: Vec<Notice>,
    pub(super) events: Events,
    /// What became of its relations inside `noEvent`.
    pub(super) literal: Literal,
}

impl Program {
    /// Compiles a sorted system.
    pub fn compile(mut sorted: CausalizedDae) -> Result<Arc<Program>, Diagnostic> {
        let n = sorted.dae.variables.len();
        let sequence: Vec<Assignment> =
            sorted.blocks.iter().flat_map(|block| block.assignments()).copied().collect();
        let mut registers = Registers::new(n, sorted.dae.functions.clone());
        for (variable, info) in (0u32..).zip(&sorted.dae.variables) {
            if matches!(info.kind, Kind::Parameter { .. } | Kind::Constant(_)) {
                registers.hoisted.fix(variable);
            }
        }
        let observed: Vec<VarId> = (0..n as u32)
            .map(VarId)
            .filter(|v| sorted.dae.is_solved_for(*v) && sorted.aliases[v.0 as usize].is_none())
            .collect();
        let mut next = n as u32;
        let mut pool = std::mem::take(&mut sorted.dae.pool);
        let steps = compile_steps(&mut pool, &mut registers, &sorted.blocks, &mut next);
        let initial_steps =
            compile_steps(&mut pool, &mut registers, &sorted.initial_blocks, &mut next);
        let mut event_steps =
            compile_steps(&mut pool, &mut registers, &sorted.event_blocks, &mut next);
        for step in &mut event_steps {
            if let Step::Solve(newton) = step {
                newton.block += sorted.blocks.len() as u32;
            }
        }

        let mut derivatives: FxHashMap<VarId, VarId> = FxHashMap::default();
        for (v, variable) in (0..).map(VarId).zip(&sorted.dae.variables) {
            if let Kind::Derivative(of) = variable.kind {
                derivatives.entry(of).or_insert(v);
            }
        }
        let mut outputs: Vec<Expr> = Vec::new();
        for state in &sorted.states {
            outputs.push(resolved(&mut pool, &sorted, derivatives[state]));
        }
        let Held { iteration, n_auxiliary, residuals, sequence: integrated } =
            Held::choose(&mut pool, &sorted, &outputs);
        outputs.extend(&residuals);
        let rhs =
            compile_continuous(&pool, &mut registers, &integrated, &outputs, Hoisting::Certain);

        let unknowns: Vec<VarId> = sorted.states.iter().chain(&iteration).copied().collect();
        let needed = slice(&pool, &integrated, &outputs);
        let slopes = differentiate_sequence(&mut pool, &needed, &outputs, &unknowns, &mut next);
        let mut rows = slopes.rows;
        let zero = pool.constant(0.0);
        // An implicit method subtracts from the diagonal of the states: it belongs to the pattern.
        for (state, row) in rows.iter_mut().take(sorted.states.len()).enumerate() {
            row.entry(state).or_insert(zero);
        }
        let (pattern, entries) = by_columns(&rows, unknowns.len());
        let extended = slopes.sequence;
        let jacobian =
            compile_continuous(&pool, &mut registers, &extended, &entries, Hoisting::Total);

        let mut relations = Vec::new();
        let mut relation_sides = Vec::new();
        let mut crossing_relations = Vec::new();
        let mut differences = Vec::new();
        let mut rests = Vec::new();
        for relation in &sorted.dae.relations {
            let difference = pool.sub(relation.left, relation.right);
            let time = linear_in_time(&mut pool, &sorted, difference);
            match time {
                None => {
                    crossing_relations.push(relations.len());
                    differences.extend([relation.left, relation.right]);
                }
                Some((_, rest)) => rests.push((relations.len(), rest)),
            }
            relations.push(CompiledRelation {
                register: relation.variable.0,
                operator: relation.operator,
                time: time.map(|(factor, _)| (factor, 0)),
            });
            let sides = [relation.left, relation.right];
            relation_sides.push(compile_outputs(&pool, &mut registers, &[], &sides));
        }
        let mut roundings = Vec::new();
        for rounding in &sorted.dae.events.roundings {
            let time = linear_in_time(&mut pool, &sorted, rounding.argument);
            match time {
                None => {
                    let value = pool.variable(rounding.variable);
                    let above = pool.sub(rounding.argument, value);
                    let one = pool.constant(1.0);
                    differences.extend([above, pool.sub(above, one)]);
                }
                Some((_, rest)) => rests.push((relations.len() + roundings.len(), rest)),
            }
            let time = time.map(|(slope, _)| (slope, 0));
            roundings.push(CompiledRounding { register: rounding.variable.0, time });
        }
        let rest_expressions: Vec<Expr> = rests.iter().map(|(_, rest)| *rest).collect();
        let time_rests = compile_outputs(&pool, &mut registers, &[], &rest_expressions);
        for ((at, _), register) in rests.iter().zip(&time_rests.outputs) {
            let time = match at.checked_sub(relations.len()) {
                None => &mut relations[*at].time,
                Some(at) => &mut roundings[at].time,
            };
            if let Some(time) = time {
                time.1 = *register;
            }
        }
        let crossings_vary_in_time = {
            let needed = slice(&pool, &sequence, &differences);
            let mut values = needed.iter().map(|a| a.value).chain(differences.iter().copied());
            values.any(|value| pool.depends_on(value, VarId(0)))
        };
        let crossings =
            compile_continuous(&pool, &mut registers, &sequence, &differences, Hoisting::Total);

        let selections = sorted.selections.iter().map(|selection| {
            let entries: Vec<Expr> = selection.jacobian.iter().flatten().copied().collect();
            let of = |variables: &[VarId]| variables.iter().map(|v| v.0).collect::<Vec<_>>();
            CompiledSelection {
                jacobian: compile_outputs(&pool, &mut registers, &sequence, &entries),
                candidates: of(&selection.candidates),
                states: of(&selection.states),
                weights: selection.weights.iter().map(|row| of(row)).collect(),
                chosen: selection.chosen.clone(),
            }
        });
        let selections = selections.collect();

        let observed_expressions: Vec<Expr> = observed.iter().map(|v| pool.variable(*v)).collect();
        let observe = compile_continuous(
            &pool,
            &mut registers,
            &sequence,
            &observed_expressions,
            Hoisting::Total,
        );
        let assertions = sorted
            .dae
            .assertions
            .iter()
            .enumerate()
            .filter(|(_, assertion)| assertion.level == Level::Error)
            .map(|(at, assertion)| {
                (
                    at,
                    compile_continuous(
                        &pool,
                        &mut registers,
                        &sequence,
                        &[assertion.condition],
                        Hoisting::Total,
                    ),
                )
            })
            .collect();

        let mut notice = |at: usize, assertion: &Assertion| {
            let outputs: Vec<Expr> =
                std::iter::once(assertion.condition).chain(assertion.values()).collect();
            let code =
                compile_continuous(&pool, &mut registers, &sequence, &outputs, Hoisting::Total);
            Notice { assertion: at as u32, code }
        };
        let notices = sorted.dae.assertions.iter().enumerate();
        let notices = notices
            .filter(|(_, assertion)| assertion.level != Level::Error)
            .map(|(at, assertion)| notice(at, assertion))
            .collect();

        let initial_checks = sorted
            .initial_checks
            .iter()
            .map(|check| compile_outputs(&pool, &mut registers, &[], &[check.left, check.right]))
            .collect();
        let mut events = compile_events(&pool, &mut registers, &sorted, &sequence);
        events.steps = event_steps;
        events.roundings = roundings;
        let base = number_of_equations(&sorted);
        let mut parameter_tapes = Vec::new();
        for parameter in &sorted.parameters {
            if let Some(binding) = sorted.dae.variable(*parameter).binding {
                let mut builder = TapeBuilder::new(&pool, &mut registers);
                builder.origin((base + parameter.0 as usize) as u32);
                builder.store(*parameter, binding);
                parameter_tapes.push((*parameter, builder.finish()));
            }
        }
        let kinds = sorted.dae.variables.iter().map(|v| v.kind);
        let solved = (0u32..).map(VarId).zip(kinds).filter(|(_, k)| *k == Kind::Solved);
        let solved = solved.map(|(v, _)| v).collect();
        let mut starts = Vec::new();
        let mut nominals = Vec::new();
        for position in 0..n as u32 {
            let variable = sorted.dae.variable(VarId(position));
            let id = VarId(position);
            if !sorted.dae.is_solved_for(id) && variable.kind != Kind::Solved {
                continue;
            }
            if let Some(start) = variable.start {
                let mut builder = TapeBuilder::new(&pool, &mut registers);
                builder.origin((base + position as usize) as u32);
                builder.store(VarId(position), start);
                starts.push((VarId(position), builder.finish()));
            }
            if let Some(nominal) = variable.nominal {
                let mut builder = TapeBuilder::new(&pool, &mut registers);
                let register = builder.emit(nominal);
                nominals.push((VarId(position), builder.finish(), register));
            }
        }
        let relations_of_blocks = relations_of_blocks(&pool, &sorted);
        let memoryless = memoryless(&pool, &sorted);
        sorted.dae.pool = pool;
        let variables = variables(&sorted, &observed);
        let parameters = parameters(&sorted);
        let mut program = Program {
            sorted,
            registers,
            sequence,
            integrated,
            residuals,
            unknowns,
            iteration,
            n_auxiliary,
            parameters,
            variables,
            observed,
            parameter_tapes,
            starts,
            solved,
            nominals,
            initial_steps,
            initial_checks,
            steps,
            relations,
            relation_sides,
            time_rests: time_rests.tape,
            rhs,
            jacobian,
            pattern,
            crossing_relations,
            crossings_vary_in_time,
            crossings,
            relations_of_blocks,
            memoryless,
            selections,
            observe,
            assertions,
            notices,
            events,
            literal: Literal::default(),
        };
        program.fill_defaults();
        Ok(Arc::new(program))
    }

    /// Default values and bounds, computed with the default parameters.
    fn fill_defaults(&mut self) {
        let values = super::system::default_values(self);
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

    /// Number of crossing functions of relations and roundings.
    pub(super) fn n_crossings(&self) -> usize {
        self.crossings.outputs.len() - self.crossing_relations.len()
    }

    /// An independent system, one for every thread.
    pub fn system(self: &Arc<Program>) -> System {
        System::new(self.clone())
    }
}

/// Equations, initial equations and those of events.
pub(super) fn number_of_equations(sorted: &CausalizedDae) -> usize {
    let dae = &sorted.dae;
    dae.equations.len() + dae.initial_equations.len() + dae.events.equations.len()
}

/// A set of variables with all that they are computed from.
pub(super) fn close(
    pool: &Pool,
    sequence: &[Assignment],
    mut wanted: FxHashSet<VarId>,
) -> FxHashSet<VarId> {
    let mut collection = VariableCollection::new(pool);
    for assignment in sequence.iter().rev() {
        if wanted.contains(&assignment.variable) {
            collection.add(assignment.value, |variable| {
                wanted.insert(variable);
            });
        }
    }
    wanted
}

/// The assignments that outputs need, in order.
pub(super) fn slice(pool: &Pool, sequence: &[Assignment], outputs: &[Expr]) -> Vec<Assignment> {
    let mut wanted = FxHashSet::default();
    let mut collection = VariableCollection::new(pool);
    for output in outputs {
        collection.add(*output, |variable| {
            wanted.insert(variable);
        });
    }
    let wanted = close(pool, sequence, wanted);
    sequence.iter().filter(|a| wanted.contains(&a.variable)).copied().collect()
}

/// Code that computes outputs, and only what they need.
pub(super) fn compile_outputs(
    pool: &Pool,
    registers: &mut Registers,
    sequence: &[Assignment],
    outputs: &[Expr],
) -> Outputs {
    compile_continuous(pool, registers, sequence, outputs, Hoisting::Never)
}

/// The same for code that runs when the parameters have their values.
pub(super) fn compile_continuous(
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

/// The steps of solving blocks one after another.
fn compile_steps(
    pool: &mut Pool,
    registers: &mut Registers,
    blocks: &[Block],
    next: &mut u32,
) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut run: Vec<Assignment> = Vec::new();
    for (number, block) in blocks.iter().enumerate() {
        let torn = match block {
            Block::Assignment(_) | Block::Linear(_) => {
                run.extend(block.assignments());
                continue;
            }
            Block::Loop(torn) => torn,
        };
        steps.extend(compile_run(pool, registers, &mut run));
        let residuals: Vec<Expr> = torn.residuals.iter().map(|(residual, _)| *residual).collect();
        let slopes =
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
        for Assignment { variable, value, equation } in &slopes.sequence {
            if !inner.contains(variable) {
                builder.origin(*equation as u32);
                builder.define(*variable, *value);
            }
        }
        let mut jacobian = Vec::new();
        for (row, (_, equation)) in torn.residuals.iter().enumerate() {
            builder.origin(*equation as u32);
            for column in 0..torn.iteration.len() {
                let entry = slopes.rows[row].get(&column).copied().unwrap_or(zero);
                jacobian.push(builder.emit(entry));
            }
        }
        steps.push(Step::Solve(CompiledLoop {
            tape: builder.finish(),
            unknowns: torn.iteration.iter().map(|v| v.0).collect(),
            residuals: results,
            jacobian,
            has_residuals,
            block: number as u32,
        }));
    }
    steps.extend(compile_run(pool, registers, &mut run));
    steps
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
    Some(Step::Run(builder.finish()))
}

/// A variable's representative, with its sign.
pub(super) fn resolved(pool: &mut Pool, sorted: &CausalizedDae, variable: VarId) -> Expr {
    match sorted.aliases[variable.0 as usize] {
        None => pool.variable(variable),
        Some(alias) => {
            let of = pool.variable(alias.of);
            if alias.negated { pool.neg(of) } else { of }
        }
    }
}

/// Entries of a Jacobian by columns.
fn by_columns(rows: &[BTreeMap<usize, Expr>], n: usize) -> (Pattern, Vec<Expr>) {
    let mut columns: Vec<Vec<(usize, Expr)>> = vec![Vec::new(); n];
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

fn parameters(sorted: &CausalizedDae) -> Vec<ParameterInfo> {
    let tunable = |(_, v): &(usize, &Variable)| v.kind == Kind::Parameter { tunable: true };
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
            Kind::Time => Access::Time,
            Kind::Constant(value) => Access::Constant(value),
            Kind::Parameter { .. } if matches!(v.base, BaseType::ExternalObject(_)) => continue,
            Kind::Parameter { .. } | Kind::Solved => Access::Parameter,
            Kind::Frozen | Kind::Text | Kind::Previous(_) | Kind::Signal | Kind::Delayed => {
                continue;
            }
            // A trajectory has no place for texts.
            Kind::Discrete if v.base == BaseType::String => continue,
            Kind::Discrete if v.name.starts_with('$') => continue,
            Kind::Unknown | Kind::Derivative(_) | Kind::Discrete => {
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
