//! Derivatives of cubic Hermite splines through points with strictly increasing abscissae.
//!
//! References: [Akima 1970](gapilib_base::bibliography#akima-1970),
//! [Fritsch & Butland 1984](gapilib_base::bibliography#fritsch-butland-1984),
//! [Steffen 1990](gapilib_base::bibliography#steffen-1990).

/// How the derivatives at the points are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Spline {
    /// Akima's weights.
    Akima,
    /// Akima's weights with the means of the secants added, so that flat parts do not overshoot.
    ModifiedAkima,
    /// The weighted harmonic mean of Fritsch and Butland; keeps monotonicity.
    FritschButland,
    /// Steffen's limited parabola; keeps monotonicity.
    Steffen,
}

impl Spline {
    /// The derivative at every point; at least two points.
    pub(crate) fn derivatives(self, x: &[f64], y: &[f64]) -> Vec<f64> {
        let h: Vec<f64> = x.windows(2).map(|x| x[1] - x[0]).collect();
        let m: Vec<f64> = y.windows(2).zip(&h).map(|(y, h)| (y[1] - y[0]) / h).collect();
        if m.len() == 1 {
            return vec![m[0]; 2];
        }
        match self {
            Spline::Akima => akima(&m, difference),
            Spline::ModifiedAkima => akima(&m, |a, b| (b - a).abs() + (b + a).abs() / 2.0),
            Spline::FritschButland => inner_and_ends(&h, &m, fritsch_butland),
            Spline::Steffen => inner_and_ends(&h, &m, steffen),
        }
    }
}

/// Secants with two more at either end, which continue the last two linearly; a single one is
/// repeated.
pub(crate) fn extended(m: &[f64]) -> Vec<f64> {
    let n = m.len();
    if n == 1 {
        return vec![m[0]; 5];
    }
    let mut all = vec![0.0; n + 4];
    all[2..n + 2].copy_from_slice(m);
    all[1] = 2.0 * all[2] - all[3];
    all[0] = 2.0 * all[1] - all[2];
    all[n + 2] = 2.0 * all[n + 1] - all[n];
    all[n + 3] = 2.0 * all[n + 2] - all[n + 1];
    all
}

/// The shares of the secants before and after a point in the derivative there; `m` are the two
/// secants on either side.
pub(crate) fn shares(m: &[f64], weight: fn(f64, f64) -> f64) -> [f64; 2] {
    let (before, after) = (weight(m[2], m[3]), weight(m[0], m[1]));
    match before + after {
        0.0 => [0.5, 0.5],
        sum => [before / sum, after / sum],
    }
}

/// The difference of two secants.
pub(crate) fn difference(a: f64, b: f64) -> f64 {
    (b - a).abs()
}

/// w₋ m₋ + w₊ m₊ with shares by the neighbours' secants.
fn akima(m: &[f64], weight: fn(f64, f64) -> f64) -> Vec<f64> {
    let derivative = |m: &[f64]| {
        let [before, after] = shares(m, weight);
        before * m[1] + after * m[2]
    };
    extended(m).windows(4).map(derivative).collect()
}

/// Derivatives between two intervals; at the ends those of the first and of the last interval, as
/// in the standard library.
fn inner_and_ends(h: &[f64], m: &[f64], inner: fn([f64; 2], [f64; 2]) -> f64) -> Vec<f64> {
    let n = m.len();
    let mut derivatives = vec![m[0]];
    derivatives.extend((1..n).map(|i| inner([h[i - 1], h[i]], [m[i - 1], m[i]])));
    derivatives.push(m[n - 1]);
    derivatives
}

fn fritsch_butland(h: [f64; 2], m: [f64; 2]) -> f64 {
    if m[0] * m[1] <= 0.0 {
        return 0.0;
    }
    let (a, b) = (2.0 * h[1] + h[0], h[1] + 2.0 * h[0]);
    (a + b) / (a / m[0] + b / m[1])
}

fn steffen(h: [f64; 2], m: [f64; 2]) -> f64 {
    let sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
    let parabola = (m[0] * h[1] + m[1] * h[0]) / (h[0] + h[1]);
    let limit = m[0].abs().min(m[1].abs()).min(0.5 * parabola.abs());
    (sign(m[0]) + sign(m[1])) * limit
}
