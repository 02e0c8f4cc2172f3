//! Sobol sequence: points that fill the unit cube evenly in every pair of directions, moved
//! together by a random shift so that the seed counts.
//!
//! References: [Sobol 1967](gapilib_base::bibliography#sobol-1967),
//! [Joe & Kuo 2008](gapilib_base::bibliography#joe-kuo-2008) (direction numbers).

use super::{Sampling, latin_hypercube, scaled};
use crate::diag::Fault;
use crate::ga::{Gene, Genomes, Mrg32k3a};
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Sampling> = Entry {
    name: "sobol",
    aliases: &["quasi_random"],
    summary: "low-discrepancy sequence for any number of genes",
    reference: "sobol-1967",
    make: |_| Ok(Box::new(Sobol)),
};

/// Genes that the sequence is made for; further ones are those of a Latin hypercube.
pub(crate) const SOBOL_GENES: usize = 1 + POLYNOMIALS.len();

/// For the second gene and those after it: degree and inner coefficients of a primitive
/// polynomial, and the first direction numbers.
const POLYNOMIALS: [(u32, u32, &[u32]); 20] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
    (5, 11, &[1, 1, 5, 1, 1]),
    (5, 13, &[1, 1, 1, 3, 11]),
    (5, 14, &[1, 3, 5, 5, 31]),
    (6, 1, &[1, 3, 3, 9, 7, 49]),
    (6, 13, &[1, 1, 1, 15, 21, 21]),
    (6, 16, &[1, 3, 1, 13, 27, 49]),
    (6, 19, &[1, 1, 1, 15, 7, 5]),
    (6, 22, &[1, 3, 1, 15, 13, 25]),
    (6, 25, &[1, 1, 5, 5, 19, 61]),
    (7, 1, &[1, 3, 7, 11, 23, 15, 103]),
    (7, 4, &[1, 3, 7, 13, 13, 15, 69]),
];

struct Sobol;

impl Sampling for Sobol {
    fn sample(&self, genes: &[Gene], count: usize, rng: &mut Mrg32k3a) -> Result<Genomes, Fault> {
        Ok(scaled(sobol(genes.len(), count, rng), genes))
    }
}

/// `count` individuals in the unit cube, at most 2³² of them; `n_genes` is at least 1.
pub fn sobol(n_genes: usize, count: usize, rng: &mut Mrg32k3a) -> Genomes {
    let n_sobol = n_genes.min(SOBOL_GENES);
    let shift: Vec<f64> = (0..n_sobol).map(|_| rng.uniform()).collect();
    let mut genomes = match n_genes > n_sobol {
        true => latin_hypercube(n_genes, count, rng),
        false => {
            let mut empty = Genomes::with_capacity(n_genes, count);
            (0..count).for_each(|_| empty.push(&vec![0.0; n_genes]));
            empty
        }
    };
    let directions: Vec<[u32; 32]> = (0..n_sobol).map(directions).collect();
    let mut point = vec![0_u32; n_sobol];
    for k in 0..count {
        for ((value, bits), shift) in genomes.row_mut(k).iter_mut().zip(&point).zip(&shift) {
            *value = (f64::from(*bits) / 4_294_967_296.0 + shift).fract();
        }
        // Gray code: the next point differs by the direction of the lowest zero of the number.
        let zero = (k as u32).trailing_ones().min(31) as usize;
        point.iter_mut().zip(&directions).for_each(|(bits, all)| *bits ^= all[zero]);
    }
    genomes
}

/// The direction numbers of a gene as binary fractions.
fn directions(gene: usize) -> [u32; 32] {
    if gene == 0 {
        return std::array::from_fn(|k| 1 << (31 - k));
    }
    let (degree, coefficients, first) = POLYNOMIALS[gene - 1];
    let degree = degree as usize;
    let mut all = [0; 32];
    for k in 0..32 {
        all[k] = if k < degree {
            first[k] << (31 - k)
        } else {
            let ends = all[k - degree] ^ (all[k - degree] >> degree);
            (1..degree)
                .filter(|inner| coefficients >> (degree - 1 - inner) & 1 == 1)
                .fold(ends, |sum, inner| sum ^ all[k - inner])
        };
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of the unshifted sequence, genes 1, 2, 3, 10 and 21, as SciPy 1.17 gives them.
    const REFERENCE: [(usize, [f64; 5]); 4] = [
        (2, [0.75, 0.25, 0.25, 0.75, 0.25]),
        (3, [0.25, 0.75, 0.75, 0.25, 0.75]),
        (100, [0.4140625, 0.2578125, 0.7734375, 0.6953125, 0.7578125]),
        (127, [0.0078125, 0.6640625, 0.5546875, 0.5390625, 0.5390625]),
    ];

    #[test]
    fn points_of_the_published_direction_numbers() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let genomes = sobol(SOBOL_GENES, 128, &mut rng);
        let unshifted = |k: usize, gene: usize| {
            let difference = genomes.row(k)[gene] - genomes.row(0)[gene];
            (difference + 1.0).fract()
        };
        for (k, expected) in REFERENCE {
            for (gene, expected) in [0, 1, 2, 9, 20].into_iter().zip(expected) {
                let found = unshifted(k, gene);
                assert!((found - expected).abs() < 1e-9, "{k} {gene}: {found} for {expected}");
            }
        }
    }

    #[test]
    fn every_pair_of_genes_is_filled() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let genomes = sobol(8, 256, &mut rng);
        for (a, b) in [(0, 1), (2, 5), (6, 7)] {
            let mut cells = [0; 16];
            for genome in genomes.rows() {
                cells[(genome[a] * 4.0) as usize * 4 + (genome[b] * 4.0) as usize] += 1;
            }
            assert!(cells.iter().all(|&count| (8..=24).contains(&count)), "{cells:?}");
        }
        assert_eq!(sobol(30, 5, &mut rng).n_genes(), 30);
    }
}
