//! What a run has produced so far. The tracer and the reader both follow it, so that an event needs
//! to name only what does not follow from the events before.

use super::event::{Event, Genes, Numbers};
use super::operation::OperationKind;
use crate::ga::{Gene, Genomes, Mrg32k3a, crossover, mutation, survival};

/// The results of the paper's functions, as the next ones usually get them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Produced {
    /// Number of genes of each individual; 0 before the first simulation.
    pub(super) n_genes: usize,
    /// The numbers drawn last.
    pub(super) numbers: Vec<f64>,
    /// The individuals simulated since the last sort.
    pub(super) simulated: Vec<f64>,
    /// Their fitness.
    pub(super) fitness: Vec<f64>,
    /// The individuals, best first.
    pub(super) sorted: Vec<f64>,
    /// Elites and children.
    pub(super) crossed: Vec<f64>,
    /// Elites and mutated children.
    pub(super) mutated: Vec<f64>,
    /// Whether the next simulation begins a new generation.
    pub(super) ended: bool,
}

impl Genes {
    /// `values` as they are stored next to the expected ones.
    pub(super) fn of(values: &[f64], expected: &[f64], n_genes: usize) -> Genes {
        if n_genes == 0 || !values.len().is_multiple_of(n_genes) {
            return Genes::All(values.to_vec());
        }
        let known = expected.chunks_exact(n_genes);
        let differs = |k: usize, row: &[f64]| !known.clone().nth(k).is_some_and(|e| same(e, row));
        let rows = || values.chunks_exact(n_genes).enumerate();
        let changed: Vec<usize> =
            rows().filter(|(k, row)| differs(*k, row)).map(|(k, _)| k).collect();
        let len = values.len() / n_genes;
        if changed.is_empty() && values.len() == expected.len() {
            return Genes::Expected;
        }
        if changed.len() == len {
            return Genes::All(values.to_vec());
        }
        let stored = changed.iter().flat_map(|&k| &values[k * n_genes..(k + 1) * n_genes]);
        Genes::Changed {
            len: len as u32,
            rows: changed.iter().map(|&k| k as u32).collect(),
            values: stored.copied().collect(),
        }
    }

    /// The genomes, row by row; `None` where the event does not fit to what was expected.
    pub(super) fn resolve(&self, expected: &[f64], n_genes: usize) -> Option<Vec<f64>> {
        match self {
            Genes::Expected => Some(expected.to_vec()),
            Genes::All(values) => Some(values.clone()),
            Genes::Changed { len, rows, values } => {
                let size = (*len as usize).checked_mul(n_genes)?;
                let longest = expected.len() + values.len();
                let mut all = expected.to_vec();
                (size <= longest).then(|| all.resize(size, f64::NAN))?;
                for (&k, row) in rows.iter().zip(values.chunks_exact(n_genes)) {
                    let begin = (k as usize).checked_mul(n_genes)?;
                    all.get_mut(begin..begin + n_genes)?.copy_from_slice(row);
                }
                Some(all)
            }
        }
    }
}

impl Numbers {
    /// `values` as they are stored next to the expected ones.
    pub(super) fn of(values: &[f64], expected: &[f64]) -> Numbers {
        if same(values, expected) { Numbers::Expected } else { Numbers::All(values.to_vec()) }
    }

    /// The numbers.
    pub(super) fn resolve(&self, expected: &[f64]) -> Vec<f64> {
        match self {
            Numbers::Expected => expected.to_vec(),
            Numbers::All(values) => values.clone(),
        }
    }
}

/// Whether all bits agree.
fn same(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

impl Produced {
    /// Follows one event. A script may call the functions on populations of its own, such as single
    /// genes: where an event does not fit to those before, nothing is expected from there on.
    pub(crate) fn follow(&mut self, event: &Event) {
        if self.apply(event).is_none() {
            *self = Produced { n_genes: self.n_genes, ..Produced::default() };
        }
    }

    fn apply(&mut self, event: &Event) -> Option<()> {
        match event {
            Event::Draw { seed, count, .. } => {
                let mut rng = Mrg32k3a::new(seed).ok()?;
                self.numbers = (0..*count).map(|_| rng.uniform()).collect();
            }
            Event::Simulate { n_genes, genes, .. } => {
                self.begin_generation(*n_genes as usize);
                let added = genes.resolve(&self.mutated, self.n_genes)?;
                self.simulated.extend(added);
            }
            Event::Rate { fitness, .. } => self.fitness.extend(fitness),
            Event::Sort { genes, fitness, .. } => {
                let genes = genes.resolve(&self.simulated, self.n_genes)?;
                let fitness = fitness.resolve(&self.fitness);
                let population = Genomes::new(self.n_genes, genes).ok()?;
                let (sorted, _) = crate::ga::sort_by_fitness(&population, &fitness).ok()?;
                self.sorted = sorted.into_values();
                self.ended = true;
            }
            Event::Cross { genes, parents, elites, points, .. } => {
                let sorted = genes.resolve(&self.sorted, self.n_genes)?;
                self.crossed = crossed(sorted, self.n_genes, *parents, *elites, points)?;
                self.ended = true;
            }
            Event::Mutate { genes, numbers, elites, factor, minima, maxima, .. } => {
                let crossed = genes.resolve(&self.crossed, self.n_genes)?;
                let numbers = numbers.resolve(&self.numbers);
                let ranges = (minima.as_slice(), maxima.as_slice());
                self.mutated = mutated(crossed, self.n_genes, &numbers, *elites, *factor, ranges)?;
                self.ended = true;
            }
            Event::Alone { n_genes } => {
                let (n_genes, numbers) = (*n_genes as usize, std::mem::take(&mut self.numbers));
                *self = Produced { n_genes, numbers, ended: true, ..Produced::default() };
            }
            // What is sampled may belong to the generation at hand; all else makes the next one.
            Event::Operate(operation) => self.ended |= operation.kind() != OperationKind::Sampling,
            Event::Script { .. } | Event::Subject(_) | Event::Measured { .. } | Event::Full => {}
        }
        Some(())
    }

    /// Forgets the generation before when the first individual of a new one is simulated.
    fn begin_generation(&mut self, n_genes: usize) {
        if self.ended || n_genes != self.n_genes {
            self.simulated.clear();
            self.fitness.clear();
            self.ended = false;
        }
        self.n_genes = n_genes;
    }
}

/// Elites and children.
fn crossed(
    sorted: Vec<f64>,
    n_genes: usize,
    parents: u32,
    elites: u32,
    points: &[u32],
) -> Option<Vec<f64>> {
    let old = Genomes::new(n_genes, sorted).ok()?;
    let (parents, elites) = (parents as usize, elites as usize);
    if parents.max(elites) > old.len() {
        return None;
    }
    let points: Vec<usize> = points.iter().map(|&point| point as usize).collect();
    let mut chosen = Genomes::with_capacity(n_genes, parents);
    old.rows().take(parents).for_each(|genome| chosen.push(genome));
    let children = crossover::cross_adjacent(&chosen, &points);
    Some(survival::elites_first(&old, elites, &children).into_values())
}

fn mutated(
    crossed: Vec<f64>,
    n_genes: usize,
    numbers: &[f64],
    elites: u32,
    factor: f64,
    (minima, maxima): (&[f64], &[f64]),
) -> Option<Vec<f64>> {
    let fits = numbers.len() == crossed.len() && minima.len() == n_genes && maxima.len() == n_genes;
    let mut genomes = Genomes::new(n_genes, crossed).ok().filter(|_| fits)?;
    let genes: Vec<Gene> = (0..n_genes)
        .map(|j| Gene::new(format!("gene {}", j + 1), minima[j], maxima[j]))
        .collect::<Result<_, _>>()
        .ok()?;
    let elites = (elites as usize).min(genomes.len());
    mutation::mutate_uniform(&mut genomes, elites, &genes, factor, numbers);
    Some(genomes.into_values())
}
