//! Norms relative to nominal values.

/// The integrator computes the shares from differences of z, which the narrowest layer makes so
/// inexact.
const SHARE_NOISE: f64 = 1e-6;

/// The nominal value of a share of a sliding mode. Along a surface that moves or is curved the integrator's error of a
/// share is that of y, divided by the width of the layer and by the step: with an accuracy as that
/// of y, tests of the error would make steps shorter and this error larger until the steps are used up
/// (`der(x) = if x > 0.3*sin(3*time) then -2 else 2` at the tolerance 1e-6). What y does follows from
/// the mean of the shares over time, and their values are recomputed where they are requested.
pub(crate) fn nominal_share(tolerance: f64) -> f64 {
    (SHARE_NOISE / tolerance).max(1.0 / tolerance.sqrt())
}

/// Writes the weight of every variable, tolerance · max(|y|, nominal).
pub(crate) fn set_weights(tolerance: f64, y: &[f64], nominal: &[f64], weights: &mut [f64]) {
    for ((weight, y), nominal) in weights.iter_mut().zip(y).zip(nominal) {
        *weight = tolerance * y.abs().max(*nominal);
    }
}

/// Root mean square of x / weight for the first variables, those that have weights; 0 for none.
pub(crate) fn weighted_rms(x: &[f64], weights: &[f64]) -> f64 {
    let x = &x[..weights.len()];
    if x.is_empty() {
        return 0.0;
    }
    if x.len() < 4 {
        let squares = x.iter().zip(weights).map(|(x, weight)| (x / weight) * (x / weight));
        return (squares.sum::<f64>() / x.len() as f64).sqrt();
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
