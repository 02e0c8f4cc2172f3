//! Norms relative to nominal values.

/// Writes the weight of every variable, tolerance · max(|y|, nominal).
pub(super) fn set_weights(tolerance: f64, y: &[f64], nominal: &[f64], weights: &mut [f64]) {
    for ((weight, y), nominal) in weights.iter_mut().zip(y).zip(nominal) {
        *weight = tolerance * y.abs().max(*nominal);
    }
}

/// Root mean square of x / weight for the first variables, those that have weights; 0 for none.
pub(super) fn weighted_rms(x: &[f64], weights: &[f64]) -> f64 {
    let x = &x[..weights.len()];
    if x.is_empty() {
        return 0.0;
    }
    // Four sums that do not wait for each other.
    let mut sums = [0.0; 4];
    let (x_fours, weight_fours) = (x.chunks_exact(4), weights.chunks_exact(4));
    let last = x_fours.remainder().iter().zip(&weights[x.len() - x.len() % 4..]);
    let rest: f64 = last.map(|(x, weight)| (x / weight) * (x / weight)).sum();
    for (x, weights) in x_fours.zip(weight_fours) {
        for ((sum, x), weight) in sums.iter_mut().zip(x).zip(weights) {
            let ratio = x / weight;
            *sum += ratio * ratio;
        }
    }
    ((sums.iter().sum::<f64>() + rest) / x.len() as f64).sqrt()
}
