//! The steps in which a generation is explained.

use super::event::ScriptLine;
use super::generation::{Generation, Origin, Part, mate};
use super::operation::OperationKind;

/// One step of a generation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// The first population is drawn at random.
    Draw,
    /// All individuals are simulated.
    Simulate,
    /// Simulation and measurement are compared.
    Rate,
    /// The individuals are sorted by fitness.
    Sort,
    /// The elites pass on.
    Elite,
    /// The parents of two adjacent ranks have children: the rank of the first, from 0.
    Cross(usize),
    /// The random numbers decide about the genes of one child: its row, from 0, elites included.
    Mutate(usize),
    /// A random individual completes the next generation: its row there, from 0.
    Complete(usize),
    /// The next generation stands.
    Renew,
    /// The run ends with this generation.
    Stop,
    /// An operator is called by name.
    Operate {
        /// Which of the calls of the generation, from 0.
        call: usize,
        /// What kind of operator it is.
        kind: OperationKind,
        /// The first of the rows that the step is about, from 0.
        row: usize,
    },
}

/// The parts of a generation that a learner can skip as a whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Phase {
    /// The initial draw.
    Drawing,
    /// Simulation and fitness.
    Judging,
    /// Sorting and elites.
    Selecting,
    /// Crossover.
    Crossing,
    /// Mutation.
    Mutating,
    /// Random completion, and the next generation or the end.
    Renewing,
}

impl Step {
    /// Which part of the generation the step belongs to.
    pub fn phase(self) -> Phase {
        match self {
            Step::Draw => Phase::Drawing,
            Step::Simulate | Step::Rate => Phase::Judging,
            Step::Sort | Step::Elite => Phase::Selecting,
            Step::Cross(_) => Phase::Crossing,
            Step::Mutate(_) => Phase::Mutating,
            Step::Complete(_) | Step::Renew | Step::Stop => Phase::Renewing,
            Step::Operate { kind, .. } => match kind {
                OperationKind::Sampling => Phase::Drawing,
                OperationKind::Selection => Phase::Selecting,
                OperationKind::Crossover => Phase::Crossing,
                OperationKind::Mutation => Phase::Mutating,
                OperationKind::Survival => Phase::Renewing,
            },
        }
    }

    /// The script line of the step, where one is known.
    pub fn place(self, generation: &Generation, next: Option<&Generation>) -> Option<ScriptLine> {
        let sorted = generation.sorted.as_ref().map(|sorted| sorted.place);
        let crossed = generation.crossed.as_ref().map(|crossed| crossed.place);
        let mutated = generation.mutated.as_ref().map(|mutated| mutated.place);
        match self {
            Step::Draw => generation.drawn.last().map(|drawn| drawn.place),
            Step::Simulate => Some(generation.simulated),
            Step::Rate => generation.rated.or(sorted),
            Step::Sort => sorted,
            Step::Elite | Step::Cross(_) => crossed,
            Step::Mutate(_) => mutated,
            Step::Complete(_) => next.and_then(|next| next.drawn.last()).map(|drawn| drawn.place),
            Step::Renew | Step::Stop => {
                let simulated = (!generation.is_call).then_some(generation.simulated);
                sorted.or(generation.rated).or(simulated)
            }
            Step::Operate { call, .. } => {
                generation.operations.get(call).map(|called| called.operation.place)
            }
        }
    }
}

/// The steps of `generation`, which `next` follows.
pub(crate) fn steps(generation: &Generation, next: Option<&Generation>) -> Vec<Step> {
    let mut steps = operated(generation, Part::Opening);
    steps.extend(generation.is_drawn().then_some(Step::Draw));
    if !generation.is_call {
        steps.push(Step::Simulate);
        steps.extend((!generation.fitness.is_empty()).then_some(Step::Rate));
    }
    steps.extend(operated(generation, Part::Simulated));
    if generation.sorted.is_some() {
        steps.push(Step::Sort);
    }
    steps.extend(operated(generation, Part::Sorted));
    if let Some(crossed) = &generation.crossed {
        steps.extend((crossed.elites > 0).then_some(Step::Elite));
        let begins_pair = |rank: &usize| mate(*rank, crossed.parents) != rank.wrapping_sub(1);
        steps.extend((0..crossed.parents).filter(begins_pair).map(Step::Cross));
    }
    steps.extend(operated(generation, Part::Crossed));
    if let Some(mutated) = &generation.mutated {
        let rows = mutated.before.len() / generation.n_genes.max(1);
        steps.extend((mutated.elites..rows).map(Step::Mutate));
    }
    steps.extend(operated(generation, Part::Mutated));
    end(generation, next, &mut steps);
    steps
}

/// The calls of operators by name in a part of a generation.
fn operated(generation: &Generation, part: Part) -> Vec<Step> {
    let calls = generation.operations.iter().enumerate();
    let calls = calls.filter(|(_, called)| called.part == part);
    let rows = calls.flat_map(|(call, called)| {
        let kind = called.operation.kind();
        called.operation.rows_of_steps().into_iter().map(move |row| Step::Operate {
            call,
            kind,
            row,
        })
    });
    rows.collect()
}

/// How a generation ends: with the next one, or with the run.
fn end(generation: &Generation, next: Option<&Generation>, steps: &mut Vec<Step>) {
    match next {
        // Calls end with what they do; one that does nothing has this step all the same.
        _ if generation.is_call && !next.is_some_and(Generation::has_parents) => {
            steps.extend(steps.is_empty().then_some(Step::Stop));
        }
        None => steps.push(Step::Stop),
        Some(_) if generation.is_evaluation => {}
        Some(next) => {
            let completes = next.has_parents();
            let random = |k: &usize| completes && next.origins[*k] == Origin::Random;
            steps.extend((0..next.len()).filter(random).map(Step::Complete));
            steps.push(Step::Renew);
        }
    }
}
