//! Exchanges of two genes: sums of like terms (exponentials, peaks, waves) fit as well, or better, with
//! the terms in another order, which changes many genes at once and is seldom found by chance. Where
//! one gene of a term has the value of the other term's, the descent does the rest.

use crate::elementary;
use std::cmp::Ordering;

/// What the fractions of a gene mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// The value of 0.
    pub min: f64,
    /// The value of 1.
    pub max: f64,
    /// Whether the logarithm is divided evenly.
    pub logarithmic: bool,
    /// Genes of one unit can be exchanged.
    pub unit: String,
}

impl Scale {
    fn value(&self, fraction: f64) -> f64 {
        match self.logarithmic {
            true => self.min * elementary::powf(self.max / self.min, fraction),
            false => self.min + fraction * (self.max - self.min),
        }
    }

    /// `None` where the value lies outside.
    fn fraction(&self, value: f64) -> Option<f64> {
        let fraction = match self.logarithmic {
            true => elementary::ln(value / self.min) / elementary::ln(self.max / self.min),
            false => (value - self.min) / (self.max - self.min),
        };
        (0.0..=1.0).contains(&fraction).then_some(fraction)
    }

    /// How different the ranges of two genes are; `None` where they are not of one kind.
    fn distance(&self, other: &Scale) -> Option<f64> {
        if self.unit != other.unit || self.logarithmic != other.logarithmic {
            return None;
        }
        let distance = match self.logarithmic {
            true => {
                elementary::ln(self.min / other.min).abs()
                    + elementary::ln(self.max / other.max).abs()
            }
            false => {
                let widest = (self.max - self.min).max(other.max - other.min);
                ((self.min - other.min).abs() + (self.max - other.max).abs()) / widest
            }
        };
        distance.is_finite().then_some(distance)
    }
}

/// Pairs of genes, those of the most similar ranges first, and how far they were tried from a place.
#[derive(Debug, Clone, Default)]
pub(crate) struct Exchanges {
    scales: Vec<Scale>,
    pairs: Vec<[usize; 2]>,
    from: Vec<f64>,
    next: usize,
}

impl Exchanges {
    pub(crate) fn new(scales: Vec<Scale>) -> Exchanges {
        let n = scales.len();
        let all = (0..n).flat_map(|a| (a + 1..n).map(move |b| [a, b]));
        let mut pairs: Vec<([usize; 2], f64)> =
            all.filter_map(|[a, b]| Some(([a, b], scales[a].distance(&scales[b])?))).collect();
        pairs.sort_by(|a, b| a.1.partial_cmp(&b.1).unwrap_or(Ordering::Equal));
        let pairs = pairs.into_iter().map(|(pair, _)| pair).collect();
        Exchanges { scales, pairs, from: Vec::new(), next: 0 }
    }

    /// The next place that differs from `best` by an exchange; from the first pair on where `best` is
    /// another place than before, as `is_same` says.
    pub(crate) fn next(
        &mut self,
        best: &[f64],
        is_same: impl Fn(&[f64], &[f64]) -> bool,
    ) -> Option<Vec<f64>> {
        if self.from.is_empty() || !is_same(&self.from, best) {
            self.from = best.to_vec();
            self.next = 0;
        }
        while let Some(&[a, b]) = self.pairs.get(self.next) {
            self.next += 1;
            let of = |k: usize| self.scales[k].value(best[k]);
            let exchanged = self.scales[a].fraction(of(b)).zip(self.scales[b].fraction(of(a)));
            let Some((own, other)) = exchanged else { continue };
            let mut genome = best.to_vec();
            (genome[a], genome[b]) = (own, other);
            if !is_same(&genome, best) {
                return Some(genome);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(min: f64, max: f64, logarithmic: bool, unit: &str) -> Scale {
        Scale { min, max, logarithmic, unit: unit.to_owned() }
    }

    fn is_same(a: &[f64], b: &[f64]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6)
    }

    #[test]
    fn values_are_exchanged_between_ranges_and_the_most_similar_come_first() {
        let scales = vec![
            scale(1.0, 100.0, true, "s"),
            scale(0.1, 10.0, true, "s"),
            scale(1.0, 100.0, true, "m"),
            scale(2.0, 200.0, true, "s"),
        ];
        let mut exchanges = Exchanges::new(scales.clone());
        // 10, 1, ., 20
        let best = [0.5, 0.5, 0.5, 0.5];
        let found = exchanges.next(&best, is_same).unwrap();
        assert!((scales[0].value(found[0]) - 20.0).abs() < 1e-12, "{found:?}");
        assert!((scales[3].value(found[3]) - 10.0).abs() < 1e-12, "{found:?}");
        let found = exchanges.next(&best, is_same).unwrap();
        assert!((scales[0].value(found[0]) - 1.0).abs() < 1e-12, "{found:?}");
        assert!((scales[1].value(found[1]) - 10.0).abs() < 1e-12, "{found:?}");
        // 1 lies below the range of the last, and metres are not seconds.
        assert_eq!(exchanges.next(&best, is_same), None);
        assert!(exchanges.next(&[0.4, 0.5, 0.5, 0.5], is_same).is_some(), "another place");
    }

    #[test]
    fn equal_values_make_no_other_place() {
        let scales = vec![scale(-1.0, 1.0, false, ""), scale(-1.0, 1.0, false, "")];
        assert_eq!(Exchanges::new(scales).next(&[0.3, 0.3], is_same), None);
        assert_eq!(Exchanges::new(Vec::new()).next(&[0.3, 0.3], is_same), None);
    }
}
