//! One running instance of a program: its registers, parameter values and frozen relations.

use super::execution::{Operation, read, run, run_assignments, run_parameter, run_strictly};
use super::instants::{Change, Stage, either, same_time};
use super::newton::{Attempts, LoopSolver};
use super::partial_observation::OtherVariables;
use super::sensitivity_state::Sensitivity;
use super::state::{
    DelayState, EventState, GivenStart, LoopState, MessageState, OutputState, RelationState,
};
use super::state_selection::Choice;
use crate::codegen::code::{Assertions, LogAssertion, Step};
use crate::codegen::memory::Memory;
use crate::codegen::program::{Access, Program, number_of_equations};
use crate::codegen::sequence::{expressions, observing};
use crate::diag::Fault;
use crate::fault;
use crate::flatten::BaseType;
use crate::sim::{
    EventOutcome, Events, Failure, Linearity, Modes, Pattern, Residual, Sensitive, Side, Treatment,
};
use crate::symbolic::VarId;
use std::sync::Arc;

/// A system whose relations inside `noEvent` are looked at, or have events.
#[derive(Debug, Clone, Default)]
pub(super) struct LiteralRelations {
    /// Where differences are computed.
    pub(super) memory: Option<Box<Memory>>,
    /// The system as it was before they had events.
    pub(super) plain: Option<Box<System>>,
}

/// A system that one thread simulates.
#[derive(Debug, Clone)]
pub struct System {
    pub(super) program: Arc<Program>,
    pub(super) registers: Memory,
    /// Values set from outside, by number of the parameter.
    pub(super) set: Vec<Option<f64>>,
    nominal: Vec<f64>,
    /// Derivatives that are carried along, if any are.
    pub(super) sensitivity: Option<Box<Sensitivity>>,
    pub(super) relations: RelationState,
    /// Its relations inside `noEvent`.
    pub(super) literal: LiteralRelations,
    pub(super) loops: LoopState,
    pub(super) delays: DelayState,
    pub(super) events: EventState,
    pub(super) outputs: OutputState,
    pub(super) messages: MessageState,
    /// What simulations begin with.
    pub(super) given_start: Option<Box<GivenStart>>,
}

impl Program {
    /// An independent system, one for every thread.
    pub fn system(self: &Arc<Program>) -> System {
        System::new(self.clone())
    }
}

impl System {
    /// An independent system, one for every thread.
    pub fn new(program: Arc<Program>) -> System {
        let registers = Memory::new(&program.registers);
        let n = program.continuous.unknowns.len();
        let mut system = System {
            registers,
            set: vec![None; program.parameters().len()],
            nominal: vec![1.0; n],
            sensitivity: None,
            relations: RelationState::new(&program),
            literal: LiteralRelations::default(),
            loops: LoopState { linear: program.linear_unknowns(), ..LoopState::default() },
            delays: DelayState::new(&program),
            events: EventState::new(&program),
            outputs: OutputState::new(&program),
            messages: MessageState::default(),
            given_start: None,
            program,
        };
        system.evaluate_nominals();
        system
    }

    /// The program it runs.
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }

    /// Sets a parameter by its position in [`Program::parameters`]; it takes effect at the next
    /// initialization. Bounds are the caller's to check.
    pub fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), Fault> {
        let name = &self.program.parameters().get(index).map(|p| p.name.clone());
        let is_fraction = value.fract() != 0.0 && !self.is_real(index);
        match (self.set.get_mut(index), name) {
            (Some(_), Some(name)) if !value.is_finite() => Err(fault!(
                crate::codegen::errors::UNKNOWN_PARAMETER,
                "the value of `{name}` is {value}"; help: "use a finite number"
            )),
            (Some(_), Some(name)) if is_fraction => Err(fault!(
                crate::codegen::errors::UNKNOWN_PARAMETER,
                "`{name}` takes whole numbers only";
                help: "in an identification, run once for each of several fixed values and \
                       compare the results"
            )),
            (Some(slot), _) => {
                *slot = Some(value);
                Ok(())
            }
            (None, _) => Err(fault!(
                crate::codegen::errors::UNKNOWN_PARAMETER,
                "there is no parameter number {index}"
            )),
        }
    }

    fn is_real(&self, parameter: usize) -> bool {
        self.program.parameters().get(parameter).is_none_or(|own| own.base == BaseType::Real)
    }

    /// Takes back all values set.
    pub fn reset_parameters(&mut self) {
        self.set.fill(None);
    }

    /// Restricts [`Residual::observe`] to these variables (positions in [`Program::variables`]),
    /// one column each in this order, and computes nothing that they do not need.
    pub fn observe_only(&mut self, variables: &[usize]) {
        self.restore_program();
        self.outputs.observed_variables = Some(variables.to_vec());
        let program = self.program.clone();
        let mut pool = program.sorted.dae.pool.clone();
        let outputs = expressions(&program, &mut pool, variables);
        let (registers, observed) = observing(&program, &pool, &outputs);
        self.registers.extend(&registers);
        self.outputs.observed = Some(observed);
        self.outputs.others = OtherVariables::default();
        let variables = variables.iter().map(|at| program.variables()[*at].variable);
        self.outputs.has_means = variables.map(|v| program.has_means(v)).collect();
    }

    /// The value of a parameter or constant (position in [`Program::variables`]) after
    /// initialization; `None` for other variables.
    pub fn value(&self, variable: usize) -> Option<f64> {
        let info = self.program.variables().get(variable)?;
        match info.access {
            Access::Constant(value) => Some(value),
            Access::Parameter => Some(self.registers[info.variable.0 as usize]),
            _ => None,
        }
    }

    /// Gives discrete variables, by their positions in [`Program::variables`], values that hold from the
    /// next event on. Those that follow from others are computed again there.
    pub fn set_discrete(&mut self, values: &[(usize, f64)]) {
        self.loops.is_solved = false;
        for (variable, value) in values {
            let Some(info) = self.program.variables().get(*variable) else { continue };
            if self.program.events.discrete.contains(&info.variable) {
                self.registers[info.variable.0 as usize] = *value;
            }
        }
    }

    pub(super) fn load(&mut self, t: f64, y: &[f64]) {
        self.loops.is_solved = false;
        self.registers[0] = t;
        let registers = &mut self.registers[..];
        for (variable, value) in self.program.continuous.unknowns.iter().zip(y) {
            registers[variable.0 as usize] = *value;
        }
        if !self.delays.histories.is_empty() {
            self.load_delayed(t);
        }
        self.load_transported(t, false);
        if self.sensitivity.is_some() {
            self.load_derivatives(y);
        }
    }

    /// Number of iteration variables that the integrator holds.
    pub(super) fn n_held_iteration(&self) -> usize {
        if self.loops.solves_loops { 0 } else { self.program.continuous.iteration.len() }
    }

    /// Whether loops are solved inside, and there are some.
    fn has_inner_loops(&self) -> bool {
        self.loops.solves_loops && !self.program.continuous.iteration.is_empty()
    }

    /// Loads y, and solves for the iteration variables that it does not hold.
    fn load_solved(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        if self.has_inner_loops() {
            return self.load_with_loops(t, y);
        }
        self.load(t, y);
        Ok(())
    }

    /// Loads y, and solves for all iteration variables, unless the registers hold the solution there: what is
    /// asked at a point is asked one thing after the other.
    pub(super) fn load_with_loops(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        if self.loops.is_solved && self.is_loaded(t, y) {
            return Ok(());
        }
        self.load(t, y);
        self.solve(Stage::Continuous)?;
        self.agree_with_transported(t)?;
        self.note_solution(t, y);
        // What delays and pipes read at a point changes with what they record, derivatives with y.
        self.loops.is_solved = !self.has_past() && self.sensitivity.is_none();
        Ok(())
    }

    /// Whether the registers hold these bits.
    pub(super) fn is_loaded(&self, t: f64, y: &[f64]) -> bool {
        let is_held =
            |register: usize, value: f64| self.registers[register].to_bits() == value.to_bits();
        let mut unknowns = self.program.continuous.unknowns.iter().zip(y);
        is_held(0, t) && unknowns.all(|(variable, value)| is_held(variable.0 as usize, *value))
    }

    pub(super) fn unload(&self, y: &mut [f64]) {
        for (variable, value) in self.program.continuous.unknowns.iter().zip(y.iter_mut()) {
            *value = self.registers[variable.0 as usize];
        }
        if self.sensitivity.is_some() {
            self.unload_derivatives(y);
        }
    }

    /// A domain failure where an assertion does not hold is the assertion's.
    pub(super) fn refine(&mut self, failure: Failure) -> Failure {
        match failure {
            Failure::Domain { .. } | Failure::Function { .. } => self.violated().unwrap_or(failure),
            other => other,
        }
    }

    /// The first assertion that does not hold, of those that can be evaluated.
    fn violated(&mut self) -> Option<Failure> {
        let mut failures =
            (0..self.program.assertions.each.len()).filter_map(|at| self.assert(at).err());
        failures.find(|failure| matches!(failure, Failure::Assertion { .. }))
    }

    /// Evaluates all assertions, one by one where they do not all hold.
    pub(super) fn assert_all(&mut self) -> Result<(), Failure> {
        let Assertions { each, conditions } = &self.program.assertions;
        let n = each.len();
        let mut hold = std::mem::take(&mut self.messages.hold);
        hold.resize(n, 0.0);
        let are_known = read(conditions, &mut self.registers, &mut hold).is_ok();
        let all_hold = are_known && hold.iter().all(|condition| *condition != 0.0);
        self.messages.hold = hold;
        if all_hold { Ok(()) } else { (0..n).try_for_each(|at| self.assert(at)) }
    }

    /// Evaluates an assertion.
    fn assert(&mut self, at: usize) -> Result<(), Failure> {
        let assertion = &self.program.assertions.each[at];
        let mut holds = [0.0];
        read(&assertion.condition, &mut self.registers, &mut holds)?;
        if holds != [0.0] {
            return Ok(());
        }
        let program = self.program.clone();
        let LogAssertion { assertion, values, .. } = &program.assertions.each[at];
        Err(self.failed_assertion(*assertion, values))
    }

    /// Whether a value is a number; it need not be where a parameter has no value.
    fn is_a_number(&self, value: f64) -> Result<(), Failure> {
        match &self.messages.lacking {
            Some(failure) if value.is_nan() => Err(*failure),
            _ => Ok(()),
        }
    }

    /// Whether a parameter is finite; it need not be a number where another one has no value.
    fn is_finite(&self, parameter: VarId) -> Result<(), Failure> {
        let value = self.registers[parameter.0 as usize];
        self.is_a_number(value)?;
        if value.is_finite() || (value.is_nan() && self.messages.lacking.is_some()) {
            return Ok(());
        }
        let origin = number_of_equations(&self.program.sorted) as u32 + parameter.0;
        Err(Failure::Domain { origin, operation: Operation::OTHER })
    }

    /// Computes all parameters from those that are set.
    ///
    /// # Errors
    /// One of them cannot be computed.
    pub fn evaluate_parameters(&mut self) -> Result<(), Failure> {
        let program = self.program.clone();
        self.messages.lacking = None;
        self.loops.at_event.time = f64::NAN;
        self.registers.calls.restart();
        let solvers = self.loops.initial_solvers.iter_mut().chain(&mut self.loops.solvers);
        solvers.chain(&mut self.loops.event_solvers).for_each(LoopSolver::forget);
        let mut tunable = 0;
        // Slots of set values first: tapes run in order of dependence, not of declaration.
        let mut given: Vec<(VarId, f64)> = Vec::new();
        for (info, set) in program.parameters().iter().zip(&self.set) {
            if let Some(value) = set {
                given.push((info.variable, *value));
                tunable += 1;
            }
        }
        for (parameter, tape) in &program.values.parameter_tapes {
            let set = match tunable {
                0 => None,
                _ => given.iter().find(|(v, _)| v == parameter),
            };
            match set {
                Some((_, value)) => self.registers[parameter.0 as usize] = *value,
                None => match run_parameter(*parameter, tape, &mut self.registers)? {
                    Some(failure) => self.messages.lacking = Some(failure),
                    None => self.is_finite(*parameter)?,
                },
            }
        }
        run_strictly(&program.registers.hoisted.tape, &mut self.registers)?;
        run(&program.switching.time_rests, &mut self.registers)?;
        for (at, relation) in program.switching.relations.iter().enumerate() {
            let time = relation
                .time
                .filter(|_| !relation.is_rescheduled)
                .map(|(factor, rest)| -self.registers[rest as usize] / factor);
            self.set_switch(at, time);
        }
        Ok(())
    }

    /// With the default parameters, so that no run depends on those before it: the attribute
    /// `nominal`, else the start value, else 1.
    fn evaluate_nominals(&mut self) {
        let program = self.program.clone();
        let tapes = program.values.parameter_tapes.iter().chain(&program.values.starts);
        for (variable, tape) in tapes {
            if tape.run(&mut self.registers).is_err() {
                self.registers[variable.0 as usize] = 1.0;
            }
        }
        for (at, variable) in program.continuous.unknowns.iter().enumerate() {
            self.nominal[at] = self.nominal_of(*variable);
        }
        self.loops.initial_solvers = self.solvers_of(&program.initial_steps);
        self.loops.solvers = self.solvers_of(&program.steps);
        self.loops.event_solvers = self.solvers_of(&program.events.steps);
        for selection in &program.selections {
            let candidates = selection.candidates.iter();
            let nominal = candidates.map(|c| self.nominal_of(VarId(*c))).collect();
            self.loops.choices.push(Choice::new(selection, nominal));
        }
    }

    fn solvers_of(&mut self, steps: &[Step]) -> Vec<LoopSolver> {
        let loops = steps.iter().filter_map(|step| match step {
            Step::Solve(torn) => Some(torn),
            Step::Run(_) => None,
        });
        loops
            .map(|torn| {
                let unknowns = torn.unknowns.iter();
                let nominal = unknowns.map(|u| self.nominal_of(VarId(*u))).collect();
                LoopSolver::new(nominal, torn)
            })
            .collect()
    }

    fn nominal_of(&mut self, variable: VarId) -> f64 {
        let program = self.program.clone();
        // They are in the order of the variables.
        let known = program.values.nominals.binary_search_by_key(&variable, |(v, ..)| *v);
        let value = match known.ok().map(|at| &program.values.nominals[at]) {
            Some((_, tape, register)) => match tape.run(&mut self.registers) {
                Ok(()) => self.registers[*register as usize],
                Err(_) => 1.0,
            },
            None => self.registers[variable.0 as usize],
        };
        let usable = value.is_finite() && value != 0.0;
        if usable { value.abs() } else { 1.0 }
    }

    /// Solves the blocks of a stage one after another.
    pub(super) fn solve(&mut self, stage: Stage) -> Result<(), Failure> {
        self.loops.is_solved = false;
        let program = self.program.clone();
        let (steps, solvers) = match stage {
            Stage::Initial => (&program.initial_steps, &mut self.loops.initial_solvers),
            Stage::Event if !program.events.steps.is_empty() => {
                (&program.events.steps, &mut self.loops.event_solvers)
            }
            Stage::Event | Stage::Continuous => (&program.steps, &mut self.loops.solvers),
        };
        let initial = stage == Stage::Initial;
        if initial && self.messages.log.is_some() {
            self.registers.forget_solutions();
        }
        let may_jump = stage != Stage::Continuous || program.sorted.states.is_empty();
        let attempts = Attempts { initial, may_jump, is_brief: initial && self.loops.is_brief };
        let mut solvers = solvers.iter_mut();
        for step in steps {
            match step {
                Step::Run(code) => run_assignments(code, &mut self.registers)?,
                Step::Solve(torn) => {
                    let solver = solvers.next().expect("every loop has its solver");
                    solver.solve(torn, &mut self.registers, attempts).map_err(|f| {
                        match (f, initial) {
                            (Failure::Newton { block } | Failure::Singular { block }, true) => {
                                Failure::Initialization { block }
                            }
                            _ => f,
                        }
                    })?
                }
            }
        }
        Ok(())
    }

    /// Everything as it is before the initial system is solved.
    pub(super) fn take_start_values(&mut self, t: f64) -> Result<(), Failure> {
        self.loops.is_solved = false;
        let program = self.program.clone();
        self.registers[0] = t;
        for variable in program.observed.iter().chain(&program.values.solved) {
            self.registers[variable.0 as usize] = 0.0;
        }
        for relation in &program.switching.relations {
            self.registers[relation.register as usize] = 0.0;
        }
        self.evaluate_parameters()?;
        for (_, tape) in &program.values.starts {
            run(tape, &mut self.registers)?;
        }
        self.prefer_present_values();
        self.take_start_values_of_events();
        self.start_recordings(t);
        self.relations.has_changed.fill(false);
        self.relations.held.fill(false);
        self.relations.is_idle.fill(false);
        self.relations.uncertainty.fill(0.0);
        self.relations.tolerated.fill(0.0);
        self.update_relations(t, Change::All);
        self.relations.has_changed.fill(false);
        for (choice, selection) in self.loops.choices.iter_mut().zip(&program.selections) {
            choice.reset(selection, &mut self.registers);
        }
        Ok(())
    }

    /// Chooses better states where those at hand come to their end; whether it did.
    pub(super) fn improve_choices(&mut self) -> Result<bool, Failure> {
        let mut improved = false;
        for (choice, selection) in self.loops.choices.iter_mut().zip(&self.program.selections) {
            improved |= choice.improve(selection, &mut self.registers)?;
        }
        Ok(improved)
    }
}

impl Residual for System {
    fn begin(&mut self) {
        self.restore_program();
    }

    fn n_differential(&self) -> usize {
        self.program.sorted.states.len()
    }

    fn n_algebraic(&self) -> usize {
        self.n_held_iteration()
    }

    fn n_auxiliary(&self) -> usize {
        if self.loops.solves_loops { 0 } else { self.program.continuous.n_auxiliary }
    }

    fn solve_loops(&mut self, inside: bool) {
        self.loops.solves_loops = inside;
    }

    fn nominal(&self, out: &mut [f64]) {
        out.copy_from_slice(&self.nominal[..out.len()]);
    }

    fn rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.load_solved(t, y)?;
        read(&self.program.continuous.rhs, &mut self.registers, out).map_err(|f| self.refine(f))
    }

    fn pattern(&self) -> &Pattern {
        if !self.has_inner_loops() {
            return &self.program.continuous.pattern;
        }
        self.loops.full_pattern.get_or_init(|| Pattern::full(self.n_differential()))
    }

    fn jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        if self.has_inner_loops() {
            return self.difference_jacobian(t, y, values);
        }
        self.load(t, y);
        match read(&self.program.continuous.jacobian, &mut self.registers, values) {
            // A derivative may have no value where the right-hand side has one.
            Err(Failure::Domain { .. }) if self.sensitivity.is_none() => {
                self.difference_jacobian(t, y, values)
            }
            other => other,
        }
    }

    fn linearity(&self) -> Option<Linearity> {
        let program = &self.program;
        if !program.selections.is_empty() || self.has_past() {
            return None;
        }
        let has_assertions =
            !program.assertions.each.is_empty() || !program.log_assertions.is_empty();
        let is_watched = has_assertions || self.n_crossings() > 0;
        program.continuous.linearity.map(|linearity| Linearity { is_watched, ..linearity })
    }

    fn initialize(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        self.relations.postponed.fill(false);
        self.relations.is_at_start = true;
        let done = self.solve_for_start(t, y);
        self.loops.is_solved = false;
        done?;
        self.take_given_start(t, y)
    }

    fn finish(&mut self, t: f64, y: &mut [f64]) -> Result<bool, Failure> {
        let Some(terminal) = self.program.events.terminal else { return Ok(false) };
        self.load(t, y);
        self.final_event(t, terminal)?;
        self.unload(y);
        // Continuous variables may depend on `terminal()`, too.
        Ok(true)
    }

    fn check(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        let tells = self.messages.log.is_some() && !self.program.log_assertions.is_empty();
        if self.program.assertions.each.is_empty() && !tells {
            return Ok(());
        }
        self.load_solved(t, y)?;
        self.assert_all()?;
        self.log_assertions(t)
    }

    fn n_observed(&self) -> usize {
        if let Some(sensitivity) = &self.sensitivity {
            return sensitivity.code.observe.outputs.len();
        }
        self.outputs.observed.as_ref().unwrap_or(&self.program.observe).outputs.len()
    }

    fn observe(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.load_solved(t, y)?;
        if self.loops.solves_loops {
            self.differentiate_algebraic()?;
        }
        if let Some(sensitivity) = &self.sensitivity {
            let code = &sensitivity.code.observe;
            return read(code, &mut self.registers, out).map_err(|f| self.refine(f));
        }
        if self.messages.log.is_some() {
            self.registers.forget_solutions();
        }
        let observed = self.outputs.observed.as_ref().unwrap_or(&self.program.observe);
        if let Err(failure) = read(observed, &mut self.registers, out) {
            let failure = self.refine(failure);
            self.observe_others(t, failure, out)?;
        }
        out.iter().try_for_each(|value| self.is_a_number(*value))?;
        self.note_open(t);
        Ok(())
    }
}

impl Sensitive for System {
    fn n_directions(&self) -> usize {
        self.sensitivity.as_ref().map_or(0, |sensitivity| sensitivity.code.n_directions())
    }

    fn directions(&self, out: &mut [f64]) {
        self.magnitudes_of_parameters(out);
    }

    fn sensitivity_rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.load(t, y);
        self.right_sides_along(out).map_err(|f| self.refine(f))
    }
}

impl Events for System {
    fn sample_distance(&self, start: f64, stop: f64) -> Option<f64> {
        self.distance_of_knots(start, stop)
    }

    fn has_event_at_start(&self) -> bool {
        self.relations.is_at_start && self.changes_after(self.registers[0])
    }

    fn n_crossings(&self) -> usize {
        self.program.n_crossings()
            + self.loops.choices.len()
            + 2 * self.program.events.transports.len()
    }

    fn crossings_vary_in_time(&self) -> bool {
        self.program.switching.crossings_vary_in_time
    }

    fn oscillation(&mut self, t: f64) -> f64 {
        let program = self.program.clone();
        let rates = &program.switching.oscillations;
        self.registers[0] = t;
        if rates.outputs.is_empty() || rates.tape.run(&mut self.registers).is_err() {
            return 0.0;
        }
        let rates = rates.outputs.iter().map(|rate| self.registers[*rate as usize].abs());
        rates.filter(|rate| rate.is_finite()).fold(0.0, f64::max)
    }

    fn crossings(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
        self.load_solved(t, y)?;
        let (first, others) = out.split_at_mut(self.program.n_crossings());
        let (last, transported) = others.split_at_mut(self.loops.choices.len());
        self.relation_crossings(first)?;
        self.transported_crossings(t, transported)?;
        for ((choice, selection), out) in
            self.loops.choices.iter_mut().zip(&self.program.selections).zip(last)
        {
            *out = choice.quality(selection, &mut self.registers)?;
        }
        Ok(())
    }

    fn crossings_among(
        &mut self,
        t: f64,
        y: &[f64],
        which: &[usize],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        if self.program.switching.crossing_parts.is_empty() {
            return self.crossings(t, y, out);
        }
        self.load_solved(t, y)?;
        match self.relation_crossings_among(which, out) {
            Some(computed) => computed,
            None => self.crossings(t, y, out),
        }
    }

    fn next_time_event(&self, t: f64) -> Option<f64> {
        let later = |time: &f64| *time > t && !same_time(*time, t);
        let all = self
            .relations
            .switches
            .iter()
            .flatten()
            .copied()
            .chain(self.scheduled())
            .chain(self.next_knots())
            .chain(self.arriving_jumps());
        all.filter(later).min_by(f64::total_cmp)
    }

    fn handle_event(&mut self, t: f64, y: &mut [f64]) -> Result<EventOutcome, Failure> {
        let done = self.pass_event(t, y);
        self.loops.is_solved = false;
        done
    }

    fn keep_relations(&mut self, crossings: &[(usize, f64)]) {
        self.keep_relations_of(crossings);
    }

    fn remembers(&self) -> bool {
        self.has_past()
    }

    fn remember(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.load_solved(t, y)?;
        self.remember_values(t).map_err(|f| self.refine(f))?;
        self.record_transported(t).map_err(|f| self.refine(f))
    }

    fn has_kinks(&self) -> bool {
        self.program.differences().is_some() || self.program.has_kinks()
    }

    fn longest_step(&self) -> f64 {
        self.delays.delay_times.iter().copied().fold(self.longest_transport(), f64::min)
    }

    fn set_uncertainty(&mut self, crossings: &[f64]) {
        self.keep_uncertainty(crossings);
    }

    fn crossed(&mut self, crossing: Option<usize>, span: f64) {
        self.note_cause(crossing, span);
    }
}

impl System {
    /// Handles the event at (t, y).
    fn pass_event(&mut self, t: f64, y: &mut [f64]) -> Result<EventOutcome, Failure> {
        if self.program.acts_by_recordings_alone() {
            self.relations.is_at_start = false;
            self.registers.calls.next_instant();
            return Ok(EventOutcome::Continue { y_changed: self.advance_recordings(t) });
        }
        self.load(t, y);
        self.relations.is_at_start = false;
        self.registers.calls.next_instant();
        self.relations.has_changed.fill(false);
        self.relations.has_effect = false;
        self.enter_event(t)?;
        let mut outcome = self.event(t)?;
        self.note_idle_relations();
        if self.improve_choices()? {
            outcome = either(outcome, EventOutcome::Continue { y_changed: true });
        }
        self.leave_event(outcome)?;
        self.prefer_present_values();
        self.note_open(t);
        self.reschedule();
        self.unload(y);
        Ok(outcome)
    }
}

impl Modes for System {
    fn prepare_modes(&mut self, t: f64, y: &[f64], sides: &[Side]) -> Result<bool, Failure> {
        self.load(t, y);
        self.compute_modes(sides)
    }

    fn enter_mode(&mut self, mode: usize) {
        self.load_mode(mode);
    }

    fn can_follow(&self, crossing: usize) -> bool {
        self.is_memoryless(crossing)
    }

    fn can_follow_now(&self, crossing: usize) -> bool {
        self.is_memoryless(crossing) || self.is_idle_now(crossing)
    }

    fn is_of_loop(&self, crossing: usize) -> bool {
        self.is_in_loop(crossing)
    }

    fn follow(&mut self, t: f64, y: &[f64], sides: &[(usize, bool)]) -> Result<bool, Failure> {
        self.load(t, y);
        self.change_sides(sides)
    }

    fn literal_relations(&mut self, t: f64, y: &[f64], out: &mut Vec<f64>) -> Result<(), Failure> {
        self.load_solved(t, y)?;
        self.literal_differences(out)
    }

    fn give_events(&mut self, t: f64, y: &[f64]) -> Result<bool, Failure> {
        self.load_solved(t, y)?;
        self.solve(Stage::Continuous)?;
        self.replace_program(t)
    }

    fn has_means(&self, observed: usize) -> bool {
        self.outputs.has_means.get(observed).is_none_or(|has| *has)
    }

    fn note_treatment(&mut self, t: f64, crossing: usize, treatment: Treatment) {
        self.note_treated(t, crossing, treatment);
    }
}
