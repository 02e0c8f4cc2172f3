//! Simulated binary crossover on genes in 0..1: children lie about their parents as the children
//! of bit strings would; a large `eta` keeps them close. The spread is limited so that children
//! stay in 0..1.
//!
//! Reference: [Deb & Agrawal 1995](crate::bibliography#deb-agrawal-1995), §3.

use crate::elementary;
use crate::ga::Mrg32k3a;

/// Parents closer than this have children like themselves.
const SAME: f64 = 1e-14;

/// Turns two parents into two children; each gene is crossed with the probability 1/2.
pub fn sbx(first: &mut [f64], second: &mut [f64], eta: f64, rng: &mut Mrg32k3a) {
    for (a, b) in first.iter_mut().zip(second) {
        if rng.uniform() > 0.5 || (*a - *b).abs() < SAME {
            continue;
        }
        let (low, high) = (a.min(*b), a.max(*b));
        let (u, distance) = (rng.uniform(), high - low);
        let spread = |room: f64| {
            let alpha = 2.0 - elementary::powf(1.0 + 2.0 * room / distance, -(eta + 1.0));
            let base = if u <= 1.0 / alpha { u * alpha } else { 1.0 / (2.0 - u * alpha) };
            elementary::powf(base, 1.0 / (eta + 1.0))
        };
        let lower = (0.5 * (low + high - spread(low) * distance)).clamp(0.0, 1.0);
        let upper = (0.5 * (low + high + spread(1.0 - high) * distance)).clamp(0.0, 1.0);
        (*a, *b) = if rng.uniform() < 0.5 { (lower, upper) } else { (upper, lower) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn children_stay_in_the_cube_and_equal_parents_stay(
            a in prop::collection::vec(0.0..=1.0_f64, 1..8),
            eta in 0.0..50.0_f64,
        ) {
            let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
            let (mut first, mut second) = (a.clone(), a.iter().map(|v| 1.0 - v).collect::<Vec<_>>());
            sbx(&mut first, &mut second, eta, &mut rng);
            prop_assert!(first.iter().chain(&second).all(|v| (0.0..=1.0).contains(v)));
            let (mut first, mut second) = (a.clone(), a.clone());
            sbx(&mut first, &mut second, eta, &mut rng);
            prop_assert_eq!(first, second);
        }
    }

    /// In the middle of the cube, where the limits do not matter, the mean of the children is the
    /// mean of the parents.
    #[test]
    fn children_keep_the_mean_of_their_parents() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let (mut first, mut second) = (vec![0.49; 100], vec![0.51; 100]);
        sbx(&mut first, &mut second, 15.0, &mut rng);
        for (a, b) in first.iter().zip(&second) {
            assert!((a + b - 1.0).abs() < 1e-9, "{a} {b}");
        }
        assert!(first.iter().any(|v| *v != 0.49));
    }
}
