//! One running instance of a program: its registers, parameter values and frozen relations.

use super::execution::run_assignments;
use super::instants::Stage;
use super::newton::{Attempts, LoopSolver};
use super::partial_observation::OtherVariables;
use super::recordings::RecordedInputs;
use super::sensitivity_state::Sensitivity;
use super::state::{
    DelayState, EventState, GivenStart, LoopState, MessageState, OutputState, RelationState,
};
use super::state_selection::Choice;
use crate::codegen::code::Step;
use crate::codegen::memory::Memory;
use crate::codegen::program::Program;
use crate::codegen::sequence::{expressions, observing};
use crate::sim::Failure;
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
    pub(super) nominal: Vec<f64>,
    /// Derivatives that are carried along, if any are.
    pub(super) sensitivity: Option<Box<Sensitivity>>,
    pub(super) relations: RelationState,
    /// Its relations inside `noEvent`.
    pub(super) literal: LiteralRelations,
    pub(super) loops: LoopState,
    pub(super) delays: DelayState,
    pub(super) events: EventState,
    pub(super) inputs: RecordedInputs,
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
            inputs: RecordedInputs::new(&program),
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

    /// Restricts what is observed to these variables (positions in [`Program::variables`]), one column
    /// each in this order, and computes nothing that they do not need.
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

    /// Number of iteration variables that the integrator holds.
    pub(super) fn n_held_iteration(&self) -> usize {
        if self.loops.solves_loops { 0 } else { self.program.continuous.iteration.len() }
    }

    /// Gives a recorded input, by its number from [`Program::recorded_input`], a value that holds from the
    /// next event, or the start, until another one is given. It has one sample.
    pub fn set_recorded(&mut self, input: u32, value: f64) {
        self.loops.is_solved = false;
        self.inputs.give(&mut self.registers, input, value);
    }

    /// Whether delays read at `t` what has been recorded.
    pub fn knows_past(&self, t: f64) -> bool {
        self.delays.knows_past(t)
    }

    /// Whether loops are solved inside, and there are some.
    pub(super) fn has_inner_loops(&self) -> bool {
        self.loops.solves_loops && !self.program.continuous.iteration.is_empty()
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

    /// Chooses better states where those at hand come to their end; whether it did.
    pub(super) fn improve_choices(&mut self) -> Result<bool, Failure> {
        let mut improved = false;
        for (choice, selection) in self.loops.choices.iter_mut().zip(&self.program.selections) {
            improved |= choice.improve(selection, &mut self.registers)?;
        }
        Ok(improved)
    }

    /// Takes events of relations inside `noEvent` back: every simulation begins without.
    pub(super) fn restore_program(&mut self) {
        let Some(plain) = self.literal.plain.take() else { return };
        let changed = std::mem::replace(self, *plain);
        self.take_settings(changed);
    }

    /// What was asked of a system since its simulation began.
    fn take_settings(&mut self, changed: System) {
        self.set = changed.set;
        self.messages.log = changed.messages.log;
    }
}
