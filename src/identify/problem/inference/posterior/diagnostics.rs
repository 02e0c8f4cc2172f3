//! Whether Markov chains have converged: rank-normalized split R-hat and effective sample sizes.
//!
//! Reference: [Vehtari et al. 2021](gapilib_base::bibliography#vehtari-2021); the sums of correlations end
//! by Geyer's initial monotone sequence.

use crate::elementary;
use crate::problem::distributions::normal_quantile;

/// The larger of rank-normalized split R-hat and that of the folded draws; 1 where the chains
/// cannot be distinguished. NaN for chains that never moved or of fewer than 4 draws.
pub(crate) fn r_hat(chains: &[Vec<f64>]) -> f64 {
    let halves = split(chains);
    if halves.iter().any(|half| half.len() < 2) {
        return f64::NAN;
    }
    let median = middle(&halves);
    let folded: Vec<Vec<f64>> = halves
        .iter()
        .map(|half| half.iter().map(|value| (value - median).abs()).collect())
        .collect();
    basic_r_hat(&rank_normalized(&halves)).max(basic_r_hat(&rank_normalized(&folded)))
}

/// Effective number of independent draws for the centre of the distribution.
pub(crate) fn bulk_ess(chains: &[Vec<f64>]) -> f64 {
    effective(&rank_normalized(&split(chains)))
}

/// Effective number for the 5 % and 95 % quantiles, the smaller of both.
pub(crate) fn tail_ess(chains: &[Vec<f64>]) -> f64 {
    let mut all: Vec<f64> = chains.concat();
    all.sort_by(f64::total_cmp);
    let below = |p: f64| {
        let limit = super::super::bootstrap::quantile(&all, p);
        let mark = |value: &f64| if *value <= limit { 1.0 } else { 0.0 };
        let marks: Vec<Vec<f64>> =
            chains.iter().map(|chain| chain.iter().map(mark).collect()).collect();
        effective(&split(&marks))
    };
    below(0.05).min(below(0.95))
}

fn split(chains: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let halves = |chain: &Vec<f64>| {
        let half = chain.len() / 2;
        [chain[..half].to_vec(), chain[chain.len() - half..].to_vec()]
    };
    chains.iter().flat_map(halves).collect()
}

fn middle(chains: &[Vec<f64>]) -> f64 {
    let mut all: Vec<f64> = chains.concat();
    all.sort_by(f64::total_cmp);
    super::super::bootstrap::quantile(&all, 0.5)
}

/// Normal quantiles of the ranks among all draws; equal values share their mean rank.
fn rank_normalized(chains: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let all: Vec<f64> = chains.concat();
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by(|a, b| all[*a].total_cmp(&all[*b]));
    let mut scores = vec![0.0; all.len()];
    let mut first = 0;
    for group in order.chunk_by(|a, b| all[*a] == all[*b]) {
        let rank = first as f64 + (group.len() as f64 + 1.0) / 2.0;
        first += group.len();
        let score = normal_quantile((rank - 0.375) / (all.len() as f64 + 0.25));
        group.iter().for_each(|&place| scores[place] = score);
    }
    let mut rest = scores.as_slice();
    let cut = |chain: &Vec<f64>| {
        let (own, others) = rest.split_at(chain.len());
        rest = others;
        own.to_vec()
    };
    chains.iter().map(cut).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn variance(values: &[f64]) -> f64 {
    let mean = mean(values);
    values.iter().map(|value| elementary::powi(value - mean, 2)).sum::<f64>()
        / (values.len() as f64 - 1.0)
}

fn basic_r_hat(chains: &[Vec<f64>]) -> f64 {
    let n = chains[0].len() as f64;
    let means: Vec<f64> = chains.iter().map(|chain| mean(chain)).collect();
    let within = mean(&chains.iter().map(|chain| variance(chain)).collect::<Vec<_>>());
    let between = n * variance(&means);
    ((between / within + n - 1.0) / n).sqrt()
}

/// Autocovariance of a chain at one lag, by its length.
fn autocovariance(centred: &[f64], lag: usize) -> f64 {
    let n = centred.len();
    centred[..n - lag].iter().zip(&centred[lag..]).map(|(a, b)| a * b).sum::<f64>() / n as f64
}

fn effective(chains: &[Vec<f64>]) -> f64 {
    let (m, n) = (chains.len(), chains[0].len());
    if n < 4 {
        return f64::NAN;
    }
    let means: Vec<f64> = chains.iter().map(|chain| mean(chain)).collect();
    let centred: Vec<Vec<f64>> = chains
        .iter()
        .zip(&means)
        .map(|(chain, mean)| chain.iter().map(|value| value - mean).collect())
        .collect();
    let mean_at =
        |lag: usize| centred.iter().map(|chain| autocovariance(chain, lag)).sum::<f64>() / m as f64;
    let size = n as f64;
    let within = mean_at(0) * size / (size - 1.0);
    let between = if m > 1 { variance(&means) } else { 0.0 };
    let total = within * (size - 1.0) / size + between;
    let correlation = |lag: usize| 1.0 - (within - mean_at(lag)) / total;
    let mut correlations = vec![1.0, correlation(1)];
    let (mut even, mut odd) = (1.0, correlations[1]);
    let mut lag = 1;
    while lag < n - 3 && even + odd > 0.0 {
        (even, odd) = (correlation(lag + 1), correlation(lag + 2));
        if even + odd >= 0.0 {
            correlations.extend([even, odd]);
        }
        lag += 2;
    }
    if even + odd >= 0.0 && correlations.len() > 2 {
        // Correlated to the very end: the last pair is the noisiest.
        correlations.truncate(correlations.len() - 2);
    }
    // The sum of pairs never grows (initial monotone sequence).
    let mut smallest = f64::INFINITY;
    let mut time = -1.0;
    for pair in correlations.chunks_exact(2) {
        smallest = smallest.min(pair[0] + pair[1]);
        time += 2.0 * smallest;
    }
    // The last even term stabilizes antithetic chains.
    time += even.max(0.0);
    let count = (m * n) as f64;
    count / time.max(1.0 / elementary::log10(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chains of a linear congruential generator, made in the same way by the script that gave the
    /// reference numbers (arviz, methods `rank`, `bulk` and `tail`).
    fn chains(shift: f64, persistence: f64) -> Vec<Vec<f64>> {
        let mut state: u64 = 12345;
        let mut uniform = || {
            state = (state * 1_103_515_245 + 12345) % (1 << 31);
            state as f64 / f64::from(1u32 << 31)
        };
        (0..4)
            .map(|chain| {
                let mut value = 0.0;
                (0..200)
                    .map(|_| {
                        let noise: f64 = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
                        value = persistence * value + noise;
                        value + shift * f64::from(chain)
                    })
                    .collect()
            })
            .collect()
    }

    #[test]
    fn as_arviz_computes_them() {
        // arviz-stats: array_stats.rhat and array_stats.ess.
        let cases = [
            (0.0, 0.0, [1.0028596769263132, 820.1066754271498, 813.1623502780711]),
            (0.0, 0.8, [1.0347779534500914, 121.9319511696774, 222.72682851793857]),
            (0.5, 0.3, [1.1447578570553931, 20.333698203364854, 510.88944971891794]),
            (0.0, -0.5, [1.0112219137180132, 2322.471989593555, 812.8145150772458]),
        ];
        for (shift, persistence, expected) in cases {
            let chains = chains(shift, persistence);
            let found = [r_hat(&chains), bulk_ess(&chains), tail_ess(&chains)];
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found / expected - 1.0).abs() < 1e-9,
                    "{shift} {persistence}: {found} {expected}"
                );
            }
        }
    }
}
