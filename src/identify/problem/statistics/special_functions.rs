//! The incomplete gamma and beta functions, from [`elementary`] functions alone, so that
//! probabilities have the same digits on every machine (DiDonato & Morris, ACM Transactions on
//! Mathematical Software 12 (1986) and 18 (1992), name the expansions).

use crate::elementary;

/// Most terms of a series or a continued fraction; both need about the root of their parameter.
const MOST_TERMS: usize = 100_000;
/// In place of a zero denominator of a continued fraction (Lentz).
const TINY: f64 = 1e-300;

/// ln Γ(x) for a positive x: Stirling's series, after the recurrence where x is small.
pub(crate) fn ln_gamma(x: f64) -> f64 {
    const TERMS: [f64; 7] = [
        1.0 / 12.0,
        -1.0 / 360.0,
        1.0 / 1_260.0,
        -1.0 / 1_680.0,
        1.0 / 1_188.0,
        -691.0 / 360_360.0,
        1.0 / 156.0,
    ];
    let (mut own, mut product) = (x, 1.0);
    while own < 15.0 {
        product *= own;
        own += 1.0;
    }
    let square = 1.0 / (own * own);
    let series = TERMS.iter().rev().fold(0.0, |sum, term| sum * square + term) / own;
    let half_ln_tau = 0.5 * elementary::ln(std::f64::consts::TAU);
    (own - 0.5) * elementary::ln(own) - own + half_ln_tau + series - elementary::ln(product)
}

/// ln of the number of ways to choose `k` of `n`.
pub(crate) fn ln_binomial(n: u64, k: u64) -> f64 {
    let factorial = |n: u64| ln_gamma(n as f64 + 1.0);
    factorial(n) - factorial(k) - factorial(n - k)
}

/// The regularized incomplete gamma functions P(a, x) and Q(a, x) = 1 - P(a, x).
pub(crate) fn gamma_tails(a: f64, x: f64) -> [f64; 2] {
    if x <= 0.0 {
        return [0.0, 1.0];
    }
    if x.is_infinite() {
        return [1.0, 0.0];
    }
    let factor = elementary::exp(a * elementary::ln(x) - x - ln_gamma(a));
    if x < a + 1.0 {
        let (mut term, mut sum) = (1.0 / a, 1.0 / a);
        for k in 1..MOST_TERMS {
            term *= x / (a + k as f64);
            sum += term;
            if term < sum * f64::EPSILON / 4.0 {
                break;
            }
        }
        let lower = (factor * sum).min(1.0);
        return [lower, 1.0 - lower];
    }
    let upper = continued_fraction(x + 1.0 - a, |k| {
        let k = k as f64;
        (k * (a - k), x + 2.0 * k + 1.0 - a)
    });
    let upper = (factor / upper).min(1.0);
    [1.0 - upper, upper]
}

/// The regularized incomplete beta functions I(x; a, b) and 1 - I(x; a, b), from `x` and `1 - x`.
pub(crate) fn beta_tails(a: f64, b: f64, [x, rest]: [f64; 2]) -> [f64; 2] {
    if x <= 0.0 {
        return [0.0, 1.0];
    }
    if rest <= 0.0 {
        return [1.0, 0.0];
    }
    if x > (a + 1.0) / (a + b + 2.0) {
        let [lower, upper] = beta_tails(b, a, [rest, x]);
        return [upper, lower];
    }
    let ln_beta = ln_gamma(a) + ln_gamma(b) - ln_gamma(a + b);
    let factor = elementary::exp(a * elementary::ln(x) + b * elementary::ln(rest) - ln_beta);
    let fraction = continued_fraction(1.0, |k| {
        let half = (k / 2) as f64;
        let numerator = match k % 2 {
            0 => half * (b - half) * x / ((a + 2.0 * half - 1.0) * (a + 2.0 * half)),
            _ => -(a + half) * (a + b + half) * x / ((a + 2.0 * half) * (a + 2.0 * half + 1.0)),
        };
        (numerator, 1.0)
    });
    let lower = (factor / (a * fraction)).clamp(0.0, 1.0);
    [lower, 1.0 - lower]
}

/// `b₀ + a₁/(b₁ + a₂/(b₂ + …))` by Lentz's method; `term` gives aₖ and bₖ.
fn continued_fraction(first: f64, term: impl Fn(usize) -> (f64, f64)) -> f64 {
    let nonzero = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut value = nonzero(first);
    let (mut c, mut d) = (value, 0.0);
    for k in 1..MOST_TERMS {
        let (a, b) = term(k);
        d = 1.0 / nonzero(b + a * d);
        c = nonzero(b + a / c);
        value *= c * d;
        if (c * d - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    value
}

/// Where a function of a positive number, not increasing, falls to `value`; by bisection to the
/// last bit.
pub(crate) fn falls_to(value: f64, function: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0_f64, 1.0_f64);
    while function(high) > value {
        (low, high) = (high, 2.0 * high);
        if high.is_infinite() {
            return high;
        }
    }
    loop {
        let middle = low + (high - low) / 2.0;
        if middle <= low || middle >= high {
            return high;
        }
        if function(middle) > value {
            low = middle;
        } else {
            high = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 1e-13 * expected.abs(), "{found} {expected}");
    }

    /// Values computed with 60 digits.
    #[test]
    fn special_functions_have_thirteen_digits() {
        near(ln_gamma(0.7), 0.260_867_246_531_666_5);
        near(ln_gamma(33.25), 82.429_238_345_909_04);
        assert!(ln_gamma(1.0).abs() < 1e-14 && ln_gamma(2.0).abs() < 1e-14);
        near(ln_binomial(10, 3), 120_f64.ln());
        near(gamma_tails(200.0, 210.0)[0], 0.763_969_674_501_153_9);
        near(beta_tails(30.0, 0.5, [0.4, 0.6])[0], 1.510_860_857_718_345_5e-13);
        near(beta_tails(0.5, 30.0, [0.6, 0.4])[1], 1.510_860_857_718_345_5e-13);
        near(falls_to(0.25, |x| 1.0 / (1.0 + x)), 3.0);
    }
}
