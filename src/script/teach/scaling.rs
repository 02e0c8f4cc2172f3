//! How a script makes genes of random numbers, as far as the numbers show it: each gene linearly within
//! a range of its own, `low + (high - low) u`.

use super::generation::Generation;

/// A number counts as what the range gives where it differs by less than this share of the range.
/// Scripts write the formula in other orders, which costs some bits of 53.
const EXACT: f64 = 1e-9;

/// The ranges of the genes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scaling {
    /// The genes for u = 0.
    pub low: Vec<f64>,
    /// The genes for u = 1.
    pub high: Vec<f64>,
}

/// The ranges that explain every gene of the generations that were drawn at random; `None` where there
/// are none, or another formula was used.
pub(super) fn scaling(generations: &[Generation]) -> Option<Scaling> {
    let first = generations.iter().find(|generation| generation.is_drawn())?;
    let n = first.n_genes;
    let drawn = generations.iter().filter(|g| g.is_drawn() && g.n_genes == n);
    let drawn: Option<Vec<_>> =
        drawn.map(|generation| Some((generation.numbers_of_genes()?, &generation.genes))).collect();
    let samples: Vec<(f64, f64)> = drawn?
        .iter()
        .flat_map(|(numbers, genes)| numbers.iter().copied().zip(genes.iter().copied()))
        .collect();
    let ranges: Option<Vec<[f64; 2]>> =
        (0..n).map(|j| range(samples.iter().skip(j).step_by(n))).collect();
    let (low, high) = ranges?.into_iter().map(|[low, high]| (low, high)).unzip();
    Some(Scaling { low, high })
}

/// The line through the outermost samples, if all others lie on it: its values at 0 and 1.
fn range<'a>(samples: impl Iterator<Item = &'a (f64, f64)> + Clone) -> Option<[f64; 2]> {
    let by_number = |a: &&(f64, f64), b: &&(f64, f64)| a.0.total_cmp(&b.0);
    let (u, gene) = *samples.clone().min_by(by_number)?;
    let (last_u, last_gene) = *samples.clone().max_by(by_number)?;
    let width = (last_gene - gene) / (last_u - u);
    let low = gene - width * u;
    let explains = |&(u, gene): &(f64, f64)| (low + width * u - gene).abs() <= EXACT * width.abs();
    // Equal numbers give no line: its width is infinite or not a number.
    let is_range = width.is_finite() && width != 0.0;
    // What rounding leaves of zero is zero.
    let end = |value: f64| if value.abs() <= EXACT * width.abs() { 0.0 } else { value };
    (is_range && samples.clone().all(explains)).then(|| [end(low), end(low + width)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::teach::{Origin, generation::Drawn};

    /// A generation whose genes are made of these numbers.
    fn drawn(numbers: &[f64], gene: impl Fn(usize, f64) -> f64) -> Generation {
        let genes: Vec<f64> = numbers.iter().enumerate().map(|(k, u)| gene(k % 2, *u)).collect();
        let numbers = numbers.to_vec();
        Generation {
            n_genes: 2,
            origins: vec![Origin::Random; genes.len() / 2],
            genes,
            drawn: vec![Drawn {
                place: crate::teach::ScriptLine::default(),
                seed: [1.0; 6],
                numbers,
            }],
            ..Generation::default()
        }
    }

    #[test]
    fn ranges_are_found_where_every_gene_lies_in_them() {
        let place = |j: usize, u: f64| if j == 0 { 5.0 + 15.0 * u } else { 1.0 + u * (10.0 - 1.0) };
        let all = [drawn(&[0.25, 0.5], place), drawn(&[0.75, 0.9, 0.1, 0.2], place)];
        let Scaling { low, high } = scaling(&all).expect("ranges");
        for (found, expected) in low.iter().chain(&high).zip([5.0, 1.0, 20.0, 10.0]) {
            assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
        }
        // One individual shows no range, and neither does a logarithmic scale.
        assert_eq!(scaling(&all[..1]), None);
        let logarithmic = |_: usize, u: f64| crate::elementary::exp(u);
        assert_eq!(scaling(&[drawn(&[0.25, 0.5, 0.75, 0.9, 0.1, 0.2], logarithmic)]), None);
        assert_eq!(scaling(&[]), None);
    }
}
