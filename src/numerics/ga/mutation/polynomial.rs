//! Polynomial mutation: small changes are likelier than large ones, the more so the larger `eta`.
//! The distribution on each side ends with the range.
//!
//! Reference: [Deb & Agrawal 1999](gapilib_base::bibliography#deb-agrawal-1999).

use super::{Child, Mutation};
use crate::diag::Fault;
use crate::elementary;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Mutation> = Entry {
    name: "polynomial",
    aliases: &["deb"],
    summary: "polynomial mutation: a step within the range, smaller for larger `eta`",
    reference: "deb-agrawal-1999",
    make: |options| Ok(Box::new(Polynomial { eta: options.take("eta", 0.0..=1000.0, 20.0)? })),
};

struct Polynomial {
    eta: f64,
}

impl Mutation for Polynomial {
    fn mutate(&self, child: Child, rng: &mut Mrg32k3a) -> Result<(), Fault> {
        child.change(rng, |value, gene, rng| {
            let u = gene.fraction(value);
            gene.at((u + change(u, self.eta, rng.uniform())).clamp(0.0, 1.0))
        });
        Ok(())
    }
}

/// The change of a gene at `value` in 0..1 for a uniform number.
fn change(value: f64, eta: f64, u: f64) -> f64 {
    let power = 1.0 / (eta + 1.0);
    if u <= 0.5 {
        elementary::powf(
            2.0 * u + (1.0 - 2.0 * u) * elementary::powf(1.0 - value, eta + 1.0),
            power,
        ) - 1.0
    } else {
        1.0 - elementary::powf(
            2.0 * (1.0 - u) + (2.0 * u - 1.0) * elementary::powf(value, eta + 1.0),
            power,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the ends are far away, |Δ| of the range has the distribution function
    /// 1 − (1 − |Δ|)^(η + 1), so that its mean is 1/(η + 2).
    #[test]
    fn changes_have_the_mean_of_the_distribution() {
        for eta in [20.0, 80.0] {
            let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
            let n = 20_000;
            let sum: f64 = (0..n).map(|_| change(0.5, eta, rng.uniform()).abs()).sum();
            let (found, expected) = (sum / f64::from(n), 1.0 / (eta + 2.0));
            assert!((found - expected).abs() < 0.03 * expected, "{eta}: {found} for {expected}");
        }
    }

    #[test]
    fn the_ends_of_the_range_are_the_ends_of_the_distribution() {
        for value in [0.0, 0.2, 1.0] {
            assert!((value + change(value, 5.0, 0.0)).abs() < 1e-12);
            assert!((value + change(value, 5.0, 1.0) - 1.0).abs() < 1e-12);
            assert_eq!(change(value, 5.0, 0.5), 0.0);
        }
    }
}
