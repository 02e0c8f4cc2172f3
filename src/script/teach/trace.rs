//! A trace that was read: the scripts, what is identified, and the generations.

use super::errors::BAD_TRACE;
use super::event::{Event, Genes, Numbers, Subject};
use super::file;
use super::generation::{Called, Crossed, Drawn, Generation, Mutated, Origin, Part, Sorted};
use super::operation::{Operation, OperationKind};
use super::produced::Produced;
use crate::bail;
use crate::diag::Fault;
use crate::ga::Mrg32k3a;

/// A script that the run has executed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Script {
    /// Its path as it was asked for.
    pub name: String,
    /// Its lines.
    pub lines: Vec<String>,
}

/// The trace of one run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trace {
    /// The scripts, as places count them.
    pub scripts: Vec<Script>,
    /// What is identified.
    pub subject: Subject,
    /// Measured X and Y; empty where none were read.
    pub measured: (Vec<f64>, Vec<f64>),
    /// The generations in order; there is at least one.
    pub generations: Vec<Generation>,
    /// Whether the file ends within an event, as an interrupted run leaves it.
    pub cut: bool,
    /// Whether the run continued after the trace had reached its largest size.
    pub full: bool,
}

impl Trace {
    /// Reads the bytes that a [`Tracer`](super::Tracer) gave.
    ///
    /// # Errors
    ///
    /// `bad-trace` when they are no trace, or no generation was recorded.
    pub fn read(bytes: &[u8]) -> Result<Trace, Fault> {
        let (events, whole) = file::read(bytes)?;
        let evolves = events.iter().any(makes_children);
        let mut reading = Reading { evolves, ..Reading::default() };
        events.into_iter().for_each(|event| reading.follow(event));
        let mut trace = reading.trace;
        trace.cut = !whole;
        if trace.generations.is_empty() {
            bail!(
                BAD_TRACE, "the trace contains no generation: no `Eval` and no operator was called";
                help: "`identify` is not recorded step by step: take a script that calls `Eval`, such as \
                       `scripts/GAPILib.mos`, or an operator such as `Cross` or `Op_Crossover`"
            );
        }
        if trace.subject.parameters.is_empty() {
            let most = trace.generations.iter().map(|g| g.n_genes).max().unwrap_or(0);
            trace.subject.parameters = (1..=most).map(|j| format!("gene {j}")).collect();
        }
        Ok(trace)
    }
}

#[derive(Default)]
struct Reading {
    trace: Trace,
    produced: Produced,
    /// Draws that no generation has used yet.
    drawn: Vec<Drawn>,
    /// Whether something was simulated.
    is_run: bool,
    /// Whether something selects, crosses or mutates individuals.
    evolves: bool,
}

/// Whether an event belongs to a genetic algorithm.
fn makes_children(event: &Event) -> bool {
    match event {
        Event::Sort { .. } | Event::Cross { .. } | Event::Mutate { .. } => true,
        Event::Operate(operation) => operation.kind() != OperationKind::Sampling,
        _ => false,
    }
}

impl Reading {
    fn follow(&mut self, event: Event) {
        // Only a damaged file has individuals without genes.
        if matches!(event, Event::Simulate { n_genes: 0, .. }) {
            return;
        }
        let begins = matches!(event, Event::Simulate { .. });
        self.produced.ended |= begins && !self.evolves && self.is_rated();
        self.is_run |= begins;
        if !self.is_run {
            self.begin_call(&event);
        }
        self.note(&event);
        self.produced.follow(&event);
        self.complete(&event);
    }

    /// Whether all that was simulated last has its fitness.
    fn is_rated(&self) -> bool {
        let last = self.trace.generations.last();
        last.is_some_and(|last| last.rated.is_some() && last.fitness.len() >= last.len())
    }

    /// Notes a call of an operator by name: in the generation at hand, or alone where nothing was
    /// simulated yet.
    fn operate(&mut self, operation: Operation) {
        if !operation.is_whole() {
            return;
        }
        let n_genes = operation.n_genes as usize;
        match self.trace.generations.last_mut().filter(|_| self.is_run) {
            Some(generation) => {
                let part = generation.part();
                generation.operations.push(Called { part, operation });
            }
            None => self.trace.generations.push(Generation {
                is_call: true,
                n_genes,
                operations: vec![Called { part: Part::Opening, operation }],
                ..Generation::default()
            }),
        }
    }

    /// The calls of operators that came before the first simulation belong to the first generation.
    fn opening(&mut self) -> Vec<Called> {
        let generations = &mut self.trace.generations;
        let is_call = |generation: &Generation| generation.is_call && generation.is_empty();
        let first = generations.iter().rposition(|g| !is_call(g)).map_or(0, |at| at + 1);
        generations.drain(first..).flat_map(|generation| generation.operations).collect()
    }

    /// Begins a generation of individuals that were not simulated, where an operator is called on
    /// others than those that the operator before has given.
    fn begin_call(&mut self, event: &Event) {
        let produced = &self.produced;
        let last = self.trace.generations.last();
        let (genes, expected, continues) = match event {
            Event::Sort { genes, .. } => (genes, &produced.simulated, false),
            Event::Cross { genes, .. } => {
                let sorted = last.is_some_and(|l| l.sorted.is_some() && l.crossed.is_none());
                (genes, &produced.sorted, sorted)
            }
            Event::Mutate { genes, .. } => {
                let crossed = last.is_some_and(|l| l.crossed.is_some() && l.mutated.is_none());
                (genes, &produced.crossed, crossed)
            }
            _ => return,
        };
        if continues && *genes == Genes::Expected {
            return;
        }
        let n_genes = produced.n_genes;
        let Some(genes) = genes.resolve(expected, n_genes).filter(|_| n_genes > 0) else { return };
        let origins = match last {
            Some(before) if before.n_genes == n_genes => before.origins_of(&genes),
            _ => vec![Origin::Script; genes.len() / n_genes],
        };
        let call = Generation { is_call: true, n_genes, genes, origins, ..Generation::default() };
        self.trace.generations.push(call);
    }

    /// What must be taken from what was produced before the event.
    fn note(&mut self, event: &Event) {
        match event {
            Event::Script { name, text } => {
                let lines = text.lines().map(str::to_owned).collect();
                self.trace.scripts.push(Script { name: name.clone(), lines });
            }
            Event::Subject(subject) => self.trace.subject = subject.clone(),
            Event::Measured { x, y } => self.trace.measured = (x.clone(), y.clone()),
            Event::Draw { place, seed, count } => {
                if let Ok(mut rng) = Mrg32k3a::new(seed) {
                    let numbers = (0..*count).map(|_| rng.uniform()).collect();
                    self.drawn.push(Drawn { place: *place, seed: *seed, numbers });
                }
            }
            Event::Simulate { place, n_genes, .. } => {
                let n_genes = *n_genes as usize;
                let operations = self.opening();
                let begins = self.produced.ended
                    || self.trace.generations.last().is_some_and(|last| last.is_call)
                    || self.trace.generations.last().is_none_or(|last| last.n_genes != n_genes);
                if begins {
                    let drawn = std::mem::take(&mut self.drawn);
                    let simulated = *place;
                    self.trace.generations.push(Generation {
                        is_evaluation: !self.evolves,
                        operations,
                        drawn,
                        n_genes,
                        simulated,
                        ..Generation::default()
                    });
                }
            }
            Event::Full => self.trace.full = true,
            Event::Operate(operation) => self.operate(operation.clone()),
            Event::Alone { .. }
            | Event::Rate { .. }
            | Event::Sort { .. }
            | Event::Cross { .. }
            | Event::Mutate { .. } => {}
        }
        self.note_decision(event);
    }

    fn note_decision(&mut self, event: &Event) {
        let produced = &self.produced;
        let seed = self.drawn.last().map(|drawn| drawn.seed);
        let Some(generation) = self.trace.generations.last_mut() else { return };
        match event {
            Event::Sort { place, genes, fitness, parents, elites } => {
                let fitness = fitness.resolve(&produced.fitness);
                let order = crate::ga::order(&fitness);
                let sorts_these = genes
                    .resolve(&produced.simulated, produced.n_genes)
                    .is_some_and(|sorted| sorted == generation.genes);
                if sorts_these {
                    generation.fitness = fitness;
                }
                let (parents, elites) = (*parents as usize, *elites as usize);
                generation.sorted = Some(Sorted { place: *place, order, parents, elites });
            }
            Event::Mutate { place, genes, numbers, elites, factor, minima, maxima } => {
                let before = genes.resolve(&produced.crossed, produced.n_genes);
                generation.mutated = Some(Mutated {
                    place: *place,
                    before: before.unwrap_or_default(),
                    after: Vec::new(),
                    numbers: numbers.resolve(&produced.numbers),
                    seed: seed.filter(|_| *numbers == Numbers::Expected),
                    elites: *elites as usize,
                    factor: *factor,
                    minima: minima.clone(),
                    maxima: maxima.clone(),
                });
            }
            _ => {}
        }
    }

    /// What can be taken only from what the event has produced.
    fn complete(&mut self, event: &Event) {
        let produced = &self.produced;
        let Some((generation, before)) = self.trace.generations.split_last_mut() else { return };
        match event {
            Event::Simulate { failures, .. } => {
                let offset = generation.len();
                let shifted = |(k, cause): &(u32, String)| (*k as usize + offset, cause.clone());
                generation.failures.extend(failures.iter().map(shifted));
                generation.genes = produced.simulated.clone();
                generation.origins = origins(generation, before.last());
            }
            Event::Rate { place, fitness, best } => {
                let known = generation.best().map_or(f64::INFINITY, |(_, fitness)| fitness);
                if fitness.iter().any(|fitness| *fitness < known) {
                    generation.best_simulated = best.clone();
                }
                generation.more_ratings +=
                    usize::from(generation.fitness.len() >= generation.len());
                generation.rated = Some(*place);
                generation.fitness = produced.fitness.clone();
            }
            Event::Cross { place, parents, elites, points, .. } => {
                generation.crossed = Some(Crossed {
                    place: *place,
                    parents: *parents as usize,
                    elites: *elites as usize,
                    points: points.iter().map(|&point| point as usize).collect(),
                    rows: produced.crossed.clone(),
                });
            }
            Event::Mutate { .. } => {
                if let Some(mutated) = &mut generation.mutated {
                    mutated.after = produced.mutated.clone();
                }
                // The numbers drawn so far have been used up by the mutation.
                self.drawn.clear();
            }
            _ => {}
        }
    }
}

/// How the individuals of a generation came into it. Where none descends from the one before, the
/// script begins again.
fn origins(generation: &Generation, before: Option<&Generation>) -> Vec<Origin> {
    let is_like = |before: &&Generation| before.n_genes == generation.n_genes && !before.is_call;
    let inherited = before.filter(is_like).map(|before| before.origins_of(&generation.genes));
    let is_child = |origin: &Origin| matches!(origin, Origin::Elite { .. } | Origin::Child { .. });
    match inherited {
        Some(origins) if origins.iter().any(is_child) => origins,
        _ if generation.numbers_of_genes().is_some() && !generation.is_empty() => {
            vec![Origin::Random; generation.len()]
        }
        _ => vec![Origin::Script; generation.len()],
    }
}
