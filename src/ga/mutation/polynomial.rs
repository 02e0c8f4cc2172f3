//! Polynomial mutation on genes in 0..1: small changes are likelier than large ones, the more so
//! the larger `eta`.
//!
//! Reference: [Deb & Agrawal 1999](crate::bibliography#deb-agrawal-1999).

use crate::elementary;
use crate::ga::Mrg32k3a;

/// Changes each gene with the given probability.
pub fn polynomial(genome: &mut [f64], probability: f64, eta: f64, rng: &mut Mrg32k3a) {
    let power = 1.0 / (eta + 1.0);
    for value in genome {
        if rng.uniform() >= probability {
            continue;
        }
        let u = rng.uniform();
        let change = if u <= 0.5 {
            elementary::powf(
                2.0 * u + (1.0 - 2.0 * u) * elementary::powf(1.0 - *value, eta + 1.0),
                power,
            ) - 1.0
        } else {
            1.0 - elementary::powf(
                2.0 * (1.0 - u) + (2.0 * u - 1.0) * elementary::powf(*value, eta + 1.0),
                power,
            )
        };
        *value = (*value + change).clamp(0.0, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn stays_in_the_cube(
            mut genome in prop::collection::vec(0.0..=1.0_f64, 1..20),
            eta in 0.0..100.0_f64,
        ) {
            let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
            let before = genome.clone();
            polynomial(&mut genome, 0.0, eta, &mut rng);
            prop_assert_eq!(&genome, &before);
            polynomial(&mut genome, 1.0, eta, &mut rng);
            prop_assert!(genome.iter().all(|v| (0.0..=1.0).contains(v)));
        }
    }

    #[test]
    fn a_large_eta_keeps_genes_near() {
        let mean_change = |eta: f64| {
            let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
            let mut genome = vec![0.5; 1000];
            polynomial(&mut genome, 1.0, eta, &mut rng);
            genome.iter().map(|v| (v - 0.5).abs()).sum::<f64>() / 1000.0
        };
        assert!(mean_change(20.0) < 0.05 && mean_change(1.0) > 0.1);
    }
}
