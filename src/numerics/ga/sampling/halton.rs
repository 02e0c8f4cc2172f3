//! Halton sequence: gene j has the radical inverses of 1, 2, 3, … in the j-th prime number as
//! base, moved together by a random shift so that the seed counts.
//!
//! References: [Halton 1960](gapilib_base::bibliography#halton-1960), random shift:
//! [Cranley & Patterson 1976](gapilib_base::bibliography#cranley-patterson-1976).

use super::{Sampling, latin_hypercube, scaled};
use crate::diag::Fault;
use crate::ga::{Gene, Genomes, Mrg32k3a};
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Sampling> = Entry {
    name: "halton",
    aliases: &[],
    summary: "low-discrepancy sequence for few genes and any number of individuals",
    reference: "halton-1960",
    make: |_| Ok(Box::new(Halton)),
};

/// Bases. Further genes are those of a Latin hypercube: pairs of large bases begin with long runs
/// of points on lines.
const PRIMES: [u64; 10] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29];

struct Halton;

impl Sampling for Halton {
    fn sample(&self, genes: &[Gene], count: usize, rng: &mut Mrg32k3a) -> Result<Genomes, Fault> {
        Ok(scaled(halton(genes.len(), count, rng), genes))
    }
}

fn halton(n_genes: usize, count: usize, rng: &mut Mrg32k3a) -> Genomes {
    let shift = PRIMES.map(|_| rng.uniform());
    let mut genomes = latin_hypercube(n_genes, count, rng);
    for k in 0..count {
        let bases = PRIMES.iter().zip(&shift);
        for (value, (base, shift)) in genomes.row_mut(k).iter_mut().zip(bases) {
            *value = (radical_inverse(k as u64 + 1, *base) + shift).fract();
        }
    }
    genomes
}

/// The digits of a number mirrored at the point: 6 = 110 in base 2 gives 0.011 = 3/8.
fn radical_inverse(mut number: u64, base: u64) -> f64 {
    let (mut inverse, mut place) = (0.0, 1.0);
    while number > 0 {
        place /= base as f64;
        inverse += place * (number % base) as f64;
        number /= base;
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_mirrored() {
        for (number, base, expected) in [(6, 2, 0.375), (1, 3, 1.0 / 3.0), (5, 3, 7.0 / 9.0)] {
            assert!((radical_inverse(number, base) - expected).abs() < 1e-15);
        }
    }

    /// Among 2ᵃ 3ᵇ points in a row every box of 2ᵃ × 3ᵇ equal ones holds one, shift apart; the
    /// shift moves at most one into each neighbour.
    #[test]
    fn boxes_are_evenly_filled() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let genomes = halton(2, 720, &mut rng);
        let mut boxes = [0; 36];
        for genome in genomes.rows() {
            boxes[(genome[0] * 4.0) as usize * 9 + (genome[1] * 9.0) as usize] += 1;
        }
        assert!(boxes.iter().all(|&count| (17..=23).contains(&count)), "{boxes:?}");
        assert_eq!(halton(12, 3, &mut rng).n_genes(), 12);
    }
}
