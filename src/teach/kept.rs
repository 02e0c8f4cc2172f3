//! Which generations of a long run a page steps through: a page with all of them would be one that no
//! browser opens and no mail takes.

use super::generation::Generation;
use super::operation::{Action, Operation};
use super::step::steps;
use std::collections::BTreeSet;

/// Bytes of all generations on a page. With what else a page has, it stays below 3 MB: the twin of
/// case 4.1 (5000 generations of 100 individuals with 6 genes) has 2.3 MB.
const MOST: usize = 2_300_000;
/// Of these, at most this part is for the improvements, in tenths; the rest is for the first ones.
const IMPROVEMENTS: usize = 7;
/// Bytes of one gene: before and after crossover and mutation, and its random number.
const PER_GENE: usize = 36;
/// No table of a page has more rows than this.
pub const MOST_ROWS: usize = 100;
/// Bytes of one row of the table of an operator's call, and of one number of it.
const PER_ROW: usize = 60;
const PER_NUMBER: usize = 16;
/// Bytes of one step: its sentence.
const PER_STEP: usize = 260;

/// The generations to keep, from 0, in order: the first ones, those with the largest improvements of
/// the best together with the ones that brought them about, and the last; all of them where they fit.
pub fn kept(generations: &[Generation]) -> Vec<usize> {
    let costs: Vec<usize> = (0..generations.len()).map(|at| cost(generations, at)).collect();
    let Some(last) = generations.len().checked_sub(1) else { return Vec::new() };
    if costs.iter().sum::<usize>() <= MOST {
        return (0..=last).collect();
    }
    let mut chosen = BTreeSet::from([0, last]);
    let mut spent = costs[0] + costs[last];
    let mut keep = |at: usize, most: usize| {
        let fits = chosen.contains(&at) || spent + costs[at] <= most;
        if fits && chosen.insert(at) {
            spent += costs[at];
        }
        fits
    };
    let pairs = improvements(generations).into_iter().flat_map(|at| [at - 1, at]);
    pairs.take_while(|at| keep(*at, MOST / 10 * IMPROVEMENTS)).for_each(drop);
    (1..last).take_while(|at| keep(*at, MOST)).for_each(drop);
    chosen.into_iter().collect()
}

fn cost(generations: &[Generation], at: usize) -> usize {
    let steps = steps(&generations[at], generations.get(at + 1)).len();
    let operation: usize =
        generations[at].operations.iter().map(|called| rows(&called.operation)).sum();
    PER_GENE * generations[at].genes.len() + PER_STEP * steps + operation
}

/// Bytes of the rows of an operator's call: their names and notes, and the numbers.
fn rows(operation: &Operation) -> usize {
    let count = match &operation.action {
        Action::Sampling { sampled, .. } => operation.count(sampled).min(MOST_ROWS),
        Action::Selection { fitness, .. } => fitness.len().min(MOST_ROWS),
        Action::Crossover { parents, .. } => 2 * operation.count(parents),
        Action::Mutation { before, .. } => 2 * operation.count(before),
        Action::Survival { fitness, fitness_offspring, .. } => {
            (fitness.len() + fitness_offspring.len()).min(MOST_ROWS)
        }
    };
    count * (PER_ROW + PER_NUMBER * (1 + operation.n_genes as usize))
}

/// The generations after the first whose best is better than all before, the largest gain first.
fn improvements(generations: &[Generation]) -> Vec<usize> {
    let mut best = f64::INFINITY;
    let mut found = Vec::new();
    for (at, generation) in generations.iter().enumerate() {
        let Some((_, fitness)) = generation.best().filter(|(_, fitness)| *fitness < best) else {
            continue;
        };
        if at > 0 {
            found.push((fitness / best, at));
        }
        best = fitness;
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    found.into_iter().map(|(_, at)| at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::teach::Origin;

    /// So many generations of 100 individuals; the best improves at each multiple of 300.
    fn long(count: usize) -> Vec<Generation> {
        let fitness = |at: usize| 1e3 / (1 + at / 300) as f64;
        let generation = |at| Generation {
            n_genes: 6,
            genes: vec![0.5; 600],
            fitness: vec![fitness(at); 100],
            origins: vec![Origin::Script; 100],
            ..Generation::default()
        };
        (0..count).map(generation).collect()
    }

    #[test]
    fn a_short_run_is_kept_whole() {
        assert_eq!(kept(&long(20)), (0..20).collect::<Vec<_>>());
        assert!(kept(&[]).is_empty());
    }

    #[test]
    fn improvements_and_the_end_of_a_long_run_are_kept() {
        let kept = kept(&long(1000));
        for at in [0, 1, 299, 300, 599, 600, 899, 900, 999] {
            assert!(kept.contains(&at), "{at} is missing in {kept:?}");
        }
        assert!(!kept.contains(&450) && kept.len() < 200, "{}", kept.len());
        assert!(kept.is_sorted());
    }
}
