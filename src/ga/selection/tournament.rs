//! Binary tournament: of two individuals drawn at random the better one becomes a parent.
//!
//! Reference: [Goldberg 1989](crate::bibliography#goldberg-1989).

use crate::ga::Mrg32k3a;

/// The number of a parent out of `count` individuals (at least 1); `better(a, b)` says whether a
/// wins over b.
pub fn tournament(
    count: usize,
    rng: &mut Mrg32k3a,
    better: impl Fn(usize, usize) -> bool,
) -> usize {
    let mut draw = || ((rng.uniform() * count as f64) as usize).min(count - 1);
    let (a, b) = (draw(), draw());
    if better(a, b) { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The k-th best of n wins with the probability (2 (n − k) − 1)/n², k from 0.
    #[test]
    fn the_better_one_wins_as_often_as_it_should() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let mut wins = [0; 4];
        for _ in 0..16_000 {
            wins[tournament(4, &mut rng, |a, b| a <= b)] += 1;
        }
        for (k, &wins) in wins.iter().enumerate() {
            let expected = 16_000.0 * f64::from(2 * (4 - k as i32) - 1) / 16.0;
            assert!((f64::from(wins) - expected).abs() < 5.0 * expected.sqrt(), "{k}: {wins}");
        }
    }
}
