//! Norms relative to nominal values.

/// Writes the weight of every variable, tolerance · max(|y|, nominal).
pub(super) fn set_weights(tolerance: f64, y: &[f64], nominal: &[f64], weights: &mut [f64]) {
    for ((weight, y), nominal) in weights.iter_mut().zip(y).zip(nominal) {
        *weight = tolerance * y.abs().max(*nominal);
    }
}

/// Root mean square of x / weight; 0 for no variables.
pub(super) fn weighted_rms(x: &[f64], weights: &[f64]) -> f64 {
    if x.is_empty() {
        return 0.0;
    }
    let sum: f64 = x.iter().zip(weights).map(|(x, weight)| (x / weight).powi(2)).sum();
    (sum / x.len() as f64).sqrt()
}
