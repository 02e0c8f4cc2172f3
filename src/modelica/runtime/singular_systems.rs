//! Systems that are structurally regular and yet singular: equations that depend on each other leave
//! unknowns open. They are reported to the listener of a simulation, once for each loop. Of the
//! solutions of a linear system that is taken which is nearest to the values after the event before, at
//! first to the start values: where no fluid flows, its temperature is not 0 K.

use super::simulation_log::OpenLoop;
use super::system::System;
use crate::causalize::{Block, LinearLoop, Loop};
use crate::codegen::code::{CompiledLoop, Step};
use crate::codegen::memory::Memory;
use crate::codegen::program::Program;
use crate::source::Span;
use crate::symbolic::{Node, VarId};
use std::collections::BTreeMap;

/// More names are counted only.
const MOST_NAMES: usize = 6;

/// Unknowns that equations which depend on each other do not determine.
#[derive(Debug, Clone, PartialEq)]
pub struct Undetermined {
    /// When that was so first, seconds.
    pub time: f64,
    /// Their names, each in backquotes.
    pub names: Vec<String>,
    /// How many more there are.
    pub omitted: usize,
    /// Whether they are those of a linear system: of its solutions the nearest was taken.
    pub is_linear: bool,
    /// Where one of the equations is written.
    pub span: Span,
}

impl Undetermined {
    /// Whether it names the same unknowns, in any order.
    fn names_the_same(&self, other: &Undetermined) -> bool {
        let same = self.names.len() == other.names.len() && self.omitted == other.omitted;
        same && self.names.iter().all(|name| other.names.contains(name))
    }
}

/// The torn loops among steps, in order.
pub(super) fn loops_of(steps: &[Step]) -> impl Iterator<Item = &CompiledLoop> {
    steps.iter().filter_map(|step| match step {
        Step::Solve(torn) => Some(torn),
        Step::Run(_) => None,
    })
}

impl System {
    /// From here on, one of many solutions of a linear system is that nearest to the present values.
    pub(super) fn prefer_present_values(&mut self) {
        let Memory { registers, systems, .. } = &mut self.registers;
        for (system, unknowns) in &self.loops.linear {
            systems[*system as usize].prefer(unknowns.iter().map(|v| registers[v.0 as usize]));
        }
    }

    /// Notes linear systems and torn loops that had many solutions in the evaluation before.
    pub(super) fn note_open(&mut self, t: f64) {
        let Some(log) = &mut self.messages.log else { return };
        for (system, solved) in (0..).zip(&self.registers.systems) {
            let places = solved.open_unknowns();
            if !places.is_empty() {
                log.note_open(t, OpenLoop::Linear { system, places });
            }
        }
        let between = loops_of(&self.program.steps).zip(&self.loops.solvers);
        let at_events = loops_of(&self.program.events.steps).zip(&self.loops.event_solvers);
        for (torn, solver) in between.chain(at_events) {
            if solver.is_singular {
                log.note_open(t, OpenLoop::Later { block: torn.block });
            }
        }
    }

    /// As [`System::note_open`], for the initial system with its torn loops.
    pub(super) fn note_open_at_start(&mut self, t: f64) {
        self.note_open(t);
        let Some(log) = &mut self.messages.log else { return };
        for (torn, solver) in loops_of(&self.program.initial_steps).zip(&self.loops.initial_solvers)
        {
            if solver.is_singular {
                log.note_open(t, OpenLoop::Initial { block: torn.block });
            }
        }
    }

    /// What the equations did not determine in the last simulation, if there was a listener.
    pub fn undetermined(&self) -> Vec<Undetermined> {
        let Some(log) = &self.messages.log else { return Vec::new() };
        let mut found: Vec<Undetermined> = Vec::new();
        for open in &log.open {
            let of = match &open.what {
                OpenLoop::Linear { system, places } => {
                    self.program.open_linear(*system, places, open.time)
                }
                OpenLoop::Initial { block } => {
                    let blocks = &self.program.sorted.initial_blocks;
                    self.program.open_loop(blocks.get(*block as usize), open.time)
                }
                OpenLoop::Later { block } => {
                    let sorted = &self.program.sorted;
                    let mut blocks = sorted.blocks.iter().chain(&sorted.event_blocks);
                    self.program.open_loop(blocks.nth(*block as usize), open.time)
                }
            };
            // The initial system and the others may have the same loop.
            found.extend(of.filter(|of| !found.iter().any(|known| known.names_the_same(of))));
        }
        found
    }
}

impl Program {
    /// All linear loops that are solved in workspaces, with the numbers of these.
    fn linear_loops(&self) -> impl Iterator<Item = (u32, &LinearLoop)> {
        let sorted = &self.sorted;
        let blocks = sorted.blocks.iter().chain(&sorted.event_blocks).chain(&sorted.initial_blocks);
        blocks.filter_map(|block| match block {
            Block::Linear(solved) => Some((self.workspace_of(solved)?, solved)),
            Block::Assignment(_) | Block::Loop(_) => None,
        })
    }

    /// The unknowns of linear systems, by their workspaces; not those of loops that share one, as
    /// equal components may.
    pub(super) fn linear_unknowns(&self) -> Vec<(u32, Vec<VarId>)> {
        let mut unknowns: BTreeMap<u32, Option<&[VarId]>> = BTreeMap::new();
        for (system, solved) in self.linear_loops() {
            let known = unknowns.entry(system).or_insert(Some(&solved.unknowns));
            *known = known.filter(|known| *known == solved.unknowns);
        }
        unknowns.into_iter().filter_map(|(system, of)| Some((system, of?.to_vec()))).collect()
    }

    /// The unknowns of the linear loops that are solved in a workspace; `None` where that is a
    /// derivative of loops only.
    fn open_linear(&self, system: u32, places: &[usize], time: f64) -> Option<Undetermined> {
        let loops = self.linear_loops().filter(|(workspace, _)| *workspace == system);
        let loops: Vec<&LinearLoop> = loops.map(|(_, solved)| solved).collect();
        let mut names: Vec<String> = Vec::new();
        for solved in &loops {
            for variable in self.open_variables(solved, places) {
                let name = format!("`{}`", self.sorted.dae.variable(variable).name);
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        let equation = loops.first()?.assignments.first()?.equation;
        Some(self.undetermined(time, names, equation, true))
    }

    /// The unknowns of a linear loop that its equations leave open, with what follows from these in
    /// the loop.
    fn open_variables(&self, solved: &LinearLoop, places: &[usize]) -> Vec<VarId> {
        let mut open: Vec<VarId> =
            places.iter().filter_map(|at| solved.unknowns.get(*at)).copied().collect();
        for assignment in &solved.assignments {
            let depends = |v| open.contains(&v);
            if !solved.unknowns.contains(&assignment.variable)
                && self.sorted.dae.pool.any_variable(assignment.value, depends)
            {
                open.push(assignment.variable);
            }
        }
        open
    }

    /// The workspace in which a linear loop is solved.
    fn workspace_of(&self, solved: &LinearLoop) -> Option<u32> {
        let assignment = solved.assignments.first()?;
        match self.sorted.dae.pool.node(assignment.value) {
            Node::Solution { matrix, .. } => self.registers.workspace_of(*matrix),
            _ => None,
        }
    }

    fn open_loop(&self, block: Option<&Block>, time: f64) -> Option<Undetermined> {
        let Some(Block::Loop(Loop { iteration, residuals, .. })) = block else { return None };
        let names = iteration.iter().map(|v| format!("`{}`", self.sorted.dae.variable(*v).name));
        Some(self.undetermined(time, names.collect(), residuals.first()?.1, false))
    }

    fn undetermined(
        &self,
        time: f64,
        mut names: Vec<String>,
        equation: usize,
        is_linear: bool,
    ) -> Undetermined {
        let omitted = names.len().saturating_sub(MOST_NAMES);
        names.truncate(MOST_NAMES);
        Undetermined { time, names, omitted, is_linear, span: self.place(equation as u32) }
    }
}
