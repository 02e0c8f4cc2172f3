//! The steps in which a generation is explained.

use super::event::Place;
use super::generation::{Generation, Origin, mate};
use super::operation::Kind;

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
    /// An operator is called by name: the first of the rows that the step is about, from 0.
    Operate(Kind, usize),
}

/// The parts of a generation that a learner may want to skip as a whole.
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
            Step::Operate(kind, _) => match kind {
                Kind::Sampling => Phase::Drawing,
                Kind::Selection => Phase::Selecting,
                Kind::Crossover => Phase::Crossing,
                Kind::Mutation => Phase::Mutating,
                Kind::Survival => Phase::Renewing,
            },
        }
    }

    /// The script line behind the step, where one is known.
    pub fn place(self, generation: &Generation, next: Option<&Generation>) -> Option<Place> {
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
            Step::Renew | Step::Stop => sorted.or(generation.rated),
            Step::Operate(..) => generation.operation.as_ref().map(|operation| operation.place),
        }
    }
}

/// The steps of `generation` number `number`, which `next` follows.
pub fn steps(number: usize, generation: &Generation, next: Option<&Generation>) -> Vec<Step> {
    if let Some(operation) = &generation.operation {
        let rows = operation.rows_of_steps().into_iter();
        return rows.map(|row| Step::Operate(operation.kind(), row)).collect();
    }
    let mut steps = Vec::new();
    if number == 0 && !generation.drawn.is_empty() && !generation.is_call {
        steps.push(Step::Draw);
    }
    if !generation.is_call {
        steps.push(Step::Simulate);
        steps.extend((!generation.fitness.is_empty()).then_some(Step::Rate));
    }
    if generation.sorted.is_some() {
        steps.push(Step::Sort);
    }
    if let Some(crossed) = &generation.crossed {
        steps.extend((crossed.elites > 0).then_some(Step::Elite));
        let begins_pair = |rank: &usize| mate(*rank, crossed.parents) != rank.wrapping_sub(1);
        steps.extend((0..crossed.parents).filter(begins_pair).map(Step::Cross));
    }
    if let Some(mutated) = &generation.mutated {
        let rows = mutated.before.len() / generation.n_genes.max(1);
        steps.extend((mutated.elites..rows).map(Step::Mutate));
    }
    match next {
        // Calls end with what they do; one that does nothing has this step all the same.
        _ if generation.is_call && !next.is_some_and(Generation::has_parents) => {
            steps.extend(steps.is_empty().then_some(Step::Stop));
        }
        None => steps.push(Step::Stop),
        Some(next) => {
            let random = |k: &usize| next.origins[*k] == Origin::Random;
            steps.extend((0..next.len()).filter(random).map(Step::Complete));
            steps.push(Step::Renew);
        }
    }
    steps
}
